"""Monte Carlo forced response of randomly mistuned bladed disks with friction dampers.

A study says what is solved, ``run`` solves it, and its results are tables with percentiles:

    study = blisk.Study.from_toml("study.toml")
    results = blisk.run(study)
    print(results.summary_text)

Numbers are those of the command ``blisk``, bit for bit. Units stand in the names of keys and columns: SI, Hz, N.
"""

from ._answer import Answer
from ._answers import (
    campbell,
    check,
    compare,
    estimate,
    merge,
    model,
    modes,
    optimum,
    plan,
    replay,
    response,
    status,
    tails,
    tradeoff,
    verify,
)
from ._errors import BliskError, Finding, InputError
from ._figure import Figure, figures
from ._files import Keys, explain, init, schema, slurm
from ._native import BUILD as __build__
from ._native import VERSION as __version__
from ._native import Table
from ._progress import Progress
from ._results import Best, Results
from ._run import run
from ._sector import Sector
from ._study import Study
from ._wheel import Peak, Wheel

__all__ = [
    "Answer",
    "Best",
    "BliskError",
    "Figure",
    "Finding",
    "InputError",
    "Keys",
    "Peak",
    "Progress",
    "Results",
    "Sector",
    "Study",
    "Table",
    "Wheel",
    "__build__",
    "__version__",
    "campbell",
    "check",
    "compare",
    "estimate",
    "explain",
    "figures",
    "init",
    "merge",
    "model",
    "modes",
    "optimum",
    "plan",
    "replay",
    "response",
    "run",
    "schema",
    "slurm",
    "status",
    "tails",
    "tradeoff",
    "verify",
]
