"""Every notebook runs from the first to the last cell, and is stored without outputs."""

import os
import re
import sys
import time

import nbclient
import nbformat
import pytest
from conftest import ROOT, SMALL

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
    "populations": [r"P95 without friction (\S+) m by NumPy, (\S+) m by blisk", r"the tighter tolerance takes \d+ % off the P95"],
    "quickstart": [r"slide: (\S+) m at \S+ Hz; blisk: (\S+) m", r"\d+ N per sector: P99", r"quickstart\.html"],
}


def test_there_are_five():
    assert [path.stem for path in NOTEBOOKS] == sorted(SAYS)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_stored_without_outputs(path):
    for cell in nbformat.read(path, as_version=4).cells:
        assert cell.cell_type == "markdown" or (cell.outputs == [] and cell.execution_count is None)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A fresh folder to run a notebook in; the kernel is that of this environment, whatever others are registered."""
    kernels = tmp_path / "kernels" / "python3"
    kernels.mkdir(parents=True)
    (kernels / "kernel.json").write_text(
        '{"argv": ["%s", "-m", "ipykernel_launcher", "-f", "{connection_file}"], "display_name": "own", "language": "python"}'
        % sys.executable
    )
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path))
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    (tmp_path / "work").mkdir()
    return tmp_path / "work"


class Client(nbclient.NotebookClient):
    """Runs a notebook and keeps the messages of its kernel."""

    def __init__(self, notebook, folder):
        self.messages = []
        super().__init__(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}})

    def process_message(self, msg, cell, cell_index):
        self.messages.append(msg)
        return super().process_message(msg, cell, cell_index)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, folder):
    notebook = nbformat.read(path, as_version=4)
    began = time.monotonic()
    Client(notebook, folder).execute()
    print(f"{path.stem}: {time.monotonic() - began:.0f} s", file=sys.stderr)
    text, kinds = "", set()
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            assert output.get("name") != "stderr", output
            kinds.update(output.get("data", {}))
            text += output.get("text", "") + output.get("data", {}).get("text/plain", "") + os.linesep
    for words in SAYS[path.stem]:
        assert re.search(words, text), f"{words} is not in what {path.stem} says:\n{text}"
    # Each shows a figure, and no warning but those that its words explain.
    assert "image/png" in kinds
    assert "warning" not in text.lower()


def test_progress_in_a_notebook_is_a_bar_that_is_written_over(folder):
    # Every event is shown, so that the test does not depend on how long the rows take.
    study = {**SMALL, "study": {**SMALL["study"], "patterns": 800}}
    run = (
        "import blisk, blisk._progress\nblisk._progress._CELL_INTERVAL_S = 0.0\n"
        f"blisk.run(blisk.Study(**{study!r}), out='own', threads=1, progress=True).finished"
    )
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(run)])
    client = Client(notebook, folder)
    client.execute()
    shown = [message for message in client.messages if message["msg_type"] in ("display_data", "update_display_data")]
    kinds = [message["msg_type"] for message in shown]
    assert kinds[0] == "display_data" and len(kinds) > 2 and set(kinds[1:]) == {"update_display_data"}
    assert len({message["content"]["transient"]["display_id"] for message in shown}) == 1
    texts = [message["content"]["data"]["text/plain"] for message in shown]
    bar = r"\[#* *\] (\d+) of 3200 rows, 0 failed"
    assert any(re.fullmatch(rf"{bar}, about \d+ s left", text) for text in texts), texts
    assert re.fullmatch(rf"{bar}, \d+ s", texts[-1])[1] == "3200"
    # That line is the output of the cell, with what the cell gives, and nothing else.
    outputs = [output["data"]["text/plain"] for output in notebook.cells[0].outputs]
    assert outputs == [texts[-1], "True"]


def test_steps_of_an_import_in_a_notebook_are_one_output_that_grows(folder):
    code = (
        "from blisk._import._steps import Steps\nsteps = Steps(True)\n"
        "steps.begins('reading')\nsteps.begins('checking')\nSteps(False).begins('silent')"
    )
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
    Client(notebook, folder).execute()
    (output,) = notebook.cells[0].outputs
    assert re.fullmatch(r" +\d+ s  reading\n +\d+ s  checking", output["data"]["text/plain"])
