"""Packages that one function needs and the others do not."""

from __future__ import annotations

import importlib
from typing import Any

# The first is the one that is missing; what the function needs besides stands with it.
_INSTALLED_BY = {
    "ansys.mapdl.reader": "ansys-mapdl-reader scipy",
    "pyyeti.nastran": "pyyeti scipy",
    "scipy.sparse": "scipy",
    "scipy.sparse.linalg": "scipy",
    "scipy.io": "scipy",
    "scipy.spatial": "scipy",
    "matplotlib.pyplot": "matplotlib",
    "matplotlib.ticker": "matplotlib",
}


def needed(module: str, what: str) -> Any:
    """The module, which is needed for ``what``; ``ImportError`` says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        packages = _INSTALLED_BY.get(module, module)
        raise ImportError(
            f"{what} needs the package {packages.split()[0]}, which cannot be imported ({error}); pip install {packages}"
        ) from error
