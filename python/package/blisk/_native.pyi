"""The native part of the package: what the Rust library gives it."""

import os
from collections.abc import Callable, Sequence
from typing import Any, Optional, Union, final

__all__ = [
    "BUILD",
    "COMMIT",
    "CheckedStudy",
    "Table",
    "VERSION",
    "bundle_facts",
    "bundle_frequencies",
    "campbell",
    "compare",
    "estimate",
    "examples",
    "explain",
    "figure",
    "figure_names",
    "import_sector",
    "init",
    "key_names",
    "main",
    "manifest",
    "merge",
    "model",
    "optimum",
    "plan",
    "repair",
    "replay",
    "report",
    "response",
    "run",
    "schema",
    "slurm",
    "status",
    "summary",
    "table",
    "tables_of",
    "tails",
    "tradeoff",
    "verify",
]

_Path = Union[str, os.PathLike[str]]
_Listener = Callable[[str, str, int, int, int, Optional[float]], object]

VERSION: str
BUILD: str
COMMIT: str

@final
class CheckedStudy:
    """A study that the reader of study files has accepted."""

    def __new__(cls, path: _Path, text: str) -> CheckedStudy: ...
    @property
    def name(self) -> str: ...
    @property
    def patterns(self) -> int: ...
    @property
    def scenarios(self) -> int: ...
    def digest(self) -> str: ...
    def resolved(self) -> str: ...
    def echo(self) -> str: ...
    def check(self) -> tuple[str, str]: ...

@final
class Table:
    """A table: named columns of the same length, with units.

    Libraries take it as it is: ``polars.DataFrame(responses)``, ``pyarrow.table(responses)``,
    ``pandas.DataFrame.from_arrow(responses)``, ``duckdb.sql("from responses")``.
    """

    @property
    def name(self) -> str:
        """Name of the table, like ``responses``."""
    @property
    def columns(self) -> list[str]:
        """Names of the columns, in order."""
    @property
    def units(self) -> dict[str, str]:
        """Unit of each column by its name; ``1`` for pure numbers, nothing for names and flags."""
    @property
    def descriptions(self) -> dict[str, str]:
        """What each column holds, by its name."""
    def rows(self) -> list[dict[str, Any]]:
        """The rows as a list of dictionaries by the names of the columns."""
    def __len__(self) -> int:
        """Number of rows."""
    def __getitem__(self, column: str, /) -> list[Any]:
        """The values of a column as a list with one entry per row; ``None`` where there is no value."""
    def __arrow_c_schema__(self) -> object:
        """The schema by the Arrow PyCapsule interface."""
    def __arrow_c_stream__(self, requested_schema: Optional[object] = None) -> object:
        """The rows by the Arrow PyCapsule interface."""

def main(program: _Path, arguments: Sequence[str]) -> int: ...
def examples() -> list[tuple[str, str]]: ...
def init(example: str, out: _Path) -> None: ...
def slurm(
    study: _Path,
    tasks: int,
    out: Optional[_Path],
    threads: int,
    time: Optional[str],
    script: Optional[_Path],
    program: _Path,
) -> _Path: ...
def explain(name: str) -> tuple[str, str]: ...
def schema(of_import: bool) -> str: ...
def key_names() -> list[str]: ...
def tables_of(text: str) -> str: ...
def run(
    study: CheckedStudy,
    out: _Path,
    threads: Optional[int],
    solve_anew: bool,
    listener: Optional[_Listener],
) -> tuple[int, int]: ...
def optimum(
    study: CheckedStudy,
    between_n: tuple[float, float],
    percent: float,
    quantity: str,
    resolution: float,
    out: _Path,
    solved: _Path,
    threads: Optional[int],
    listener: Optional[_Listener],
) -> tuple[str, str]: ...
def plan(study: CheckedStudy, pilot: int, threads: Optional[int]) -> tuple[str, str]: ...
def response(
    study: CheckedStudy,
    pattern: Optional[int],
    load: Union[float, str],
    frequencies_hz: Sequence[float],
    load_case: Optional[str],
    engine_order: Optional[int],
    standard_deviation: Optional[float],
    way: str,
    path: _Path,
) -> Table: ...
def compare(folders: Sequence[_Path], percent: float, baseline: Optional[int]) -> tuple[str, str]: ...
def summary(results: _Path) -> tuple[tuple[str, str], Optional[tuple[int, int]]]: ...
def status(results: _Path) -> tuple[str, str]: ...
def tails(results: _Path) -> tuple[str, str]: ...
def manifest(results: _Path) -> str: ...
def report(results: _Path, path: _Path, curves: bool, study_file: Optional[_Path]) -> None: ...
def table(results: _Path, name: str) -> Table: ...
def model(study: CheckedStudy, export: Optional[_Path]) -> tuple[str, str]: ...
def campbell(
    study: CheckedStudy,
    engine_orders: Sequence[int],
    modes: int,
    range_rpm: Optional[tuple[float, float]],
    bundles: Sequence[tuple[float, _Path]],
    plots: tuple[Optional[_Path], Optional[_Path], Optional[float]],
) -> tuple[str, str]: ...
def merge(shards: Sequence[_Path], out: _Path, study_file: Optional[_Path]) -> None: ...
def replay(results: _Path, scenario: int, pattern: int, full: bool, study_file: Optional[_Path]) -> tuple[str, str]: ...
def verify(
    results: _Path,
    question: str,
    sample: int,
    seed: Optional[int],
    row: Optional[tuple[int, int]],
    threads: Optional[int],
    study_file: Optional[_Path],
    listener: Optional[_Listener],
) -> tuple[str, str]: ...
def repair(
    results: _Path,
    threads: Optional[int],
    study_file: Optional[_Path],
    listener: Optional[_Listener],
) -> tuple[str, str]: ...
def tradeoff(
    study: CheckedStudy,
    patterns: int,
    full: bool,
    out: _Path,
    threads: Optional[int],
    listener: Optional[_Listener],
) -> tuple[str, str]: ...
def estimate(
    study: CheckedStudy,
    percent: Optional[float],
    patterns: Optional[int],
    solves: Optional[int],
    out: _Path,
    threads: Optional[int],
    listener: Optional[_Listener],
) -> tuple[str, str]: ...
def figure_names() -> list[tuple[str, str]]: ...
def figure(
    results: _Path,
    name: str,
    load_case: Optional[str],
    engine_order: Optional[int],
    standard_deviation: Optional[float],
    study_file: Optional[_Path],
) -> tuple[str, str, str]: ...
def import_sector(file: _Path, out: _Path, frequencies: int) -> tuple[str, str]: ...
def bundle_facts(folder: _Path) -> str: ...
def bundle_frequencies(folder: _Path, count: int) -> list[list[float]]: ...
