#!/usr/bin/env python3
"""Does the load that is best for the tuned wheel hold for mistuned ones?

    python3 studies/optimal-load/run.py [--blisk PROGRAM] [--out FOLDER] [--only WORDS] [--engine-orders 3,9] [--patterns N]
        [--threads N]

Eight wheels (four dampers, lumped and of finite elements) under a low and a high engine order, three
standard deviations. For each the load that is best for the tuned wheel is searched first; then the
populations are solved at loads round it, and `blisk compare` says which of these loads could be the
best for a percentile. Writes table.csv and README.md into FOLDER (results/optimal-load); the
results folders of the runs are kept in FOLDER/runs, so that a second run solves nothing twice.
Needs Python alone. README.md beside this file says how verdicts are made.
"""

import argparse
import csv
import json
import math
import re
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DAMPERS = ("ring", "underplatform", "shroud", "blade_to_ground")
SOURCES = ("lumped", "finite_elements")
ENGINE_ORDERS = (3, 9)
STANDARD_DEVIATIONS = (0.005, 0.02, 0.08)
# Patterns of a population. P99 needs 368: wheels whose rows take long have fewer.
PATTERNS = {
    "lumped-shroud": 100,
    "finite-elements-underplatform": 100,
    "finite-elements-shroud": 100,
    "finite-elements-blade-to-ground": 100,
}
PATTERNS_ELSEWHERE = 400
PERCENTS = (50, 95, 99)
QUANTITIES = ("peak_amplitude_m", "amplification_factor")
# Loads of a population over the tuned optimum. A verdict looks at 0.9 and 1.1.
FACTORS = (0.25, 0.5, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4, 2.0, 4.0)
NEAR = (0.9, 1.1)
# Ratio of neighbouring loads in the first, second and third round of the search on the tuned wheel.
ROUNDS = (1.6, 1.15, 1.03)
EFFECT_ORDERS = (0, 1, 2, 3, 4, 6, 8, 10, 12)


def rounded(load):
    return float(f"{load:.4g}")


class Wheel:
    """One damper on one wheel: its study, and the program that runs it."""

    def __init__(self, program, folder, damper, source, threads, patterns=None):
        self.program, self.folder, self.threads = program, folder, threads
        self.damper, self.source = damper, source
        self.name = f"{source}-{damper}".replace("_", "-")
        self.patterns = patterns or PATTERNS.get(self.name, PATTERNS_ELSEWHERE)
        self.text = (HERE / f"{self.name}.toml").read_text()

    def study(self, name, **keys):
        """The study with other values of some keys."""
        text = self.text
        for key, value in keys.items():
            line = re.compile(rf"^{key} = .*$", re.MULTILINE)
            if len(line.findall(text)) != 1:
                sys.exit(f"{self.name}.toml: {key} must stand on one line of its own")
            text = line.sub(f"{key} = {value}", text)
        path = self.folder / "runs" / f"{name}.toml"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def command(self, *words):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)
        # 5: what was asked for is not estimable; the JSON says so.
        if done.returncode not in (0, 5):
            sys.exit(f"blisk {' '.join(map(str, words))}: {done.stderr}")
        return done.stdout

    def run(self, name, **keys):
        """Runs the study so, and gives its results folder."""
        results = self.folder / "runs" / name
        self.command("run", self.study(name, **keys), "--out", results, "--threads", self.threads)
        return results

    def tuned(self, results):
        """Amplitude of the tuned wheel, m, by engine order and load."""
        found = json.loads(self.command("stats", results, "--json"))
        return {
            (own["engine_order"], own["normal_load_n"]): own["tuned_amplitude_m"]
            for own in found["scenarios"]
            if own["tuned_status"] == "ok" and own["tuned_amplitude_m"]
        }

    def scan(self, ratio):
        """Loads over the range that the study names, each at most so many times the one before."""
        low, high = json.loads(re.search(r"^# loads_n: (.*)$", self.text, re.MULTILINE)[1])
        steps = math.ceil(math.log(high / low, ratio))
        return [rounded(low * (high / low) ** (i / steps)) for i in range(steps + 1)]

    def tuned_optimum(self, order):
        """Load with the lowest tuned amplitude, to 3 %."""
        loads = set(self.scan(ROUNDS[0]))
        amplitudes = {}
        for place, ratio in enumerate((*ROUNDS[1:], None)):
            # Each round has a folder of its own: a folder can be run again with the loads that it has, not with fewer.
            results = self.run(
                f"{self.name}-{order}-tuned-{place + 1}",
                engine_orders=[order],
                patterns=1,
                standard_deviation=[0.0],
                normal_load_n=sorted(loads),
            )
            amplitudes |= {load: a for (_, load), a in self.tuned(results).items()}
            best = min(amplitudes, key=amplitudes.get)
            if ratio:
                nearest = sorted(amplitudes)
                at = nearest.index(best)
                sides = nearest[max(at - 1, 0)], nearest[min(at + 1, len(nearest) - 1)]
                count = math.ceil(math.log(sides[1] / sides[0], ratio))
                loads = {rounded(sides[0] * ratio**i) for i in range(1, count)} - set(nearest)
        return best

    def population(self, order, optimum):
        """Results folder of the populations at loads round the tuned optimum."""
        return self.run(
            f"{self.name}-{order}",
            engine_orders=[order],
            patterns=self.patterns,
            standard_deviation=list(STANDARD_DEVIATIONS),
            normal_load_n=[rounded(factor * optimum) for factor in FACTORS],
        )

    def verdicts(self, order, optimum):
        results = self.population(order, optimum)
        for percent in PERCENTS:
            compared = json.loads(
                self.command("compare", results, "--percentile", percent, "--json")
            )
            for quantity in QUANTITIES:
                own = next(q for q in compared["quantities"] if q["quantity"] == quantity)
                for best in own["best"]:
                    yield self.verdict(order, optimum, percent, quantity, best)

    def verdict(self, order, optimum, percent, quantity, best):
        loads = sorted(best["loads"], key=lambda load: load["normal_load_n"])
        values = [load["percentile"]["value"] for load in loads]
        newtons = [load["normal_load_n"] for load in loads]
        possible = [i for i, load in enumerate(loads) if load["could_be_best"]]
        known = [i for i, value in enumerate(values) if value is not None]
        row = {
            "source": self.source,
            "damper": self.damper,
            "engine_order": order,
            "standard_deviation": loads[0]["standard_deviation"],
            "quantity": quantity,
            "percent": percent,
            "tuned_optimum_n": optimum,
            "optimum_n": None,
            "lower_n": None,
            "upper_n": None,
            "loss_at_tuned_optimum": None,
            "verdict": "open",
        }
        if len(known) < len(loads) or not possible:
            return row
        lowest = min(known, key=values.__getitem__)
        row["optimum_n"] = newtons[lowest]
        # The nearest loads on either side that are significantly worse; none: the best load may lie beyond all of them.
        below, above = possible[0] - 1, possible[-1] + 1
        row["lower_n"] = newtons[below] if below >= 0 else None
        row["upper_n"] = newtons[above] if above < len(loads) else None
        tuned = min(range(len(loads)), key=lambda i: abs(newtons[i] - optimum))
        row["loss_at_tuned_optimum"] = round(values[tuned] / values[lowest] - 1.0, 4)
        lower, upper = row["lower_n"] or 0.0, row["upper_n"] or math.inf
        near = [rounded(factor * optimum) for factor in NEAR]
        if near[0] <= lower and upper <= near[1]:
            row["verdict"] = "confirmed"
        elif upper <= near[0] or lower >= near[1]:
            row["verdict"] = "refuted"
        return row

    def effect(self):
        """Tuned amplitude at its best load over that without friction, the lower one of slide and stuck, by engine order."""
        results = self.run(
            f"{self.name}-effect",
            engine_orders=list(EFFECT_ORDERS),
            patterns=1,
            standard_deviation=[0.0],
            normal_load_n=json.dumps(["slide", *self.scan(1.25), "stuck"]),
        )
        found = json.loads(self.command("stats", results, "--json"))["scenarios"]
        effects = {}
        for order in EFFECT_ORDERS:
            own = [s for s in found if s["engine_order"] == order and s["tuned_amplitude_m"]]
            linear = [s["tuned_amplitude_m"] for s in own if s["normal_load_n"] is None]
            damped = [s["tuned_amplitude_m"] for s in own if s["normal_load_n"] is not None]
            effects[order] = min(damped) / min(linear) if damped and linear else None
        return effects


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--blisk", default=str(ROOT / "target/release/blisk"))
    parser.add_argument("--out", type=Path, default=ROOT / "results/optimal-load")
    parser.add_argument("--only", default="", help="wheels whose names hold one of these words, with commas between")
    parser.add_argument("--engine-orders", default=",".join(map(str, ENGINE_ORDERS)))
    parser.add_argument("--patterns", type=int, help="patterns of a population [default: 400, or 100 where rows take long]")
    parser.add_argument("--threads", default="2")
    arguments = parser.parse_args()
    rows, effects = [], {}
    for source in SOURCES:
        for damper in DAMPERS:
            wheel = Wheel(
                arguments.blisk, arguments.out, damper, source, arguments.threads, arguments.patterns
            )
            if not any(word in wheel.name for word in arguments.only.split(",")):
                continue
            effects[wheel.name] = wheel.effect()
            for order in map(int, arguments.engine_orders.split(",")):
                optimum = wheel.tuned_optimum(order)
                own = list(wheel.verdicts(order, optimum))
                rows += own
                print(f"{wheel.name}, engine order {order}: tuned optimum {optimum} N", flush=True)
    if not rows:
        names = ", ".join(sorted(path.stem for path in HERE.glob("*.toml")))
        sys.exit(f"--only {arguments.only}: no wheel has such a name; accepted: words of {names}")
    command = "python3 studies/optimal-load/run.py"
    if arguments.only:
        command += f" --only {arguments.only}"
    if arguments.engine_orders != parser.get_default("engine_orders"):
        command += f" --engine-orders {arguments.engine_orders}"
    if arguments.patterns:
        command += f" --patterns {arguments.patterns}"
    write(arguments.out, command, rows, effects)


def write(folder, command, rows, effects):
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "table.csv", "w", newline="") as table:
        writer = csv.DictWriter(table, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    lines = [
        "# Does the tuned optimum hold?",
        "",
        f"Made by `{command}`; [its page](../../studies/optimal-load/README.md) says how. Single verdicts: [table.csv](table.csv).",
        "",
        "| wheel | engine order | tuned optimum, N | amplitude: confirmed, open, refuted | worst loss | amplification factor: confirmed, open, refuted |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    groups = dict.fromkeys((r["source"], r["damper"], r["engine_order"]) for r in rows)
    for group in groups:
        own = [r for r in rows if (r["source"], r["damper"], r["engine_order"]) == group]
        counts = {}
        for quantity in QUANTITIES:
            of = [r["verdict"] for r in own if r["quantity"] == quantity]
            counts[quantity] = ", ".join(str(of.count(v)) for v in ("confirmed", "open", "refuted"))
        losses = [
            r["loss_at_tuned_optimum"]
            for r in own
            if r["quantity"] == QUANTITIES[0] and r["loss_at_tuned_optimum"] is not None
        ]
        worst = f"{100 * max(losses):.1f} %" if losses else "-"
        source, damper, order = group
        lines.append(
            f"| {source.replace('_', ' ')}, {damper.replace('_', ' ')} | {order} | {own[0]['tuned_optimum_n']} | "
            f"{counts[QUANTITIES[0]]} | {worst} | {counts[QUANTITIES[1]]} |"
        )
    lines += [
        "",
        "Worst loss: how much higher the percentile of the amplitude is at the tuned optimum than at the best of the loads solved.",
        "",
        "## Effect by nodal diameter",
        "",
        "Amplitude of the tuned wheel at its best load over the lower one of its amplitudes with sliding and with stuck contact.",
        "",
        "| wheel | " + " | ".join(map(str, EFFECT_ORDERS)) + " |",
        "| --- |" + " --- |" * len(EFFECT_ORDERS),
    ]
    for name, own in effects.items():
        cells = ["-" if own[o] is None else f"{own[o]:.3f}" for o in EFFECT_ORDERS]
        lines.append(f"| {name.replace('-', ' ')} | " + " | ".join(cells) + " |")
    (folder / "README.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
