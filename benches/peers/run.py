#!/usr/bin/env python3
"""Measures other programs and blisk on lumped24 side by side; see README.md beside this file."""

import argparse
import csv
import json
import os
import resource
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
CASE = ROOT / "tests" / "data" / "lumped24"
STUDY = ROOT / "studies" / "lumped24.toml"
ONE_THREAD = {
    name: "1" for name in ("RAYON_NUM_THREADS", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
} | {"XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"}
CURVE_TOLERANCE, PEAK_TOLERANCE = 1e-6, 1e-3
FREQUENCIES = ("340:370:121", "340:340:1")
# The wheels of two studies: their difference is the cost of a row.
WHEELS = (1, 41)
# Two readings of what pyHarm takes for a peak are held against the same bar: a curve that is fine enough, since it has no
# search, and a search written round it.
CURVE_BAR, PEAK_BAR = 200, 2000
CURVE_BAR_MS = 60


def run(command, folder=ROOT):
    """Standard output of a command, and the processor time that it took, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [str(part) for part in command], cwd=folder, env=os.environ | ONE_THREAD, text=True, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stdout}{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def figures(text):
    return tomllib.loads("\n".join(line for line in text.splitlines() if " = " in line))


def with_packages(environment, packages):
    """The Python of an environment with these packages, made once."""
    python = environment / "bin" / "python"
    marker = environment / "_".join(packages)
    if not marker.exists():
        run([sys.executable, "-m", "venv", environment])
        run([python, "-m", "pip", "install", "--quiet", *packages])
        marker.touch()
    return python


class Peer:
    """Another program: its name, and the command that prints its figures for one repetition; or why it is left out."""

    def __init__(self, name, command=None, left_out=None):
        self.name, self.command, self.left_out, self.figures = name, command, left_out, None

    def measure(self, folder):
        found = figures(run(self.command, folder)[0])
        self.figures = keep_least(self.figures, found)


def keep_least(figures, found):
    """The smaller of both times, and the newer of everything else."""
    is_time = lambda name: name.endswith(("_s", "_ms"))
    return found | {name: min(figures[name], found[name]) for name in found if is_time(name)} if figures else found


def pyharm(arguments):
    python = with_packages(arguments.environment / "pyharm", ["pyharm-os==1.2.2"])
    return Peer("pyHarm 1.2.2", [python, HERE / "pyharm_case.py", CASE, 1])


def clone(folder, file, measured):
    """What is written after the name of a program that is a clone: its commit; or why it is left out."""
    if folder is None:
        return None, "no folder of a clone is given"
    if not (folder / file).exists():
        return None, f"{folder} has no {file}"
    head = subprocess.run(["git", "-C", folder, "rev-parse", "HEAD"], text=True, stdout=subprocess.PIPE)
    found = head.stdout.strip() or "of no known commit"
    return found[:7] if found == measured else f"{found[:7]} (not {measured[:7]})", None


def tmdsimpy(arguments):
    version, missing = clone(arguments.tmdsimpy, "tmdsimpy/nlforces/vector_jenkins.py",
                             "17d5fc3ffa22c8ac6f38e5b77e3a396aae261e7b")
    if missing:
        return Peer("tmdsimpy", left_out=f"{missing} (--tmdsimpy)")
    # The versions in its specific_reqs.txt.
    packages = ["numpy==1.26.4", "scipy==1.12.0", "jax==0.4.25", "jaxlib==0.4.25"]
    python = with_packages(arguments.environment / "tmdsimpy", packages)
    return Peer(f"tmdsimpy {version}", [python, HERE / "tmdsimpy_case.py", CASE, 1, arguments.tmdsimpy.resolve()])


def nlvib(arguments):
    version, missing = clone(arguments.nlvib, "SRC/HB_residual.m", "69598c5e85a5967d1931d3560e5c3d7ab968596f")
    octave = shutil.which(arguments.octave)
    if missing or not octave:
        return Peer("NLvib", left_out=f"{missing} (--nlvib)" if missing else f"{arguments.octave} is not installed")
    octave_version = run([octave, "--norc", "--version"])[0].splitlines()[0].split()[-1]
    command = [octave, "--norc", "--quiet", HERE / "nlvib_case.m", CASE, 1, arguments.nlvib.resolve()]
    return Peer(f"NLvib {version} (Octave {octave_version})", command)


class Blisk:
    """Whole processes of the binary, all with the same study, and with the process less the work to take away."""

    def __init__(self, binary, folder):
        self.binary, self.folder = binary, folder
        self.studies = [self.study(wheels) for wheels in WHEELS]
        self.seconds = {}

    def study(self, wheels):
        """A study of so many wheels, each of them pattern 0."""
        with open(CASE / "mistuning.csv", newline="") as file:
            pattern = [row for row in csv.DictReader(file) if row["pattern"] == "0"]
        table = self.folder / f"wheels{wheels}.csv"
        lines = [f"{wheel},{row['blade']},{row['deviation']}" for wheel in range(wheels) for row in pattern]
        table.write_text("\n".join(["pattern,blade,deviation", *lines]) + "\n")
        study = self.folder / f"wheels{wheels}.toml"
        study.write_text(STUDY.read_text().replace("../tests/data/lumped24/mistuning.csv", table.name))
        return study

    def keep(self, name, seconds):
        self.seconds[name] = min(self.seconds.get(name, seconds), seconds)

    def measure(self):
        for _ in range(3):
            for frequencies in FREQUENCIES:
                table = self.folder / f"curve{frequencies.split(':')[-1]}.csv"
                command = [self.binary, "response", STUDY, "--pattern", "0", "--load", "50", "--frequencies",
                           frequencies, "--out", table]
                self.keep(frequencies, run(command)[1])
            for wheels, study in zip(WHEELS, self.studies):
                results = self.folder / f"results{wheels}"
                shutil.rmtree(results, ignore_errors=True)
                text, seconds = run([self.binary, "run", study, "--out", results, "--threads", "1", "--json"])
                self.keep(wheels, seconds)
                self.peak_m = json.loads(text)["scenarios"][0]["peak_amplitude_m"]["mean"]

    def milliseconds(self):
        curve, one = (1e3 * self.seconds[frequencies] for frequencies in FREQUENCIES)
        few, many = (1e3 * self.seconds[wheels] for wheels in WHEELS)
        return dict(process=curve, curve=curve - one, row=(many - few) / (WHEELS[1] - WHEELS[0]), study=few)

    def curve_difference(self):
        """The worst blade of the curve from the stored one."""
        rows = [line.split(",") for line in (CASE / "ref_p0_h3.csv").read_text().splitlines() if line[0] != "#"]
        expected = {float(row[0]): [float(cell) for cell in row[1:]] for row in rows}
        with open(self.folder / "curve121.csv", newline="") as file:
            found = list(csv.DictReader(file))
        assert len(found) == sum(len(row) for row in expected.values())
        return max(abs(float(row["amplitude_m"]) / expected[float(row["frequency_hz"])][int(row["blade"])] - 1)
                   for row in found)


def bench_lines(before, after, peer):
    """The lines with bars: blisk by curve.rs, without the process and what a study makes once."""
    own = keep_least(before, after)
    print(f"\nblisk by curve.rs, before and after: curve {before['curve_ms']:.0f} and {after['curve_ms']:.0f} ms, peak "
          f"{before['row_ms']:.0f} and {after['row_ms']:.0f} ms\n")
    print("| without what a study makes once | pyHarm, s | blisk, ms | ratio | bar |")
    print("| --- | ---: | ---: | ---: | ---: |")

    def line(what, seconds, milliseconds, bar=""):
        print(f"| {what} | {seconds:.2f} | {milliseconds:.1f} | {1e3 * seconds / milliseconds:.0f} | {bar} |")

    line("curve of 121 points", peer["curve_s"], own["curve_ms"], CURVE_BAR)
    line(f"peak to 0.1 %, pyHarm as it is: {peer['swept_points']} points", peer["swept_s"], own["row_ms"], PEAK_BAR)
    line("the same, pyHarm with a search round it", peer["peak_s"], own["row_ms"], PEAK_BAR)
    print(f"\nbar of the curve: {CURVE_BAR_MS} ms")
    print(f"worst blade {own['curve_difference']:.1e}; peak {own['peak_m']:.4e} m in {own['peak_solves']} solves, off by "
          f"{own['peak_difference']:.1e}")


def report(peers, blisk, binary):
    own, worst = blisk.milliseconds(), blisk.curve_difference()
    assert worst <= CURVE_TOLERANCE, worst
    version = run([binary, "--version"])[0].split("\n")
    print(f"load average {os.getloadavg()[0]:.1f}; {', '.join(line for line in version if line)}\n")
    print("| processor time on one thread |", *(f"{peer.name}, s (ratio) |" for peer in peers), "blisk, ms |")
    print("| --- |", *("---: |" for _ in peers), "---: |")

    def line(what, name, milliseconds):
        cells = (f"{peer.figures[name]:.1f} ({1e3 * peer.figures[name] / milliseconds:.0f}) |"
                 if name in peer.figures else "– |" for peer in peers)
        print(f"| {what} |", *cells, f"{milliseconds:.1f} |")

    line("curve of 121 points", "curve_s", own["curve"])
    line("the same, blisk as a whole process", "curve_s", own["process"])
    line("peak to 0.1 %, a search written round the others, blisk with its error columns", "peak_s", own["row"])
    line("the same, blisk as a whole process with a study of one wheel", "peak_s", own["study"])
    line("peak to 0.1 %, others as they are: a fine curve", "swept_s", own["row"])
    print(f"\nblisk: worst blade {worst:.1e} from the reference, peak {blisk.peak_m:.4e} m")
    for peer in peers:
        found = peer.figures
        print(f"{peer.name}: worst blade {found['curve_difference']:.1e}, {found['curve_solves']} solves; peak "
              f"{found['peak_m']:.4e} m in {found['peak_solves']} solves"
              + (f"; fine curve {found['swept_points']} points" if "swept_points" in found else ""))
        apart = abs(found["peak_m"] / blisk.peak_m - 1)
        # Each is within 0.1 % of the top.
        assert apart <= 2 * PEAK_TOLERANCE, apart
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--environment", type=Path, default=ROOT / "target" / "peers")
    parser.add_argument("--repetitions", type=int, default=3, help="turns of every program; the smallest time counts")
    parser.add_argument("--tmdsimpy", type=Path, help="folder of a clone of tmdsimpy; left out without it")
    parser.add_argument("--nlvib", type=Path, help="folder of a clone of NLvib; left out without it")
    parser.add_argument("--octave", default="octave-cli")
    parser.add_argument("--blisk", type=Path, help="a release binary; without it, blisk and curve.rs are compiled")
    arguments = parser.parse_args()
    arguments.environment = arguments.environment.resolve()
    arguments.environment.mkdir(parents=True, exist_ok=True)
    peers = [pyharm(arguments), tmdsimpy(arguments), nlvib(arguments)]
    for peer in peers:
        if peer.left_out:
            print(f"not measured: {peer.name}, since {peer.left_out}")
    peers = [peer for peer in peers if not peer.left_out]

    bench = ["cargo", "bench", "--quiet", "--bench", "curve"]
    binary = (arguments.blisk or ROOT / "target" / "release" / "blisk").resolve()
    if not arguments.blisk:
        run(["cargo", "build", "--release"])
        run(["cargo", "bench", "--bench", "curve", "--no-run"])
        before = figures(run(bench)[0])
    # In turns, so that a machine that grows busy is busy for all.
    blisk = Blisk(binary, arguments.environment)
    for turn in range(arguments.repetitions):
        for peer in peers:
            blisk.measure()
            peer.measure(arguments.environment)  # pyHarm leaves a folder where it is run
        blisk.measure()
        print(f"\nturn {turn + 1} of {arguments.repetitions}, {time.strftime('%H:%M')}")
        report(peers, blisk, binary)
    if not arguments.blisk:
        bench_lines(before, figures(run(bench)[0]), peers[0].figures)
    else:
        print("\nnot measured: curve.rs, since a binary is given (--blisk)")


main()
