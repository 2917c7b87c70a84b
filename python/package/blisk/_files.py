"""Files to begin with: study files and scripts for Slurm, and what a study file accepts."""

from __future__ import annotations

import json
import os
import shutil
import sysconfig
from pathlib import Path
from typing import Any, Optional, Union

from . import _native
from ._run import checked_threads
from ._study import Study


class Keys(list[dict[str, Any]]):
    """Keys of study files, a dictionary each, as ``blisk explain --json`` gives them; ``str`` of it is in words.

    ``key``: full key. ``accepted``: what may stand there. ``default``: its default, or nothing. ``required``: whether a
    study has to have it. ``meaning``: what it is, with its unit.
    """

    text: str
    """Keys and terms in words, as the command prints them."""

    def __init__(self, keys: list[dict[str, Any]], text: str) -> None:
        super().__init__(keys)
        self.text = text

    def __str__(self) -> str:
        return self.text


def init(out: Union[str, os.PathLike[str], None] = None, example: str = "template") -> str:
    """A commented study file to begin with.

    ``out``: a file that the text is written to as well, and beside it the files that the study reads. None of them is
    written over: there is a ``BliskError`` instead.
    ``example``: one of the studies that come with the program; a ``ValueError`` says which there are.

    Returns the text of the file, for ``Study.from_toml``.
    """
    texts = dict(_native.examples())
    if example not in texts:
        raise ValueError(f"example = {example!r} is not accepted; accepted: {', '.join(texts)}")
    if out is not None:
        _native.init(example, Path(out))
    return texts[example]


def explain(words: str = "") -> Keys:
    """What keys of study files accept and mean.

    ``words``: a key, like ``solver.peak_tolerance``, a table, like ``solver``, or words that are sought in names and
    meanings; ``import`` for the keys of import files. All keys of study files unless given.

    Returns a list with a dictionary per key: ``key``, ``accepted``, ``default``, ``required``, ``meaning``. Raises ``ValueError`` with the nearest names where there is no such key.
    """
    keys, text = _native.explain(words)
    return Keys(json.loads(keys), text)


def schema(of: str = "study") -> dict[str, Any]:
    """The JSON schema of study files, or of import files.

    ``of``: ``study``, or ``import`` for import files.

    Returns the schema as nested dictionaries.
    """
    if of not in ("study", "import"):
        raise ValueError(f"of = {of!r} is not accepted; accepted: study, import")
    found: dict[str, Any] = json.loads(_native.schema(of == "import"))
    return found


def slurm(
    study_file: Union[str, os.PathLike[str]],
    tasks: int,
    *,
    out: Union[str, os.PathLike[str], None] = None,
    threads: int = 1,
    time: Optional[str] = None,
    script: Union[str, os.PathLike[str], None] = None,
    program: Union[str, os.PathLike[str], None] = None,
) -> Path:
    """Writes a script that submits a study to Slurm, as an array of shards and a merge after it.

    ``study_file``: the study, which the tasks read.
    ``tasks``: number of shards, 1 to 100000.
    ``out``: the results folder, on a file system that all nodes see; ``results/<name>`` unless given.
    ``threads``: threads of each shard, 1 to 1024.
    ``time``: time limit of each shard, as ``sbatch --time`` takes it, like ``12:00:00``; that of Slurm unless given.
    ``script``: the script, which must not exist yet; ``<name>-slurm.sh`` unless given.
    ``program``: the command ``blisk`` on the nodes; that of this package unless given.

    Returns the path of the script.
    """
    if not 1 <= tasks <= 100_000:
        raise ValueError(f"tasks = {tasks} is not accepted; accepted: a whole number, 1 to 100000")
    checked_threads(threads)
    # The findings of a study that is not accepted are those of an `InputError`.
    Study.from_toml(Path(study_file))
    folder = None if out is None else Path(out)
    path = None if script is None else Path(script)
    command = _command() if program is None else Path(program)
    return Path(_native.slurm(Path(study_file), tasks, folder, threads, time, path, command))


def _command() -> Path:
    """The command ``blisk`` that the package installs; else the one that is found."""
    found = shutil.which("blisk", path=sysconfig.get_path("scripts")) or shutil.which("blisk")
    if found is None:
        raise ValueError("program is needed: the command blisk is neither beside this Python nor on PATH")
    return Path(found)
