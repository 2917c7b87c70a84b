"""Runs the Python recipes of docs/reading-results.md on a results folder.

    python recipes.py RESULTS
"""

import re
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reading-results.md"


def main():
    sections = re.split(r"^## ", PAGE.read_text(), flags=re.MULTILINE)[1:]
    run = 0
    for section in sections:
        name = section.splitlines()[0]
        for recipe in re.findall(r"^```python\n(.*?)^```", section, flags=re.MULTILINE | re.DOTALL):
            if "Run by `.ci/run`." not in section:
                sys.exit(f"FAILED: {name} has a recipe in Python that does not say that it is run")
            print(f"-- {name}")
            exec(compile(recipe, f"{PAGE.name}: {name}", "exec"), {"results": sys.argv[1]})
            run += 1
    if run < 4:
        sys.exit(f"FAILED: only {run} recipes were found")


main()
