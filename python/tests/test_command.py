"""The command that the package installs."""

import os
import signal
import subprocess
import time

import pytest
from conftest import MANY, called, installed

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
