"""Study files, scripts for Slurm, and what a study file accepts: what the commands write and print."""

import json
import subprocess
import sys

import pytest
from conftest import called, installed, is_that_of

import blisk


def files_in(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("example", ["template", "wheel", "lumped24"])
def test_a_study_file_is_that_of_the_command(tmp_path, example):
    (tmp_path / "own").mkdir()
    (tmp_path / "other").mkdir()
    text = blisk.init(tmp_path / "own" / "study.toml", example)
    ended = called("init", "--example", example, cwd=tmp_path / "other")
    assert ended.returncode == 0, ended.stderr
    written = files_in(tmp_path / "own")
    assert written == files_in(tmp_path / "other") != {}
    assert text.encode() == (tmp_path / "own" / "study.toml").read_bytes()
    assert text == blisk.init(example=example)
    blisk.Study.from_toml(tmp_path / "own" / "study.toml").check()
    with pytest.raises(blisk.BliskError, match="exists already and is not overwritten") as refused:
        blisk.init(tmp_path / "own" / "study.toml", example)
    again = called("init", "--out", tmp_path / "own" / "study.toml", "--example", example)
    assert (refused.value.exit_code, f"error: {refused.value}\n") == (again.returncode, again.stderr)
    assert files_in(tmp_path / "own") == written


def test_an_example_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ValueError, match="accepted: template, "):
        blisk.init(tmp_path / "study.toml", "nothing")
    assert files_in(tmp_path) == {}


@pytest.mark.parametrize("words", ["solver.peak_tolerance", "solver", "friction", "import", ""])
def test_keys_are_explained_as_by_the_command(words):
    keys = blisk.explain(words)
    is_that_of(keys, "explain", *words.split())
    assert all(set(key) == {"key", "accepted", "default", "required", "meaning"} for key in keys)


def test_a_key_that_is_not_there_is_told_its_neighbour():
    with pytest.raises(ValueError, match="did you mean") as refused:
        blisk.explain("solver.peak_tolerence")
    ended = called("explain", "solver.peak_tolerence")
    assert (ended.returncode, ended.stderr) == (2, f"error: {refused.value}\n")


@pytest.mark.parametrize(("of", "flags"), [("study", []), ("import", ["--import"])])
def test_a_schema_is_that_of_the_command(of, flags):
    assert blisk.schema(of) == json.loads(called("schema", *flags).stdout)
    with pytest.raises(ValueError, match="accepted: study, import"):
        blisk.schema("results")


def test_a_check_is_that_of_the_command(study):
    answer = blisk.check(blisk.Study.from_toml("study.toml"))
    is_that_of(answer, "check", "study.toml")
    assert (answer["study_digest"], answer["rows"]) == (study.digest, 320)
    assert answer["study"] == study.resolved()


def test_a_study_with_loads_of_rotation_is_checked_as_by_the_command(study):
    load = {"from": "rotation", "speed_rpm": 3000, "ring_radius_m": 0.2}
    with open("turning.toml", "w") as file:
        file.write(study.replace({"contact.normal_load": load}).to_toml())
    answer = blisk.check(blisk.Study.from_toml("turning.toml"))
    assert answer["rotation"] is not None and "3000 rpm" in str(answer)
    is_that_of(answer, "check", "turning.toml")


def test_a_script_for_slurm_is_that_of_the_command(study):
    script = blisk.slurm("study.toml", 4, time="12:00:00", threads=2, script="own.sh")
    ended = called("slurm", "study.toml", "--tasks", 4, "--time", "12:00:00", "--threads", 2, "--script", "other.sh")
    assert ended.returncode == 0, ended.stderr
    text = script.read_text()
    with open("other.sh") as other:
        assert text == other.read()
    # Nodes carry out the command of the package, not the Python that it runs in.
    assert f"\nblisk='{installed()}'\n" in text and sys.executable not in text.splitlines()
    subprocess.run(["bash", "-n", script], check=True)
    assert blisk.slurm("study.toml", 4).name == "small-slurm.sh"
    with open("small-slurm.sh") as named:
        assert "#SBATCH --time" not in named.read()
    elsewhere = blisk.slurm("study.toml", 4, out="far", program="/opt/blisk", script="far.sh").read_text()
    assert "\nblisk='/opt/blisk'\n" in elsewhere and "/far'\n" in elsewhere


def test_a_script_for_slurm_that_is_not_accepted_is_refused(study):
    for more, words in (({"tasks": 0}, "1 to 100000"), ({"tasks": 2, "time": "soon"}, "HOURS:MINUTES:SECONDS")):
        with pytest.raises(ValueError, match=words):
            blisk.slurm("study.toml", **more)
    with pytest.raises(blisk.BliskError) as refused:
        blisk.slurm("study.toml", 81)
    ended = called("slurm", "study.toml", "--tasks", 81)
    assert (refused.value.exit_code, f"error: {refused.value}\n") == (ended.returncode, ended.stderr)
    blisk.slurm("study.toml", 2)
    with pytest.raises(blisk.BliskError, match="exists already"):
        blisk.slurm("study.toml", 2)
    with open("study.toml", "a") as file:
        file.write("\n[nothing]\n")
    with pytest.raises(blisk.InputError) as invalid:
        blisk.slurm("study.toml", 2, script="new.sh")
    assert invalid.value.findings[0].problem == "unknown_key"
