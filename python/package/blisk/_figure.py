"""Figures: those of the report as SVG, and percentiles as axes of matplotlib."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from . import _native
from ._needed import needed

if TYPE_CHECKING:
    from ._results import Results

LABELS = {"peak_amplitude_m": "peak blade amplitude", "amplification_factor": "amplification factor"}
_LIMITS = {"slide": ":", "stuck": "--"}
"""Line of a linear limit."""
_UNITS = (("m", 1.0, 100.0), ("mm", 1e-3, 0.1), ("µm", 1e-6, 1e-8), ("nm", 1e-9, 0.0))
"""Name and length (m) of a unit, and the amplitude (m) from which on the report takes it."""
_OF_THE_REPORT = (5, 50, 95, 99)
"""Percentiles whose values and bounds decide on the scale of the report's figure."""
_LOGARITHMIC_FROM = 4.0
"""Ratio of the largest to the smallest value from which on the report has a logarithmic axis."""


class Figure:
    """A figure of the report; a notebook shows it."""

    name: str
    """Its name, like ``amplitude``."""
    svg: str
    """The figure as SVG, which needs nothing else."""
    title: str
    """What it shows."""
    setting: str
    """Of which excitation, and which results."""

    def __init__(self, name: str, svg: str, title: str, setting: str) -> None:
        self.name, self.svg, self.title, self.setting = name, svg, title, setting

    def save(self, path: Union[str, os.PathLike[str]]) -> Path:
        """Writes the SVG file.

        ``path``: the file, which is written over. Returns its path.
        """
        target = Path(path)
        target.write_text(self.svg, encoding="utf-8")
        return target

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<blisk.Figure {self.name}: {self.title}>"


def figures() -> dict[str, str]:
    """The figures of ``Results.figure``.

    Returns a dictionary: what each shows, by its name.
    """
    return dict(_native.figure_names())


def plotted(results: Results, quantity: str, percentiles: Sequence[float], wanted: Mapping[str, Any], ax: Any) -> Any:
    """Percentiles over the normal load; see ``Results.plot``."""
    checked_quantity(quantity)
    every = results.scenarios.rows()
    scenarios = only(every, wanted)
    own = {row["scenario"] for row in scenarios}
    table = [row for row in results.percentiles.rows() if row["scenario"] in own and row["quantity"] == quantity]
    unit, metres = unit_of(every) if quantity == "peak_amplitude_m" else ("", 1.0)
    if ax is None:
        _, ax = needed("matplotlib.pyplot", "plot()").subplots()
    for percent in percentiles:
        rows = [row for row in table if row["percent"] == percent and row["value"] is not None]
        loads = sorted((row for row in rows if row["contact"] == "full"), key=lambda row: row["normal_load_n"])
        if not rows:
            continue
        x = [row["normal_load_n"] for row in loads]
        (line,) = ax.plot(x, [row["value"] / metres for row in loads], marker="o", label=f"P{percent:g}")
        bounded = [row for row in loads if row["lower"] is not None and row["upper"] is not None]
        ax.fill_between(
            [row["normal_load_n"] for row in bounded],
            [row["lower"] / metres for row in bounded],
            [row["upper"] / metres for row in bounded],
            color=line.get_color(),
            alpha=0.2,
        )
        for row in rows:
            if row["contact"] in _LIMITS:
                style = _LIMITS[row["contact"]]
                ax.axhline(row["value"] / metres, color=line.get_color(), linestyle=style, linewidth=0.8)
    tuned = [row for row in scenarios if quantity == "peak_amplitude_m" and row["tuned_amplitude_m"] is not None]
    points = sorted((row["normal_load_n"], row["tuned_amplitude_m"] / metres) for row in tuned if row["contact"] == "full")
    ax.plot(*zip(*points), color="black", linewidth=0.8, label="tuned") if points else None
    for contact, style in _LIMITS.items():
        if any(row["contact"] == contact for row in scenarios):
            ax.plot([], [], color="grey", linestyle=style, linewidth=0.8, label=contact)
    drawn = [row for row in table if row["percent"] in _OF_THE_REPORT and row["value"] is not None]
    values = [row[key] / metres for row in drawn for key in ("value", "lower", "upper") if row[key] is not None]
    values += [row["tuned_amplitude_m"] / metres for row in tuned]
    _scale(ax, [row["normal_load_n"] for row in scenarios if row["contact"] == "full"], values, f"{LABELS[quantity]}{unit}")
    ax.legend()
    return ax


def checked_quantity(quantity: str) -> None:
    """Refuses what is no quantity."""
    if quantity not in LABELS:
        raise ValueError(f"quantity = {quantity!r} is not accepted; accepted: {', '.join(LABELS)}")


def unit_of(scenarios: list[dict[str, Any]]) -> tuple[str, float]:
    """The unit of amplitudes, as the report has it, and its length in m."""
    found = [row[key] for row in scenarios for key in ("tuned_amplitude_m", "peak_amplitude_m_mean")]
    smallest = min((own for own in found if own is not None), default=1e-6)
    return next((f", {name}", metres) for name, metres, least in _UNITS if smallest >= least)


def _scale(ax: Any, loads: Sequence[float], values: Sequence[float], label: str) -> None:
    """Scales and titles of both axes, as the report has them."""
    ticker = needed("matplotlib.ticker", "plot()")
    spread = bool(loads) and 0.0 < min(loads) < max(loads)
    ax.set_xscale("log" if spread else "linear")
    ax.set_xlabel(f"damper normal load per sector, N{' (logarithmic)' if spread else ''}")
    if spread:
        ax.xaxis.set_minor_locator(ticker.NullLocator())
    wide = bool(values) and 0.0 < _LOGARITHMIC_FROM * min(values) < max(values)
    ax.set_yscale("log" if wide else "linear")
    ax.set_ylabel(f"{label}{' (log.)' if wide else ''}")
    if wide:
        ax.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.yaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
        ax.yaxis.set_minor_locator(ticker.NullLocator())
    if spread:
        _ticks(ax, sorted(set(loads)))


def _ticks(ax: Any, loads: Sequence[float]) -> None:
    """A tick at every load, and labels at the ends and between them where they do not run into each other."""
    labels = [f"{load:g}" for load in loads]
    ax.set_xticks(loads, labels=labels)
    # Places of the labels are those of the layout.
    ax.figure.figure.draw_without_rendering()
    boxes = [label.get_window_extent() for label in ax.get_xticklabels()]
    last = len(boxes) - 1
    end = boxes[0].x1
    for place in range(1, last):
        box = boxes[place]
        gap = box.height / 2
        if end + gap < box.x0 and box.x1 + gap < boxes[last].x0:
            end = box.x1
        else:
            labels[place] = ""
    ax.set_xticks(loads, labels=labels)


def only(rows: list[dict[str, Any]], wanted: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The rows of one excitation and standard deviation."""
    for key, value in wanted.items():
        rows = [row for row in rows if value is None or row.get(key) == value]
        choices = sorted({row.get(key) for row in rows}, key=str)
        if len(choices) > 1:
            raise ValueError(f"the study has several values of {key}; name one: {', '.join(map(str, choices))}")
    if not rows:
        raise ValueError(f"the study has no scenario with {dict(wanted)}")
    return rows
