"""Studies: from a file, a text or nested dictionaries."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _native
from ._toml import text_of

if TYPE_CHECKING:
    from ._wheel import Wheel

_FILE = "<study>"
"""Stands for the study file of a study that has none."""


class Study:
    """What is solved: a model, its mistuning, loads and settings, as a study file has them.

    The tables of the study file are the keywords, nested dictionaries their content; ``schema = 1`` is understood:

        blisk.Study(study={"name": "ring", "seed": 7, "patterns": 400}, model={"source": "parametric"}, ...)

    Keys may be dotted as well, and a value of ``None`` is a key that is left out. Everything is checked as the command
    checks a study file, and ``InputError`` says what is wrong in the same words. A study cannot be changed; ``replace``
    makes another one.

    ``base``: the folder in which files that the study names are sought; the working directory unless given.
    ``tables``: the tables of the study file by name, a dictionary each. ``blisk.explain()`` has every key with its unit.
    """

    __slots__ = ("_checked", "_path", "_text")

    _checked: _native.CheckedStudy
    _path: str
    _text: str

    def __init__(self, *, base: Union[str, os.PathLike[str], None] = None, **tables: Any) -> None:
        own: dict[str, Any] = {"schema": 1}
        _put_all(own, tables)
        self._read(_path_in(base), text_of(own))

    @classmethod
    def from_toml(cls, source: Union[str, os.PathLike[str]], base: Union[str, os.PathLike[str], None] = None) -> Study:
        """The study in a file, or in a text.

        ``source``: a ``str`` with a line break or ``=`` is the text of a study file, any other one the path of a file.
        ``base``: the folder in which files that the study names are sought; that of the file, or for a text the working
        directory, unless given.

        Returns the study; ``InputError`` says what of it is not accepted.
        """
        is_text = isinstance(source, str) and ("\n" in source or "=" in source)
        if is_text:
            return cls._of(_path_in(base), str(source))
        path = Path(source)
        text = path.read_text(encoding="utf-8")
        return cls._of(str(path) if base is None else str(Path(base) / path.name), text)

    @classmethod
    def _of(cls, path: str, text: str) -> Study:
        study = cls.__new__(cls)
        study._read(path, text)
        return study

    def _read(self, path: str, text: str) -> None:
        self._path, self._text = path, text
        self._checked = _native.CheckedStudy(path, text)

    def replace(self, changes: Optional[Mapping[str, Any]] = None, /, **tables: Any) -> Study:
        """The same study with other values.

        ``changes``, ``tables``: values by their keys, dotted or nested. What is not named stays as it is; ``None`` takes
        a key out:

            study.replace({"study.patterns": 4000, "solver.harmonics": None})
            study.replace(study={"patterns": 4000})

        Returns the other study.
        """
        own = self.to_dict()
        _put_all(own, changes or {})
        _put_all(own, tables)
        return self._of(self._path, text_of(own))

    def wheel(self, deviations: Iterable[float]) -> Wheel:
        """One wheel with known blades, for instance a measured one, under the loads and settings of this study.

        ``deviations``: relative deviation of each blade's stiffness, shape (N,) with N sectors, unit 1: 0.02 is 2 %. A
        deviation of the blade's frequency is about half of it.

        Returns the wheel.
        """
        from ._wheel import Wheel

        return Wheel(self, deviations)

    def check(self) -> list[str]:
        """Looks at model and patterns as well, and solves nothing.

        Returns remarks on what is unusual, a text each. Raises ``InputError`` if the model or the patterns are not accepted.
        """
        remarks: list[str] = json.loads(self._checked.echo())["remarks"]
        return remarks

    def describe(self) -> str:
        """Returns the study in words, as ``blisk check`` prints it."""
        text: str = json.loads(self._checked.echo())["text"]
        return text

    def to_toml(self) -> str:
        """Returns the text of the study file: as it was read, or as it would be written."""
        return self._text

    def to_dict(self) -> dict[str, Any]:
        """Returns the study as nested dictionaries, with the keys that it states."""
        tables: dict[str, Any] = json.loads(_native.tables_of(self._text))
        return tables

    def resolved(self) -> dict[str, Any]:
        """Returns the study as nested dictionaries with every default filled in."""
        tables: dict[str, Any] = json.loads(self._checked.resolved())
        return tables

    @property
    def name(self) -> str:
        """Name of the study; its results are in ``results/<name>`` unless ``run`` is told otherwise."""
        return self._checked.name

    @property
    def patterns(self) -> int:
        """Number of patterns, each a wheel; at most so many with ``[stop]``."""
        return self._checked.patterns

    @property
    def scenarios(self) -> int:
        """Number of scenarios: load cases, engine orders, standard deviations and normal loads that are combined."""
        return self._checked.scenarios

    @property
    def digest(self) -> str:
        """Digest of the study and of the files that it names, hexadecimal."""
        return self._checked.digest()

    def __repr__(self) -> str:
        return f"<blisk.Study {self.name}: {self.patterns} patterns, {self.scenarios} scenarios>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Study):
            return NotImplemented
        return self._path == other._path and self._text == other._text

    def __hash__(self) -> int:
        return hash((self._path, self._text))

    def __reduce__(self) -> tuple[Any, ...]:
        return (Study._of, (self._path, self._text))


def _path_in(base: Union[str, os.PathLike[str], None]) -> str:
    """Path of a study file that is not there in the folder ``base``."""
    return _FILE if base is None else str(Path(base) / _FILE)


def _put_all(table: dict[str, Any], changes: Mapping[str, Any]) -> None:
    """Puts values under keys of a table, dotted or not."""
    for key, value in changes.items():
        if not isinstance(key, str):
            raise TypeError(f"a key of a study is a text, and {key!r} is none")
        _put(table, key.split("."), value)


def _put(table: dict[str, Any], path: list[str], value: Any) -> None:
    """Puts ``value`` under a key of a table; a dictionary into the table that is there."""
    key, rest = path[0], path[1:]
    if not rest and not isinstance(value, Mapping):
        if value is None:
            table.pop(key, None)
        else:
            table[key] = copy.deepcopy(value)
        return
    if not isinstance(table.get(key), dict):
        table[key] = {}
    if rest:
        _put(table[key], rest, value)
    else:
        _put_all(table[key], value)
