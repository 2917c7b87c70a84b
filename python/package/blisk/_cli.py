"""The command ``blisk`` of the package."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> None:
    """Carries out the command line of this process and ends it with the exit code of the command."""
    # The command watches for signals itself; Python's handler would raise KeyboardInterrupt after it.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.main(sys.argv[0], ["blisk", *sys.argv[1:]]))
