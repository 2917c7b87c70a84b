"""The recipes of docs/ten-tasks.md run as they stand, in one folder, and print what the page shows. With ``-s``: their times."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from conftest import ROOT

from blisk._import._run import _component

PAGE = ROOT / "docs" / "ten-tasks.md"
# Commands that install the package or need a cluster.
NOT_RUN = ("python3 -m venv ", "pip install ", "bash ring-slurm.sh")


def comparison():
    """What holds the README's excerpts against fresh output, words as they are and numbers within 0.2 %."""
    spec = importlib.util.spec_from_file_location("readme", ROOT / "tests" / "readers" / "readme.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.stands_in


def recipes(page):
    """Number and text of each recipe."""
    return re.findall(r"^## (\d+)\. (.*?)(?=^## |\Z)", page, flags=re.MULTILINE | re.DOTALL)


def blocks(text):
    """Language and content of each block of code."""
    return re.findall(r"^```(\w+)\n(.*?)^```", text, flags=re.MULTILINE | re.DOTALL)


def files_of_ansys(folder):
    """The beam that ansys-mapdl-reader installs, with the components that the recipe names."""
    for name, source in (("wheel.full", examples.fullfile), ("blade.full", examples.fullfile), ("wheel.rst", examples.rstfile)):
        shutil.copy(source, folder / name)
    beam = reader.Archive(examples.hexarchivefile, parse_vtk=False)
    positions = dict(zip(beam.nnum.tolist(), beam.nodes[:, :3].tolist()))
    sets = {
        "ROOT": [node for node, (x, y, z) in positions.items() if z == 0.0],
        "SIDE": [node for node, (x, y, z) in positions.items() if y == 1.0 and x <= 0.5 and 2.5 <= z <= 3.0],
        "TIP": [node for node, position in positions.items() if position == [1.0, 1.0, 5.0]],
    }
    components = "".join(_component(name, nodes) for name, nodes in sets.items())
    (folder / "wheel.cdb").write_text(Path(examples.hexarchivefile).read_text() + components)


def ran(line, folder):
    """The output of a line of a shell in an environment that has the package."""
    place = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    ended = subprocess.run(
        ["bash", "-e", "-c", line],
        cwd=folder,
        env={**os.environ, "PATH": place},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    assert ended.returncode == 0, f"{line}\n{ended.stdout}"
    return ended.stdout


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """What every recipe prints, and how long it takes, s."""
    folder = tmp_path_factory.mktemp("ten-tasks")
    files_of_ansys(folder)
    found = {}
    for number, text in recipes(PAGE.read_text(encoding="utf-8")):
        started, output = time.monotonic(), ""
        for language, block in blocks(text):
            if language == "python":
                # The page says to save it under this name.
                (script,) = re.findall(r"`python (recipe\d+\.py)`", text)
                assert script == f"recipe{number}.py"
                (folder / script).write_text(block, encoding="utf-8")
                output += ran(f"python {script}", folder)
            elif language == "sh":
                lines = [line for line in block.splitlines() if not line.startswith(NOT_RUN)]
                output += ran("\n".join(lines), folder)
        found[number] = output
        print(f"recipe {number}: {time.monotonic() - started:.0f} s")
    assert (folder / "results" / "quickstart" / "report.html").exists()
    assert (folder / "statistics.csv").exists() and (folder / "loads.svg").exists() and (folder / "loads.pdf").exists()
    return found


def test_the_recipes_run_and_print_what_the_page_shows(printed):
    stands_in, wrong, count = comparison(), [], 0
    for number, text in recipes(PAGE.read_text(encoding="utf-8")):
        for line in "".join(block for language, block in blocks(text) if language == "text").splitlines():
            count += 1
            if not any(stands_in(line, own) for own in printed[number].splitlines()):
                wrong.append(f"recipe {number} does not print: {line}")
    assert wrong == []
    assert len(printed) == 10 and count >= 25


def test_a_recipe_has_what_it_needs_and_few_words():
    found = recipes(PAGE.read_text(encoding="utf-8"))
    assert [number for number, _ in found] == [str(number) for number in range(1, 11)]
    for number, text in found:
        for part in ("**You have**", "**Type**", "**You see**", "**It means**"):
            assert part in text, (number, part)
        prose = re.sub(r"^```\w+\n.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
        prose = re.sub(r"\]\([^)]*\)", "]", prose)
        assert len(re.findall(r"\w[\w.']*", prose)) <= 150, number
