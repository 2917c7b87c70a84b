"""Holds studies/calculix/compare.py to what it promises, without CalculiX: it passes where frequencies agree, and
fails where they do not, or where there is nothing to compare.

    python compare_calculix.py
"""

import subprocess
import sys
import tempfile
from pathlib import Path

COMPARE = Path(__file__).resolve().parents[2] / "studies" / "calculix" / "compare.py"
HZ = 6.283185307179586


def dat(frequencies):
    """The table of a cyclic symmetry run of CalculiX, every mode twice."""
    lines = ["", "     E I G E N V A L U E   O U T P U T", ""]
    for diameter, hertz in frequencies.items():
        mode = 0
        for hz in hertz:
            for _ in range(2):
                mode += 1
                omega = HZ * hz
                lines.append(f"{diameter:7d}{mode:7d}{omega * omega:15.7E}{omega:15.7E}{hz:15.7E}{0.0:15.7E}")
    return "\n".join(lines) + "\n"


def csv(frequencies):
    lines = ["nodal_diameter,mode,frequency_hz"]
    for diameter, hertz in frequencies.items():
        lines += [f"{diameter},{mode},{hz:.9e}" for mode, hz in enumerate(hertz, start=1)]
    return "\n".join(lines) + "\n"


def main():
    wheel = {0: [512.5, 703.25], 1: [515.0, 720.5], 2: [530.0, 731.0]}
    off = {**wheel, 1: [515.0 * 1.0002, 720.5]}
    rigid = {diameter: [0.5, 1.5] for diameter in wheel}
    # What the bundle has, what CalculiX has, and whether they agree.
    cases = {
        "the same": (csv(wheel), dat(wheel), True),
        "0.02 % off": (csv(off), dat(wheel), False),
        "no frequency in the bundle": (csv({}), dat(wheel), False),
        "no frequency of CalculiX": (csv(wheel), "", False),
        "neither": (csv({}), "", False),
        "rigid motions alone": (csv(rigid), dat(rigid), False),
        "a nodal diameter without frequencies in the bundle": (csv({0: wheel[0], 1: wheel[1]}), dat(wheel), False),
        "a nodal diameter without frequencies of CalculiX": (csv(wheel), dat({0: wheel[0], 1: wheel[1]}), False),
        "a frequency too few in the bundle": (csv({**wheel, 2: [530.0]}), dat(wheel), False),
        "a frequency that is no number": (csv({**wheel, 2: [530.0, float("nan")]}), dat(wheel), False),
    }
    with tempfile.TemporaryDirectory() as folder:
        bundle, run = Path(folder) / "frequencies.csv", Path(folder) / "body.dat"
        for name, (ours, theirs, agree) in cases.items():
            bundle.write_text(ours)
            run.write_text(theirs)
            ended = subprocess.run([sys.executable, COMPARE, bundle, run], capture_output=True, text=True)
            if (ended.returncode == 0) != agree:
                sys.exit(f"FAILED: {name}: compare.py ends with {ended.returncode}: {ended.stdout}{ended.stderr}")
        ended = subprocess.run([sys.executable, COMPARE, bundle], capture_output=True, text=True)
        if ended.returncode == 0:
            sys.exit("FAILED: compare.py passes without a run of CalculiX")
    print(f"compare.py: {len(cases) + 1} cases")


main()
