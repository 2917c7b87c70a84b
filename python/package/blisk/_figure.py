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

_LABELS = {"peak_amplitude_m": "peak amplitude, m", "amplification_factor": "amplification factor"}


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
    if quantity not in _LABELS:
        raise ValueError(f"quantity = {quantity!r} is not accepted; accepted: {', '.join(_LABELS)}")
    scenarios = _only(results.scenarios.rows(), wanted)
    own = {row["scenario"] for row in scenarios}
    table = [row for row in results.percentiles.rows() if row["scenario"] in own and row["quantity"] == quantity]
    if ax is None:
        _, ax = needed("matplotlib.pyplot", "plot()").subplots()
    for percent in percentiles:
        rows = [row for row in table if row["percent"] == percent and row["value"] is not None]
        loads = sorted((row for row in rows if row["contact"] == "full"), key=lambda row: row["normal_load_n"])
        if not rows:
            continue
        x = [row["normal_load_n"] for row in loads]
        (line,) = ax.plot(x, [row["value"] for row in loads], marker="o", label=f"P{percent:g}")
        bounded = [row for row in loads if row["lower"] is not None and row["upper"] is not None]
        ax.fill_between(
            [row["normal_load_n"] for row in bounded],
            [row["lower"] for row in bounded],
            [row["upper"] for row in bounded],
            color=line.get_color(),
            alpha=0.2,
        )
        for row in rows:
            if row["contact"] in ("slide", "stuck"):
                ax.axhline(
                    row["value"],
                    color=line.get_color(),
                    linestyle=":" if row["contact"] == "slide" else "--",
                    linewidth=0.8,
                )
    if quantity == "peak_amplitude_m":
        tuned = sorted(
            (row["normal_load_n"], row["tuned_amplitude_m"]) for row in scenarios if row["contact"] == "full"
        )
        ax.plot(*zip(*tuned), color="black", linewidth=0.8, label="tuned") if tuned else None
    ax.set_xlabel("normal load per sector, N (dotted: slide, dashed: stuck)")
    ax.set_ylabel(_LABELS[quantity])
    ax.legend()
    return ax


def _only(rows: list[dict[str, Any]], wanted: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The rows of one excitation and standard deviation."""
    for key, value in wanted.items():
        rows = [row for row in rows if value is None or row.get(key) == value]
        choices = sorted({row.get(key) for row in rows}, key=str)
        if len(choices) > 1:
            raise ValueError(f"the study has several values of {key}; name one: {', '.join(map(str, choices))}")
    if not rows:
        raise ValueError(f"the study has no scenario with {dict(wanted)}")
    return rows
