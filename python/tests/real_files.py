"""Real files that no package installs, read and compared; by hand, as they have to be fetched first.

    python python/tests/real_files.py ANSYS EXUDYN PYNASTRAN

ANSYS is a clone of https://github.com/ansys/pymapdl-reader (MIT), EXUDYN one of https://github.com/jgerstmayr/EXUDYN
(BSD 3-Clause), PYNASTRAN one of https://github.com/SteveDoyle2/pyNastran (BSD 3-Clause). What is found is in
docs/import.md.

- Matrices of Abaqus (FORMAT=COORDINATE) of five blocks, as sectors of four: the bundle against a cyclic eigenproblem.
- An element file of Ansys: each element leaves a rigid motion without force, and has the nodes of the archive.
- A full file of a rotor of Ansys against the modes of its result file.
- The stiffness of NX Nastran (OUTPUT2) of solids, plates and bars against the displacements that it prints.
"""

import sys
import tempfile
from pathlib import Path

import numpy
from ansys.mapdl import reader
from ansys.mapdl.reader import examples

import blisk
from blisk._import import _abaqus, _ansys, _check, _nastran, _run
from blisk._import._run import Run


def blocks_of_abaqus(folder, work):
    for name in ("blockC3D4", "blockC3D8", "blockC3D10", "blockC3D20", "blockC3D20R"):
        deck = _abaqus.Deck(folder / f"{name}.inp")
        # The block lies along x, 1 x 1 x 4: a quarter about the edge y = z = 0, held at x = 0.
        held = [node for node, (x, y, z) in deck.positions.items() if x == 0.0 or y == z == 0.0]
        tip = max(deck.positions, key=lambda node: sum(deck.positions[node]))
        stiffness, mass = folder / f"{name}_STIF1.mtx", folder / f"{name}_MASS1.mtx"
        whole = _abaqus.matrices(deck, stiffness, None)
        blade = whole.keeping([at for at, (node, _) in enumerate(whole.rows) if min(deck.positions[node][1:]) > 0.4])
        entries = blade.stiffness.tocoo()
        with open(work / "blade.mtx", "w") as file:
            for i, j, value in zip(entries.row, entries.col, entries.data.tolist()):
                (a, b), (c, d) = blade.rows[i], blade.rows[j]
                file.write(f"{a},{b + 1}, {c},{d + 1}, {value!r}\n")
        sector = blisk.Sector.from_abaqus(
            folder / f"{name}.inp", stiffness, mass, blade_stiffness=work / "blade.mtx", out=work / name, sectors=4,
            axis="x", held=held, sets={"TIP": [tip]}, force={"set": "TIP", "component": "t"},
            observe={"name": "tip", "set": "TIP"},
        )  # fmt: skip
        check = sector.check
        print(f"{name}: {sector.dofs} dofs, {check['frequencies_compared']} frequencies of nodal diameters"
              f" {check['nodal_diameters']} within {check['worst_relative_difference']:.1e}")  # fmt: skip


def elements_of_ansys(path):
    file, archive = reader.read_binary(str(path)), reader.Archive(examples.hexarchivefile, parse_vtk=False)
    positions = dict(zip(archive.nnum.tolist(), archive.nodes[:, :3]))
    nodes_of = dict(zip(archive.enum.tolist(), ({int(node) for node in own[10:]} for own in archive.elem)))
    worst, count = 0.0, 0
    for index, number in enumerate(file.eeqv.tolist()):
        if number not in nodes_of:
            continue
        dofs, entries = file.read_element(index)
        nodes = [int(file.neqv[dof // 3]) for dof in dofs]
        assert set(nodes) == nodes_of[number], number
        stiffness = numpy.zeros((len(dofs), len(dofs)))
        stiffness[numpy.tril_indices(len(dofs))] = entries["stress"]
        stiffness = stiffness + numpy.tril(stiffness, -1).T
        for axis in numpy.eye(3):
            shift = [axis[dof % 3] for dof in dofs]
            turn = [numpy.cross(axis, positions[node])[dof % 3] for node, dof in zip(nodes, dofs)]
            worst = max(
                worst, *(abs(stiffness @ numpy.array(own)).max() / abs(stiffness).max() for own in (shift, turn))
            )
        count += 1
    assert count == 40 and worst < 1e-12, (count, worst)
    print(f"{path.name}: {count} elements, largest force of a rigid motion {worst:.1e} of the stiffness")


def rotor_of_ansys(full, rst):
    result = reader.read_binary(str(rst))
    elements = [[int(node) for node in own[10:]] for own in result.mesh.elem]
    own = Run("ansys", "", {}, elements, {}, _ansys.matrices(full))
    modes = []
    for index, hz in enumerate(result.time_values):
        nodes, shape = result.nodal_solution(index)
        modes.append((float(hz), dict(zip(nodes.tolist(), shape[:, :3].tolist()))))
    check = _check.modes_compared(own, (), modes, 1e-6, rst.name)
    print(f"{full.name}, {rst.name}: {check['modes_compared']} modes over {check['inner_rows']} rows within"
          f" {check['worst_relative_difference']:.1e}")  # fmt: skip


def solids_of_nastran(folder):
    # The same model twice: one run wrote its stiffness, the other one printed its displacements.
    rows, upper = _nastran.matrix(folder / "static_solid_shell_bar_kelm.op2", "KGG", "K")
    assert rows is None
    stiffness = _run.symmetric(upper, "KGG").toarray()
    # Grid points 22 to 25 are held, the rotations of 5 to 13, which solids alone hold, too.
    free = [row for row in range(126) if row % 6 < 3 or not 4 <= row // 6 <= 12]
    force, found = numpy.zeros(150), numpy.zeros(150)
    force[6 * 12 + 2] = 10000.0
    found[free] = numpy.linalg.solve(stiffness[numpy.ix_(free, free)], force[free])
    printed = numpy.full(150, numpy.nan)
    text = (folder / "static_solid_shell_bar.f06").read_text().partition("D I S P L A C E M E N T")[2]
    for line in text.splitlines()[:31]:
        words = line.split()
        if len(words) == 8 and words[1] == "G":
            printed[6 * int(words[0]) - 6 : 6 * int(words[0])] = [float(word) for word in words[2:]]
    moved = printed != 0.0
    assert moved.sum() == len(free) and (found[~moved] == 0.0).all()
    # Against the largest displacement, and against the largest rotation.
    off, size = (abs(own).reshape(25, 2, 3).max(axis=(0, 2)) for own in (found - printed, printed))
    print(f"{folder.name}: {len(free)} displacements of NX Nastran's stiffness within {(off / size).max():.1e} of the"
          " printed ones")  # fmt: skip


def main(ansys, exudyn, pynastran):
    ansys, exudyn = Path(ansys) / "tests" / "testfiles", Path(exudyn) / "main" / "pythonDev" / "TestModels" / "testData"
    with tempfile.TemporaryDirectory() as work:
        blocks_of_abaqus(exudyn / "abaqus", Path(work))
    elements_of_ansys(ansys / "file.emat")
    rotor_of_ansys(ansys / "sparse.full", exudyn / "rotorAnsys.rst")
    solids_of_nastran(Path(pynastran) / "models" / "sol_101_elements")


if __name__ == "__main__":
    main(*sys.argv[1:])
