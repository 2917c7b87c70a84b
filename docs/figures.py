"""Draws docs/figures/contact-law.svg: a Jenkins element by the clips of docs/formulation.md, section 3.

    python docs/figures.py

Needs nothing but Python. The other files of docs/figures are written by `blisk plot`.
"""

import math
from pathlib import Path

OUT = Path(__file__).resolve().parent / "figures" / "contact-law.svg"
WIDTH, HEIGHT, TOP, BOTTOM = 760, 360, 60, 290
PANELS = ((70, 350), (450, 730))
BLUE, ORANGE, INK, QUIET, GRID = "#0072b2", "#d55e00", "#1b2733", "#5b6b7a", "#dfe5ea"
SAMPLES = 720


def loop(limit):
    """Displacement and force over one steady period; kt = 1, amplitude 1, limit(angle) = mu N."""
    angles = [2 * math.pi * j / SAMPLES for j in range(SAMPLES)]
    offset, closed = 0.0, []
    for _ in range(2):  # one period settles, the next one is steady
        closed = []
        for angle in angles:
            x, most = math.cos(angle), max(limit(angle), 0.0)
            offset = min(max(offset, -most - x), most - x)
            closed.append((x, x + offset))
    return closed + closed[:1]


def area(points):
    """Dissipated work of a loop."""
    return abs(sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(points, points[1:])))


def place(panel, value, low, high, upright=False):
    left, right = (BOTTOM, TOP) if upright else PANELS[panel]
    return left + (value - low) / (high - low) * (right - left)


def frame(panel, x, y, titles):
    """Grid, ticks and titles; x and y are (low, high, ticks)."""
    left, right = PANELS[panel]
    parts = []
    for tick in x[2]:
        at = place(panel, tick, *x[:2])
        parts.append(f'<path d="M{at:.1f} {TOP}V{BOTTOM}" stroke="{GRID}"/>')
        parts.append(f'<text x="{at:.1f}" y="{BOTTOM + 18}" text-anchor="middle" fill="{QUIET}">{tick:g}</text>')
    for tick in y[2]:
        at = place(panel, tick, *y[:2], upright=True)
        parts.append(f'<path d="M{left} {at:.1f}H{right}" stroke="{GRID}"/>')
        parts.append(f'<text x="{left - 8}" y="{at + 4:.1f}" text-anchor="end" fill="{QUIET}">{tick:g}</text>')
    middle = (left + right) / 2
    parts.append(f'<text x="{middle}" y="{BOTTOM + 42}" text-anchor="middle">{titles[0]}</text>')
    parts.append(
        f'<text transform="translate({left - 44} {(TOP + BOTTOM) / 2}) rotate(-90)" text-anchor="middle">{titles[1]}</text>'
    )
    return parts


def curve(panel, points, x, y, colour, dash=""):
    places = " ".join(
        f"{place(panel, a, *x[:2]):.1f},{place(panel, b, *y[:2], upright=True):.1f}" for a, b in points
    )
    return f'<polyline points="{places}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>'


def legend(panel, entries):
    at, parts = PANELS[panel][0], []
    for words, colour, dash in entries:
        parts.append(f'<path d="M{at} 40h22" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        parts.append(f'<text x="{at + 28}" y="44">{words}</text>')
        at += 44 + 6.6 * len(words)
    return parts


def main():
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="system-ui,sans-serif" '
        f'font-size="13" fill="{INK}">',
        "<title>Friction of a Jenkins element: hysteresis, and dissipated work against its limit</title>",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
    ]
    x, y = (-1.15, 1.15, (-1, 0, 1)), (-0.95, 0.95, (-0.5, 0, 0.5))
    parts += frame(0, x, y, ("displacement / amplitude", "friction / (kt amplitude)"))
    varying = loop(lambda angle: 0.5 * (1 + 0.6 * math.cos(angle)))
    parts.append(curve(0, varying, x, y, ORANGE, "6 4"))
    parts.append(curve(0, loop(lambda _: 0.5), x, y, BLUE))
    parts += legend(0, (("constant normal load", BLUE, ""), ("varying", ORANGE, "6 4")))

    limits = [1.2 * i / 60 for i in range(61)]
    x, y = (0, 1.2, (0, 0.5, 1)), (0, 1.05, (0, 0.5, 1))
    parts += frame(1, x, y, ("limit mu N / (kt amplitude)", "work per period / (kt amplitude²)"))
    dissipated = [(limit, area(loop(lambda _, limit=limit: limit))) for limit in limits]
    parts.append(curve(1, dissipated, x, y, BLUE))
    best = max(dissipated, key=lambda point: point[1])
    # In closed form 4 (mu N)(X - mu N / kt): largest at half the amplitude.
    assert abs(best[0] - 0.5) < 0.03 and abs(best[1] - 1.0) < 0.01, best
    parts += legend(1, (("slides at 0, sticks from 1 on", BLUE, ""),))
    parts.append("</svg>")
    OUT.write_text("\n".join(parts) + "\n")


main()
