"""Lists the examples, or runs one: ``python -m blisk.examples NAME [FOLDER]``."""

from __future__ import annotations

import ast
import runpy
import sys
from pathlib import Path

HERE = Path(__file__).parent
EXAMPLES = {path.stem: path for path in sorted(HERE.glob("[!_]*.py"))}


def main(arguments: list[str]) -> None:
    """Carries out the command line."""
    if not arguments:
        print("python -m blisk.examples NAME [FOLDER] runs one of these scripts; FOLDER has its results.\n")
        for name, path in EXAMPLES.items():
            about = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
            print(f"{name}: {about.splitlines()[0]}\n    {path}")
        return
    name = arguments[0]
    if name not in EXAMPLES:
        sys.exit(f"error: {name} is no example; accepted: {', '.join(EXAMPLES)}")
    sys.argv = [str(EXAMPLES[name]), *arguments[1:]]
    runpy.run_path(str(EXAMPLES[name]), run_name="__main__")


if __name__ == "__main__":
    main(sys.argv[1:])
