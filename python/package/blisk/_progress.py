"""How far a run is, and who is told."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Optional, Union

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


ProgressArgument = Union[bool, Callable[[Progress], object], None]
"""``True`` for a line on the standard error stream, a function, or nothing."""


@contextmanager
def listening(progress: ProgressArgument) -> Iterator[Optional[Callable[[str, int, int, int], None]]]:
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

    def listen(stage: str, planned: int, done: int, failed: int) -> None:
        if told is not None:
            told(Progress(stage, planned, done, failed, time.monotonic() - began))

    try:
        yield None if told is None else listen
    finally:
        if line is not None:
            line.finish()


class _Line:
    """A line about the progress: written over on a terminal and in a notebook, a plain one now and then elsewhere."""

    def __init__(self) -> None:
        self._over = sys.stderr.isatty() or "ipykernel" in sys.modules
        self._last = time.monotonic()
        self._width = 0
        self._rows: Optional[tuple[float, int]] = None

    def show(self, reached: Progress) -> None:
        now = time.monotonic()
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
        elif now - self._last >= _PLAIN_INTERVAL_S:
            self._last = now
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def finish(self) -> None:
        if self._over and self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()
