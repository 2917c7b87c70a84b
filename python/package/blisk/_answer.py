"""What a question is answered with."""

from __future__ import annotations

import json
from typing import Any


class Answer(dict[str, Any]):
    """An answer as nested dictionaries, with the keys of ``--json`` of the command; ``str`` of it is in words."""

    text: str
    """The answer in words, as the command prints it."""

    def __init__(self, values: dict[str, Any], text: str) -> None:
        super().__init__(values)
        self.text = text

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(self.text)}</pre>"


def answer_of(answer: tuple[str, str]) -> Answer:
    """The answer of the native part: JSON and words."""
    values, text = answer
    return Answer(json.loads(values), text)
