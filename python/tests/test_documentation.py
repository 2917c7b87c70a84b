"""What the pages show is run, and the stubs say what is there."""

import dataclasses
import importlib.metadata
import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib
import pytest
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from conftest import ROOT, SMALL, called, study_of
from pyyeti.nastran import op4
from solid import Solid
from test_sector import bulk_data, deck, labels, matrix_text

import blisk
from blisk._import._keywords import Keywords, Wheel
from blisk._import._run import _component

matplotlib.use("Agg")

PAGE = ROOT / "docs" / "python.md"
GUIDE = ROOT / "docs" / "import.md"


def blocks_of(page):
    """Language and text of each block of code."""
    return re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def test_every_code_block_of_the_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(blisk.Study(**SMALL).to_toml())
    blocks = blocks_of(PAGE)
    names = {"__name__": "page"}
    for number, (language, block) in enumerate(blocks):
        if language == "sh":
            # That is how these tests have got the package.
            assert block == "python3 -m venv env && . env/bin/activate\npip install ./python\n"
            continue
        assert language == "python", block
        exec(compile(block, f"{PAGE.name}: block {number}", "exec"), names)
    assert len(blocks) >= 10
    assert len(names["more"].patterns) == (SMALL["study"]["patterns"] + 20) * 6
    assert (tmp_path / "results" / "first" / "report.html").exists()


def test_every_block_of_python_of_the_guide_to_imports_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    solid = Solid()
    own = [element for element, is_blade in zip(solid.elements, solid.blade) if is_blade]
    of_blade = {node for element in own for node in element}
    # Ansys: the beam, whose held end stands for both faces, and the same beam as a ring that touches it at one side.
    for name in ("wheel.full", "blade.full", "ring.full"):
        shutil.copy(examples.fullfile, name)
    shutil.copy(examples.rstfile, "wheel.rst")
    held = sorted({int(node) for node, _ in reader.read_binary(examples.fullfile).const})
    beam = reader.Archive(examples.hexarchivefile, parse_vtk=False)
    positions = zip(beam.nnum.tolist(), beam.nodes[:, :3].tolist())
    side = [node for node, (x, y, z) in positions if y == 1.0 and x <= 0.5 and 2.5 <= z <= 3.0]
    for name, sets in (("wheel", {"FLANGE": side, "TIP": [27]}), ("ring", {"RING_TOP": side})):
        components = "".join(_component(own, nodes) for own, nodes in {"LOW": held, "HIGH": held, **sets}.items())
        Path(f"{name}.cdb").write_text(Path(examples.hexarchivefile).read_text() + components)
    # Nastran and Abaqus: bricks.
    Path("wheel.bdf").write_text(
        bulk_data(solid).replace(
            "ENDDATA", f"SET1,8,{','.join(map(str, labels(solid.held[:7])))}\n,{labels(solid.held)[7]}\nENDDATA"
        )
    )
    op4.write("wheel.op4", {"KGG": solid.stiffness.toarray(), "MGG": solid.mass.toarray()})
    op4.write("blade.op4", {"KGG": solid.blade_stiffness.toarray()})
    Path("wheel.inp").write_text(deck(solid, solid.elements))
    for name, matrix, used in (
        ("wheel_STIF1", solid.stiffness, None),
        ("wheel_MASS1", solid.mass, None),
        ("blade_STIF1", solid.blade_stiffness, of_blade),
    ):
        Path(f"{name}.mtx").write_text(matrix_text(matrix, "matrix input", used or range(len(solid.positions))))
    names = {"__name__": "page"}
    found = []
    for number, (language, block) in enumerate(blocks_of(GUIDE)):
        if language == "python":
            exec(compile(block, f"{GUIDE.name}: block {number}", "exec"), names)
            found.append(names["sector"])
            assert found[-1].check["worst_relative_difference"] < 1e-6
    assert [sector.sectors for sector in found] == [24, 6, 12, 6, 6]
    # What the example of masses prints is what the page says.
    best = names["best"]
    printed = f"{best.normal_load_n:g} N per sector: P95 {best.value:.3e} m, 95 % bounds {best.lower:.3e} to {best.upper:.3e} m"
    assert printed in GUIDE.read_text(encoding="utf-8")
    # Units, ring and contact are those that the page says: half a millimetre squared is in contact.
    report = found[0].report
    assert [body["body"] for body in report["bodies"]] == ["blisk", "ring"]
    (surfaces,) = report["contact"]["surfaces"]
    assert (surfaces["first"], surfaces["second"]) == ("blisk.FLANGE", "ring.RING_TOP")
    assert surfaces["area_m2"] == pytest.approx(0.5e-3**2, rel=1e-9)


@pytest.mark.parametrize("code", ["ansys", "nastran", "abaqus", "arrays"])
def test_help_shows_every_keyword_of_a_maker(code):
    maker = getattr(blisk.Sector, f"from_{code}")
    parameters = inspect.signature(maker).parameters
    assert [name for name, own in parameters.items() if own.kind is own.VAR_KEYWORD] == []
    required = {name for name, own in parameters.items() if own.kind is own.KEYWORD_ONLY and own.default is own.empty}
    assert required == {"out", "sectors", "force", "observe"}
    assert (parameters["axis"].default, parameters["units"].default) == ("z", "m-kg-s")
    assert set(Keywords.__annotations__) == {own.name for own in dataclasses.fields(Wheel)} < set(parameters)
    # Positions as many as there are before the keywords.
    files = ["a file" for own in parameters.values() if own.kind is own.POSITIONAL_OR_KEYWORD]
    given = {"out": "o", "sectors": 6, "force": {}, "observe": {}}
    with pytest.raises(TypeError, match=f"from_{code}.*unexpected keyword argument 'axes'"):
        maker(*files, **given, axes="z")
    del given["sectors"]
    with pytest.raises(TypeError, match=f"from_{code}.*missing a required argument: 'sectors'"):
        maker(*files, **given)


def test_the_example_runs_unchanged_and_gives_the_bytes_of_the_command(tmp_path, program):
    example = ROOT / "python" / "examples" / "quickstart.py"
    ended = subprocess.run([sys.executable, str(example), str(tmp_path)], capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    assert re.search(r"^lowest P99: .* at \d+ N per sector$", ended.stdout, flags=re.MULTILINE), ended.stdout
    assert (tmp_path / "report.html").exists()
    # A first study is short, and nothing of it is to be explained.
    assert len([line for line in example.read_text().splitlines() if line]) <= 30
    assert not re.search("warning|remark", ended.stdout + ended.stderr, flags=re.IGNORECASE)
    assert blisk.Results(tmp_path / "ring").summary["warnings"] == []
    # The same study from a file, by the command.
    (tmp_path / "study.toml").write_text(blisk.Study(**study_of(example)).to_toml())
    ended = called("run", "study.toml", "--out", "by-command", command=program, cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    own, other = (
        {path.name: path.read_bytes() for path in (tmp_path / folder).glob("*.parquet")} for folder in ("ring", "by-command")
    )
    assert len(own) >= 5 and own == other


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
    # The keywords that makers of sectors share are known to the checker, by name and by type.
    (tmp_path / "wrong.py").write_text(
        "import blisk\n"
        'where = {"set": "9"}\n'
        'blisk.Sector.from_nastran("a", "b", out="c", sectors=6, force=where, observe=where, axis="x")\n'
        'blisk.Sector.from_nastran("a", "b", out="c", sectors=6, force=where, observe=where, axes="x")\n'
        'blisk.Sector.from_arrays(1, 1, 1, 1, out="c", sectors="6", force=where, observe=where)\n'
        'blisk.Sector.from_abaqus("a", "b", "c", out="c", force=where, observe=where)\n'
    )
    wrong = subprocess.run([*mypy[:-2], "wrong.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
    found = re.findall(r"^wrong.py:(\d+): error: .*\[(\S+)\]$", wrong.stdout, flags=re.MULTILINE)
    assert found == [("4", "call-arg"), ("5", "arg-type"), ("6", "call-arg")], wrong.stdout
    stubs = [sys.executable, "-m", "mypy.stubtest", "blisk._native"]
    same = subprocess.run(stubs, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert same.returncode == 0, same.stdout


def public():
    """Name and function of everything public that is called, and whose documentation its parameters are in."""
    for name in blisk.__all__:
        thing = getattr(blisk, name)
        if inspect.isfunction(thing):
            yield name, thing, thing.__doc__
        if not isinstance(thing, type) or thing.__module__ == "blisk._native":
            continue
        # Exceptions and answers come from the package; what has fields has their words.
        if not dataclasses.is_dataclass(thing) and thing in (blisk.Study, blisk.Results, blisk.Sector, blisk.Wheel):
            yield name, thing.__init__, thing.__doc__
        for own, value in vars(thing).items():
            method = getattr(value, "__func__", value)
            if not own.startswith("_") and inspect.isfunction(method):
                yield f"{name}.{own}", method, method.__doc__


def described(documentation):
    """The parameters that a documentation says something of: ``a``, ``b``: what they are."""
    lists = re.findall(r"((?:``\w+``,\s+)*``\w+``):\s+\S", documentation)
    return {name for names in lists for name in re.findall(r"``(\w+)``", names)}


def undescribed(function, documentation):
    """The parameters that the documentation does not describe, and what is returned where it does not say it."""
    parameters = set(inspect.signature(function).parameters) - {"self", "cls"}
    of_parameters, says_what, _ = documentation.partition("Returns ")
    missing = parameters - described(of_parameters)
    if function.__annotations__.get("return") not in (None, "None") and not says_what:
        missing.add("return")
    return missing


def test_everything_public_is_described():
    for name in blisk.__all__:
        if name.startswith("__"):
            continue
        thing = getattr(blisk, name)
        assert thing.__doc__, name
        for own, value in vars(thing).items() if isinstance(thing, type) else []:
            if not own.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{own}"


def test_every_parameter_and_what_is_returned_are_described():
    seen = {name: undescribed(function, documentation) for name, function, documentation in public()}
    assert {name: missing for name, missing in seen.items() if missing} == {}
    assert len(seen) >= 40 and {"run", "plan", "Study", "Results.best", "Sector.from_ansys", "Wheel.peaks"} < set(seen)
    # A parameter that is left out, or only mentioned, would be found.
    page = blisk.plan.__doc__
    for planted in (page.replace("``threads``: as", "As"), page.replace("``threads``: as", "With ``threads`` as")):
        assert undescribed(blisk.plan, planted) == {"threads"}
    assert undescribed(blisk.plan, page.replace("Returns", "Gives")) == {"return"}


def test_keys_of_answers_are_described(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = blisk.Study(**SMALL)
    results = blisk.run(study)
    answers = {
        blisk.plan: blisk.plan(study, pilot=2),
        blisk.compare: blisk.compare(results, percentile=90),
        blisk.optimum: blisk.optimum(study, (50, 150), percentile=90, resolution=0.5),
        blisk.estimate: blisk.estimate(study, 90, patterns=300, solves=60),
        blisk.status: blisk.status(results),
    }
    for function, answer in answers.items():
        assert set(answer) - described(function.__doc__) == set(), function.__name__
        # Units of what has one.
        for key, unit in (("_n", "N"), ("_s", "s"), ("per_second", "1/s")):
            if any(own.endswith(key) for own in answer):
                assert re.search(rf"\b{unit}\b", function.__doc__), (function.__name__, unit)
