"""Faults that the comparison has to find, planted into a binary."""

import shutil
import sys

from sides import all_found, difference
from studies import Case, small

CASE = Case("proof", small(), "run study.toml", "plan study.toml --pilot 2", "status results/small")


def edited(path, old, new):
    """A line of the shell that replaces a text in a file."""
    return f"sed 's/{old}/{new}/' {path} >edited && mv edited {path}"


def overwritten(path):
    """A line of the shell that writes over one byte of a file."""
    return f"printf x | dd of={path} bs=1 seek=99 conv=notrunc 2>/dev/null"


# What a stand-in for the binary does at the last line of the case, once the binary itself has done its part.
FAULTS = {
    "an exit code": "code=1",
    "an end by a signal": "kill -9 $$",
    "a line of stdout": "echo more",
    "a line of stderr": "echo more >&2",
    "a digit of a text": edited("results/small/summary.txt", "seed 7", "seed 8"),
    "a digit of a manifest": edited("results/small/manifest.json", '"seed": 7', '"seed": 8'),
    "a digit beside the times of a record": edited("results/small/runs/1.json", '"threads": 1', '"threads": 2'),
    "a byte of a table": overwritten("results/small/responses.parquet"),
    "a byte of a reduced model": overwritten("$(echo results/small/model/*)"),
    "a file that is missing": "rm results/small/percentiles.parquet",
    "a file more": ": >results/small/more.txt",
}


def stand_in(path, binary, fault):
    """Writes a program that does what the binary does, and the fault."""
    path.write_text(f'#!/bin/sh\n{binary} "$@"\ncode=$?\nif [ "$1" = status ]; then\n{fault}\nfi\nexit $code\n')
    path.chmod(0o755)
    return path


def proved(binary, scratch):
    """Prints a line a fault; whether every one is found, and the binary is the same as itself."""
    real, text = scratch / "real" / "blisk", scratch / "text"
    real.parent.mkdir()
    shutil.copy(binary, real)
    text.write_text("no program\n")
    programs = {
        "no binary": scratch / "absent",
        "no program": text,
        "another program": sys.executable,
        **{what: stand_in(scratch / f"{number}", real, fault) for number, (what, fault) in enumerate(FAULTS.items())},
    }

    def outcome(program):
        [found] = all_found(program, [CASE], scratch)
        return found

    own, again = outcome(binary), outcome(binary)
    outcomes = {what: outcome(program) for what, program in programs.items()}
    pairs = {
        **{what: (own, found) for what, found in outcomes.items()},
        "no binary on both sides": (outcomes["no binary"],) * 2,
        "an exit code on both sides": (outcomes["an exit code"],) * 2,
    }
    differences = {what: difference(*pair) for what, pair in pairs.items()}
    for what, found in differences.items():
        print(f"{what}: {f'found: {found}' if found else 'NOT FOUND'}")
    itself = difference(own, again)
    print(f"the binary beside itself: {f'DIFFERS: {itself}' if itself else 'same'}")
    return itself is None and all(differences.values())
