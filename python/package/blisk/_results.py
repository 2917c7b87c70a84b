"""Results folders: tables, summary, manifest, report."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, Optional, Union

from . import _native
from ._distribution import drawn
from ._errors import BliskError
from ._figure import Figure, plotted
from ._native import Table


@dataclass(frozen=True)
class Best:
    """The normal load with the lowest percentile among those of a study."""

    scenario: int
    """Index of the scenario, as in the tables."""
    normal_load_n: float
    """Normal load per sector, N."""
    value: float
    """The percentile there, in the unit of the quantity."""
    lower: Optional[float]
    """Lower 95 % bound of the percentile; ``None``: there is none."""
    upper: Optional[float]
    """Upper 95 % bound of the percentile; ``None``: there is none."""
    percent: float
    """Which percentile, %."""
    quantity: str
    """``peak_amplitude_m`` (m) or ``amplification_factor`` (1)."""
    engine_order: int
    """Engine order of the excitation."""
    standard_deviation: Optional[float]
    """Of the blades' relative stiffness deviation; ``None`` for patterns from a file."""
    load_case: Optional[str]
    """Load case of the excitation; ``None``: the study has none."""


class Results:
    """A results folder, as ``run`` or the command ``blisk run`` writes it.

    ``folder``: its path; ``BliskError`` where it is no results folder.

    Tables are read when they are asked for, and each is checked against its digest. docs/results.md says what every
    column holds; ``Table.units`` and ``Table.descriptions`` say it as well. N patterns, S scenarios and B blades make

    ================  ==========================================================
    ``responses``     N S rows, ordered by pattern, then scenario
    ``scenarios``     S rows with the tuned peak and statistics
    ``percentiles``   a row per scenario, quantity and percentile
    ``distribution``  a row per scenario, quantity and value of the sample
    ``patterns``      N B rows per standard deviation: the deviation of each blade
    ``main_effects``  a row per scenario, quantity and random contact parameter
    ================  ==========================================================
    """

    def __init__(self, folder: Union[str, os.PathLike[str]]) -> None:
        self.folder = Path(folder)
        # Whether this is a results folder shows at once.
        _native.manifest(self.folder)

    def table(self, name: str) -> Table:
        """A table of the folder, also one that another command wrote.

        ``name``: that of the file without ``.parquet``, like ``tail_fits``. Returns the table.
        """
        return _native.table(self.folder, name)

    @property
    def responses(self) -> Table:
        """One row per pattern and scenario: peak amplitude (m), its frequency (Hz), amplification factor, status."""
        return self.table("responses")

    @property
    def scenarios(self) -> Table:
        """One row per scenario: tuned peak; mean, P5, P50, P95, P99 of peak amplitude (m), amplification factor (1)."""
        return self.table("scenarios")

    @property
    def percentiles(self) -> Table:
        """One row per scenario, quantity and percentile, with 95 % bounds, ranks and achieved coverage."""
        return self.table("percentiles")

    @property
    def distribution(self) -> Table:
        """One row per scenario, quantity and value, with the share of smaller values and its 95 % band."""
        return self.table("distribution")

    @property
    def patterns(self) -> Table:
        """One row per pattern and blade: relative deviation of the blade's stiffness. Up to 10,000 patterns."""
        return self.table("patterns")

    @property
    def main_effects(self) -> Table:
        """One row per scenario, quantity and input: share of the variance. Only where the contact varies."""
        return self.table("main_effects")

    @property
    def summary(self) -> dict[str, Any]:
        """The summary as nested dictionaries, as ``blisk stats --json`` prints it.

        Of a study that is not finished it is that of the rows stored, with ``unfinished``, ``rows_stored`` and
        ``rows_planned``.
        """
        (text, _), unfinished = _native.summary(self.folder)
        summary: dict[str, Any] = json.loads(text)
        if unfinished is not None:
            stored, planned = unfinished
            summary = {"unfinished": True, "rows_stored": stored, "rows_planned": planned, **summary}
        return summary

    @property
    def summary_text(self) -> str:
        """The summary as ``blisk run`` prints it."""
        return _native.summary(self.folder)[0][1]

    @property
    def manifest(self) -> dict[str, Any]:
        """``manifest.json``: resolved study, digests of inputs and tables, seed, build, chosen settings, counts."""
        manifest: dict[str, Any] = json.loads(_native.manifest(self.folder))
        return manifest

    @property
    def finished(self) -> bool:
        """Whether every row is there; ``run`` with the same study continues one that is not."""
        return bool(self.manifest["state"] == "finished")

    def best(
        self,
        percentile: float = 99.0,
        quantity: str = "peak_amplitude_m",
        *,
        engine_order: Optional[int] = None,
        standard_deviation: Optional[float] = None,
        load_case: Optional[str] = None,
    ) -> Best:
        """The normal load with the lowest percentile among the loads of the study; linear limits do not count.

        ``percentile``: in %; one of those that ``percentiles`` has.
        ``quantity``: ``peak_amplitude_m`` (m) or ``amplification_factor`` (1).
        ``engine_order``, ``standard_deviation``, ``load_case``: the number, the relative deviation (1) and the name of
        one setting; needed where the study has several.

        Returns the load (N per sector) with the percentile and its 95 % bounds. Loads whose bounds overlap may still
        differ, or be as good: ``blisk.compare`` tells, on the patterns that they share.

        Raises ``ValueError`` where no load has such a percentile: P95 needs 72 patterns, P99 368.
        """
        wanted = {"engine_order": engine_order, "standard_deviation": standard_deviation, "load_case": load_case}
        rows = [row for row in self.percentiles.rows() if row["contact"] == "full" and row["quantity"] == quantity]
        for key, value in wanted.items():
            rows = [row for row in rows if value is None or row.get(key) == value]
            choices = sorted({row.get(key) for row in rows}, key=str)
            if len(choices) > 1:
                raise ValueError(f"the study has several values of {key}; name one: {', '.join(map(str, choices))}")
        rows = [row for row in rows if row["percent"] == percentile and row["value"] is not None]
        if not rows:
            raise ValueError(
                f"no normal load has a value of P{percentile:g} of {quantity} with {wanted}; `percentiles` has what"
                " there is, and its column `status` says why a value is missing"
            )
        row = min(rows, key=lambda row: row["value"])
        own = ("scenario", "normal_load_n", "value", "lower", "upper", "percent", "quantity", "engine_order")
        return Best(
            **{key: row[key] for key in own},
            standard_deviation=row["standard_deviation"],
            load_case=row.get("load_case"),
        )

    def report(
        self,
        path: Union[str, os.PathLike[str], None] = None,
        *,
        curves: bool = True,
        study_file: Union[str, os.PathLike[str], None] = None,
    ) -> Path:
        """Writes the report, one HTML page.

        ``path``: the file; ``report.html`` in the folder unless given.
        ``curves``: also response curves, for which wheels are solved again.
        ``study_file``: the study file beside which the inputs lie now; that of the last run unless given.

        Returns the path of the page.
        """
        target = self.folder / "report.html" if path is None else Path(path)
        _native.report(self.folder, target, curves, None if study_file is None else Path(study_file))
        return target

    def figure(
        self,
        name: str = "amplitude",
        *,
        load_case: Optional[str] = None,
        engine_order: Optional[int] = None,
        standard_deviation: Optional[float] = None,
        study_file: Union[str, os.PathLike[str], None] = None,
    ) -> Figure:
        """A figure of the report as SVG, which a notebook shows.

        ``name``: one of ``blisk.figures()``. Figures of single wheels solve these again.
        ``load_case``, ``engine_order``, ``standard_deviation``: the name, the number and the relative deviation (1) of
        one setting; needed where the study has several.
        ``study_file``: the study file beside which the inputs lie now; that of the last run unless given.

        Returns the figure.
        """
        own = (load_case, engine_order, standard_deviation, None if study_file is None else Path(study_file))
        return Figure(name, *_native.figure(self.folder, name, *own))

    def plot(
        self,
        quantity: str = "peak_amplitude_m",
        *,
        percentiles: Sequence[float] = (50.0, 95.0, 99.0),
        engine_order: Optional[int] = None,
        standard_deviation: Optional[float] = None,
        load_case: Optional[str] = None,
        ax: Any = None,
    ) -> Any:
        """Draws percentiles over the normal load per sector (N), with 95 % bounds and the tuned wheel.

        ``quantity``: ``peak_amplitude_m`` or ``amplification_factor``. Units and scales are those of the figure of the
        report: amplitudes in µm from 0.01 µm to 10 cm, and a logarithmic axis where values differ by more than a
        factor of 4.
        ``percentiles``: in %; those without a value are left out.
        ``engine_order``, ``standard_deviation``, ``load_case``: the number, the relative deviation (1) and the name of
        one setting; needed where the study has several.
        ``ax``: axes of matplotlib to draw into; new ones unless given.

        Returns the axes. The linear limits are level lines. Every load has a tick, and a label where there is room for it.
        """
        wanted = {"engine_order": engine_order, "standard_deviation": standard_deviation, "load_case": load_case}
        return plotted(self, quantity, percentiles, wanted, ax)

    def plot_distribution(
        self,
        quantity: str = "peak_amplitude_m",
        *,
        loads: Optional[Sequence[Union[float, str]]] = None,
        engine_order: Optional[int] = None,
        standard_deviation: Optional[float] = None,
        load_case: Optional[str] = None,
        ax: Any = None,
    ) -> Any:
        """Draws the share of the wheels that stay below a value, %, with the 95 % band of the whole distribution.

        ``quantity``: ``peak_amplitude_m`` or ``amplification_factor``. Unit and scales are those of the report's figure
        ``amplitude-distribution``: the vertical axis is that of Gumbel's law, which spreads the tail.
        ``loads``: normal loads per sector (N) of the study, or the names ``"slide"``, ``"stuck"``, ``"free"``; unless
        given the load with the lowest of the highest percentile that has a value.
        ``engine_order``, ``standard_deviation``, ``load_case``: the number, the relative deviation (1) and the name of
        one setting; needed where the study has several.
        ``ax``: axes of matplotlib to draw into; new ones unless given.

        Returns the axes. A square is a percentile, and the line through it reaches from its lower to its upper 95 % bound.
        """
        wanted = {"engine_order": engine_order, "standard_deviation": standard_deviation, "load_case": load_case}
        return drawn(self, quantity, loads, wanted, ax)

    def _repr_html_(self) -> str:
        text = f"<pre>{escape(self.summary_text)}</pre>"
        try:
            return self.figure().svg + text
        except (BliskError, ValueError):
            # Not finished, or several excitations.
            return text

    def __repr__(self) -> str:
        return f"<blisk.Results {self.folder}>"
