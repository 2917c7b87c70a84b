"""Results: every table as other libraries see it, the summary, the report, and damage."""

import json
import shutil

import duckdb
import pandas
import polars
import pyarrow
import pyarrow.parquet
import pytest
from conftest import called

import blisk

TABLES = ["responses", "scenarios", "percentiles", "distribution", "patterns"]


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_its_file_in_every_library(finished, name):
    table = getattr(finished, name)
    path = finished.folder / f"{name}.parquet"
    own, expected = table, pyarrow.parquet.read_table(path)
    of_file = pyarrow.parquet.read_metadata(path).metadata
    assert (len(table), table.columns, table.name) == (expected.num_rows, expected.column_names, name)
    assert table.rows() == expected.to_pylist()

    arrow = pyarrow.table(table)
    assert arrow.to_pylist() == expected.to_pylist()
    for field in expected.schema:
        assert arrow.schema.field(field.name).metadata == field.metadata
        assert table.units[field.name] == field.metadata[b"unit"].decode()
        assert table.descriptions[field.name] == field.metadata[b"description"].decode()
        assert table[field.name] == expected.column(field.name).to_pylist()
    assert arrow.schema.metadata[b"blisk.study_digest"] == of_file[b"blisk.study_digest"]

    assert polars.DataFrame(table).equals(polars.read_parquet(path))
    pandas.testing.assert_frame_equal(pandas.DataFrame.from_arrow(table), pandas.read_parquet(path), check_dtype=False)
    assert duckdb.sql("select * from own").fetchall() == duckdb.sql(f"select * from '{path}'").fetchall()


def test_a_table_can_be_read_more_than_once_and_outlives_its_results(finished):
    table = blisk.Results(finished.folder).scenarios
    assert pyarrow.table(table) == pyarrow.table(table)
    frame = polars.DataFrame(table)
    del table
    assert frame["ok"].sum() == 320
    assert pyarrow.schema(finished.scenarios).names == finished.scenarios.columns


def test_exports_share_the_memory_of_the_table(finished):
    table = finished.responses
    first, second = pyarrow.table(table), pyarrow.table(table)
    frame = polars.DataFrame(table)
    numbers = [field.name for field in first.schema if pyarrow.types.is_floating(field.type)]
    assert len(numbers) >= 4
    for name in numbers:
        addresses = [own.column(name).chunk(0).buffers()[1].address for own in (first, second)]
        assert addresses[0] == addresses[1] == frame[name].to_arrow().buffers()[1].address, name
    # Two readings of the file do not share.
    other = pyarrow.table(finished.responses)
    assert other.column(numbers[0]).chunk(0).buffers()[1].address != addresses[0]


def test_a_column_that_is_not_there_is_a_key_error(finished):
    with pytest.raises(KeyError, match="peak_amplitude_m_p95"):
        finished.scenarios["p95"]


def test_tables_that_are_not_there_are_errors(finished):
    for name in ["main_effects", "tail_fits", "nothing", "../small/responses"]:
        with pytest.raises(blisk.BliskError) as refused:
            finished.table(name)
        assert refused.value.exit_code == 7, name
    with pytest.raises(blisk.BliskError) as refused:
        blisk.Results(finished.folder / "elsewhere")
    assert refused.value.exit_code == 7


def test_random_contact_has_main_effects_and_commands_add_tables(small, tmp_path):
    small["contact"]["variation"] = {"friction_coefficient": {"kind": "normal", "standard_deviation": 0.1}}
    results = blisk.run(blisk.Study(**small, **{"study.patterns": 120}), out=tmp_path)
    assert set(results.main_effects["input"]) == {"friction_coefficient", "rest"}
    assert called("stats", tmp_path, "--tails").returncode == 0
    assert "weibull_bounded_above" in results.table("tail_fits")["law"]


def test_a_changed_table_is_refused(finished, tmp_path):
    folder = tmp_path / "copy"
    shutil.copytree(finished.folder, folder)
    path = folder / "scenarios.parquet"
    content = bytearray(path.read_bytes())
    content[100] ^= 1
    path.write_bytes(content)
    with pytest.raises(blisk.BliskError) as refused:
        blisk.Results(folder).scenarios
    assert refused.value.exit_code == 8
    assert len(blisk.Results(folder).percentiles) > 0


def test_summary_and_manifest_are_those_of_the_command(finished):
    ended = called("stats", finished.folder, "--json")
    assert ended.returncode == 0
    assert finished.summary == json.loads(ended.stdout)
    assert finished.summary_text == (finished.folder / "summary.txt").read_text()
    assert finished.manifest["counts"] == {"planned": 320, "ok": 320, "failed": 0, "by_status": {"ok": 320}}
    assert finished.manifest["build"] == blisk.__build__


def test_the_best_load_is_the_lowest_of_those_with_a_value(finished):
    best = finished.best(percentile=95)
    rows = [row for row in finished.scenarios.rows() if row["contact"] == "full"]
    lowest = min(rows, key=lambda row: row["peak_amplitude_m_p95"])
    assert (best.scenario, best.normal_load_n) == (lowest["scenario"], lowest["normal_load_n"])
    assert best.value == lowest["peak_amplitude_m_p95"]
    assert (best.lower, best.upper) == (lowest["peak_amplitude_m_p95_lower"], lowest["peak_amplitude_m_p95_upper"])
    factor = finished.best(95, "amplification_factor")
    assert factor.value == min(row["amplification_factor_p95"] for row in rows)
    with pytest.raises(ValueError, match="no normal load has a value of P99 "):
        finished.best()


def test_the_best_load_is_asked_for_one_excitation(small, tmp_path):
    results = blisk.run(blisk.Study(**small, **{"excitation.engine_orders": [1, 2]}), out=tmp_path)
    with pytest.raises(ValueError, match="name one: 1, 2"):
        results.best(95)
    assert results.best(95, engine_order=1).engine_order == 1


def test_the_report_is_that_of_the_command(finished, tmp_path):
    path = finished.report(tmp_path / "own.html", curves=False)
    ended = called("report", finished.folder, "--no-curves", "--out", tmp_path / "other.html")
    assert ended.returncode == 0, ended.stderr
    assert path.read_bytes() == (tmp_path / "other.html").read_bytes()
    with_curves = finished.report(tmp_path / "curves.html")
    assert with_curves.stat().st_size > path.stat().st_size
