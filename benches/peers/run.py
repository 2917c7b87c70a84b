#!/usr/bin/env python3
"""Measures pyHarm and blisk on lumped24 side by side; see README.md beside this file."""

import argparse
import os
import resource
import subprocess
import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
ONE_THREAD = {
    name: "1" for name in ("RAYON_NUM_THREADS", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
}
# Two readings of what pyHarm takes for a peak are held against the same bar: a curve that is fine enough, since it has no
# search, and a search written round it.
CURVE_BAR, PEAK_BAR = 200, 2000
CURVE_BAR_MS = 60


def run(command, folder=ROOT):
    """Standard output of a command, and the processor time that it took, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [str(part) for part in command], cwd=folder, env=os.environ | ONE_THREAD, check=True, text=True,
        stdout=subprocess.PIPE,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def figures(text):
    return tomllib.loads("\n".join(line for line in text.splitlines() if " = " in line))


def with_pyharm(environment, version):
    """The Python of an environment with pyHarm, made once."""
    python = environment / "bin" / "python"
    marker = environment / f"pyharm-os-{version}"
    if not marker.exists():
        run([sys.executable, "-m", "venv", environment])
        run([python, "-m", "pip", "install", "--quiet", f"pyharm-os=={version}"])
        marker.touch()
    return python


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--environment", type=Path, default=ROOT / "target" / "peers")
    arguments.add_argument("--repetitions", type=int, default=3, help="of pyHarm; the smallest time counts")
    arguments = arguments.parse_args()
    environment = arguments.environment.resolve()
    python = with_pyharm(environment, "1.2.2")

    run(["cargo", "build", "--release"])
    run(["cargo", "bench", "--bench", "curve", "--no-run"])
    bench = ["cargo", "bench", "--quiet", "--bench", "curve"]
    # Before and after, so that a machine that grows busy is seen.
    before = figures(run(bench)[0])
    # pyHarm leaves a folder where it is run.
    case = ROOT / "tests" / "data" / "lumped24"
    peer = figures(run([python, HERE / "pyharm_case.py", case, arguments.repetitions], environment)[0])
    after = figures(run(bench)[0])
    own = {name: min(before[name], after[name]) if name.endswith("_ms") else before[name] for name in before}
    response = [
        ROOT / "target" / "release" / "blisk", "response", "studies/lumped24.toml", "--pattern", "0", "--load", "50",
        "--frequencies", "340:370:121", "--out", environment / "curve.csv",
    ]
    process = min(run(response)[1] for _ in range(5))

    print(f"load average {os.getloadavg()[0]:.1f}; blisk before and after pyHarm: curve {before['curve_ms']:.0f} and "
          f"{after['curve_ms']:.0f} ms, peak {before['peak_ms']:.0f} and {after['peak_ms']:.0f} ms\n")
    print("| processor time on one thread | pyHarm, s | blisk, ms | ratio | bar |")
    print("| --- | ---: | ---: | ---: | ---: |")

    def line(what, seconds, milliseconds, bar=""):
        print(f"| {what} | {seconds:.2f} | {milliseconds:.1f} | {1e3 * seconds / milliseconds:.0f} | {bar} |")

    line("curve of 121 points", peer["curve_s"], own["curve_ms"], CURVE_BAR)
    line("the same, whole process `blisk response`", peer["curve_s"], 1e3 * process)
    line(f"peak to 0.1 %, pyHarm as it is: {peer['swept_points']} points", peer["swept_s"], own["peak_ms"], PEAK_BAR)
    line("the same, pyHarm with a search round it", peer["peak_s"], own["peak_ms"], PEAK_BAR)
    line("the same, with blisk's error columns", peer["peak_s"], own["row_ms"])
    print(f"\nbar of the curve: {CURVE_BAR_MS} ms")
    print(f"worst blade: pyHarm {peer['curve_difference']:.1e}, blisk {own['curve_difference']:.1e} from the reference")
    print(f"peak: pyHarm {peer['peak_m']:.4e} m in {peer['peak_solves']} solves (off by {peer['peak_difference']:.1e}), "
          f"blisk {own['peak_m']:.4e} m in {own['peak_solves']} (off by {own['peak_difference']:.1e})")


main()
