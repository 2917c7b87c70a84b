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

    ``study``: what is looked at.

    Returns a dictionary. ``study``: its tables with every default, as nested dictionaries. ``study_digest``, ``inputs``:
    digests of the study and of its files, hexadecimal. ``scenarios``, ``rows``: their numbers. ``echo``: what will be
    solved, with ``remarks`` on what is unusual. ``rotation``: normal load per sector (N) at each speed (rpm); ``None``:
    the study states its loads.

    Raises ``InputError`` with ``findings`` if the model or the patterns are not accepted. A study file that is not
    accepted raises it when it is read, by ``Study.from_toml``.
    """
    return answer_of(study._checked.check())


def status(results: Folder) -> Answer:
    """How far a results folder is, which is not touched.

    ``results``: the results, or the path of their folder.

    Returns a dictionary. ``name``: of the study. ``work``: ``running``, ``finished`` or ``interrupted``. ``planned``: rows
    of the finished study. ``rows``: rows stored, ``planned``, ``ok``, ``failed`` and ``by_status``, and the upper 95 %
    bound of the share that fails (``failed_share_upper_bound``, 1). ``rows_per_second``: speed, 1/s. ``seconds_left``:
    time that the other rows take at that speed, s. ``holder``: the process that works in the folder. ``shard``: which
    share of the patterns the folder is about, like ``3/8``; ``None``: all. ``shards``: the same keys for each shard.
    ``missing_shards``: numbers of the shards that are not finished. What is not known is ``None``.
    """
    return answer_of(_native.status(_folder_of(results)))


def tails(results: Results) -> Answer:
    """Fits Weibull and generalised extreme value laws to the tails.

    ``results``: finished results. The fits are also written into their folder: ``results.table("tail_fits")``, a row per
    scenario, quantity, law and percentile.

    Returns the dictionary of ``Results.summary`` with one more key. ``tails``: a list, an entry per scenario and quantity
    with ``fits``: ``law``, ``parameters``, ``percentiles`` of peak amplitude (m) or amplification factor (1), and marks.
    """
    return answer_of(_native.tails(results.folder))


def compare(*results: Results, percentile: float = 95.0, baseline: Optional[int] = None) -> Answer:
    """Percentiles between the loads of one study, or between studies, paired on the patterns that they share.

    ``results``: those of one study, or of several.
    ``percentile``: in %, above 0 and below 100.
    ``baseline``: index of the scenario of the first results, from 0, that all others are compared with; unless given
    the best load of one, the same load of several.

    Returns a dictionary. ``percent``: the percentile, %. ``resamples``, ``seed``: of the bootstrap. ``baseline_choice``:
    how the baseline was chosen. ``folders``: what is compared. ``unmatched``: scenarios without a counterpart.
    ``quantities``: an entry for peak amplitude (m) and one for the amplification factor (1). Its ``comparisons`` have
    ``baseline`` and ``candidate``, ``percentile`` with ``difference`` (in the unit of the quantity), ``ratio`` (1), both
    with 95 % bounds, and ``p_value``, and ``pairs``: how many wheels improve. Its ``best`` has the scenario with the
    ``lowest`` percentile, and of all ``loads`` (N per sector) whether each ``could_be_best``.
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

    ``study``: what is solved at each load, with one standard deviation; its own loads do not count.
    ``between``: lowest and highest normal load per sector, N.
    ``percentile``: in %, above 0 and below 100.
    ``quantity``: ``peak_amplitude_m`` (m) or ``amplification_factor`` (1).
    ``resolution``: how close the loads beside the lowest one are at the end, relative, 0.001 to 1.
    ``out``: folder of the search; ``results/<name>-optimum`` unless given.
    ``solved``: results whose loads are not solved again; ``results/<name>`` unless given, and it need not be there.
    ``threads``, ``progress``: as in ``run``, and so is interruption.

    Returns a dictionary. ``normal_load_n``: load with the lowest percentile, N per sector. ``normal_load_lower_n``,
    ``normal_load_upper_n``: the nearest loads that are significantly worse, N; ``None``: the search has none.
    ``resolved``: whether the loads beside the best one are as close as wanted. ``best``: all ``loads`` solved, each with
    its ``percentile`` (``value``, ``lower`` and ``upper`` in the unit of the quantity) and ``could_be_best``; ``lowest``
    is the place of the best one, ``lower`` and ``upper`` bound its percentile. ``excitations``: the same under each load
    case and engine order alone, where there are several. ``name``, ``seed``, ``patterns``, ``percent``, ``quantity``:
    what was searched.
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
    """Time, memory, disk and widths of intervals to expect, from the first patterns, which are solved and not kept.

    ``study``: what is planned.
    ``pilot``: number of patterns that are solved, at least 2.
    ``threads``: as in ``run``, for the pilot and for the times.

    Returns a dictionary. ``name``, ``patterns``, ``scenarios``, ``rows``, ``threads``: of the study to come.
    ``pilot_patterns``, ``pilot_rows``: what was solved, by status. ``set_up_s``: time before the first row, s.
    ``cpu_s_per_pattern``: mean processor time of a pattern, s. ``processor_share``: share of a processor that a thread
    had, 1. ``time``: of all patterns: ``cpu_s`` on processors and ``wall_s`` on the clock, s, with 95 % bounds.
    ``expected_time``: the same for the patterns at which ``[stop]`` is expected to end; ``None``: it is not.
    ``stored``: ``rows`` that ``folder``, results/NAME, has already, and the ``time`` of the others; ``None``: it has none.
    ``memory_bytes``: largest memory. ``disk``: ``results_bytes``, and ``peak_bytes`` while it runs. ``percentiles``: for
    each ``percent`` the ``needed_patterns``, whether it is ``estimable``, and the expected width of its 95 % interval
    over its value (1) for both quantities; ``None``: the pilot has none. ``stop``: the looks of ``[stop]``; ``None``:
    the study has no such table.
    """
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

    ``study``: model, contact, excitation and patterns; its loads do not count.
    ``load``: normal load per sector, N, or a linear limit: ``stuck``, ``slide``, ``free``.
    ``frequencies_hz``: frequencies of the excitation, Hz, shape (F,), positive and ascending.
    ``pattern``: id of the pattern, from 0; the tuned wheel unless given.
    ``load_case``, ``engine_order``, ``standard_deviation``: the name, the number and the relative deviation (1) of one
    setting; needed where the study has several.
    ``fidelity``: ``reduced``; ``full`` solves every contact dof of the whole wheel, finely sampled; slow.
    ``continuation``: the curve is followed through its folds, upwards and downwards; the table has more columns
    (``direction``, ``branch``, ...), and rows at folds as well.

    Returns a table. With F frequencies and B blades it has F B rows, ordered by frequency, then blade. Its columns are
    ``frequency_hz`` (Hz), ``blade`` (from 0), ``amplitude_m`` (m) and ``status``.
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
    """Builds the reduced model of a study.

    ``study``: the study; nothing of it is solved.
    ``export``: a folder into which the sector is written as a bundle; none unless given.

    Returns a dictionary. ``sectors``, ``sector_dofs``, ``contact_pairs``, ``reduced_coordinates``: sizes. ``observed``:
    names of the observed points. ``basis``: that of the reduction. ``error``: of its tuned peak, relative.
    ``nodal_diameters``: for each the ``rank``, the ``condition``, ``stick_frequencies_hz`` and ``slide_frequencies_hz``
    (Hz). ``memory_bytes``: of the model. ``warnings``: what is unusual.
    """
    return answer_of(_native.model(study._checked, None if export is None else Path(export)))


def campbell(
    study: Study,
    engine_orders: Iterable[int] = (),
    speed_rpm: Optional[tuple[float, float]] = None,
    *,
    at: Optional[Mapping[float, Union[str, os.PathLike[str]]]] = None,
    modes: int = 6,
    plot: Optional[Union[str, os.PathLike[str]]] = None,
    plot_safe: Optional[Union[str, os.PathLike[str]]] = None,
    top_hz: Optional[float] = None,
) -> Answer:
    """Natural frequencies per nodal diameter (Hz), and the speeds (rpm) at which engine orders cross them.

    ``study``: the model.
    ``engine_orders``: whole numbers from 1; those of the study unless given.
    ``speed_rpm``: lowest and highest speed, rpm; all unless given.
    ``at``: bundles by speed in rpm, in the place of the model of the study; frequencies then follow the speed.
    ``modes``: modes per nodal diameter, 1 to 100.
    ``plot``, ``plot_safe``: SVG files to write, the Campbell diagram (over speed) and the SAFE diagram (over nodal diameter).
    ``top_hz``: highest frequency of the diagrams, Hz; above the third mode of every nodal diameter unless given.

    Returns a dictionary. ``model``, ``sectors``: of the model. ``speed_rpm``: the speeds of ``at``, rpm. ``range_rpm``:
    the speeds that were asked for, rpm. ``modes``: a list with ``contact``, ``nodal_diameter``, ``mode`` (from 1) and
    ``frequency_hz``, a list by speed, Hz. ``crossings``: a list with ``engine_order``, ``nodal_diameter``, ``backward``,
    ``contact``, ``mode``, ``speed_rpm`` (rpm), ``frequency_hz`` (Hz), and whether it is ``extrapolated``.
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
    for name, file in (("plot", plot), ("plot_safe", plot_safe)):
        if file is not None and Path(file).suffix.lower() != ".svg":
            raise ValueError(f"{name} = {os.fspath(file)!r} is not accepted; accepted: a file name ending in .svg")
    if top_hz is not None and not 1e-3 <= top_hz <= 1e9:
        raise ValueError(f"top_hz = {top_hz} is not accepted; accepted: a frequency from 1e-3 to 1e9 Hz")
    plots = (plot, plot_safe, top_hz)
    return answer_of(_native.campbell(study._checked, orders, modes, speeds, bundles, plots))


def modes(study: Study, count: int = 6) -> list[dict[str, Any]]:
    """Natural frequencies of the tuned wheel.

    ``study``: the model.
    ``count``: modes per nodal diameter, 1 to 100.

    Returns a list with a dictionary per nodal diameter, contact and mode: ``nodal_diameter``, ``contact`` (``free``,
    ``slide`` or ``stuck``), ``mode`` (from 1), ``frequency_hz`` (Hz). ``pandas.DataFrame(blisk.modes(study))`` is a table
    of it.
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

    ``study``: whose population is estimated.
    ``target``: what the solves are to tell best, ``"mean"`` or a percentile from 50 to 99.9, %.
    ``patterns``: number of patterns of the population; that of the study unless given.
    ``solves``: so many patterns are solved in each scenario at most, at least 60; a tenth of them unless given.
    ``out``: folder of the estimate; ``results/<name>-estimate`` unless given.
    ``threads``, ``progress``: as in ``run``, and so is interruption.

    Returns a dictionary. ``patterns``, ``solves``, ``target``: as asked for. ``scenarios``: for each its keys
    (``contact``, ``normal_load_n`` in N, ...), ``tuned_amplitude_m`` (m), ``rows`` by status, ``failed_share`` (1), and
    ``quantities``: of peak amplitude (m) and amplification factor (1) the ``mean`` and the ``percentiles``, each with
    ``value`` and 95 % bounds ``lower`` and ``upper``, and ``equivalent_patterns``: random wheels that tell as much.
    ``name``, ``seed``, ``study``, ``study_digest``, ``inputs``, ``version``, ``build``, ``sample_digest``: where it comes
    from. ``reduction``, ``chosen``: model and settings.
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

    ``study``: whose rows are solved.
    ``patterns``: number of patterns of the sample, at least 2.
    ``reference``: ``reduced``; ``full`` checks the best settings by the full-contact model, which is slow.
    ``out``: folder of the tables; ``results/<name>`` unless given.
    ``threads``, ``progress``: as in ``run``.

    Returns a dictionary. ``settings``: those tried, each with its errors of ``amplitude``, ``frequency`` and
    ``amplification_factor``, all relative, and ``cpu_s`` (processor time, s). ``choices``: for each ``accepted_error``
    (relative) the cheapest ``setting``. ``reference``: what the errors are taken against. ``patterns``, ``scenarios``,
    ``normal_loads_n`` (N per sector): the sample.
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
    ``out``: the results folder to write.
    ``study_file``: the study file beside which the inputs lie now; that of the last run unless given.

    Returns the results.
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
    """Solves one delivered row again and says whether it is the same bit for bit.

    ``results``: where the row is.
    ``scenario``: its index, from 0.
    ``pattern``: its id, from 0.
    ``fidelity``: ``reduced``; ``full`` solves it by the full-contact model as well, which is slow.
    ``study_file``: the study file beside which the inputs lie now; that of the last run unless given.

    Returns a dictionary. ``identical``: whether the row is the same. ``delivered``, ``replayed``: both with
    ``peak_amplitude_m`` (m), ``peak_frequency_hz`` (Hz), ``peak_blade``, ``amplification_factor`` (1), ``status`` and
    more. With ``full`` also ``full`` and ``errors``, relative.
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

    ``results``: the results, or the path of their folder, which need not open.
    ``question``: one of four. ``"full_model"``, the same on the full-contact model? ``"dense_sweep"``, a higher peak
    elsewhere? ``"time_domain"``, the same by integration in time? ``"integrity"``, are all files as they were written?
    The first two write tables, which ``results.table`` reads.
    ``repair``: of ``integrity``; damaged files are set aside, and what they held is solved again.
    ``sample``: number of rows, at least 1.
    ``seed``: of the sample; that of the study unless given.
    ``row``: of ``time_domain``; scenario and pattern of one row, in the place of a sample.
    ``threads``, ``progress``: as in ``run``.
    ``study_file``: the study file beside which the inputs lie now; that of the last run unless given. A repair needs it
    where the manifest is damaged.

    Returns a dictionary. ``verified``: whether the rows stand. ``sampled``, ``rows``: rows solved again, and of the
    study. All differences are relative: ``closed`` and ``separating`` of ``full_model``, ``under_read`` of
    ``dense_sweep``; docs/results.md has the keys of ``time_domain``. Of ``integrity``: ``whole``, whether all files are
    as they were, and the ``files``. Of a repair: ``set_aside``, and ``different``, tables that are not the same bytes as
    before.
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
