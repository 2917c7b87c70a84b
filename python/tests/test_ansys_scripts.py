"""The macro and the script that write what an import needs, as far as they can be tried without Ansys."""

import importlib.util
import re
import shutil

import numpy
import pytest
import scipy.io
import scipy.sparse
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from conftest import ROOT
from solid import Solid, of_wheel

import blisk

FOLDER = ROOT / "studies" / "ansys"
MACRO = (FOLDER / "export_sector.mac").read_text()


def commands(text):
    """The command lines of a macro, without comments."""
    return [line.strip() for line in text.splitlines() if line.strip() and not line.startswith("!")]


def test_macro_and_script_give_the_same_commands():
    script = load()
    own = "\n".join(commands(MACRO))
    for part in (script.SECTOR, script.BLADE):
        assert part in own
    assert own.index(script.SECTOR) < own.index(script.BLADE)


def test_the_import_file_of_the_macro_imports_what_hbmat_writes(tmp_path):
    # The lines after *VWRITE, with what Ansys would put into them; the files as its manuals describe them.
    solid = Solid()
    lines = re.findall(r"^\*VWRITE(,ARG1)?\n(.*)$", MACRO, flags=re.MULTILINE)
    assert len(lines) == MACRO.count("*VWRITE\n") + MACRO.count("*VWRITE,")
    written = [text.replace("%I", "6") if arguments else text for arguments, text in lines]
    (tmp_path / "wheel.toml").write_text("\n".join(written) + "\n")
    assert all("%" not in line and len(line) < 128 for line in written)
    free = [row for row in range(3 * len(solid.positions)) if row // 3 not in solid.held]
    own = numpy.flatnonzero(abs(solid.blade_stiffness).sum(axis=1)).tolist()
    for name, matrix, rows in (
        ("stiffness", solid.stiffness, free),
        ("mass", solid.mass, free),
        ("blade", solid.blade_stiffness, own),
    ):
        # SciPy writes a general matrix: it is told to be one triangle of a symmetric one.
        path = tmp_path / f"{name}.matrix"
        scipy.io.hb_write(path, scipy.sparse.tril(matrix[rows][:, rows]).tocsc())
        path.write_text(path.read_text().replace("RUA", "RSA"))
        table = [f"{at:8d} {row // 3 + 1:8d}  U{'XYZ'[row % 3]}" for at, row in enumerate(rows, start=1)]
        (tmp_path / f"{name}.mapping").write_text("\n".join(["Matrix Eqn   Node     DOF", *table]) + "\n")
    (tmp_path / "wheel.cdb").write_text(archive(solid))
    sector = blisk.Sector.from_import_file(tmp_path / "wheel.toml", tmp_path / "bundle", frequencies=6)
    found = of_wheel(sector.report["frequencies_hz"], 6)
    assert numpy.allclose(found[:12], solid.wheel_hz()[:12], rtol=1e-6, atol=0)
    # Which names the macro uses for files, it writes.
    for name in re.findall(r'"(\w+)\.(?:matrix|mapping)"', "\n".join(written)):
        assert f"HBMAT,{name},matrix,,ASCII," in MACRO


def archive(solid):
    """Nodes, elements and components as ``CDWRITE`` writes them."""
    lines = [
        "/PREP7",
        f"ET, 1,185\nNBLOCK,6,SOLID,{len(solid.positions):10d},{len(solid.positions):10d}",
        "(3i9,6e21.13)",
    ]
    for number, xyz in enumerate(solid.positions, start=1):
        lines.append(f"{number:9d}{0:9d}{0:9d}" + "".join(f"{x:21.13E}" for x in xyz))
    count = len(solid.elements)
    lines += ["N,R5.3,LOC,       -1,", f"EBLOCK,19,SOLID,{count:10d},{count:10d}", "(19i9)"]
    for number, element in enumerate(solid.elements, start=1):
        head = [1, 1, 1, 1, 0, 0, 0, 0, 8, 0, number]
        lines.append("".join(f"{own:9d}" for own in [*head, *(node + 1 for node in element)]))
    lines.append("       -1")
    for name, nodes in (("LOW", solid.low), ("HIGH", solid.high), ("TIP", [solid.tip])):
        lines += [f"CMBLOCK,{name:<8},NODE,{len(nodes):8d}", "(8i10)"]
        lines += ["".join(f"{node + 1:10d}" for node in nodes[at : at + 8]) for at in range(0, len(nodes), 8)]
    return "\n".join([*lines, "FINISH"]) + "\n"


def load():
    """The script as a module."""
    spec = importlib.util.spec_from_file_location("pymapdl_sector", FOLDER / "pymapdl_sector.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Session:
    """Stands for a session of PyMAPDL: it notes the commands and hands out the files of the beam."""

    def __init__(self):
        self.commands = []

    def run(self, command):
        self.commands.append(command)

    def download(self, name, target_dir):
        whose = {"wheel.cdb": None, "wheel.full": examples.fullfile, "blade.full": examples.fullfile}
        source = {**whose, "wheel.rst": examples.rstfile}[name]
        target = f"{target_dir}/{name}"
        if source is not None:
            shutil.copy(source, target)
            return
        # The beam with the components that the script wants. Both faces are the held end: blades alone.
        held = sorted({int(node) for node, _ in reader.read_binary(examples.fullfile).const})
        text = open(examples.hexarchivefile).read()
        for component, nodes in (("LOW", held), ("HIGH", held), ("TIP", [27])):
            text += f"CMBLOCK,{component:<8},NODE,{len(nodes):8d}\n(8i10)\n"
            text += "".join(
                "".join(f"{node:10d}" for node in nodes[at : at + 8]) + "\n" for at in range(0, len(nodes), 8)
            )
        with open(target, "w") as file:
            file.write(text)


def test_the_script_makes_a_sector_of_what_a_session_hands_out(tmp_path):
    session, script = Session(), load()
    original = blisk.Sector.from_ansys
    # The script turns about z, and nodes of the beam lie on it: it is turned about x here.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(blisk.Sector, "from_ansys", lambda *own, **more: original(*own, **more, axis="x"))
        sector = script.sector(session, 5, tmp_path)
    assert sector.check["result_file"]["modes_compared"] == 6
    assert sector.check["worst_relative_difference"] < 1e-9
    assert session.commands[2] == "CDWRITE,DB,wheel,cdb" and session.commands.count("SOLVE") == 2
