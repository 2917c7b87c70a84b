"""Every notebook runs from the first to the last cell, and is stored without outputs."""

import os
import re
import sys
import time

import nbclient
import nbformat
import pytest
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.ipynb"))
# What each of them has to have said, beside the checks of its own cells.
SAYS = {
    "from-ansys": [
        r"24 frequencies within \de-\d+ of SciPy",
        r"6 modes of file\.rst within 4e-08 of Ansys",
        r"\d N per sector: P95",
    ],
    "measured-wheel": [r"blade \d+: (\S+) m; blisk: blade \d+, ", r"stuck +0 N: +\d+ % of the wheels"],
    "own-wheel": [r"frequencies within \de-\d+ of the closed form"],
    "populations": [r"P95", r"the tighter tolerance takes \d+ % off the P95"],
    "quickstart": [r"\d+ N per sector: P99", r"quickstart\.html"],
}


def test_there_are_five():
    assert [path.stem for path in NOTEBOOKS] == sorted(SAYS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_outputs(path):
    for cell in nbformat.read(path, as_version=4).cells:
        assert cell.cell_type == "markdown" or (cell.outputs == [] and cell.execution_count is None)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    # The kernel is that of this environment, whatever others are registered.
    kernels = tmp_path / "kernels" / "python3"
    kernels.mkdir(parents=True)
    (kernels / "kernel.json").write_text(
        '{"argv": ["%s", "-m", "ipykernel_launcher", "-f", "{connection_file}"], "display_name": "own", "language": "python"}'
        % sys.executable
    )
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path))
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = nbformat.read(path, as_version=4)
    began = time.monotonic()
    (tmp_path / "work").mkdir()
    client = nbclient.NotebookClient(
        notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path / "work")}}
    )
    client.execute()
    print(f"{path.stem}: {time.monotonic() - began:.0f} s", file=sys.stderr)
    text, kinds = "", set()
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            kinds.update(output.get("data", {}))
            text += output.get("text", "") + output.get("data", {}).get("text/plain", "") + os.linesep
    for words in SAYS[path.stem]:
        assert re.search(words, text), f"{words} is not in what {path.stem} says:\n{text}"
    # Each shows a figure.
    assert "image/png" in kinds
