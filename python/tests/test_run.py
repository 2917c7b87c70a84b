"""Runs: the same bytes as the command, continued and interrupted like it."""

import json
import os
import signal
import subprocess
import sys
import threading
import time

import pytest
from conftest import MANY, called

import blisk
from blisk._progress import _text

TABLES = ["responses", "scenarios", "percentiles", "distribution", "patterns"]


def content(folder):
    return {name: (folder / f"{name}.parquet").read_bytes() for name in TABLES}


def test_the_command_and_the_package_give_the_same_bytes(small, finished, program, tmp_path):
    (tmp_path / "study.toml").write_text(blisk.Study(**small).to_toml())
    ended = called("run", "study.toml", "--out", "out", command=program, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert content(tmp_path / "out") == content(finished.folder)
    assert ended.stdout == finished.summary_text.rstrip() + "\n"


def test_the_program_and_the_package_are_one_build(program):
    version = called("--version", command=program).stdout
    assert blisk.__build__ in version
    assert blisk.__version__ in version


def test_a_finished_study_is_grown(small, finished, tmp_path):
    few = blisk.Study(**small, **{"study.patterns": 30})
    reached = []
    blisk.run(few, out=tmp_path / "out", threads=1)
    blisk.run(blisk.Study(**small), out=tmp_path / "out", threads=1, progress=reached.append)
    assert content(tmp_path / "out") == content(finished.folder)
    rows = [progress for progress in reached if progress.planned]
    assert rows[0].done >= 30 * 4
    assert (rows[-1].planned, rows[-1].done, rows[-1].failed) == (320, 320, 0)
    assert all(before.done <= after.done for before, after in zip(rows, rows[1:]))
    assert rows[-1].stage == "tables"
    assert rows[-1].left_s == 0.0


def test_the_folder_is_named_by_the_study_unless_said(small, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = blisk.run(blisk.Study(**small, **{"study.patterns": 3}))
    assert str(results.folder) == os.path.join("results", "small")
    assert results.finished


def test_an_exception_of_the_listener_stops_the_run_and_the_same_call_continues(small, tmp_path):
    study = blisk.Study(**small, **{"study.patterns": MANY})

    def stop(progress):
        if progress.stage == "rows" and progress.done > 0:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        blisk.run(study, out=tmp_path, progress=stop)
    partial = blisk.Results(tmp_path)
    assert not partial.finished
    summary = partial.summary
    assert summary["unfinished"] and 0 < summary["rows_stored"] < summary["rows_planned"] == 4 * MANY
    with pytest.raises(blisk.BliskError) as unfinished:
        partial.responses
    assert unfinished.value.exit_code == 2
    began = []
    with pytest.raises(RuntimeError):
        blisk.run(study, out=tmp_path, progress=lambda progress: began.append(progress) or stop(progress))
    assert max(progress.done for progress in began) >= summary["rows_stored"]


INTERRUPTED = """
import json, sys, blisk
study = blisk.Study.from_toml(sys.argv[1])
def tell(progress):
    if progress.stage == "rows":
        print(progress.done, flush=True)
try:
    blisk.run(study, out=sys.argv[2], progress=tell)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    print(json.dumps(blisk.Results(sys.argv[2]).summary), flush=True)
    sys.exit(3)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_is_a_keyboard_interrupt_between_rows(small, tmp_path):
    study = tmp_path / "study.toml"
    study.write_text(blisk.Study(**small, **{"study.patterns": MANY}).to_toml())
    process = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED, str(study), str(tmp_path / "out")], stdout=subprocess.PIPE, text=True
    )
    line = process.stdout.readline()
    assert line.strip().isdigit()
    began = time.monotonic()
    process.send_signal(signal.SIGINT)
    output, _ = process.communicate(timeout=60)
    assert time.monotonic() - began < 10
    assert process.returncode == 3
    summary = json.loads(output.splitlines()[-1])
    assert output.splitlines()[-2] == "interrupted"
    assert summary["unfinished"] and summary["rows_stored"] < 4 * MANY
    # The folder is one that the command knows as unfinished.
    ended = called("status", tmp_path / "out", "--json")
    assert ended.returncode == 0, ended.stderr


def test_other_threads_go_on_meanwhile(small, tmp_path):
    counted, over = [0], threading.Event()

    def count():
        while not over.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    began = time.monotonic()
    blisk.run(blisk.Study(**small, **{"study.patterns": 300}), out=tmp_path, threads=1)
    took = time.monotonic() - began
    over.set()
    thread.join()
    assert counted[0] > 50 * took > 0


def test_another_study_is_refused_with_the_exit_code_of_the_command(small, finished):
    with pytest.raises(blisk.BliskError) as refused:
        blisk.run(blisk.Study(**small, **{"study.seed": 8}), out=finished.folder)
    assert refused.value.exit_code == 9
    assert "study.seed" in str(refused.value)
    assert not isinstance(refused.value, blisk.InputError)


def test_a_locked_folder_is_refused(small, tmp_path):
    study = blisk.Study(**small, **{"study.patterns": MANY})
    refusals = []

    def again(progress):
        if progress.stage == "rows":
            with pytest.raises(blisk.BliskError) as refused:
                blisk.run(study, out=tmp_path)
            refusals.append(refused.value.exit_code)
            raise RuntimeError("seen")

    with pytest.raises(RuntimeError, match="seen"):
        blisk.run(study, out=tmp_path, progress=again)
    assert refusals == [10]


@pytest.mark.parametrize("threads", [0, -1, 2000])
def test_threads_are_those_that_the_command_accepts(small, tmp_path, threads):
    with pytest.raises(ValueError, match="1 to 1024"):
        blisk.run(blisk.Study(**small), out=tmp_path, threads=threads)


def test_the_line_of_progress_says_the_step_before_the_rows_and_no_time_that_is_not_known():
    step = "tuned wheel: load 2 of 5 (10 N)"
    assert _text(blisk.Progress("tuned", 0, 0, 0, 1.0, step)) == step
    assert _text(blisk.Progress("tuned", 0, 0, 0, 1.0)) == "solving the tuned wheel"
    assert "left" not in _text(blisk.Progress("rows", 10, 1, 0, 1.0))
    assert _text(blisk.Progress("rows", 10, 5, 0, 1.0, "", 600.0)).endswith("5 of 10 rows, 0 failed, about 10 min left")


def test_progress_on_a_stream_is_a_line(small, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    blisk.run(blisk.Study(**small), out=tmp_path, progress=True)
    shown = capsys.readouterr().err
    assert shown.startswith("\r") and shown.endswith("\r") and "\n" not in shown
