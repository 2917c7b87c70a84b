"""How far a run is, and who is told."""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Optional, Union

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
_CELL_INTERVAL_S = 0.2
"""Time between two messages to the cell of a notebook."""
_BAR = 20
"""Characters of the bar: with the rows and the time the line fits into 80 columns."""


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
    step: str = ""
    """What a stage before the rows is at: ``tuned wheel: load 2 of 5 (10 N)``. Empty where nothing is said."""
    left_s: Optional[float] = None
    """Time that the rows still take, s, by the rows solved so far; none before enough of them are solved."""


ProgressArgument = Union[bool, Callable[[Progress], object], None]
"""``True`` for a line with a bar, a function, or nothing."""


@contextmanager
def listening(
    progress: ProgressArgument,
) -> Iterator[Optional[Callable[[str, str, int, int, int, Optional[float]], None]]]:
    """The function that the native part tells how far it is, or none."""
    line = _Line() if progress is True else None
    told: Optional[Callable[[Progress], object]] = None
    if line is not None:
        told = line.show
    elif callable(progress):
        told = progress
    elif progress not in (None, False):
        raise TypeError(f"progress = {progress!r} is not accepted; accepted: True, False, None or a function")
    began = time.monotonic()

    def listen(stage: str, step: str, planned: int, done: int, failed: int, left_s: Optional[float]) -> None:
        if told is not None:
            told(Progress(stage, planned, done, failed, time.monotonic() - began, step, left_s))

    try:
        yield None if told is None else listen
    finally:
        if line is not None:
            line.finish()


class _Line:
    """A line with a bar: on a terminal written over, in a notebook an output of its cell, elsewhere one now and then."""

    def __init__(self) -> None:
        self._cell = cell_of_notebook()
        self._over = sys.stderr.isatty()
        self._last = time.monotonic()
        self._width = 0
        self._reached: Optional[Progress] = None

    def show(self, reached: Progress) -> None:
        now = time.monotonic()
        self._reached = reached
        text = _text(reached)
        if self._cell is not None:
            self._cell.show(text, now)
            return
        if self._over:
            sys.stderr.write("\r" + text.ljust(self._width))
            self._width = len(text)
        elif now - self._last >= _PLAIN_INTERVAL_S:
            self._last = now
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def finish(self) -> None:
        reached = self._reached
        if self._cell is not None and reached is not None:
            # What stays in the notebook.
            self._cell.write(f"{_bar(reached)}, {_time(reached.elapsed_s)}" if reached.planned else "")
        elif self._over and self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()


class Cell:
    """The output of a notebook's cell that is written over."""

    def __init__(self) -> None:
        self._display = importlib.import_module("IPython.display").display
        self._handle: Any = None
        self._shown = 0.0

    def show(self, text: str, now: float) -> None:
        """Writes the text, unless the last one was written just now."""
        if self._handle is None or now - self._shown >= _CELL_INTERVAL_S:
            self._shown = now
            self.write(text)

    def write(self, text: str) -> None:
        """Writes the text in the place of the last one."""
        content = {"text/plain": text}
        if self._handle is None:
            self._handle = self._display(content, raw=True, display_id=True)
        else:
            self._handle.update(content, raw=True)


def cell_of_notebook() -> Optional[Cell]:
    """The output of the cell that a kernel of Jupyter carries out; none without such a kernel."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return None if getattr(shell, "kernel", None) is None else Cell()


def _text(reached: Progress) -> str:
    if reached.stage != "rows" or not reached.planned:
        return reached.step or _STAGES[reached.stage]
    text = _bar(reached)
    return text if reached.left_s is None else f"{text}, about {_time(reached.left_s)} left"


def _bar(reached: Progress) -> str:
    """Rows done of all, as a bar and in words."""
    filled = "#" * (_BAR * reached.done // reached.planned)
    return f"[{filled:<{_BAR}}] {reached.done} of {reached.planned} rows, {reached.failed} failed"


def _time(seconds: float) -> str:
    if seconds < 120.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 7200.0 else f"{seconds / 3600.0:.0f} h"
