#!/usr/bin/env python3
"""Measures what a row of the built-in wheel costs against sectors, contact pairs, harmonics, patterns and threads.

A row is a peak with its error columns under one normal load. Every study is `studies/quickstart.toml` with two loads and
one thing changed; its model is reduced by a first run. The cost of a row is the difference in processor time of two runs
with few and with more patterns, over the rows between them, so that what a study does once does not count.
Prints a Markdown table; needs nothing but Python and the release binary (`cargo build --release`, or BLISK).

With `--first-row` it prints instead what the first row takes from nothing against the contact pairs of a sector: processor
time on one thread, and the most memory.
"""

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LOADS = (320, 800)
FEW = 2
# Elements along the flange and in the passage beside a blade: 4, 24, 40 and 60 contact pairs a sector.
MESHES = {4: (1, 1), 24: (3, 3), 40: (4, 4), 60: (5, 5)}


def study(sectors, model, harmonics, patterns, loads=LOADS):
    """The quickstart with these settings."""
    text = (ROOT / "studies" / "quickstart.toml").read_text()
    options = "".join(f"{key} = {value}\n" for key, value in {"sectors": sectors, **model}.items())
    changes = [
        (r"(?m)^patterns = \d+", f"patterns = {patterns}"),
        (r'source = "parametric"\n', f'source = "parametric"\n[model.parametric]\n{options}'),
        (r"normal_load_n = .*\n", f"normal_load_n = {list(loads)}\n"),
    ]
    for pattern, replacement in changes:
        text, count = re.subn(pattern, replacement, text, count=1)
        assert count == 1, pattern
    return f"{text}\n[solver]\nharmonics = {list(harmonics)}\n" if harmonics else text


def run(blisk, text, scratch, model=None, threads=1):
    """Processor and elapsed time, s, of a run into a new folder, with its reduced model or that of an earlier one."""
    folder = Path(tempfile.mkdtemp(dir=scratch))
    file = folder / "study.toml"
    file.write_text(text)
    if model:
        shutil.copytree(model, folder / "out" / "model")
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    command = [blisk, "run", file, "--threads", str(threads), "--out", folder / "out"]
    done = subprocess.run(command, capture_output=True, text=True)
    elapsed, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{text}\n{done.stderr}")
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return used, elapsed, folder / "out" / "model"


def first_row(blisk, scratch, pairs):
    """Processor time, s, and memory, MiB, of a run with one pattern under one load, its model included."""
    flange, passage = MESHES[pairs]
    model = {"flange_axial_elements": flange, "passage_elements": passage}
    text = study(sectors=24, model=model, harmonics=(), patterns=1, loads=(480,))
    folder = Path(tempfile.mkdtemp(dir=scratch))
    (folder / "study.toml").write_text(text)
    command = [blisk, "run", folder / "study.toml", "--threads", "1", "--out", folder / "out"]
    with open(folder / "messages", "w") as messages:
        process = subprocess.Popen(command, stdout=messages, stderr=messages)
        _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit((folder / "messages").read_text())
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def measure(blisk, scratch, more, **settings):
    """Processor time of the reduction, s, and of a row, ms."""
    with_model, _, model = run(blisk, study(patterns=FEW, **settings), scratch)
    few, _, _ = run(blisk, study(patterns=FEW, **settings), scratch, model)
    many, _, _ = run(blisk, study(patterns=more, **settings), scratch, model)
    return with_model - few, 1e3 * (many - few) / ((more - FEW) * len(LOADS))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--patterns", type=int, default=10, help="of the longer run")
    arguments.add_argument("--first-row", type=int, nargs="+", choices=MESHES, metavar="PAIRS", help="4, 24, 40 or 60 each")
    options = arguments.parse_args()
    blisk = os.environ.get("BLISK", ROOT / "target" / "release" / "blisk")
    if options.first_row:
        print("| contact pairs | first row, s | memory, MiB |\n| --- | ---: | ---: |")
        with tempfile.TemporaryDirectory() as scratch:
            for pairs in options.first_row:
                used, memory = first_row(blisk, scratch, pairs)
                print(f"| {pairs} | {used:.1f} | {memory:.0f} |", flush=True)
        return
    base = {"sectors": 24, "model": {}, "harmonics": ()}
    cases = [("as in quickstart", {})]
    cases += [(f"{n} sectors", {"sectors": n}) for n in (8, 12, 48)]
    cases += [("3 elements along the flange", {"model": {"flange_axial_elements": 3}})]
    cases += [
        ("harmonic 1", {"harmonics": (1,)}),
        ("harmonics 1, 3", {"harmonics": (1, 3)}),
        ("harmonics 1, 3, 5, 7, 9", {"harmonics": (1, 3, 5, 7, 9)}),
    ]
    print("| study | model, s | row, ms |\n| --- | ---: | ---: |")
    with tempfile.TemporaryDirectory() as scratch:
        for name, change in cases:
            model, row = measure(blisk, scratch, options.patterns, **base | change)
            print(f"| {name} | {model:.1f} | {row:.0f} |", flush=True)
        print("\n| patterns, threads | processor time, s | elapsed, s |\n| --- | ---: | ---: |")
        _, _, model = run(blisk, study(patterns=FEW, **base), scratch)
        for patterns, threads in ((10, 1), (40, 1), (40, 2)):
            used, elapsed, _ = run(blisk, study(patterns=patterns, **base), scratch, model, threads)
            print(f"| {patterns}, {threads} | {used:.1f} | {elapsed:.1f} |", flush=True)


if __name__ == "__main__":
    main()
