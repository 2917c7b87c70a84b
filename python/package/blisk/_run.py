"""Running a study."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Optional, Union

from . import _native
from ._progress import ProgressArgument, listening
from ._results import Results
from ._study import Study


def run(
    study: Study,
    out: Union[str, os.PathLike[str], None] = None,
    threads: Optional[int] = None,
    progress: ProgressArgument = None,
    *,
    solve_anew: bool = False,
) -> Results:
    """Solves a study, or continues one: rows that are stored in the folder are not solved again.

    ``study``: what is solved.
    ``out``: the results folder; ``results/<name>`` unless given.
    ``threads``: number of threads, 1 to 1024; those of the scheduler's allocation unless given, else all cores.
    Results do not depend on it.
    ``progress``: ``True`` for a line on the standard error stream with a bar, rows done of all and time left, or a
    function that is called with a ``Progress``, at most 20 times a second, on the thread that called ``run``.
    ``solve_anew``: rows of another build of the program are set aside and everything is solved anew; without it they
    are a ``BliskError``.

    Returns the results. Other threads of Python go on meanwhile. ``KeyboardInterrupt``, or an exception of ``progress``, stops the run
    between rows; what is solved is stored, and the same call continues. A second one is raised at once.
    """
    folder = Path("results") / study.name if out is None else Path(out)
    with listening(progress) as listener:
        _native.run(study._checked, folder, checked_threads(threads), solve_anew, listener)
    return Results(folder)


def checked_threads(threads: Optional[int]) -> Optional[int]:
    """``threads`` if the command takes so many."""
    if threads is not None and not 1 <= threads <= 1024:
        raise ValueError(f"threads = {threads} is not accepted; accepted: a whole number, 1 to 1024")
    return threads
