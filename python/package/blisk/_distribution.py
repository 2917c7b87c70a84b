"""Distributions at loads as axes of matplotlib, as the figure of the report has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

from ._figure import LABELS, checked_quantity, only, unit_of
from ._needed import needed

if TYPE_CHECKING:
    from ._results import Results

_PERCENTS = (0.1, 1, 5, 25, 50, 75, 95, 99, 99.9, 99.99)
"""Shares of the wheels that the axis names, %."""
_NEXT_TO_ALL = 1e-9
"""Distance (1) from nought and from one at which a share is drawn that lies at infinity."""

Loads = Optional[Sequence[Union[float, str]]]


def drawn(results: Results, quantity: str, loads: Loads, wanted: Mapping[str, Any], ax: Any) -> Any:
    """Share of the wheels below a value, a stair for each load; see ``Results.plot_distribution``."""
    checked_quantity(quantity)
    every = results.scenarios.rows()
    scenarios = only(every, wanted)
    percentiles = [row for row in results.percentiles.rows() if row["value"] is not None]
    chosen = _chosen(scenarios, percentiles, loads)
    unit, metres = unit_of(every) if quantity == "peak_amplitude_m" else ("", 1.0)
    table = [row for row in results.distribution.rows() if row["quantity"] == quantity]
    if ax is None:
        _, ax = needed("matplotlib.pyplot", "plot_distribution()").subplots()
    count = 1
    for scenario in chosen:
        rows = [row for row in table if row["scenario"] == scenario["scenario"]]
        count = max(count, len(rows))
        x = [row["value"] / metres for row in rows]
        share = {key: [100.0 * row[key] for row in rows] for key in ("cumulative", "cumulative_lower", "cumulative_upper")}
        (line,) = ax.plot(x, share["cumulative"], drawstyle="steps-post", label=_name(scenario))
        color = line.get_color()
        ax.fill_between(x, share["cumulative_lower"], share["cumulative_upper"], step="post", color=color, alpha=0.2, lw=0)
        for own in percentiles:
            if (own["scenario"], own["quantity"]) != (scenario["scenario"], quantity):
                continue
            bounds = [own[key] / metres for key in ("lower", "upper") if own[key] is not None]
            ax.plot(bounds, [own["percent"]] * len(bounds), color=color, linewidth=0.8, marker="|")
            ax.plot([own["value"] / metres], [own["percent"]], color=color, marker="s", markersize=3)
    _gumbel(ax, min(1.0, 50.0 / count), max(99.9, 100.0 - 30.0 / count))
    ax.set_xlabel(f"{LABELS[quantity]}{unit}")
    ax.set_ylabel("wheels below, % (Gumbel scale)")
    ax.legend()
    return ax


def _chosen(scenarios: list[dict[str, Any]], percentiles: list[dict[str, Any]], loads: Loads) -> list[dict[str, Any]]:
    """The scenarios of the loads; that of the report unless given: the best by the highest percentile with a value."""
    if loads is not None:
        by_name: dict[Any, dict[str, Any]] = {}
        for own in scenarios:
            by_name[own["normal_load_n"] if own["contact"] == "full" else own["contact"]] = own
        unknown = [load for load in loads if load not in by_name]
        if unknown or not loads:
            names = ", ".join(f"{name:g}" if isinstance(name, float) else repr(name) for name in by_name)
            raise ValueError(f"loads = {list(loads)!r} is not accepted; accepted: some of {names}")
        return [by_name[load] for load in loads]
    full = {own["scenario"]: own for own in scenarios if own["contact"] == "full"} or {
        own["scenario"]: own for own in scenarios
    }
    found = [row for row in percentiles if row["quantity"] == "peak_amplitude_m" and row["scenario"] in full]
    if not found:
        return list(full.values())[:1]
    highest = max(row["percent"] for row in found)
    best = min((row for row in found if row["percent"] == highest), key=lambda row: row["value"])
    return [full[best["scenario"]]]


def _name(scenario: Mapping[str, Any]) -> str:
    """A load as the legend names it."""
    return f"{scenario['normal_load_n']:g} N" if scenario["contact"] == "full" else str(scenario["contact"])


def _gumbel(ax: Any, low: float, high: float) -> None:
    """The vertical axis by the reduced variate -ln(-ln p) of Gumbel's law, from ``low`` to ``high`` %."""
    numpy, ticker = needed("numpy", "plot_distribution()"), needed("matplotlib.ticker", "plot_distribution()")

    def reduced(percent: Any) -> Any:
        share = numpy.clip(numpy.asarray(percent, dtype=float) / 100.0, _NEXT_TO_ALL, 1.0 - _NEXT_TO_ALL)
        return -numpy.log(-numpy.log(share))

    def back(variate: Any) -> Any:
        return 100.0 * numpy.exp(-numpy.exp(-numpy.asarray(variate, dtype=float)))

    ax.set_yscale("function", functions=(reduced, back))
    ax.set_ylim(low, high)
    shown = [percent for percent in _PERCENTS if low <= percent <= high]
    ax.set_yticks(shown, labels=[f"{percent:g}" for percent in shown])
    ax.yaxis.set_minor_locator(ticker.NullLocator())
