"""What the tests share: a small study, its results, and the command."""

import ast
import copy
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import blisk

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "python" / "package" / "blisk" / "examples"


def study_of(script):
    """The keywords of the first study that a script makes, without carrying it out."""
    calls = [node for node in ast.walk(ast.parse(script.read_text())) if isinstance(node, ast.Call)]
    made = next(call for call in calls if ast.unparse(call.func) == "blisk.Study")
    return {own.arg: ast.literal_eval(own.value) for own in made.keywords}


# The study of the example with less to solve.
SMALL = {
    **study_of(EXAMPLES / "quickstart.py"),
    "study": {"name": "small", "seed": 7, "patterns": 80},
    "sweep": {"normal_load_n": ["slide", 50, 150, "stuck"], "standard_deviation": [0.03]},
    "solver": {"harmonics": [1, 3]},
}

# Rows enough that a run can be stopped while it solves them.
MANY = 20_000


def installed() -> Path:
    """The command that the package installs."""
    return Path(sys.executable).with_name("blisk")


def called(*arguments, command=None, cwd=None):
    """A finished command with its output as text."""
    line = [str(command or installed()), *map(str, arguments)]
    return subprocess.run(line, cwd=cwd, capture_output=True, text=True, check=False)


def is_that_of(answer, *line, code=0):
    """The answer has the numbers and the words of the command."""
    ended = called(*line, "--json")
    assert ended.returncode == code, ended.stderr
    assert answer == json.loads(ended.stdout)
    assert str(answer).rstrip() + "\n" == called(*line).stdout


@pytest.fixture
def small():
    return copy.deepcopy(SMALL)


@pytest.fixture
def study(small, tmp_path, monkeypatch):
    """The small study, and the same one in a file in the working directory."""
    monkeypatch.chdir(tmp_path)
    study = blisk.Study(**small)
    (tmp_path / "study.toml").write_text(study.to_toml())
    return study


@pytest.fixture(scope="session")
def program():
    """The program that cargo has built, where BLISK names it; else the command of the package."""
    return Path(os.environ.get("BLISK", installed()))


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """Results of the small study, which no test changes."""
    return blisk.run(blisk.Study(**SMALL), out=tmp_path_factory.mktemp("finished") / "small", threads=2)
