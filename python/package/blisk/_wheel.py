"""One wheel with known blades."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union


from ._native import Table
from ._run import run
from ._study import Study

FAR = 0.15
"""Mean deviation from which blades are others than those of the model, unit 1."""


@dataclass(frozen=True)
class Peak:
    """The peak of one wheel over blades and frequency at one load."""

    contact: str
    """``full`` under friction, or the linear limit ``stuck``, ``slide``, ``free``."""
    normal_load_n: Optional[float]
    """Normal load per sector, N; ``None`` for a linear limit."""
    amplitude_m: Optional[float]
    """Peak amplitude, m; ``None`` where ``status`` is not ``ok``."""
    frequency_hz: Optional[float]
    """Frequency of the peak, Hz."""
    blade: Optional[int]
    """The blade that has it, from 0."""
    amplification_factor: Optional[float]
    """Peak over that of the tuned wheel at the same load."""
    stated_error: Optional[float]
    """Bound on the relative numerical error of the amplitude, unit 1; ``None`` where it is not known."""
    status: str
    """``ok``, or why there is no result."""


class Wheel:
    """One wheel with known blades, under the loads and settings of a study; ``Study.wheel`` makes it.

    ``study``: the study.
    ``deviations``: relative deviation of each blade's stiffness, shape (N,) with N sectors, unit 1: 0.02 is 2 %.
    """

    deviations: tuple[float, ...]
    """Relative deviation of each blade's stiffness, one per sector, unit 1."""

    def __init__(self, study: Study, deviations: Iterable[float]) -> None:
        self.deviations = tuple(float(own) for own in deviations)
        if not self.deviations or not all(-1.0 < own < float("inf") for own in self.deviations):
            raise ValueError("deviations is not accepted; accepted: a number above -1 for each blade")
        mean = sum(self.deviations) / len(self.deviations)
        if abs(mean) > FAR:
            warnings.warn(
                f"the mean deviation of blade stiffness is {100 * mean:+.0f} %, which moves every resonance: "
                "deviations are relative to the blade of the model",
                stacklevel=3,
            )
        self.study = study

    def peaks(
        self, loads: Optional[Sequence[Union[float, str]]] = None, *, threads: Optional[int] = None
    ) -> list[Peak]:
        """The peak at each of the loads, in the order of the study's scenarios.

        ``loads``: normal loads per sector, N, and linear limits by name; those of the study unless given. The study has
        one load case and engine order.
        ``threads``: as in ``run``.

        Returns a ``Peak`` per load. ``InputError``: the study is not accepted with this wheel, for instance where there
        are not as many deviations as sectors.
        """
        with tempfile.TemporaryDirectory() as folder:
            study = self._study(Path(folder), loads)
            if study.scenarios != len(study.to_dict()["sweep"]["normal_load_n"]):
                raise ValueError("the study has several load cases or engine orders; accepted: one, by study.replace")
            rows = run(study, Path(folder) / "results", threads).responses.rows()
        own = ("contact", "normal_load_n", "amplification_factor", "stated_error", "status")
        renamed = {"amplitude_m": "peak_amplitude_m", "frequency_hz": "peak_frequency_hz", "blade": "peak_blade"}
        return [
            Peak(**{key: row[key] for key in own}, **{key: row[column] for key, column in renamed.items()})
            for row in rows
        ]

    def peak(self, load: Union[float, str], *, threads: Optional[int] = None) -> Peak:
        """The peak at one load.

        ``load``: normal load per sector, N, or a linear limit: ``stuck``, ``slide``, ``free``.
        ``threads``: as in ``run``.

        Returns the ``Peak``: amplitude in m, frequency in Hz.
        """
        return self.peaks([load], threads=threads)[0]

    def response(self, load: Union[float, str], frequencies_hz: Iterable[float]) -> Table:
        """Amplitude of every blade over frequency.

        ``load``: normal load per sector, N, or a linear limit: ``stuck``, ``slide``, ``free``.
        ``frequencies_hz``: frequencies of the excitation, Hz, shape (F,), positive and ascending.

        Returns the table of ``blisk.response``, F B rows with B blades: ``frequency_hz`` (Hz), ``blade``,
        ``amplitude_m`` (m), ``status``.
        """
        from ._answers import response

        with tempfile.TemporaryDirectory() as folder:
            return response(self._study(Path(folder), [load]), load, frequencies_hz, pattern=0)

    def _study(self, folder: Path, loads: Optional[Sequence[Union[float, str]]]) -> Study:
        """The study of this wheel alone; its blades stand in a file in ``folder``."""
        lines = [f"0,{blade},{deviation!r}\n" for blade, deviation in enumerate(self.deviations)]
        (folder / "wheel.csv").write_text("pattern,blade,deviation\n" + "".join(lines), encoding="utf-8")
        changes: dict[str, Any] = {
            "mistuning.file": str(folder / "wheel.csv"),
            "mistuning.distribution": None,
            "sweep.standard_deviation": None,
            "study.patterns": None,
            # A population may stop early, and its contact may be random.
            "stop": None,
            "contact.variation": None,
        }
        if loads is not None:
            changes["sweep.normal_load_n"] = list(loads)
        own = self.study.to_dict()
        if "contact" not in own:
            del changes["contact.variation"]
        return self.study.replace(changes)

    def __repr__(self) -> str:
        return f"<blisk.Wheel of {self.study.name}: {len(self.deviations)} blades>"
