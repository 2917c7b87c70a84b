"""Validates the studies of the repository against the JSON Schema of study files with the package jsonschema.

    python check_schema.py SCHEMA.json

The schema itself must be one; every study must fit, and none with an unknown key.
"""

import json
import sys
import tomllib
from pathlib import Path

import jsonschema

ROOT = Path(__file__).resolve().parents[2]


def main():
    schema = json.loads(Path(sys.argv[1]).read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    studies = [path for path in sorted((ROOT / "studies").rglob("*.toml")) if not path.name.startswith("wheel_")]
    for path in studies:
        study = tomllib.loads(path.read_text())
        for error in validator.iter_errors(study):
            sys.exit(f"FAILED: {path.name}: {error.json_path}: {error.message}")
        if validator.is_valid({**study, "no_such_key": 1}):
            sys.exit(f"FAILED: {path.name} is accepted with an unknown key")
    print(f"{len(studies)} studies fit the schema")


main()
