"""Questions about a study or its results that are answered in numbers and in words."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Optional, Union

from . import _native
from ._answer import Answer, answer_of
from ._native import Table
from ._progress import ProgressArgument, listening
from ._results import Results
from ._run import checked_threads
from ._study import Study


Folder = Union[Results, str, os.PathLike[str]]
"""Results, or the path of their folder, which need not be whole."""


def check(study: Study) -> Answer:
    """Looks at model and patterns of a study, and solves nothing.

    ``study``: the study with every default. ``study_digest``, ``inputs``: digests, hexadecimal. ``scenarios``, ``rows``:
    their numbers. ``echo``: what will be solved, with ``remarks`` on what is unusual. ``rotation``: normal loads of each
    speed, where a study has them.

    Raises ``InputError`` with ``findings`` if the model or the patterns are not accepted. A study file that is not
    accepted raises it when it is read, by ``Study.from_toml``.
    """
    return answer_of(study._checked.check())


def status(results: Folder) -> Answer:
    """How far a results folder is, which is not touched: state, rows by status, rows per second, seconds left, shards."""
    return answer_of(_native.status(_folder_of(results)))


def tails(results: Results) -> Answer:
    """The summary with Weibull and generalised extreme value laws fitted to the tails, in ``tails``.

    Percentiles are of peak amplitude (m) and amplification factor (1). The fits are also written into the folder:
    ``results.table("tail_fits")``, a row per scenario, quantity, law and percentile.
    """
    return answer_of(_native.tails(results.folder))


def compare(*results: Results, percentile: float = 95.0, baseline: Optional[int] = None) -> Answer:
    """Percentiles between the loads of one study, or between studies, paired on the patterns that they share.

    ``percentile``: in %, above 0 and below 100.
    ``baseline``: scenario of the first results that all others are compared with; unless given the best load of one,
    the same load of several.
    """
    if not results:
        raise TypeError("compare() needs results")
    folders = [own.folder for own in results]
    return answer_of(_native.compare(folders, _percent(percentile), baseline))


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
    return answer_of(answer)


def plan(study: Study, pilot: int = 20, threads: Optional[int] = None) -> Answer:
    """Time, memory, disk and widths of intervals to expect, from the first ``pilot`` patterns, which are not kept."""
    if pilot < 2:
        raise ValueError(f"pilot = {pilot} is not accepted; accepted: at least 2")
    return answer_of(_native.plan(study._checked, pilot, checked_threads(threads)))


def response(
    study: Study,
    load: Union[float, str],
    frequencies_hz: Iterable[float],
    pattern: Optional[int] = None,
    *,
    load_case: Optional[str] = None,
    engine_order: Optional[int] = None,
    standard_deviation: Optional[float] = None,
    fidelity: str = "reduced",
    continuation: bool = False,
) -> Table:
    """Amplitude of every blade of one wheel over frequency.

    With F frequencies and B blades the table has F B rows, ordered by frequency, then blade: ``frequency_hz`` (Hz),
    ``blade``, ``amplitude_m`` (m), ``status``.

    ``load``: normal load per sector, N, or a linear limit: ``stuck``, ``slide``, ``free``.
    ``frequencies_hz``: frequencies of the excitation, Hz, positive and ascending.
    ``pattern``: id of the pattern; the tuned wheel unless given.
    Load case, engine order and standard deviation have to be named where the study has several.
    ``fidelity``: ``full`` solves every contact dof of the whole wheel, finely sampled; slow.
    ``continuation``: the curve is followed through its folds, upwards and downwards; the table has more columns
    (``direction``, ``branch``, ...), and rows at folds as well.
    """
    if fidelity not in ("reduced", "full"):
        raise ValueError(f"fidelity = {fidelity!r} is not accepted; accepted: reduced, full")
    if continuation and fidelity == "full":
        raise ValueError("a curve is followed on the reduced model; accepted: continuation with fidelity = 'reduced'")
    frequencies = [float(frequency) for frequency in frequencies_hz]
    ascending = all(low < high for low, high in zip(frequencies, frequencies[1:]))
    if not frequencies or not ascending or not 0.0 < frequencies[0] <= frequencies[-1] < float("inf"):
        raise ValueError("frequencies_hz is not accepted; accepted: positive frequencies in ascending order")
    excitation = (load_case, engine_order, standard_deviation)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "response.parquet"
        way = "followed" if continuation else fidelity
        return _native.response(study._checked, pattern, load, frequencies, *excitation, way, path)


def model(study: Study, export: Union[str, os.PathLike[str], None] = None) -> Answer:
    """Builds the reduced model of a study: sizes, frequencies per nodal diameter (Hz), rank and condition.

    ``export``: a folder into which the sector is written as a bundle.
    """
    return answer_of(_native.model(study._checked, None if export is None else Path(export)))


def campbell(
    study: Study,
    engine_orders: Iterable[int] = (),
    speed_rpm: Optional[tuple[float, float]] = None,
    *,
    at: Optional[Mapping[float, Union[str, os.PathLike[str]]]] = None,
    modes: int = 6,
) -> Answer:
    """Natural frequencies per nodal diameter (Hz), and the speeds (rpm) at which engine orders cross them.

    ``engine_orders``: those of the study unless given. ``speed_rpm``: lowest and highest speed; all unless given.
    ``at``: bundles by speed in rpm, in the place of the model of the study; frequencies then follow the speed.
    ``modes``: modes per nodal diameter, 1 to 100.
    """
    if not 1 <= modes <= 100:
        raise ValueError(f"modes = {modes} is not accepted; accepted: 1 to 100")
    orders = [int(order) for order in engine_orders]
    if any(not 1 <= order <= 10_000 for order in orders):
        raise ValueError(f"engine_orders = {orders} is not accepted; accepted: whole numbers from 1 to 10000")
    speeds = None
    if speed_rpm is not None:
        low, high = (float(speed) for speed in speed_rpm)
        if not 0.0 <= low < high <= 1e6:
            raise ValueError(
                f"speed_rpm = {speed_rpm} is not accepted; accepted: two speeds from 0 to 1e6, the lower first"
            )
        speeds = (low, high)
    bundles = sorted((float(speed), Path(folder)) for speed, folder in (at or {}).items())
    if any(not 0.0 <= speed <= 1e6 for speed, _ in bundles):
        raise ValueError("at is not accepted; accepted: speeds from 0 to 1e6 rpm with a bundle each")
    return answer_of(_native.campbell(study._checked, orders, modes, speeds, bundles))


def modes(study: Study, count: int = 6) -> list[dict[str, Any]]:
    """Natural frequencies of the tuned wheel: a row per nodal diameter, contact and mode.

    ``count``: modes per nodal diameter. Keys: ``nodal_diameter``, ``contact`` (``free``, ``slide`` or ``stuck``),
    ``mode`` (from 1), ``frequency_hz``. ``pandas.DataFrame(blisk.modes(study))`` is a table of it.
    """
    rows = campbell(study, modes=count)["modes"]
    # One model holds at every speed.
    return [{**row, "frequency_hz": row["frequency_hz"][0]} for row in rows]


def estimate(
    study: Study,
    target: Union[float, str] = 99.0,
    *,
    patterns: Optional[int] = None,
    solves: Optional[int] = None,
    out: Union[str, os.PathLike[str], None] = None,
    threads: Optional[int] = None,
    progress: ProgressArgument = None,
) -> Answer:
    """Mean and percentiles from few solves: a cheap surrogate of every pattern says which ones to solve.

    ``target``: what the solves are to tell best, ``"mean"`` or a percentile from 50 to 99.9.
    ``patterns``: size of the population; that of the study unless given.
    ``solves``: so many patterns are solved in each scenario at most; a tenth of them unless given.
    ``out``: folder of the estimate; ``results/<name>-estimate`` unless given.
    ``threads``, ``progress`` and interruption are as in ``run``.
    """
    percent = None if target == "mean" else target
    if percent is not None and (isinstance(percent, str) or not 50.0 <= percent <= 99.9):
        raise ValueError(f"target = {target!r} is not accepted; accepted: mean, or a percentile from 50 to 99.9")
    for name, value in (("patterns", patterns), ("solves", solves)):
        if value is not None and value < 1:
            raise ValueError(f"{name} = {value} is not accepted; accepted: a whole number of at least 1")
    folder = Path("results") / f"{study.name}-estimate" if out is None else Path(out)
    own = (None if percent is None else float(percent), patterns, solves, folder, checked_threads(threads))
    with listening(progress) as listener:
        answer = _native.estimate(study._checked, *own, listener)
    return answer_of(answer)


def tradeoff(
    study: Study,
    patterns: int = 8,
    *,
    reference: str = "reduced",
    out: Union[str, os.PathLike[str], None] = None,
    threads: Optional[int] = None,
    progress: ProgressArgument = None,
) -> Answer:
    """Measures what accuracy costs: a sample of the study's rows over a ladder of settings.

    ``patterns``: patterns of the sample, at least 2. ``reference``: ``full`` checks the best settings by the
    full-contact model, which is slow. ``out``: folder of the tables; ``results/<name>`` unless given.
    """
    if patterns < 2:
        raise ValueError(f"patterns = {patterns} is not accepted; accepted: at least 2")
    if reference not in ("reduced", "full"):
        raise ValueError(f"reference = {reference!r} is not accepted; accepted: reduced, full")
    folder = Path("results") / study.name if out is None else Path(out)
    with listening(progress) as listener:
        own = (patterns, reference == "full", folder, checked_threads(threads), listener)
        answer = _native.tradeoff(study._checked, *own)
    return answer_of(answer)


def merge(
    *shards: Union[str, os.PathLike[str]],
    out: Union[str, os.PathLike[str]],
    study_file: Union[str, os.PathLike[str], None] = None,
) -> Results:
    """Joins shards of a study, which the command ``blisk run --shard`` has solved, to its results in the folder ``out``.

    ``shards``: their folders in any order, or the folder that they lie in.
    ``study_file``: the study file beside which the inputs lie now; that of the last run unless given.
    """
    if not shards:
        raise TypeError("merge() needs the folders of shards")
    _native.merge([Path(own) for own in shards], Path(out), None if study_file is None else Path(study_file))
    return Results(out)


def replay(
    results: Results,
    scenario: int,
    pattern: int,
    *,
    fidelity: str = "reduced",
    study_file: Union[str, os.PathLike[str], None] = None,
) -> Answer:
    """Solves one delivered row again and says whether it is the same bit for bit (``identical``).

    ``scenario``: its index, from 0. ``pattern``: its id. ``fidelity``: ``full`` solves it by the full-contact model as
    well, which is slow, and gives the errors.
    """
    if fidelity not in ("reduced", "full"):
        raise ValueError(f"fidelity = {fidelity!r} is not accepted; accepted: reduced, full")
    for name, value in (("scenario", scenario), ("pattern", pattern)):
        if value < 0:
            raise ValueError(f"{name} = {value} is not accepted; accepted: a whole number of at least 0")
    path = None if study_file is None else Path(study_file)
    return answer_of(_native.replay(results.folder, scenario, pattern, fidelity == "full", path))


def verify(
    results: Folder,
    question: str = "full_model",
    *,
    repair: bool = False,
    sample: int = 10,
    seed: Optional[int] = None,
    row: Optional[tuple[int, int]] = None,
    threads: Optional[int] = None,
    progress: ProgressArgument = None,
    study_file: Union[str, os.PathLike[str], None] = None,
) -> Answer:
    """Solves a random sample of delivered rows again; ``verified`` says whether they stand.

    ``question``: ``full_model``, the same on the full-contact model? ``dense_sweep``: a higher peak elsewhere?
    ``time_domain``: the same by integration in time? of one row, ``row`` being scenario and pattern. ``integrity``: are
    all files as they were written (``whole``)? The first two write tables, which ``results.table`` reads.
    ``repair``: of ``integrity``; damaged files are set aside (``set_aside``), what they held is solved again, and
    ``different`` names tables that are not the same bytes as before. The study is that of the manifest, or that of
    ``study_file`` where the manifest is damaged. ``results`` may be the path of a folder that does not open.
    ``sample``: number of rows. ``seed``: of the sample; that of the study unless given.
    """
    if sample < 1:
        raise ValueError(f"sample = {sample} is not accepted; accepted: at least 1")
    if row is not None and question != "time_domain":
        raise ValueError("row is that of question = 'time_domain'")
    if repair and question != "integrity":
        raise ValueError("repair is that of question = 'integrity'")
    folder = _folder_of(results)
    path = None if study_file is None else Path(study_file)
    with listening(progress) as listener:
        if repair:
            answer = _native.repair(folder, checked_threads(threads), path, listener)
        else:
            own = (question, sample, seed, row, checked_threads(threads), path, listener)
            answer = _native.verify(folder, *own)
    return answer_of(answer)


def _folder_of(results: Folder) -> Path:
    return results.folder if isinstance(results, Results) else Path(results)


def _percent(percent: float) -> float:
    if not 0.0 < percent < 100.0:
        raise ValueError(f"percentile = {percent} is not accepted; accepted: a number above 0 and below 100")
    return percent
