"""Compares the contact-free frequencies of a bundle with CalculiX's cyclic symmetry runs.

    python3 compare.py BUNDLE/frequencies.csv BODY.dat [BODY.dat ...]

Blisk and ring are separate runs of CalculiX; their frequencies are merged. Every mode is listed twice
there (for nodal diameter 0 and N/2, too). Frequencies below 10 Hz in magnitude are the rounding of the
free ring's rigid motions and are left out. Ends with 1 if any frequency is off by more than 0.01 %, or if a
nodal diameter has no frequency to compare.
"""

import csv
import math
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


def refuse(*words):
    sys.exit("FAILED: " + " ".join(str(word) for word in words))


def elastic(frequencies, end):
    return sorted(hz for hz in frequencies if abs(hz) > LEAST_HZ and hz <= end)


def main(bundle, *runs):
    ours = {}
    for row in csv.DictReader(open(bundle)):
        ours.setdefault(int(row["nodal_diameter"]), []).append(float(row["frequency_hz"]))
    theirs, ends = {}, {}
    for run in runs:
        for diameter, frequencies in calculix(run).items():
            theirs.setdefault(diameter, []).extend(frequencies)
            ends[diameter] = min(ends.get(diameter, math.inf), max(frequencies))
    if not ours or sorted(ours) != sorted(theirs):
        refuse(f"nodal diameters {sorted(ours)} in {bundle}, {sorted(theirs)} of CalculiX")
    if len({len(frequencies) for frequencies in ours.values()}) > 1:
        refuse(f"{bundle} has not as many frequencies in every nodal diameter")
    if not all(math.isfinite(hz) for found in (ours, theirs) for row in found.values() for hz in row):
        refuse("a frequency is no finite number")
    worst, count = 0.0, 0
    for diameter, frequencies in sorted(ours.items()):
        # Each list ends somewhere: what lies beyond the end of the other has nothing to be compared with.
        own = elastic(frequencies, ends[diameter] * (1 + LIMIT))
        reference = elastic(theirs[diameter], min(ends[diameter], max(frequencies) * (1 + LIMIT)))
        if not own or len(own) != len(reference):
            refuse(f"nodal diameter {diameter}: {own} against {reference}")
        for hz, other in zip(own, reference):
            difference = abs(hz / other - 1)
            if not difference <= LIMIT:
                refuse(f"nodal diameter {diameter}: {hz} Hz against {other} Hz")
            worst = max(worst, difference)
        count += len(own)
    print(f"{bundle}: {count} frequencies, worst relative difference to CalculiX {worst:.1e} (accepted {LIMIT:.0e})")


main(*sys.argv[1:])
