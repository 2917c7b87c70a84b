#!/usr/bin/env python3
"""Measures what an accepted error costs: the quickstart with few patterns by `blisk run --accuracy E --threads 1`.

Prints a Markdown table: processor time of the whole run, the two errors that the run measured on its sample before the
first row (manifest.json, chosen.accuracy), and the median of what the rows with friction state. The runs alternate, so
that other work on the machine meets all of them alike; the least time of each is shown.
Needs pyarrow and the release binary (`cargo build --release`, or BLISK).
"""

import argparse
import json
import os
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import pyarrow.parquet

ROOT = Path(__file__).resolve().parents[2]
ACCEPTED = ("1%", "0.3%", "0.1%")


def run(blisk, study, accepted, folder):
    """Processor time of a run into a new folder, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [blisk, "run", study, "--accuracy", accepted, "--threads", "1", "--out", folder]
    done = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def errors(folder):
    """Upper bound of the 95th percentile, worst of the sample, median of what rows with friction state."""
    evidence = json.loads((folder / "manifest.json").read_text())["chosen"]["accuracy"]["evidence"]["amplitude"]
    rows = pyarrow.parquet.read_table(folder / "responses.parquet", columns=["contact", "stated_error"]).to_pylist()
    stated = statistics.median(row["stated_error"] for row in rows if row["contact"] == "full" and row["stated_error"])
    return evidence["p95_upper"], evidence["worst"], stated


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--patterns", type=int, default=12)
    arguments.add_argument("--repeats", type=int, default=2)
    options = arguments.parse_args()
    blisk = os.environ.get("BLISK", ROOT / "target" / "release" / "blisk")
    text = (ROOT / "studies" / "quickstart.toml").read_text()
    text, count = re.subn(r"patterns = \d+", f"patterns = {options.patterns}", text, count=1)
    assert count == 1
    with tempfile.TemporaryDirectory() as scratch:
        study = Path(scratch) / "study.toml"
        study.write_text(text)
        times, found = {}, {}
        for repeat in range(options.repeats):
            for accepted in ACCEPTED:
                folder = Path(scratch) / f"{accepted}-{repeat}"
                times.setdefault(accepted, []).append(run(blisk, study, accepted, folder))
                found[accepted] = errors(folder)
    least = min(times[ACCEPTED[0]])
    print("| accepted | processor time, s | over that of 1 % | 95 % of the sample within | worst of the sample | rows state (median) |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: |")
    for accepted in ACCEPTED:
        time = min(times[accepted])
        measured = " | ".join(f"{100 * error:.2g} %" for error in found[accepted])
        print(f"| {accepted.replace('%', ' %')} | {time:.1f} | {time / least:.2f} | {measured} |")


if __name__ == "__main__":
    main()
