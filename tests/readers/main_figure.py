"""The numbers of the report's main figure, peak amplitude against normal load, from the tables alone.

    python main_figure.py RESULTS [REPORT.json]

Reads responses.parquet (rows) and scenarios.parquet (tuned wheels) with pandas and computes P5, P50, P95 and P99
with their distribution-free 95 % bounds anew, as docs/statistics.md defines them. With what
`blisk report RESULTS --json` printed, it compares every number with the report's and ends with 1 if one differs.
"""

import json
import math
import sys
from pathlib import Path

import pandas

PERCENTILES = (5, 50, 95, 99)
TAIL = 0.025


def at_most(k, n, p):
    """P(B <= k) for B binomial (n, p)."""
    if k < 0:
        return 0.0
    logs = (math.log(math.comb(n, i)) + i * math.log(p) + (n - i) * math.log1p(-p) for i in range(k + 1))
    return math.fsum(map(math.exp, logs))


def ranks(n, p):
    """Ranks of the bounds among n values, from 1; None where there is none."""
    lower = [rank for rank in range(1, n + 1) if at_most(rank - 1, n, p) <= TAIL]
    upper = [rank for rank in range(1, n + 1) if 1.0 - at_most(rank - 1, n, p) <= TAIL]
    return (lower[-1] if lower else None), (upper[0] if upper else None)


def percentile(values, failed, percent):
    """Value and bounds of the good values, ascending, beside failed rows at either infinity."""
    p, planned = percent / 100.0, len(values) + failed
    lower, upper = ranks(planned, p)
    rank = math.ceil(p * len(values) - 1e-9)
    known = lower is not None and upper is not None and failed <= min(p, 1.0 - p) / 10.0 * planned

    def at(rank):
        return values[rank - 1] if rank is not None and 1 <= rank <= len(values) else None

    return at(rank) if known else None, at(lower - failed if lower else None), at(upper)


def main():
    results = Path(sys.argv[1])
    rows = pandas.read_parquet(results / "responses.parquet", columns=["scenario", "status", "peak_amplitude_m"])
    scenarios = pandas.read_parquet(results / "scenarios.parquet")
    report = json.loads(Path(sys.argv[2]).read_text()) if len(sys.argv) > 2 else None
    compared = 0
    for _, scenario in scenarios.iterrows():
        own = rows[rows["scenario"] == scenario["scenario"]]
        good = sorted(own.loc[own["status"] == "ok", "peak_amplitude_m"])
        load = scenario["contact"] if pandas.isna(scenario["normal_load_n"]) else f"{scenario['normal_load_n']:g} N"
        line = [f"{load:>8}  tuned {1e6 * scenario['tuned_amplitude_m']:9.2f} um"]
        for percent in PERCENTILES:
            found = percentile(good, len(own) - len(good), percent)
            words = ["-" if value is None else f"{1e6 * value:.2f}" for value in found]
            line.append(f"P{percent} {words[0]} [{words[1]}, {words[2]}]")
            if report is None:
                continue
            of_scenario = report["summary"]["scenarios"][int(scenario["scenario"])]
            of_percent = next(p for p in of_scenario["peak_amplitude_m"]["percentiles"] if p["percent"] == percent)
            expected = tuple(of_percent[name] for name in ("value", "lower", "upper"))
            if found != expected:
                sys.exit(f"FAILED: P{percent} at {load}: {found} here, {expected} in the report")
            compared += 1
        print("  ".join(line))
    if report is not None:
        print(f"{compared} percentiles with their bounds are those of the report")


main()
