"""The verdicts of studies/optimal-load on cases made by hand, and a table of the study made small.

    python tests/readers/optimal_load.py FOLDER
"""

import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "studies" / "optimal-load"))
import run

OPTIMUM = 20.0


def verdict(possible, values=None):
    """The verdict where the loads at these factors could be the best."""
    values = values or {}
    loads = [
        {
            "normal_load_n": run.rounded(factor * OPTIMUM),
            "standard_deviation": 0.02,
            "could_be_best": factor in possible,
            "percentile": {"value": values.get(factor, 1.0 + abs(factor - min(possible, default=1)))},
        }
        for factor in run.FACTORS
    ]
    wheel = run.Wheel("", Path(), "ring", "lumped", "1")
    return wheel.verdict(3, OPTIMUM, 95, "peak_amplitude_m", {"loads": loads})


def main(folder):
    for possible, wanted, enclosed in [
        ({1.0}, "confirmed", (18.0, 22.0)),
        # One more load could be the best: the interval reaches beyond a tenth.
        ({1.0, 1.1}, "open", (18.0, 25.0)),
        # Its edge is 0.9 of the optimum, beyond which the best load cannot lie.
        ({0.8}, "refuted", (14.0, 18.0)),
        ({0.5, 0.7}, "refuted", (5.0, 16.0)),
        ({1.4, 2.0}, "refuted", (25.0, 80.0)),
        ({0.25}, "refuted", (None, 10.0)),
        ({4.0}, "refuted", (40.0, None)),
        (set(run.FACTORS), "open", (None, None)),
    ]:
        own = verdict(possible)
        assert own["verdict"] == wanted, (possible, own)
        assert (own["lower_n"], own["upper_n"]) == enclosed, (possible, own)
    lost = verdict({1.0}, {factor: None for factor in run.FACTORS})
    assert lost["verdict"] == "open" and lost["optimum_n"] is None, lost
    worse = verdict({0.7}, {0.7: 2.0, 1.0: 2.1, **{f: 3.0 for f in run.FACTORS if f not in (0.7, 1.0)}})
    assert worse["loss_at_tuned_optimum"] == 0.05, worse

    with open(Path(folder) / "table.csv", newline="") as table:
        rows = list(csv.DictReader(table))
    # So few patterns have a median alone.
    known = [row for row in rows if row["percent"] == "50" and row["optimum_n"]]
    # One wheel under one engine order.
    cases = len(run.STANDARD_DEVIATIONS) * len(run.QUANTITIES)
    assert len(known) == cases, f"{len(known)} of {cases} medians have an optimum"
    for row in known:
        # The tuned optimum is in the middle of the loads, and no load is far below it for a small deviation.
        assert float(row["loss_at_tuned_optimum"]) >= 0.0, row
        if row["standard_deviation"] == "0.005" and row["quantity"] == run.QUANTITIES[0]:
            assert float(row["loss_at_tuned_optimum"]) < 0.05, row
    print(f"{len(rows)} verdicts")


if __name__ == "__main__":
    main(*sys.argv[1:])
