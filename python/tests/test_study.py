"""Studies: keywords, texts and files are the same, and what is refused is refused as the command does."""

import pickle

import numpy
import pytest
from conftest import ROOT, called

import blisk


def test_keywords_a_text_and_a_file_are_the_same_study(small, tmp_path):
    study = blisk.Study(**small)
    of_text = blisk.Study.from_toml(study.to_toml())
    path = tmp_path / "study.toml"
    path.write_text(study.to_toml())
    of_file = blisk.Study.from_toml(path)
    of_name = blisk.Study.from_toml(str(path))
    assert of_text == study
    assert study.digest == of_text.digest == of_file.digest == of_name.digest
    assert study.resolved() == of_file.resolved()
    assert (study.name, study.patterns, study.scenarios) == ("small", 80, 4)
    assert repr(study) == "<blisk.Study small: 80 patterns, 4 scenarios>"


def test_a_file_keeps_its_text():
    path = ROOT / "studies" / "quickstart.toml"
    assert blisk.Study.from_toml(path).to_toml() == path.read_text()


def test_tables_are_written_in_the_order_of_the_documentation(small):
    backwards = dict(reversed(small.items()))
    assert blisk.Study(**backwards).to_toml() == blisk.Study(**small).to_toml()
    assert blisk.Study(**small).to_toml().startswith('schema = 1\n\n[study]\nname = "small"\nseed = 7\n')


@pytest.mark.parametrize("path", sorted((ROOT / "studies").glob("*.toml")), ids=lambda path: path.stem)
def test_a_study_survives_the_way_through_dictionaries(path):
    study = blisk.Study.from_toml(path)
    again = blisk.Study(base=path.parent, **study.to_dict())
    assert again.digest == study.digest
    assert again.resolved() == study.resolved()


def test_dotted_keys_arrays_and_none_are_taken(small):
    small["sweep"]["normal_load_n"] = numpy.array([50, 150])
    small["sweep"]["standard_deviation"] = [numpy.float64(0.03)]
    small["output"] = None
    study = blisk.Study(**small, **{"solver.harmonics": (1, 3), "study.patterns": numpy.int64(9)})
    assert study.to_dict()["sweep"] == {"normal_load_n": [50, 150], "standard_deviation": [0.03]}
    assert study.to_dict()["study"]["patterns"] == 9
    assert "output" not in study.to_dict()


def test_replace_changes_what_it_names_and_nothing_else(small):
    study = blisk.Study(**small)
    before = study.to_toml()
    dotted = study.replace({"study.patterns": 9, "solver.harmonics": None})
    nested = study.replace(study={"patterns": 9}, solver={"harmonics": None})
    assert dotted == nested
    assert study.to_toml() == before
    assert dotted.to_dict() == {**study.to_dict(), "study": {**small["study"], "patterns": 9}, "solver": {}}


def test_load_cases_are_tables_in_a_list(small):
    cases = [{"name": "cruise"}, {"name": "half", "amplitude_n": 5.0}]
    study = blisk.Study(**small).replace({"excitation.load_case": cases})
    assert study.to_toml().count("[[excitation.load_case]]") == 2
    assert study.scenarios == 8


def test_a_refusal_has_the_words_of_the_command(small, tmp_path):
    text = blisk.Study(**small).to_toml().replace("harmonics", "harmonix").replace("seed = 7", "seed = -7")
    path = tmp_path / "study.toml"
    path.write_text(text)
    with pytest.raises(blisk.InputError) as refused:
        blisk.Study.from_toml(path)
    ended = called("check", path)
    assert ended.returncode == refused.value.exit_code == 3
    assert ended.stderr == f"error: {refused.value}\n"


def test_findings_say_where_what_and_what_is_accepted(small):
    small["study"]["patterns"] = 0
    small["solver"]["peak_tolerance"] = 2.0
    with pytest.raises(blisk.InputError) as refused:
        blisk.Study(**small)
    by_key = {finding.key: finding for finding in refused.value.findings}
    assert set(by_key) == {"study.patterns", "solver.peak_tolerance"}
    patterns = by_key["study.patterns"]
    assert (patterns.problem, patterns.value, patterns.file) == ("not_accepted", "0", "<study>")
    assert patterns.line == 6 and "2147483647" in patterns.accepted
    assert str(refused.value).startswith(f"<study>:6: {patterns.message}\n")
    assert isinstance(refused.value, ValueError)


def test_an_unknown_key_is_told_the_nearest_one(small):
    with pytest.raises(blisk.InputError) as refused:
        blisk.Study(**small, **{"solver.peak_tolerence": 0.1})
    (unknown,) = refused.value.findings
    assert (unknown.problem, unknown.key) == ("unknown_key", "solver.peak_tolerence")
    assert unknown.suggestion == "peak_tolerance"
    assert "harmonic_tolerance" in unknown.accepted


def test_a_missing_table_is_told_what_is_accepted(small):
    del small["damping"]
    with pytest.raises(blisk.InputError) as refused:
        blisk.Study(**small)
    (missing,) = refused.value.findings
    assert (missing.problem, missing.key, missing.value) == ("missing", "damping", None)
    assert missing.accepted


@pytest.mark.parametrize("text", ["schema = ", "schema = 1\n[study\n", "a = 1\na = 2\n"])
def test_what_is_no_toml_is_a_finding(text):
    with pytest.raises(blisk.InputError) as refused:
        blisk.Study.from_toml(text)
    assert [finding.problem for finding in refused.value.findings] == ["syntax"]
    assert refused.value.findings[0].line is not None


def test_values_that_toml_cannot_hold_are_type_errors(small):
    for value in [object(), {1: 2}, [b"bytes"]]:
        with pytest.raises(TypeError, match="study"):
            blisk.Study(**small, **{"study.name": value})
    with pytest.raises(blisk.InputError):
        blisk.Study(**small, **{"excitation.amplitude_n": float("nan")})


def test_names_with_quotes_and_breaks_stay_what_they_are(small):
    with pytest.raises(blisk.InputError) as refused:
        blisk.Study(**small, **{"study.name": 'a"b\\c\n\x7f\u00e9'})
    assert refused.value.findings[0].value == '"a\\"b\\\\c\\n\\u007f\u00e9"'


def test_check_looks_at_the_model_and_remarks_what_is_unusual(small):
    study = blisk.Study(**small)
    assert any("P99 will have no value" in remark for remark in study.check())
    assert "400" not in study.describe() and "80 patterns x 4 scenarios = 320 rows" in study.describe()
    without = study.replace({"model.lumped.disk_mass_kg": 0.0})
    with pytest.raises(blisk.InputError) as refused:
        without.check()
    assert refused.value.findings


def test_files_are_sought_beside_the_study(small, tmp_path):
    small["mistuning"] = {"file": "patterns.csv"}
    del small["sweep"]["standard_deviation"], small["study"]["patterns"]
    rows = [f"{pattern},{blade},{0.001 * (blade + pattern)}" for pattern in range(2) for blade in range(6)]
    (tmp_path / "patterns.csv").write_text("pattern,blade,deviation\n" + "\n".join(rows) + "\n")
    assert blisk.Study(base=tmp_path, **small).patterns == 2
    with pytest.raises(blisk.BliskError) as refused:
        blisk.Study(base=tmp_path / "elsewhere", **small)
    assert refused.value.exit_code == 7


def test_a_study_and_its_errors_can_be_sent_to_another_process(small):
    study = blisk.Study(**small)
    assert pickle.loads(pickle.dumps(study)) == study
    with pytest.raises(blisk.InputError) as refused:
        study.replace({"study.patterns": 0})
    again = pickle.loads(pickle.dumps(refused.value))
    assert (str(again), again.findings) == (str(refused.value), refused.value.findings)
