"""Holds the table of condition numbers that the tests read to an independent computation by numpy and scipy.

    python compare_condition.py

`tests/data/lumped24/condition.py` makes `condition.csv`. Its last column is of modes that are dependent to rounding, and
is not compared.
"""

import csv
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / "data" / "lumped24"
COMPARED = ["ring", "contact_n_per_m", "condition", "condition_euclidean"]


def main():
    made = subprocess.run([sys.executable, FOLDER / "condition.py"], stdout=subprocess.PIPE, text=True, check=True)
    rows = list(csv.DictReader(made.stdout.splitlines()))
    stored = list(csv.DictReader((FOLDER / "condition.csv").read_text().splitlines()))
    if len(rows) != 9 or len(stored) != 9:
        sys.exit(f"condition numbers: {len(rows)} rows made, {len(stored)} stored, not 9")
    errors = [abs(float(row[name]) / float(kept[name]) - 1.0) for row, kept in zip(rows, stored) for name in COMPARED]
    # Five digits are stored. What is not a number is not below, either.
    if not all(error < 2e-4 for error in errors):
        sys.exit(f"condition numbers: those made and those stored differ: {errors}")
    print(f"9 condition numbers are those stored, to {max(errors):.0e}")


main()
