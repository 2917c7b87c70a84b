"""The command that the package installs."""

import inspect
import os
import re
import signal
import subprocess
import time

import pytest
from conftest import MANY, ROOT, called, installed

import blisk


def test_the_command_ends_with_the_exit_codes_of_the_program(tmp_path):
    assert called("--version").returncode == 0
    assert called("run").returncode == 2
    (tmp_path / "study.toml").write_text("schema = 1\n")
    ended = called("check", tmp_path / "study.toml")
    assert ended.returncode == 3
    assert ended.stdout == "" and ended.stderr.startswith("error: ")
    assert called("check", tmp_path / "nothing.toml").returncode == 7


def test_the_command_has_every_command_of_the_program(program):
    assert called("--help").stdout == called("--help", command=program).stdout


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_ends_the_command_as_it_ends_the_program(small, tmp_path, number, code):
    study = tmp_path / "study.toml"
    study.write_text(blisk.Study(**small, **{"study.patterns": MANY}).to_toml())
    line = [str(installed()), "run", str(study), "--out", str(tmp_path / "out")]
    process = subprocess.Popen(line, stderr=subprocess.PIPE, text=True)
    while not (tmp_path / "out" / "parts" / "header.json").exists():
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(number)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == code, errors
    assert "Traceback" not in errors


# Where an option has another name in Python: the parameter.
RENAMED = {
    ("plot", "study"): "study_file",
    ("report", "no_curves"): "curves",
    ("report", "out"): "path",
    ("report", "study"): "study_file",
    ("merge", "study"): "study_file",
    ("response", "frequencies"): "frequencies_hz",
    ("schema", "import"): "of",
    ("verify", "dense_sweep"): "question",
    ("verify", "integrity"): "question",
    ("verify", "pattern"): "row",
    ("verify", "scenario"): "row",
    ("verify", "study"): "study_file",
    ("verify", "time_domain"): "question",
}
# The functions that have not the name of their command.
FUNCTIONS = {
    "import": blisk.Sector.from_import_file,
    "plot": blisk.Results.figure,
    "report": blisk.Results.report,
    "stats": blisk.Results.__init__,
}
# What is asked for by the return value, or by another function.
ANSWERED = {("plot", "out"), ("response", "out"), ("stats", "tails"), ("stats", "json")}


def test_the_page_names_every_command_and_option_without_a_function():
    section = (ROOT / "docs" / "python.md").read_text(encoding="utf-8").partition("## What is not there\n")[2]
    named = set(re.findall(r"`([a-z]+(?: --[a-z-]+)?)`", "".join(re.findall(r"^\|([^|]*)\|", section, flags=re.MULTILINE))))
    commands = re.findall(r"^  ([a-z]+) {2,}\S", called("--help").stdout, flags=re.MULTILINE)
    assert len(commands) >= 23
    missing = set()
    for command in commands:
        function = FUNCTIONS.get(command, getattr(blisk, command, None))
        if function is None:
            missing.add(command)
            continue
        parameters = inspect.signature(function).parameters
        options = re.findall(r"^ +(?:-\w, )?--([a-z][a-z-]*)", called(command, "--help").stdout, flags=re.MULTILINE)
        for option in set(options) - {"help"}:
            name = option.replace("-", "_")
            # An answer, a table, results and a list of keys have what JSON has.
            by_json = name == "json" and command != "report"
            if RENAMED.get((command, name), name) not in parameters and (command, name) not in ANSWERED and not by_json:
                missing.add(f"{command} --{option}")
    assert missing == named
