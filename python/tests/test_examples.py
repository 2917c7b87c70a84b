"""The example of Ansys' files, against the matrices of these files, its page and its notebook."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import numpy
import pytest
import scipy.sparse
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from conftest import EXAMPLES, ROOT
from scipy.linalg import eigh

import blisk

SCRIPT = EXAMPLES / "ansys_files.py"
NOTEBOOK = ROOT / "python" / "notebooks" / "from-ansys.ipynb"
TIP, LOSS_FACTOR = 27, 0.01


@pytest.fixture(scope="module")
def carried_out(tmp_path_factory):
    """What the script prints, and its results."""
    folder = tmp_path_factory.mktemp("ansys-files")
    ended = subprocess.run([sys.executable, "-m", "blisk.examples", SCRIPT.stem, folder], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout, blisk.Results(folder / "beam")


def test_without_friction_its_percentile_is_that_of_the_matrices_of_ansys(carried_out):
    _, results = carried_out
    # The beam under a harmonic force at its tip, from the .full file alone: u = (K (1 + i eta) - omega^2 M)^-1 f.
    full = reader.read_binary(examples.fullfile)
    dofs, k, m = full.load_km()
    held = set(map(tuple, full.const.tolist()))
    free = [row for row, dof in enumerate(dofs.tolist()) if tuple(dof) not in held]
    k, m = ((own + scipy.sparse.triu(own, 1).T).tocsr()[free][:, free].toarray() for own in (k, m))
    squares, modes = eigh(k, m)
    tip = numpy.flatnonzero(dofs[free][:, 0] == TIP)
    omega = numpy.sqrt(squares[0]) * numpy.linspace(0.99, 1.01, 20_001)[:, None]
    motion = (modes[tip[0]] / (squares * (1 + 1j * LOSS_FACTOR) - omega**2)) @ modes[tip].T
    tuned_m = numpy.linalg.norm(abs(motion), axis=1).max()
    # Nothing couples the blades, and K (1 + d) has the amplitude 1 / (1 + d): the softest blade is the peak.
    deviations = {}
    for row in results.patterns.rows():
        deviations.setdefault(row["pattern"], []).append(row["deviation"])
    expected_m = {pattern: tuned_m / (1 + min(own)) for pattern, own in deviations.items()}
    rows = [row for row in results.responses.rows() if row["contact"] == "slide"]
    assert len(rows) == len(expected_m) == 80
    for row in rows:
        assert row["stated_error"] < 2e-3
        assert abs(row["peak_amplitude_m"] / expected_m[row["pattern"]] - 1) < row["stated_error"]
        assert abs(row["amplification_factor"] * (1 + min(deviations[row["pattern"]])) - 1) < 1e-5
    # The order statistic of rank ceil(0.95 n).
    p95_m = next(row["peak_amplitude_m_p95"] for row in results.scenarios.rows() if row["contact"] == "slide")
    assert abs(p95_m / sorted(expected_m.values())[75] - 1) < 1e-4


def test_it_prints_what_the_page_shows(carried_out):
    text, _ = carried_out
    section = (ROOT / "docs" / "import.md").read_text().partition("## Try it without Ansys\n")[2].partition("\n## ")[0]
    shown = re.search(r"```text\n(.*?)```", section, flags=re.DOTALL)[1].splitlines()
    # How near two solvers are is noise of the machine.
    printed = re.sub(r"within \de-1\d of SciPy", "within 4e-13 of SciPy", text).splitlines()
    assert len(shown) >= 3 and printed[-len(shown) :] == shown


def test_the_package_has_the_examples_of_the_repository_and_lists_them(tmp_path):
    installed = Path(blisk.__file__).parent / "examples"
    names = sorted(path.name for path in EXAMPLES.glob("*.py"))
    assert names == ["__init__.py", "__main__.py", "ansys_files.py", "quickstart.py"]
    for name in names:
        assert (installed / name).read_bytes() == (EXAMPLES / name).read_bytes()
        assert (ROOT / "python" / "examples" / name).samefile(EXAMPLES / name)

    def ended(*arguments):
        line = [sys.executable, "-m", "blisk.examples", *arguments]
        return subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, check=False)

    listed = ended()
    assert listed.returncode == 0, listed.stderr
    for name in ("ansys_files", "quickstart"):
        assert re.search(rf"^{name}: .*\n    {re.escape(str(installed / name))}\.py$", listed.stdout, flags=re.MULTILINE)
    wrong = ended("ansys")
    assert wrong.returncode != 0 and wrong.stderr == "error: ansys is no example; accepted: ansys_files, quickstart\n"


def calls(code):
    """The arguments of the calls that make the sector and the study, but for the folder."""
    made = [node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Call)]
    return {
        (name, argument.arg if isinstance(argument, ast.keyword) else None, ast.unparse(argument))
        for name in ("blisk.Sector.from_ansys", "blisk.Study")
        for call in made
        if ast.unparse(call.func) == name
        for argument in (*call.args, *call.keywords)
        if getattr(argument, "arg", None) != "out"
    }


def test_the_notebook_makes_the_same_sector_and_study():
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    cells = "\n".join(cell.source.rstrip(";") for cell in notebook.cells if cell.cell_type == "code")
    script = SCRIPT.read_text()
    assert len(calls(script)) > 15 and calls(script) == calls(cells)
    for name in ("root", "side", "tip"):
        line = next(line for line in script.splitlines() if line.startswith(f"{name} = "))
        assert line in cells.splitlines()
