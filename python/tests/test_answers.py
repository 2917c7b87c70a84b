"""Comparisons, searches, plans and response curves: what the commands give."""

import json

import pyarrow
import pyarrow.parquet
import pytest
from conftest import called

import blisk


def test_a_comparison_is_that_of_the_command(finished):
    answer = blisk.compare(finished, percentile=90)
    ended = called("compare", finished.folder, "--percentile", "90", "--json")
    assert ended.returncode == 0, ended.stderr
    assert answer == json.loads(ended.stdout)
    assert str(answer).rstrip() + "\n" == called("compare", finished.folder, "--percentile", "90").stdout
    with pytest.raises(ValueError, match="above 0 and below 100"):
        blisk.compare(finished, percentile=100)
    with pytest.raises(TypeError):
        blisk.compare()


def test_a_search_is_that_of_the_command(small, tmp_path):
    study = blisk.Study(**small)
    (tmp_path / "study.toml").write_text(study.to_toml())
    stages = []
    folders = {"out": tmp_path / "own", "solved": tmp_path / "none"}
    answer = blisk.optimum(study, (30, 300), resolution=0.5, progress=stages.append, **folders)
    line = ["optimum", "study.toml", "--between", "30:300", "--resolution", "0.5", "--out", "other", "--json"]
    ended = called(*line, "--solved", "none", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert answer == json.loads(ended.stdout)
    assert {"rows", "tables"} <= {progress.stage for progress in stages}
    with pytest.raises(ValueError, match="the lower first"):
        blisk.optimum(study, (300, 30))
    with pytest.raises(blisk.BliskError):
        blisk.optimum(study, (30, 300), 99, **folders)


def test_a_plan_says_what_the_study_costs(small):
    plan = blisk.plan(blisk.Study(**small), pilot=4, threads=1)
    assert plan["rows"] == 320
    assert "pilot" in str(plan)
    with pytest.raises(ValueError, match="at least 2"):
        blisk.plan(blisk.Study(**small), pilot=1)


def test_a_response_curve_is_that_of_the_command(small, tmp_path):
    study = blisk.Study(**small)
    (tmp_path / "study.toml").write_text(study.to_toml())
    line = ["response", "study.toml", "--load", "50", "--frequencies", "340:380:5"]
    for pattern in [None, 3]:
        curve = blisk.response(study, 50, range(340, 381, 10), pattern)
        asked = ["--pattern", "tuned" if pattern is None else pattern, "--out", "response.parquet"]
        ended = called(*line, *asked, cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
        assert pyarrow.table(curve).to_pylist() == pyarrow.parquet.read_table(tmp_path / "response.parquet").to_pylist()
        assert (len(curve), curve.units["amplitude_m"]) == (5 * 6, "m")
    assert max(curve["amplitude_m"]) > 1e-4
    slide = blisk.response(study, "slide", [360.0])
    assert slide["status"] == ["ok"] * 6


@pytest.mark.parametrize(
    ("more", "flags"), [({"fidelity": "full"}, ["--fidelity", "full"]), ({"continuation": True}, ["--continuation"])]
)
def test_a_curve_on_the_full_model_or_followed_is_that_of_the_command(small, tmp_path, more, flags):
    study = blisk.Study(**small)
    (tmp_path / "study.toml").write_text(study.to_toml())
    curve = blisk.response(study, 50, range(340, 381, 10), 3, **more)
    line = [
        "response",
        "study.toml",
        "--load",
        "50",
        "--frequencies",
        "340:380:5",
        "--pattern",
        3,
        "--out",
        "out.parquet",
    ]
    ended = called(*line, *flags, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    assert pyarrow.table(curve).to_pylist() == pyarrow.parquet.read_table(tmp_path / "out.parquet").to_pylist()
    assert len(curve) >= 5 * 6
    assert ("direction" in curve.columns) == ("continuation" in more)


def test_a_curve_that_cannot_be_followed_is_refused(small):
    study = blisk.Study(**small)
    for load, frequencies, more, words in (
        ("slide", [350.0, 360.0], {}, "one branch"),
        (50, [350.0], {}, "two frequencies"),
        (50, [350.0, 360.0], {"fidelity": "full"}, "reduced model"),
    ):
        with pytest.raises(ValueError, match=words):
            blisk.response(study, load, frequencies, continuation=True, **more)
    with pytest.raises(ValueError, match="reduced, full"):
        blisk.response(study, 50, [350.0], fidelity="best")


def test_what_a_curve_is_of_has_to_be_clear(small):
    study = blisk.Study(**small, **{"excitation.engine_orders": [1, 2]})
    with pytest.raises(ValueError, match="engine_order 1; engine_order 2"):
        blisk.response(study, 50, [360.0])
    assert len(blisk.response(study, 50, [360.0], engine_order=2)) == 6
    with pytest.raises(ValueError, match="standard_deviation of the study: 0.03"):
        blisk.response(study, 50, [360.0], 1, engine_order=2, standard_deviation=0.5)
    for load in [-1, float("inf"), "sticky"]:
        with pytest.raises(ValueError, match="stuck, slide or free"):
            blisk.response(study, load, [360.0], engine_order=2)
    for frequencies in [[], [0.0], [2.0, 1.0], [float("nan")]]:
        with pytest.raises(ValueError, match="ascending"):
            blisk.response(study, 50, frequencies, engine_order=2)
