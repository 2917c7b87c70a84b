"""Running a study, with progress."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Union

from . import _native
from ._results import Results
from ._study import Study

_STAGES = {
    "load_model": "loading the model",
    "reduce": "reducing the model",
    "tuned": "solving the tuned wheel",
    "surrogates": "finding the surrogates",
    "rows": "solving the patterns",
    "tables": "writing the tables",
}

_PLAIN_INTERVAL_S = 30.0
"""Time between lines where no terminal shows a line that is written over."""


@dataclass(frozen=True)
class Progress:
    """How far a run is."""

    stage: str
    """``load_model``, ``reduce``, ``tuned``, ``surrogates``, ``rows``, ``tables``."""
    planned: int
    """Rows of the study; a row is one wheel in one scenario. 0 before the first row."""
    done: int
    """Rows that are stored or solved."""
    failed: int
    """Rows of this run without a result."""
    elapsed_s: float
    """Time since the run began, s."""


def run(
    study: Study,
    out: Union[str, os.PathLike[str], None] = None,
    threads: Optional[int] = None,
    progress: Union[bool, Callable[[Progress], object], None] = None,
    *,
    solve_anew: bool = False,
) -> Results:
    """Solves a study, or continues one: rows that are stored in the folder are not solved again.

    ``out``: the results folder; ``results/<name>`` unless given.
    ``threads``: number of threads, 1 to 1024; those of the scheduler's allocation unless given, else all cores.
    Results do not depend on it.
    ``progress``: ``True`` for a line on the standard error stream, or a function that is called with a ``Progress``, at
    most 20 times a second, on the thread that called ``run``.
    ``solve_anew``: rows of another build of the program are set aside and everything is solved anew; without it they
    are a ``BliskError``.

    Other threads of Python go on meanwhile. ``KeyboardInterrupt``, or an exception of ``progress``, stops the run
    between rows; what is solved is stored, and the same call continues. A second one is raised at once.
    """
    if threads is not None and not 1 <= threads <= 1024:
        raise ValueError(f"threads = {threads} is not accepted; accepted: a whole number, 1 to 1024")
    folder = Path("results") / study.name if out is None else Path(out)
    shown = _Line() if progress is True else None
    called = shown.show if shown is not None else (progress or None)
    began = time.monotonic()

    def listen(stage: str, planned: int, done: int, failed: int) -> None:
        if callable(called):
            called(Progress(stage, planned, done, failed, time.monotonic() - began))

    try:
        _native.run(study._checked, folder, threads, solve_anew, listen if called else None)
    finally:
        if shown is not None:
            shown.finish()
    return Results(folder)


class _Line:
    """A line about the progress: written over on a terminal and in a notebook, a plain one now and then elsewhere."""

    def __init__(self) -> None:
        self._over = sys.stderr.isatty() or "ipykernel" in sys.modules
        self._last = time.monotonic()
        self._width = 0
        self._rows: Optional[tuple[float, int]] = None

    def show(self, reached: Progress) -> None:
        now = time.monotonic()
        if not self._over and now - self._last < _PLAIN_INTERVAL_S:
            return
        self._last = now
        text = _STAGES[reached.stage]
        if reached.stage == "rows" and reached.planned:
            text += f": {reached.done} of {reached.planned} rows, {reached.failed} failed"
            # The rate is that of this run; rows that were there took no time.
            since, before = self._rows = self._rows or (now, reached.done)
            if reached.done > before and now > since:
                left = (reached.planned - reached.done) * (now - since) / (reached.done - before)
                text += f", about {left:.0f} s left"
        if self._over:
            sys.stderr.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def finish(self) -> None:
        if self._over and self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()
