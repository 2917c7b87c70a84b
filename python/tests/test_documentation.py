"""What the pages show is run, and the stubs say what is there."""

import dataclasses
import importlib.metadata
import inspect
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib
import numpy
import pytest
import scipy.sparse
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from conftest import EXAMPLES, ROOT, SMALL, called, study_of
from pyyeti.nastran import op4
from scipy.linalg import eigh
from solid import Solid
from test_ansys_scripts import archive
from test_sector import bulk_data, deck, labels, matrix_text

import blisk
from blisk._import import _ansys
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


class ResultOfAnsys:
    """An ``.rst`` file of the sector alone as ansys-mapdl-reader gives it, in mm."""

    def __init__(self, solid, free):
        squares, shapes = eigh(*(own[free][:, free].toarray() for own in (solid.stiffness, solid.mass)), subset_by_index=[0, 11])
        self.time_values = numpy.sqrt(abs(squares)) / (2 * numpy.pi)
        self.shapes = numpy.zeros((12, 3 * len(solid.positions)))
        self.shapes[:, free] = shapes.T
        numbers = numpy.arange(1, len(solid.positions) + 1)
        self._resultheader, self.mesh = {"kan": 2}, SimpleNamespace(nnum=numbers)

    def nodal_solution(self, index):
        return self.mesh.nnum, self.shapes[index].reshape(-1, 3)


def full_of_ansys(matrices, held):
    """A ``.full`` file as ansys-mapdl-reader gives it, in mm, t and N: upper triangles, and held directions named."""
    nodes = matrices[0].shape[0] // 3
    dofs = numpy.array([(node + 1, direction) for node in range(nodes) for direction in range(3)])
    const = numpy.array([(node + 1, direction) for node in held for direction in range(3)])
    upper = [scipy.sparse.triu(1e-3 * own).tocsc() for own in matrices]
    return SimpleNamespace(_header={"ncefull": 0}, const=const, load_km=lambda: (dofs, *upper))


def test_the_script_from_files_of_ansys_to_the_best_load_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    block = next(block for language, block in blocks_of(GUIDE) if language == "python")
    assert len(block.splitlines()) <= 35
    # A wheel of 24 sectors with a ring under its flange, in mm, t and N. Matrices of whole files of Ansys are made.
    solid = Solid(sectors=24, with_ring=True)
    free = [row for row in range(3 * len(solid.positions)) if row // 3 not in solid.held]
    mesh = archive(SimpleNamespace(**{**vars(solid), "positions": 1e3 * solid.positions}))
    sets = {"RING": solid.ring, "FLANGE": solid.landing, "RING_TOP": solid.ring_top}
    Path("wheel.cdb").write_text(mesh + "".join(_component(name, [node + 1 for node in own]) for name, own in sets.items()))
    files = {
        "wheel.full": full_of_ansys((solid.stiffness, solid.mass), solid.held),
        "blade.full": full_of_ansys((solid.blade_stiffness, 0 * solid.mass), solid.held),
        "wheel.rst": ResultOfAnsys(solid, free),
    }
    monkeypatch.setattr(_ansys, "reader", lambda: SimpleNamespace(Archive=reader.Archive, read_binary=files.__getitem__))
    names = {"__name__": "page"}
    exec(compile(block, f"{GUIDE.name}: first block", "exec"), names)
    sector, best, loads = names["sector"], names["best"], names["loads"]
    assert (sector.sectors, sector.check["worst_relative_difference"] < 1e-6) == (24, True)
    assert sector.check["result_file"]["modes_compared"] >= 3
    assert [own["body"] for own in sector.report["bodies"]] == ["blisk", "ring"] and sector.report["contact"]["pairs"] == 6
    # The rule of the page of bundles: from 1 to 1000 times the force, a factor of 3 apart.
    assert loads[0] == names["force_n"] and 300 < loads[-1] / loads[0] <= 1000 and loads[1] == 3 * loads[0]
    assert best.normal_load_n in loads and best.lower is not None
    printed = capsys.readouterr().out
    print(printed)
    # What was compared stands in the report.
    assert re.search(r"^compared: \d+ frequencies of nodal diameters 0, 1, .* are within \S+e-\d\d of a cyclic", printed, re.M)
    assert re.search(r"^compared: stiffness and mass give \d+ modes of wheel.rst their frequencies within", printed, re.M)
    assert "P95" in printed and Path("results", "wheel-optimum").is_dir() and Path("results", "wheel").is_dir()
    # The table below the script names every component that the script or the blade's run asks for.
    table = GUIDE.read_text(encoding="utf-8").partition("| component in Ansys |")[2].partition("\n\n")[0]
    assert set(re.findall(r"CM,(\w+),", table)) == {"RING", "FLANGE", "RING_TOP", "TIP", "BLADE"}


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
    # The first one is run by the test above, with files of its own.
    blocks = [block for language, block in blocks_of(GUIDE) if language == "python"]
    for number, block in enumerate(blocks[1:], start=1):
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


def test_cut_faces_from_k0_and_kc_have_the_frequencies_of_the_wheel():
    """The block of the page against ``K0 + Kc e^(i a h) + Kc^T e^(-i a h)``, where the block makes a sector with two faces."""
    (block,) = [text for language, text in blocks_of(ROOT / "docs" / "sector-bundle.md") if language == "python"]
    spring = numpy.array([[3.0, -3.0, 0.0], [-3.0, 3.0, 0.0], [0.0, 0.0, 0.0]])
    towards = numpy.array([[0.0, 0.0, 0.0], [0.0, 0.7, 0.1], [0.0, 0.1, 0.4]])
    names = {"K0": spring + numpy.diag([0.0, 5.0, 2.0]) + 2.0 * towards, "Kc": -towards}
    names |= {"M0": numpy.diag([1.0, 2.0, 0.5]), "blade0": spring}
    exec(compile(block, "sector-bundle.md", "exec"), names)
    assert names["mass"].shape == names["blade_stiffness"].shape == names["stiffness"].shape == (5, 5)
    assert not names["blade_stiffness"][3:].any() and not names["mass"][3:].any()
    for phase in (0.0, 0.9, 2.4, numpy.pi):
        turned = numpy.vstack([numpy.eye(3), numpy.exp(1j * phase) * numpy.eye(3)[[1, 2]]])
        of_sector = eigh(turned.conj().T @ names["stiffness"] @ turned, names["M0"], eigvals_only=True)
        coupled = names["Kc"] * numpy.exp(1j * phase)
        of_wheel = eigh(names["K0"] + coupled + coupled.conj().T, names["M0"], eigvals_only=True)
        assert of_sector == pytest.approx(of_wheel, rel=1e-12)


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
    example = EXAMPLES / "quickstart.py"
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
    # The package that reads Ansys' files, which an example imports, has no types.
    config.write_text("[mypy]\nstrict = true\n[mypy-ansys.*]\nignore_missing_imports = true\n")
    example = shutil.copy(EXAMPLES / "quickstart.py", tmp_path)
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
