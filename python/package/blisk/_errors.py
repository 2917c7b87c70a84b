"""Exceptions of the package."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Optional


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong with a study, its model or its patterns."""

    message: str
    """What is wrong and what is accepted, in words."""
    problem: str
    """``unknown_key``, ``missing``, ``not_accepted``, ``conflict``, ``syntax``; ``input``: not about a key."""
    file: Optional[str] = None
    """The study file; ``<study>`` for a study that has none."""
    line: Optional[int] = None
    """Line of the file or of ``Study.to_toml()``, from 1."""
    key: Optional[str] = None
    """Full key, like ``solver.peak_tolerance``."""
    value: Optional[str] = None
    """The value as it stands in TOML."""
    accepted: Optional[str] = None
    """What is accepted there."""
    suggestion: Optional[str] = None
    """The nearest name there is."""

    def __str__(self) -> str:
        return self.message


class BliskError(Exception):
    """Something that ``blisk`` was asked for and cannot do."""

    exit_code: int
    """The exit code that the command would end with."""

    def __init__(self, message: str, exit_code: int = 1) -> None:
        super().__init__(message)
        self.exit_code = exit_code

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self), (str(self), self.exit_code))


class InputError(BliskError, ValueError):
    """A study, a model or patterns that are not accepted."""

    findings: list[Finding]
    """Everything that was found, in the order of the file."""

    def __init__(self, message: str, exit_code: int = 3, findings: Optional[list[Finding]] = None) -> None:
        super().__init__(message, exit_code)
        self.findings = findings or []

    def __reduce__(self) -> tuple[object, ...]:
        return (type(self), (str(self), self.exit_code, self.findings))


def blisk_error(message: str, exit_code: int) -> BliskError:
    """The exception of a failed call; called by the native part."""
    return BliskError(message, exit_code)


def input_error(message: str, exit_code: int, findings: str) -> InputError:
    """The exception of a refused input with its findings as JSON; called by the native part."""
    return InputError(message, exit_code, [Finding(**finding) for finding in json.loads(findings)])
