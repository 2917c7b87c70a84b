"""The figures of the pages are those that `blisk plot` draws of the results of the quickstart.

    python tests/readers/figures.py BLISK RESULTS FOLDER_OF_FIGURES

Text must be the same; a number may differ by what another kind of processor makes of its last digits.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

FIGURES = (
    "amplitude",
    "amplification-factor",
    "amplitude-distribution",
    "uncertainty",
    "worst-response",
    "worst-blades",
    "contact",
    "sector",
    "campbell",
    "safe",
)
# Of a number, and of a place in pixels.
RELATIVE, PIXELS = 2e-3, 0.5
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def difference(drawn, kept):
    """What differs first in two figures; nothing if they agree."""
    words = [NUMBER.split(text) for text in (drawn, kept)]
    if words[0] != words[1]:
        pairs = zip(*words)
        other = next(((a, b) for a, b in pairs if a != b), ("", "a figure with more in it"))
        return f"{other[0]!r} drawn, {other[1]!r} kept"
    numbers = [[float(number) for number in NUMBER.findall(text)] for text in (drawn, kept)]
    for own, other in zip(*numbers):
        if abs(own - other) > max(PIXELS, RELATIVE * abs(other)):
            return f"{own} drawn, {other} kept"
    return None


def check_the_comparison():
    kept = '<text x="10.5">P95 290.9 µm</text>'
    assert difference(kept, kept) is None
    assert difference(kept.replace("10.5", "10.9"), kept) is None
    for other in ("P99 290.9", "P95 297.9", "P95 290.9 mm", ""):
        assert difference(kept.replace("P95 290.9 µm", other), kept), other


def main(blisk, results, folder):
    check_the_comparison()
    wrong = []
    with tempfile.TemporaryDirectory() as place:
        for figure in FIGURES:
            drawn = Path(place) / f"{figure}.svg"
            subprocess.run([blisk, "plot", results, figure, "--out", drawn], check=True, capture_output=True)
            kept = Path(folder) / f"{figure}.svg"
            found = difference(drawn.read_text(encoding="utf-8"), kept.read_text(encoding="utf-8"))
            if found:
                wrong.append(f"{kept}: {found}; `blisk plot {results} {figure} --out {kept}` draws it")
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(FIGURES)} figures are as drawn")


if __name__ == "__main__":
    main(*sys.argv[1:])
