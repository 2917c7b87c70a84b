#!/usr/bin/env python3
"""Compares two builds of the program: did a change of structure move any byte of what users get?

    python3 benches/golden/run.py --before PATH --after PATH
    python3 benches/golden/run.py --before PATH --prove

Both binaries carry out the cases of physics_cases.py and command_cases.py. Exit codes, stdout, stderr and files are
compared byte for byte, but for what masks.py names. A line a case says `same`, or what differs first. The exit code is
0 only if every case ran on both sides and all of it is the same. With `--prove` faults are planted into one binary, and
each has to be found.
Needs nothing but Python and the binaries.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

from command_cases import COMMANDS, REFUSED
from physics_cases import PHYSICS
from proof import proved
from sides import all_found, difference


def compared(options, cases, scratch):
    """Prints a line a case; whether every one is the same."""
    start, same = time.monotonic(), 0
    befores = list(all_found(options.before, cases, scratch, options.jobs))
    half = time.monotonic()
    for case, before, after in zip(cases, befores, all_found(options.after, cases, scratch, options.jobs)):
        found = difference(before, after)
        same += found is None
        print(f"{case.name}: {f'DIFFERS: {found}' if found else 'same'}", flush=True)
        if options.keep:
            keep(before, options.keep / "before" / case.name)
            keep(after, options.keep / "after" / case.name)
    print(f"{same} of {len(cases)} the same; {half - start:.0f} s before, {time.monotonic() - half:.0f} s after")
    return same == len(cases)


def keep(found, folder):
    """Writes what was compared; of a case that failed there is nothing."""
    for name, content in found.items() if isinstance(found, dict) else ():
        is_stream = name.endswith((": stdout", ": stderr"))
        path = folder / (name.replace("/", "_") if is_stream else name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", type=Path, required=True, metavar="PATH", help="a release binary")
    parser.add_argument("--after", type=Path, metavar="PATH", help="another")
    parser.add_argument("--only", default="", metavar="WORD", help="the cases whose names have this word")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="cases at a time")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="write there what was compared, for `diff -r`")
    parser.add_argument("--prove", action="store_true", help="plant faults into --before instead")
    options = parser.parse_args()
    cases = [case for case in PHYSICS + COMMANDS + REFUSED if options.only in case.name]
    if not options.prove and (not options.after or not cases):
        parser.error("no --after" if cases else f"no case has {options.only} in its name")
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        good = proved(options.before, scratch) if options.prove else compared(options, cases, scratch)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
