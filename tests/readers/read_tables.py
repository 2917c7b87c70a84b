"""Reads every Parquet table of a results folder with pandas, pyarrow, Polars and DuckDB.

    python read_tables.py RESULTS

All four must see the same rows, columns, types, nulls and values; every column must have the type that
docs/results.md says, and all other numbers Float64; and each file must carry the
unit and the description of each of its columns, in the file's metadata and in that of the Arrow field, and
the digest of the study.
"""

import json
import re
import sys
from pathlib import Path

import duckdb
import pandas
import polars
import pyarrow.parquet

PAGE = Path(__file__).resolve().parents[2] / "docs" / "results.md"

# Name of each type in pyarrow, Polars, DuckDB and (without nulls) pandas.
TYPES = {
    "Int32": ({"int32"}, polars.Int32, "INTEGER", "int32"),
    "Int64": ({"int64"}, polars.Int64, "BIGINT", "int64"),
    "Float64": ({"double"}, polars.Float64, "DOUBLE", "float64"),
    "Boolean": ({"bool"}, polars.Boolean, "BOOLEAN", "bool"),
    "String": ({"string", "large_string", "string_view"}, polars.String, "VARCHAR", None),
}

EXPECTED_FILES = {
    f"{name}.parquet"
    for name in ("responses", "scenarios", "percentiles", "distribution", "tail_fits", "main_effects", "patterns", "curve")
}


def documented_kinds():
    """Type of every column that the page of results gives one."""
    kinds = {}
    for row in PAGE.read_text().splitlines():
        cells = [cell.strip() for cell in row.split("|")]
        if len(cells) > 3 and cells[2] in TYPES:
            for column in re.findall(r"`(\w+)`", cells[1]):
                check(kinds.setdefault(column, cells[2]) == cells[2], "two types of", column, "on", PAGE.name)
    check(len(kinds) > 50, "types of", len(kinds), "columns on", PAGE.name)
    return kinds


def check(condition, *words):
    if not condition:
        sys.exit("FAILED: " + " ".join(str(word) for word in words))


def check_metadata(path, columns, digest):
    by_arrow = {
        key.decode(): value.decode()
        for key, value in (pyarrow.parquet.read_metadata(path).metadata or {}).items()
    }
    rows = duckdb.sql(f"SELECT key, value FROM parquet_kv_metadata('{path}')").fetchall()
    by_duckdb = {bytes(key).decode(): bytes(value).decode() for key, value in rows}
    schema = pyarrow.parquet.read_schema(path)
    for column in columns:
        field = {key.decode(): value.decode() for key, value in (schema.field(column).metadata or {}).items()}
        check(field.get("unit") == by_arrow.get(f"unit.{column}"), path.name, "unit of the field", column)
        check(field.get("description"), path.name, "no description of the field", column)
        check(field["description"] == by_arrow.get(f"description.{column}"), path.name, "description of", column)
    for metadata, reader in ((by_arrow, "pyarrow"), (by_duckdb, "DuckDB")):
        check(metadata.get("blisk.study_digest") == digest, path.name, reader, "study digest")
        check(metadata.get("blisk.schema_version") == "1", path.name, reader, "schema version")
        check("blisk.version" in metadata, path.name, reader, "version")
        for column in columns:
            check(f"unit.{column}" in metadata, path.name, reader, "no unit of", column)
            check(metadata.get(f"description.{column}"), path.name, reader, "no description of", column)


def check_table(path, digest, kinds):
    arrow = pyarrow.parquet.read_table(path)
    frame = pandas.read_parquet(path)
    rows = polars.read_parquet(path)
    query = duckdb.sql(f"SELECT * FROM '{path}'")
    in_duckdb = duckdb.sql(f"SELECT count(*) FROM '{path}'").fetchall()[0][0]
    columns = arrow.column_names

    check(arrow.num_rows > 0, path.name, "has no rows")
    counts = {arrow.num_rows, len(frame), rows.height, in_duckdb}
    check(len(counts) == 1, path.name, "rows", counts)
    for names in (list(frame.columns), rows.columns, query.columns):
        check(names == columns, path.name, "columns", names, columns)

    duckdb_types = dict(zip(query.columns, (str(kind) for kind in query.types)))
    for column in columns:
        # Those of statistics have names by pattern on the page, and are numbers.
        kind = kinds.get(column, "Float64")
        arrow_types, polars_type, duckdb_type, pandas_type = TYPES[kind]
        where = (path.name, column, "expected", kind, "but")
        check(str(arrow.schema.field(column).type) in arrow_types, *where, arrow.schema.field(column).type)
        check(rows.schema[column] == polars_type, *where, rows.schema[column])
        check(duckdb_types[column] == duckdb_type, *where, duckdb_types[column])
        values = arrow.column(column).to_pylist()
        nulls = values.count(None)
        # pandas has no integer or flag with nulls: it makes them floats or objects.
        if nulls == 0 and pandas_type is not None:
            check(str(frame[column].dtype) == pandas_type, *where, frame[column].dtype)
        check(int(frame[column].isna().sum()) == nulls, path.name, column, "nulls in pandas")
        check(rows[column].null_count() == nulls, path.name, column, "nulls in Polars")
        check(rows[column].to_list() == values, path.name, column, "values in Polars")
        by_duckdb = [row[0] for row in duckdb.sql(f'SELECT "{column}" FROM \'{path}\'').fetchall()]
        check(by_duckdb == values, path.name, column, "values in DuckDB")
    check_metadata(path, columns, digest)
    print(f"{path.name}: {arrow.num_rows} rows, {len(columns)} columns")


def main():
    results = Path(sys.argv[1])
    digest = json.loads((results / "manifest.json").read_text())["study_digest"]
    kinds = documented_kinds()
    files = sorted(results.glob("*.parquet"))
    check(EXPECTED_FILES <= {path.name for path in files}, "tables", [path.name for path in files])
    for path in files:
        check_table(path, digest, kinds)
    versions = (pandas, pyarrow, polars, duckdb)
    print("read by", ", ".join(f"{module.__name__} {module.__version__}" for module in versions))


main()
