"""Judges the results of the README's main command against values that are kept.

    python quickstart.py results/quickstart quickstart.json            judges
    python quickstart.py results/quickstart quickstart.json --store    keeps the values of these results

Ends with 1 unless every planned row is ok, the lowest P95 lies at a friction load between the ends with
at least twice as much at either linear limit, and tuned peaks and medians are those in the file: amplitudes
within 0.5 %, tuned frequencies within 0.05 %.
"""

import json
import sys
from pathlib import Path

import pyarrow.parquet

AMPLITUDE, FREQUENCY, RISE = 5e-3, 5e-4, 2.0
TOLERANCES = {
    "tuned_amplitude_m": AMPLITUDE,
    "tuned_frequency_hz": FREQUENCY,
    "peak_amplitude_m_p50": AMPLITUDE,
}


def load_of(row):
    return row["contact"] if row["normal_load_n"] is None else f"{row['normal_load_n']:g} N"


def main(results, kept, *options):
    rows = pyarrow.parquet.read_table(Path(results) / "scenarios.parquet").to_pylist()
    found = {load_of(row): {column: row[column] for column in TOLERANCES} for row in rows}
    if options == ("--store",):
        Path(kept).write_text(json.dumps(found, indent=2) + "\n")
        return 0
    wrong = []
    for row in rows:
        if row["failed"] != 0 or row["ok"] != row["planned"] or row["planned"] == 0:
            wrong.append(f"{load_of(row)}: {row['ok']} ok and {row['failed']} failed of {row['planned']}")
        if row["tuned_status"] != "ok":
            wrong.append(f"{load_of(row)}: the tuned wheel is {row['tuned_status']}")
    expected = json.loads(Path(kept).read_text())
    if list(found) != list(expected):
        wrong.append(f"loads {list(found)}, expected {list(expected)}")
    for load, values in expected.items():
        for column, tolerance in TOLERANCES.items():
            value, wanted = found.get(load, {}).get(column), values[column]
            if value is None or not abs(value / wanted - 1.0) <= tolerance:
                wrong.append(f"{load}: {column} {value}, expected {wanted} within {100 * tolerance:g} %")
    p95 = {load_of(row): row["peak_amplitude_m_p95"] for row in rows}
    friction = [load_of(row) for row in rows if row["contact"] == "full"]
    if None in p95.values() or len(friction) < 3:
        wrong.append(f"P95 by load: {p95}")
    else:
        best = min(friction, key=p95.get)
        if best in (friction[0], friction[-1]):
            wrong.append(f"the lowest P95 lies at {best}, an end of the friction loads")
        for limit in ("slide", "stuck"):
            if not p95[limit] >= RISE * p95[best]:
                wrong.append(f"P95 at {limit} {p95[limit]}, at {best} {p95[best]}: no rise by {RISE:g}")
    for line in wrong:
        print(f"quickstart: {line}", file=sys.stderr)
    if not wrong:
        print(f"quickstart: {len(rows)} loads as kept, lowest P95 at {best}")
    return 1 if wrong else 0


sys.exit(main(*sys.argv[1:]))
