"""Draws docs/quickstart.svg from the results of studies/quickstart.toml.

    cargo run --release -- run studies/quickstart.toml
    python docs/quickstart.py results/quickstart

Needs pyarrow. Draws what scenarios.parquet holds and nothing else.
"""

import json
import math
import sys
from pathlib import Path

import pyarrow.parquet

ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT = 760, 430
LEFT, RIGHT, TOP, BOTTOM = 150, 640, 50, 350
BAND, MEDIAN, P95, TUNED, INK = "#cfe0f3", "#2f6db3", "#123f73", "#c2410c", "#222222"


def micrometres(metres):
    return None if metres is None else 1e6 * metres


def nice_step(span):
    power = 10 ** math.floor(math.log10(span / 4))
    return next(m * power for m in (1, 2, 5, 10) if m * power >= span / 4)


def svg(rows, manifest):
    friction = sorted((r for r in rows if r["contact"] == "full"), key=lambda r: r["normal_load_n"])
    limits = {r["contact"]: r for r in rows if r["contact"] in ("slide", "stuck")}
    columns = ["tuned_amplitude_m", *(f"peak_amplitude_m_p{p}" for p in (5, 50, 95))]
    top = max(micrometres(r[c]) or 0 for r in rows for c in columns)
    step = nice_step(1.05 * top)
    top = step * math.ceil(1.05 * top / step)
    low, high = (math.log(friction[i]["normal_load_n"]) for i in (0, -1))
    out = []

    def x(load):
        return LEFT + (RIGHT - LEFT) * (math.log(load) - low) / (high - low)

    def y(metres):
        return BOTTOM - (BOTTOM - TOP) * micrometres(metres) / top

    def text(px, py, words, anchor="middle", size=13, extra=""):
        out.append(
            f'<text x="{px:.1f}" y="{py:.1f}" text-anchor="{anchor}" font-size="{size}" {extra}>{words}</text>'
        )

    def line(points, colour, extra=""):
        path = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" {extra}/>')

    def dots(points, colour):
        for px, py in points:
            out.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3.2" fill="{colour}"/>')

    value = 0.0
    while value <= top * 1.0001:
        py = y(1e-6 * value)
        line([(LEFT - 70, py), (RIGHT + 70, py)], "#dddddd")
        text(LEFT - 78, py + 4, f"{value:g}", "end")
        value += step
    # The friction loads: band, median, 95th percentile, tuned.
    upper = [(x(r["normal_load_n"]), y(r["peak_amplitude_m_p95"])) for r in friction]
    lower = [(x(r["normal_load_n"]), y(r["peak_amplitude_m_p5"])) for r in friction]
    area = " ".join(f"{px:.1f},{py:.1f}" for px, py in upper + lower[::-1])
    out.append(f'<polygon points="{area}" fill="{BAND}"/>')
    for column, colour, dash in (
        ("peak_amplitude_m_p95", P95, ""),
        ("peak_amplitude_m_p50", MEDIAN, ""),
        ("tuned_amplitude_m", TUNED, 'stroke-dasharray="6 4"'),
    ):
        points = [(x(r["normal_load_n"]), y(r[column])) for r in friction if r[column] is not None]
        line(points, colour, f'stroke-width="2" {dash}')
        dots(points, colour)
    # The linear limits stand outside the axis of loads.
    for name, px in (("slide", LEFT - 45), ("stuck", RIGHT + 45)):
        if name in limits:
            row = limits[name]
            bar = (y(row["peak_amplitude_m_p95"]), y(row["peak_amplitude_m_p5"]))
            out.append(
                f'<rect x="{px - 9}" y="{bar[0]:.1f}" width="18" height="{bar[1] - bar[0]:.1f}" fill="{BAND}"/>'
            )
            for column, colour in (
                ("peak_amplitude_m_p95", P95),
                ("peak_amplitude_m_p50", MEDIAN),
                ("tuned_amplitude_m", TUNED),
            ):
                dots([(px, y(row[column]))], colour)
            text(px, BOTTOM + 20, name)
    for row in friction:
        line([(x(row["normal_load_n"]), BOTTOM), (x(row["normal_load_n"]), BOTTOM + 5)], INK)
        text(x(row["normal_load_n"]), BOTTOM + 20, f"{row['normal_load_n']:g}")
    line([(LEFT - 70, BOTTOM), (RIGHT + 70, BOTTOM)], INK)
    text((LEFT + RIGHT) / 2, BOTTOM + 42, "damper normal load per sector, N (logarithmic)")
    middle = (TOP + BOTTOM) / 2
    text(22, middle, "peak blade amplitude, µm", extra=f'transform="rotate(-90 22 {middle})"')
    head = rows[0]
    text(
        WIDTH / 2,
        22,
        f"studies/quickstart.toml: engine order {head['engine_order']}, "
        f"standard deviation {100 * head['standard_deviation']:g} %, {head['planned']} patterns",
        size=14,
    )
    legend = ((P95, "P95"), (MEDIAN, "median"), (TUNED, "tuned"), (BAND, "P5 to P95"))
    for place, (colour, words) in enumerate(legend):
        px = 190 + 105 * place
        out.append(f'<rect x="{px}" y="{HEIGHT - 24}" width="22" height="6" fill="{colour}"/>')
        text(px + 28, HEIGHT - 17, words, "start")
    body = "\n".join(out)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
        f'font-family="sans-serif" fill="{INK}">\n'
        f"<title>Peak amplitude against damper normal load; study {manifest['study_digest'][:12]}</title>\n"
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n{body}\n</svg>\n'
    )


def main():
    results = Path(sys.argv[1])
    rows = pyarrow.parquet.read_table(results / "scenarios.parquet").to_pylist()
    manifest = json.loads((results / "manifest.json").read_text())
    (ROOT / "docs/quickstart.svg").write_text(svg(rows, manifest))


main()
