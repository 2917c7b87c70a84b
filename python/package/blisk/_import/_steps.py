"""Which step of an import has begun, and after which time."""

from __future__ import annotations

import sys
import time

from .._progress import cell_of_notebook


class Steps:
    """A line for each step on the standard error stream; in a notebook an output of the cell; nothing unless wanted."""

    def __init__(self, wanted: bool) -> None:
        self._cell = cell_of_notebook() if wanted else None
        self._on_stream = wanted and self._cell is None
        self._began = time.monotonic()
        self._lines: list[str] = []

    def begins(self, step: str) -> None:
        """Says the step, and the time since the import began."""
        line = f"{time.monotonic() - self._began:5.0f} s  {step}"
        if self._cell is not None:
            self._lines.append(line)
            self._cell.write("\n".join(self._lines))
        elif self._on_stream:
            print(line, file=sys.stderr, flush=True)
