"""Questions about a study or its results that are answered in numbers and in words."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Optional, Union

from . import _native
from ._native import Table
from ._progress import ProgressArgument, listening
from ._results import Results
from ._run import checked_threads
from ._study import Study


class Answer(dict[str, Any]):
    """An answer as nested dictionaries, with the keys of ``--json`` of the command; ``str`` of it is in words."""

    text: str
    """The answer in words, as the command prints it."""

    def __init__(self, values: dict[str, Any], text: str) -> None:
        super().__init__(values)
        self.text = text

    def __str__(self) -> str:
        return self.text


def compare(*results: Results, percentile: float = 95.0, baseline: Optional[int] = None) -> Answer:
    """Percentiles between the loads of one study, or between studies, paired on the patterns that they share.

    ``percentile``: in %, above 0 and below 100.
    ``baseline``: scenario of the first results that all others are compared with; unless given the best load of one,
    the same load of several.
    """
    if not results:
        raise TypeError("compare() needs results")
    folders = [own.folder for own in results]
    return _answer(_native.compare(folders, _percent(percentile), baseline))


def optimum(
    study: Study,
    between: tuple[float, float],
    percentile: float = 95.0,
    quantity: str = "peak_amplitude_m",
    *,
    resolution: float = 0.05,
    out: Union[str, os.PathLike[str], None] = None,
    solved: Union[str, os.PathLike[str], None] = None,
    threads: Optional[int] = None,
    progress: ProgressArgument = None,
) -> Answer:
    """Searches the normal load with the lowest percentile, on the patterns of the study.

    ``between``: lowest and highest normal load per sector, N.
    ``percentile``: in %. ``quantity``: ``peak_amplitude_m`` or ``amplification_factor``.
    ``resolution``: how close the loads beside the lowest one are at the end, relative, 0.001 to 1.
    ``out``: folder of the search; ``results/<name>-optimum`` unless given.
    ``solved``: results whose loads are not solved again; ``results/<name>`` unless given, and it need not be there.
    ``threads``, ``progress`` and interruption are as in ``run``.
    """
    low, high = (float(load) for load in between)
    if not 0.0 < low < high < float("inf"):
        raise ValueError(f"between = {between} is not accepted; accepted: two positive loads, the lower first")
    if not 1e-3 <= resolution <= 1.0:
        raise ValueError(f"resolution = {resolution} is not accepted; accepted: a number from 0.001 to 1")
    named = Path("results")
    folder = named / f"{study.name}-optimum" if out is None else Path(out)
    known = named / study.name if solved is None else Path(solved)
    wanted = ((low, high), _percent(percentile), quantity, resolution)
    with listening(progress) as listener:
        answer = _native.optimum(study._checked, *wanted, folder, known, checked_threads(threads), listener)
    return _answer(answer)


def plan(study: Study, pilot: int = 20, threads: Optional[int] = None) -> Answer:
    """Time, memory, disk and widths of intervals to expect, from the first ``pilot`` patterns, which are not kept."""
    if pilot < 2:
        raise ValueError(f"pilot = {pilot} is not accepted; accepted: at least 2")
    return _answer(_native.plan(study._checked, pilot, checked_threads(threads)))


def response(
    study: Study,
    load: Union[float, str],
    frequencies_hz: Iterable[float],
    pattern: Optional[int] = None,
    *,
    load_case: Optional[str] = None,
    engine_order: Optional[int] = None,
    standard_deviation: Optional[float] = None,
) -> Table:
    """Amplitude of every blade of one wheel over frequency.

    With F frequencies and B blades the table has F B rows, ordered by frequency, then blade: ``frequency_hz`` (Hz),
    ``blade``, ``amplitude_m`` (m), ``status``.

    ``load``: normal load per sector, N, or a linear limit: ``stuck``, ``slide``, ``free``.
    ``frequencies_hz``: frequencies of the excitation, Hz, positive and ascending.
    ``pattern``: id of the pattern; the tuned wheel unless given.
    Load case, engine order and standard deviation have to be named where the study has several.
    """
    frequencies = [float(frequency) for frequency in frequencies_hz]
    ascending = all(low < high for low, high in zip(frequencies, frequencies[1:]))
    if not frequencies or not ascending or not 0.0 < frequencies[0] <= frequencies[-1] < float("inf"):
        raise ValueError("frequencies_hz is not accepted; accepted: positive frequencies in ascending order")
    excitation = (load_case, engine_order, standard_deviation)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "response.parquet"
        return _native.response(study._checked, pattern, load, frequencies, *excitation, path)


def _answer(answer: tuple[str, str]) -> Answer:
    values, text = answer
    return Answer(json.loads(values), text)


def _percent(percent: float) -> float:
    if not 0.0 < percent < 100.0:
        raise ValueError(f"percentile = {percent} is not accepted; accepted: a number above 0 and below 100")
    return percent
