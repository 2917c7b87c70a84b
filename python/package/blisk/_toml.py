"""Nested dictionaries as the text of a study file."""

from __future__ import annotations

import json
import operator
from collections.abc import Mapping
from functools import cache
from typing import Any

from . import _native


@cache
def _places() -> dict[str, int]:
    """Place of each key in the order of the documentation of study files."""
    return {key: place for place, key in enumerate(_native.key_names())}


def text_of(tables: Mapping[str, Any]) -> str:
    """The text of a study file with these tables; keys with ``None`` are left out.

    Keys are in the order of the documentation, whatever order they come in; unknown ones are last.
    """
    lines: list[str] = []
    _write(lines, (), _plain(tables, "the study"))
    return "\n".join(lines).strip("\n") + "\n"


def _plain(value: Any, place: str) -> Any:
    """``value`` of the types that TOML has; arrays and numbers of numpy are taken as lists and numbers."""
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise TypeError(f"{place} has the key {key!r}, which is no text")
        return {key: _plain(own, key) for key, own in value.items() if own is not None}
    for kind in (bool, int, float, str):
        # Those of numpy are subclasses that write themselves in another way.
        if isinstance(value, kind):
            return kind(value)
    if hasattr(value, "tolist"):
        return _plain(value.tolist(), place)
    if isinstance(value, (list, tuple, range)):
        return [_plain(own, place) for own in value]
    if hasattr(value, "__index__"):
        return operator.index(value)
    if hasattr(value, "__fspath__"):
        return str(value)
    raise TypeError(f"{place} = {value!r} is of a type that a study file cannot hold: {type(value).__name__}")


def _write(lines: list[str], path: tuple[str, ...], table: dict[str, Any]) -> None:
    """Writes the table ``path``: first its own values, then the tables in it."""
    places = _places()
    ordered = sorted(table, key=lambda key: places.get(".".join((*path, key)), len(places)))
    below: list[str] = []
    for key in ordered:
        value = table[key]
        if isinstance(value, dict) or _is_tables(value):
            below.append(key)
        else:
            lines.append(f"{_key(key)} = {_inline(value)}")
    for key in below:
        value, own = table[key], (*path, key)
        name = ".".join(map(_key, own))
        for inner in value if isinstance(value, list) else [value]:
            lines.extend(["", f"[[{name}]]" if isinstance(value, list) else f"[{name}]"])
            _write(lines, own, inner)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(own, dict) for own in value)


def _inline(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, list):
        return "[" + ", ".join(_inline(own) for own in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_inline(own)}" for key, own in value.items()) + " }"
    # The shortest text that is this number; that of a number that is not finite is TOML as well.
    return repr(value)


def _string(text: str) -> str:
    # What JSON escapes in a text, and the character that only TOML wants escaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _key(key: str) -> str:
    bare = key.isascii() and key.replace("-", "").replace("_", "").isalnum()
    return key if bare else _string(key)
