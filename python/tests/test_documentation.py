"""What the pages show is run, and the stubs say what is there."""

import importlib.metadata
import re
import shutil
import subprocess
import sys

from conftest import ROOT, SMALL

import blisk

PAGE = ROOT / "docs" / "python.md"


def test_every_code_block_of_the_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(blisk.Study(**SMALL).to_toml())
    blocks = re.findall(r"^```(\w*)\n(.*?)^```", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    names = {"__name__": "page"}
    for number, (language, block) in enumerate(blocks):
        if language == "sh":
            # That is how these tests have got the package.
            assert block == "pip install ./python\n"
            continue
        assert language == "python", block
        exec(compile(block, f"{PAGE.name}: block {number}", "exec"), names)
    assert len(blocks) >= 10
    assert len(names["more"].patterns) == (SMALL["study"]["patterns"] + 20) * 6
    assert (tmp_path / "results" / "first" / "report.html").exists()


def test_the_example_runs_unchanged(tmp_path):
    example = ROOT / "python" / "examples" / "quickstart.py"
    ended = subprocess.run([sys.executable, str(example), str(tmp_path)], capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    assert re.search(r"^lowest P99: .* at \d+ N per sector$", ended.stdout, flags=re.MULTILINE), ended.stdout
    assert (tmp_path / "report.html").exists()


def test_the_package_has_the_version_of_the_program():
    assert importlib.metadata.version("blisk") == blisk.__version__


def test_types_hold_and_stubs_are_complete(tmp_path):
    config = tmp_path / "mypy.ini"
    config.write_text("[mypy]\nstrict = true\n")
    example = shutil.copy(ROOT / "python" / "examples" / "quickstart.py", tmp_path)
    mypy = [sys.executable, "-m", "mypy", "--config-file", str(config), "-p", "blisk"]
    own = subprocess.run(mypy, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert own.returncode == 0, own.stdout
    used = subprocess.run([*mypy[:-2], example], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert used.returncode == 0, used.stdout
    stubs = [sys.executable, "-m", "mypy.stubtest", "blisk._native"]
    same = subprocess.run(stubs, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert same.returncode == 0, same.stdout


def test_everything_public_is_described():
    for name in blisk.__all__:
        if name.startswith("__"):
            continue
        thing = getattr(blisk, name)
        assert thing.__doc__, name
        for own, value in vars(thing).items() if isinstance(thing, type) else []:
            if not own.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{own}"
