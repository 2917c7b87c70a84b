"""Compares the contact-free frequencies of a bundle with CalculiX's cyclic symmetry runs.

    python3 compare.py BUNDLE/frequencies.csv BODY.dat [BODY.dat ...]

Blisk and ring are separate runs of CalculiX; their frequencies are merged. Every mode is listed twice
there (for nodal diameter 0 and N/2, too). Frequencies below 10 Hz in magnitude are the rounding of the
free ring's rigid motions and are left out. Ends with 1 if any frequency is off by more
than 0.01 %.
"""

import csv
import sys

LIMIT = 1e-4
LEAST_HZ = 10.0


def calculix(path):
    """Frequencies by nodal diameter; negative where the eigenvalue is."""
    frequencies = {}
    for line in open(path):
        words = line.split()
        try:
            diameter, mode = int(words[0]), int(words[1])
            eigenvalue, _, real, imaginary = (float(word) for word in words[2:])
        except (ValueError, IndexError):
            continue
        if mode % 2 == 1:
            hz = real if eigenvalue > 0 else -imaginary / 6.283185307179586
            frequencies.setdefault(diameter, []).append(hz)
    return frequencies


def main(bundle, *runs):
    ours = {}
    for row in csv.DictReader(open(bundle)):
        ours.setdefault(int(row["nodal_diameter"]), []).append(float(row["frequency_hz"]))
    theirs, ends = {}, {}
    for run in runs:
        for diameter, frequencies in calculix(run).items():
            theirs.setdefault(diameter, []).extend(frequencies)
            ends[diameter] = min(ends.get(diameter, float("inf")), max(frequencies))
    worst, count = 0.0, 0
    for diameter, frequencies in sorted(ours.items()):
        own = [hz for hz in frequencies if abs(hz) > LEAST_HZ and hz <= ends[diameter] * (1 + LIMIT)]
        reference = sorted(hz for hz in theirs[diameter] if abs(hz) > LEAST_HZ)[: len(own)]
        assert len(reference) == len(own), f"nodal diameter {diameter}: {own} against {reference}"
        worst = max([worst, *(abs(hz / other - 1) for hz, other in zip(own, reference))])
        count += len(own)
    print(f"{bundle}: {count} frequencies, worst relative difference to CalculiX {worst:.1e} (accepted {LIMIT:.0e})")
    return 0 if worst <= LIMIT else 1


sys.exit(main(*sys.argv[1:]))
