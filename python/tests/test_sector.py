"""Sectors from other codes: their frequencies against those of whole wheels and of the codes' own files."""

import importlib
import json
import math
import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import meshio
import numpy
import pytest
import pyyeti
import scipy.sparse
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from conftest import ROOT, called
from pyyeti.nastran import op4
from scipy.linalg import eigh
from solid import Solid, assembled, brick, of_wheel

import blisk
from blisk._import import _ansys, _nastran
from blisk._import._run import Matrices, Run

matplotlib.use("Agg")
CCX = ROOT / "tests" / "data" / "calculix_wheel"
WORDS = {"force": {"set": "TIP", "component": "t"}, "observe": {"name": "tip", "set": "TIP"}}


@pytest.fixture(scope="module")
def solid():
    return Solid()


@pytest.fixture(scope="module")
def wheel_hz(solid):
    return solid.wheel_hz()


def has_the_frequencies_of(sector, wheel_hz, tolerance=1e-9):
    """Of the whole wheel, as far as every nodal diameter has been asked for."""
    by_diameter = sector.report["frequencies_hz"]
    found = of_wheel(by_diameter, sector.sectors)
    known = min(own[-1] for own in by_diameter)
    compared = int((found <= known).sum())
    assert compared >= 12
    assert numpy.allclose(found[:compared], wheel_hz[:compared], rtol=tolerance, atol=0)
    assert sector.check["worst_relative_difference"] < 1e-6
    assert sector.check["nodal_diameters"] == list(range(sector.sectors // 2 + 1))


def labels(nodes):
    """Node numbers of a code, which leave some out."""
    return [10 * node + 7 for node in nodes]


# Arrays and meshes


def test_arrays_make_a_sector_with_the_frequencies_of_the_whole_wheel(solid, wheel_hz, tmp_path):
    sector = blisk.Sector.from_arrays(
        solid.stiffness, solid.mass, solid.blade_stiffness, solid.positions, out=tmp_path / "bundle", sectors=6,
        held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS,
    )  # fmt: skip
    has_the_frequencies_of(sector, wheel_hz)
    assert (sector.name, sector.sectors, sector.dofs) == ("wheel", 6, 3 * (len(solid.positions) - len(solid.held)))
    assert sector.report["bodies"][0]["cyclic_node_pairs"] == 4
    # What was written makes the same bundle by the command.
    ended = called(
        "import", tmp_path / "bundle" / "import" / "import.toml", "--out", tmp_path / "again", "--frequencies", 6
    )
    assert ended.returncode == 0, ended.stderr
    for name in ("K.mtx", "M.mtx", "K_blade.mtx", "dofs.csv", "cyclic.csv", "force.csv", "frequencies.csv"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "bundle" / name).read_bytes()


@pytest.mark.parametrize("axis", ["x", "y"])
def test_the_axis_may_be_another_one(solid, wheel_hz, tmp_path, axis):
    # The solid with its axis along x or y: coordinates and rows change places.
    turn = {"x": [2, 0, 1], "y": [1, 2, 0]}[axis]
    rows = [3 * node + turn[direction] for node in range(len(solid.positions)) for direction in range(3)]
    moved = [matrix[rows][:, rows] for matrix in (solid.stiffness, solid.mass, solid.blade_stiffness)]
    sector = blisk.Sector.from_arrays(
        *moved, solid.positions[:, turn], out=tmp_path, sectors=6, axis=axis, held=[node + 1 for node in solid.held],
        sets={"TIP": [solid.tip + 1]}, **WORDS,
    )  # fmt: skip
    has_the_frequencies_of(sector, wheel_hz)


def test_millimetres_and_tonnes_are_units(solid, wheel_hz, tmp_path):
    sector = blisk.Sector.from_arrays(
        1e-3 * solid.stiffness, 1e-3 * solid.mass, 1e-3 * solid.blade_stiffness, 1e3 * solid.positions, out=tmp_path,
        sectors=6, units="mm-t-s", held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS,
    )  # fmt: skip
    has_the_frequencies_of(sector, wheel_hz)


def test_a_mesh_of_meshio_with_a_ring_and_a_contact(tmp_path):
    solid = Solid(with_ring=True)
    sets = {"TIP": [solid.tip], "RING": solid.ring, "LANDING": solid.landing, "RING_TOP": solid.ring_top}
    mesh = meshio.Mesh(solid.positions, [("hexahedron", solid.elements)], point_sets=sets)
    # As it comes back from a file of Abaqus.
    meshio.write(tmp_path / "mesh.inp", mesh)
    sector = blisk.Sector.from_arrays(
        solid.stiffness, solid.mass, solid.blade_stiffness, meshio.read(tmp_path / "mesh.inp"), out=tmp_path / "bundle",
        sectors=6, held=[node + 1 for node in solid.held], ring={"set": "RING", "grounding_hz": 100.0},
        contact={"blisk": "LANDING", "ring": "RING_TOP"}, **WORDS,
    )  # fmt: skip
    has_the_frequencies_of(sector, solid.wheel_hz(ring_grounding_hz=100.0))
    assert [own["cyclic_node_pairs"] for own in sector.report["bodies"]] == [4, 4]
    assert sector.report["contact"]["pairs"] == 6
    inner, outer = 0.15, 0.2
    area = 3 * 0.5 * math.sin(math.pi / 9) * (outer**2 - inner**2)
    assert math.isclose(sector.report["contact"]["area_m2"], area, rel_tol=1e-9)


def test_a_sector_is_the_model_of_a_study(solid, small, tmp_path):
    sector = blisk.Sector.from_arrays(
        solid.stiffness, solid.mass, solid.blade_stiffness, solid.positions, out=tmp_path / "bundle", sectors=6,
        held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS,
    )  # fmt: skip
    small["model"] = sector.model
    small["sweep"]["normal_load_n"] = ["free"]
    del small["contact"]
    results = blisk.run(blisk.Study(**small), out=tmp_path / "results")
    # The tuned peak lies at a frequency of the nodal diameter of the engine order.
    tuned = results.scenarios.rows()[0]
    nearest = min(abs(hz / tuned["tuned_frequency_hz"] - 1) for hz in sector.frequencies_hz()[2])
    assert nearest < 1e-3
    assert blisk.Sector.from_bundle(sector.folder).frequencies_hz() == sector.report["frequencies_hz"]
    lines = sector.plot(2).get_lines()
    assert [list(line.get_ydata()) for line in lines] == [
        [own[mode] for own in sector.frequencies_hz(2)] for mode in (0, 1)
    ]


def test_rows_that_a_penalty_holds_and_empty_rows_are_left_out():
    stiffness = scipy.sparse.csr_matrix(numpy.diag([2.0, 1e36, 0.0, 3.0]))
    kept = Matrices([(1, 0), (1, 1), (2, 0), (2, 1)], stiffness, stiffness).without_held(())
    assert kept.rows == [(1, 0), (2, 1)] and (kept.mass.toarray() == numpy.diag([2.0, 3.0])).all()
    with pytest.raises(blisk.InputError, match="no row that is free"):
        kept.without_held([1, 2])


# Abaqus


def deck(solid, elements, in_parts=False):
    """An input file as Abaqus/CAE writes it: one part and one instance, or flat."""
    lines = ["*Heading", "** made by a test"]
    if in_parts:
        lines += ["*Part, name=wheel", "*End Part", "*Assembly, name=Assembly", "*Instance, name=wheel-1, part=wheel"]
    lines.append("*Node")
    lines += [
        f"{label}, {x!r}, {y!r}, {z!r}"
        for label, (x, y, z) in zip(labels(range(len(solid.positions))), solid.positions.tolist())
    ]
    lines.append("*Element, type=C3D8")
    for number, element in enumerate(elements, start=1):
        words = [number, *labels(element)]
        lines += [", ".join(map(str, words[:6])) + ",", "   " + ", ".join(map(str, words[6:]))]
    lines.append("*Nset, nset=Bore")
    lines.append(", ".join(map(str, labels(solid.held))))
    lines += ["*Nset, nset=Tip, generate", f"{labels([solid.tip])[0]}, {labels([solid.tip])[0]}, 1"]
    if in_parts:
        lines += ["*End Instance", "*End Assembly"]
    lines += ["*Material, name=steel", "*Density", "7800.,", "*Step", "*MATRIX GENERATE, STIFFNESS, MASS=CONSISTENT"]
    return "\n".join([*lines, "*End Step"]) + "\n"


def matrix_text(matrix, layout, used):
    """A matrix in a format of ``*MATRIX OUTPUT``; ``used``: the nodes of its elements."""
    entries = scipy.sparse.coo_matrix(matrix)
    place = {node: at for at, node in enumerate(sorted(used))}
    lines = []
    for row, column, value in zip(entries.row.tolist(), entries.col.tolist(), entries.data.tolist()):
        if layout == "coordinate":
            i, j = (3 * place[own // 3] + own % 3 + 1 for own in (row, column))
            lines.append(f"{i} {j}  {value:.15e}")
        elif row >= column:
            (a, b), (c, d) = ((labels([own // 3])[0], own % 3 + 1) for own in (row, column))
            lines.append(
                f"{a},{b}, {c},{d}, {value:.15e}" if layout == "matrix input" else f"{a} {b} {c} {d} {value:.15e}"
            )
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("layout", ["coordinate", "matrix input", "labels"])
def test_every_text_format_of_abaqus_is_read(solid, wheel_hz, tmp_path, layout):
    whole = range(len(solid.positions))
    own = [element for element, is_blade in zip(solid.elements, solid.blade) if is_blade]
    (tmp_path / "wheel.inp").write_text(deck(solid, solid.elements, in_parts=layout == "coordinate"))
    (tmp_path / "blade.inp").write_text(deck(solid, own))
    of_blade = {node for element in own for node in element}
    for name, matrix, used in (
        ("wheel_STIF1", solid.stiffness, whole),
        ("wheel_MASS1", solid.mass, whole),
        ("blade_STIF1", solid.blade_stiffness, of_blade),
    ):
        (tmp_path / f"{name}.mtx").write_text(matrix_text(matrix, layout, used))
    sector = blisk.Sector.from_abaqus(
        tmp_path / "wheel.inp", tmp_path / "wheel_STIF1.mtx", tmp_path / "wheel_MASS1.mtx", out=tmp_path / "bundle",
        blade_stiffness=tmp_path / "blade_STIF1.mtx", blade_inp=tmp_path / "blade.inp", sectors=6,
        held="BORE" if layout == "labels" else labels(solid.held), **WORDS,
    )  # fmt: skip
    has_the_frequencies_of(sector, wheel_hz)
    assert sector.report["observed"] == [["tip", labels([solid.tip])[0]]]
    assert sector.report["blade_dofs"] == 24


def test_a_ring_with_files_of_its_own(tmp_path):
    # Blisk and ring are two jobs with the same node numbers, which are raised for the ring.
    solid = Solid(with_ring=True)
    jobs = {"blisk": [e for e in solid.elements if e[0] not in solid.ring]}
    jobs["ring"] = [e for e in solid.elements if e[0] in solid.ring]
    jobs["blade"] = [element for element, is_blade in zip(solid.elements, solid.blade) if is_blade]
    for name, own in jobs.items():
        used = sorted({node for element in own for node in element})
        stiffness, mass = assembled(solid.positions, own)
        lines = [
            "*NODE",
            *(f"{at + 1}, {x!r}, {y!r}, {z!r}" for at, (x, y, z) in enumerate(solid.positions[used].tolist())),
        ]
        number = {node: at + 1 for at, node in enumerate(used)}
        for at, element in enumerate(own, start=1):
            lines += ["*ELEMENT, TYPE=C3D8", ", ".join(map(str, [at, *(number[node] for node in element)]))]
        sets = {"LANDING": solid.landing, "RING_TOP": solid.ring_top, "BORE": solid.held, "TIP": [solid.tip]}
        for set_name, nodes in sets.items():
            there = [str(number[node]) for node in nodes if node in number]
            lines += [f"*NSET, NSET={set_name}", ", ".join(there)] if there else []
        (tmp_path / f"{name}.inp").write_text("\n".join(lines) + "\n")
        # The blade's nodes have the numbers that they have in the blisk.
        whose = sorted({node for element in jobs["blisk" if name == "blade" else name] for node in element})
        for kind, matrix in (("STIF1", stiffness), ("MASS1", mass)):
            entries = scipy.sparse.tril(matrix).tocoo()
            text = ""
            for i, j, value in zip(entries.row.tolist(), entries.col.tolist(), entries.data.tolist()):
                text += f"{whose.index(i // 3) + 1},{i % 3 + 1}, {whose.index(j // 3) + 1},{j % 3 + 1}, {value!r}\n"
            (tmp_path / f"{name}_{kind}.mtx").write_text(text)

    def files(name):
        own = {"inp": f"{name}.inp", "stiffness": f"{name}_STIF1.mtx", "mass": f"{name}_MASS1.mtx"}
        return {key: tmp_path / file for key, file in own.items()}

    sector = blisk.Sector.from_abaqus(
        **files("blisk"), blade_stiffness=tmp_path / "blade_STIF1.mtx", held="BORE", out=tmp_path / "bundle", sectors=6,
        ring={**files("ring"), "grounding_hz": 100.0}, contact={"blisk": "LANDING", "ring": "RING_TOP"}, **WORDS,
    )  # fmt: skip
    has_the_frequencies_of(sector, solid.wheel_hz(ring_grounding_hz=100.0))
    assert [own["body"] for own in sector.report["bodies"]] == ["blisk", "ring"]
    assert sector.report["contact"]["pairs"] == 6
    with pytest.raises(ValueError, match="ring has inp; accepted: inp, stiffness, mass, or `set`"):
        blisk.Sector.from_abaqus(
            **files("blisk"), blade_stiffness=tmp_path / "blade_STIF1.mtx", out=tmp_path / "out", sectors=6,
            ring={"inp": tmp_path / "ring.inp"}, **WORDS,
        )  # fmt: skip


def test_what_abaqus_writes_and_cannot_be_used_is_refused(solid, tmp_path):
    (tmp_path / "wheel.inp").write_text(deck(solid, solid.elements))
    (tmp_path / "k.mtx").write_text(matrix_text(solid.stiffness, "labels", range(len(solid.positions))))

    def refusal(deck_text=None, mass_text=None):
        (tmp_path / "other.inp").write_text(deck_text or (tmp_path / "wheel.inp").read_text())
        (tmp_path / "m.mtx").write_text(mass_text or (tmp_path / "k.mtx").read_text())
        with pytest.raises(blisk.InputError) as refused:
            blisk.Sector.from_abaqus(
                tmp_path / "other.inp", tmp_path / "k.mtx", tmp_path / "m.mtx", out=tmp_path / "out", sectors=6,
                blade_stiffness=tmp_path / "k.mtx", **WORDS,
            )  # fmt: skip
        assert refused.value.exit_code == 4
        return str(refused.value)

    own = (tmp_path / "wheel.inp").read_text()
    moved = own.replace("*Node\n", "*Instance, name=a, part=b\n0., 0., 1.\n*Node\n")
    assert "the instance is moved" in refusal(moved)
    assert "*INCLUDE is not followed" in refusal(own + "*INCLUDE, INPUT=more.inp\n")
    assert "type S4R" in refusal(own.replace("C3D8", "S4R"))
    assert "internal nodes" in refusal(mass_text="-1,1, -1,1, 2.0\n")
    assert "the dof 4" in refusal(mass_text="7,4, 7,4, 2.0\n")
    assert "columns" in refusal(mass_text="1 2\n")


# Nastran


def bulk_data(solid):
    """Bulk data in free and large fields; sets by number."""
    lines = ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,2.0+11,,0.3,7800.", "PSOLID,1,1"]
    for label, (x, y, z) in zip(labels(range(len(solid.positions))), solid.positions.tolist()):
        lines += [f"GRID*   {label:16d}{'':16}{x:16.9E}{y:16.9E}*", f"*       {z:16.9E}"]
    for number, element in enumerate(solid.elements, start=1):
        words = [str(own) for own in labels(element)]
        lines += [f"CHEXA,{number},1,{','.join(words[:6])}", f",{','.join(words[6:])}"]
    lines += [f"SET1,9,{labels([solid.tip])[0]}", "ENDDATA"]
    return "\n".join(lines) + "\n"


def of_six(matrix):
    """The same matrix with rows of rotations, which are empty."""
    size = matrix.shape[0] // 3
    rows = numpy.array([6 * node + direction for node in range(size) for direction in range(3)])
    own = scipy.sparse.coo_matrix(matrix)
    return scipy.sparse.coo_matrix((own.data, (rows[own.row], rows[own.col])), shape=(6 * size, 6 * size))


def punched(name, matrix):
    """DMIG entries as Nastran punches them: the lower triangle, by columns."""
    lines = [f"DMIG    {name:<8}       0       6       2       0"]
    own = scipy.sparse.tril(matrix).tocsc()
    for column in range(own.shape[1]):
        entries = range(own.indptr[column], own.indptr[column + 1])
        if entries:
            lines.append(f"DMIG*   {name:<16}{labels([column // 3])[0]:16d}{column % 3 + 1:16d}")
        for at in entries:
            row, value = own.indices[at], own.data[at]
            lines.append(f"*       {labels([row // 3])[0]:16d}{row % 3 + 1:16d}{value:16.9E}".replace("E", "D"))
    return "\n".join(lines) + "\n"


NASTRAN = {"force": {"set": "9", "component": "t"}, "observe": {"name": "tip", "set": "9"}}


@pytest.mark.parametrize("binary", [True, False])
def test_output4_of_nastran_is_read(solid, wheel_hz, tmp_path, binary):
    (tmp_path / "wheel.bdf").write_text(bulk_data(solid))
    k, m, blade = (of_six(matrix).toarray() for matrix in (solid.stiffness, solid.mass, solid.blade_stiffness))
    op4.write(tmp_path / "wheel.op4", {"KGG": k, "MGG": m}, binary=binary, digits=16)
    op4.write(tmp_path / "blade.op4", {"KGG": blade}, binary=binary, digits=16)
    sector = blisk.Sector.from_nastran(
        tmp_path / "wheel.bdf", tmp_path / "wheel.op4", blade=tmp_path / "blade.op4", out=tmp_path / "bundle", sectors=6,
        held=labels(solid.held), **NASTRAN,
    )  # fmt: skip
    # Positions have ten digits here.
    has_the_frequencies_of(sector, wheel_hz, 1e-7)
    assert sector.report["blade_dofs"] == 24


def test_a_punch_file_of_nastran_is_read(solid, wheel_hz, tmp_path):
    (tmp_path / "wheel.bdf").write_text(bulk_data(solid))
    (tmp_path / "wheel.pch").write_text(punched("KAAX", solid.stiffness) + punched("MAAX", solid.mass))
    (tmp_path / "blade.pch").write_text(punched("KAAX", solid.blade_stiffness))
    sector = blisk.Sector.from_nastran(
        tmp_path / "wheel.bdf", tmp_path / "wheel.pch", blade=tmp_path / "blade.pch", out=tmp_path / "bundle", sectors=6,
        held=labels(solid.held), **NASTRAN,
    )  # fmt: skip
    # Matrices have ten digits there.
    has_the_frequencies_of(sector, wheel_hz, 1e-6)


def printed_hz(path, count):
    """The first frequencies of the tables of eigenvalues that Nastran prints."""
    found = []
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if len(words) == 7 and words[0] == str(len(found) + 1) == words[1] and "E" in words[2]:
            found.append(float(words[4]))
    return found[:count]


def test_matrices_of_real_files_of_nastran_have_the_printed_frequencies():
    # A modal stiffness holds the squares of the frequencies; the models have no solid elements.
    folder = Path(pyyeti.__file__).parent / "tests" / "nas2cam_extseout"
    for file, name, printed, own in (
        ("full.op2", "KHH", "full.out", slice(6, 50)),
        ("inboard.op4", "KXX", "inboard.out", slice(24, 27)),
    ):
        rows, stiffness = _nastran.matrix(folder / file, name, "K")
        assert rows is None
        hz = numpy.sqrt(scipy.sparse.csr_matrix(stiffness).diagonal()[own]) / (2 * math.pi)
        expected = printed_hz(folder / printed, 50)[6:] if file == "full.op2" else printed_hz(folder / printed, 3)
        assert len(hz) == len(expected) and numpy.allclose(hz, expected, rtol=1e-6, atol=0), (hz, expected)
    rows, identity = _nastran.matrix(folder.parent / "nastran_dmig_data" / "matrix_factory.pch", "IDENT", "K")
    assert len(rows) == len(identity) and (numpy.asarray(identity) == numpy.eye(len(rows))).all()


def test_what_nastran_writes_and_cannot_be_used_is_refused(solid, tmp_path):
    (tmp_path / "wheel.bdf").write_text(bulk_data(solid))
    k = solid.stiffness.toarray()

    def refusal(matrices, **more):
        op4.write(tmp_path / "own.op4", matrices)
        with pytest.raises(blisk.InputError) as refused:
            blisk.Sector.from_nastran(
                tmp_path / "wheel.bdf", tmp_path / "own.op4", blade=tmp_path / "own.op4", out=tmp_path / "out", sectors=6,
                **NASTRAN, **more,
            )  # fmt: skip
        return str(refused.value)

    assert "KAA, KGG" in refusal({"KGG": k, "KAA": k, "MGG": k})
    assert f"{3 * len(solid.positions) - 1} rows" in refusal({"KGG": k[1:, 1:], "MGG": k})
    turning = of_six(solid.stiffness).toarray()
    turning[3, 3] = 1.0
    assert "rotations with stiffness" in refusal({"KGG": turning, "MGG": turning})
    lopsided = k.copy()
    lopsided[0, 1] += 1e9
    assert "not symmetric" in refusal({"KGG": lopsided, "MGG": k})


# Ansys


@pytest.fixture(scope="module")
def beam():
    """Free rows of the beam of ansys-mapdl-reader, its matrices, held nodes and positions."""
    full = reader.read_binary(examples.fullfile)
    dofs, k, m = full.load_km()
    held = set(map(tuple, full.const.tolist()))
    free = [row for row, dof in enumerate(dofs.tolist()) if tuple(dof) not in held]
    whole = [(own + scipy.sparse.triu(own, 1).T).tocsr()[free][:, free] for own in (k, m)]
    archive = reader.Archive(examples.hexarchivefile, parse_vtk=False)
    positions = dict(zip(archive.nnum.tolist(), archive.nodes[:, :3].tolist()))
    return [tuple(dof) for dof in dofs[free].tolist()], *whole, sorted({node for node, _ in held}), positions


def test_files_of_ansys_have_its_frequencies_and_those_of_their_matrices(beam, tmp_path):
    # Nothing couples the blades, so every nodal diameter has the frequencies of one.
    rows, k, m, held, _ = beam
    sector = blisk.Sector.from_ansys(
        examples.fullfile, examples.hexarchivefile, blade_full=examples.fullfile, rst=examples.rstfile, sectors=5,
        out=tmp_path, axis="x", low_face="LOW", high_face="HIGH", sets={"LOW": held, "HIGH": held, "TIP": [27]},
        frequencies=8, **WORDS,
    )  # fmt: skip
    expected = numpy.sqrt(eigh(k.toarray(), m.toarray(), eigvals_only=True)[:8]) / (2 * math.pi)
    assert len(sector.report["frequencies_hz"]) == 3
    assert numpy.allclose(sector.report["frequencies_hz"], expected, rtol=1e-9, atol=0)
    result = sector.check["result_file"]
    assert (result["reference"], result["modes_compared"], result["inner_rows"]) == ("file.rst", 6, 810)
    assert result["worst_relative_difference"] < 1e-7
    assert (sector.name, len(rows)) == ("HexBeam", sector.dofs)


def test_the_beam_of_ansys_is_a_sector_of_four_with_faces_that_are_found(beam, tmp_path):
    # Turned by 90 degrees about one of its edges, the beam is a quarter of a block. The block is assembled here: a
    # node of a quarter is that of the next one, turned.
    rows, k, m, _, positions = beam
    on_axis = [node for node, (x, y, _) in positions.items() if x == y == 0.0]
    kept = [row for row, (node, _) in enumerate(rows) if node not in on_axis]
    outer = [row for row, (node, _) in enumerate(rows) if min(positions[node][:2]) >= 0.5]
    blade = scipy.sparse.lil_matrix(k.shape)
    blade[numpy.ix_(outer, outer)] = k[outer][:, outer]
    sector = blisk.Sector.from_arrays(
        k, m, blade, positions, rows=[(node, direction + 1) for node, direction in rows], out=tmp_path, sectors=4,
        held=on_axis, sets={"TIP": [27]}, frequencies=8, **WORDS,
    )  # fmt: skip
    place, entries = {}, []
    turn = numpy.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    for quarter in range(4):
        own = numpy.linalg.matrix_power(turn, quarter)
        for at, row in enumerate(kept):
            node, direction = rows[row]
            where = tuple(numpy.round(own @ positions[node], 9) + 0.0)
            for other in range(3):
                if own[other, direction]:
                    column = place.setdefault((where, other), len(place))
                    entries.append((quarter * len(kept) + at, column, float(own[other, direction])))
    i, j, values = zip(*entries)
    join = scipy.sparse.csr_matrix((values, (i, j)), shape=(4 * len(kept), len(place)))
    block = [join.T @ scipy.sparse.block_diag([own[kept][:, kept]] * 4) @ join for own in (k, m)]
    wheel_hz = numpy.sqrt(eigh(block[0].toarray(), block[1].toarray(), eigvals_only=True)) / (2 * math.pi)
    assert sector.report["bodies"][0]["cyclic_node_pairs"] == 60
    has_the_frequencies_of(sector, wheel_hz)


def test_a_result_file_of_another_model_fails_the_check(beam, tmp_path):
    _, _, _, held, _ = beam
    own = _ansys.run(examples.fullfile, examples.hexarchivefile, ())
    own.matrices.mass = 1.01 * own.matrices.mass
    with pytest.raises(blisk.BliskError, match="mode 1 of file.rst, .* is not one of the matrices") as refused:
        _ansys.result_checked(examples.rstfile, examples.fullfile, own, held, lambda count: [], 5)
    assert refused.value.exit_code == 11
    # The mesh of the result file is the first that is compared.
    rows = [(node + 1000 * (node > 300), direction) for node, direction in own.matrices.rows]
    own.matrices = Matrices(rows, own.matrices.stiffness, own.matrices.mass)
    with pytest.raises(blisk.InputError) as refused:
        _ansys.result_checked(examples.rstfile, "wheel.full", own, held, lambda count: [], 5)
    words = f"{examples.rstfile} and wheel.full are not of one model: {examples.rstfile} has 321 nodes, and wheel.full has 300"
    assert str(refused.value).startswith(words), refused.value
    assert "accepted: files of one model" in str(refused.value)


def test_a_mesh_or_a_blade_of_another_model_is_refused_by_the_numbers_of_nodes(tmp_path, monkeypatch):
    def refusal(full=examples.fullfile, cdb=examples.hexarchivefile, blade_full=examples.fullfile):
        with pytest.raises(blisk.InputError) as refused:
            blisk.Sector.from_ansys(full, cdb, blade_full=blade_full, out=tmp_path, sectors=5, axis="x", **WORDS)
        return str(refused.value)

    full, other = examples.fullfile, examples.sector_archive_file
    words = refusal(cdb=other)
    counts = f"{full} has 321 nodes, and {other} has 655 nodes, of which 230 belong to its elements"
    assert words.startswith(f"{full} and {other} are not of one model: {counts}"), words
    assert "accepted: files of one model, all of them written after the last change of its mesh" in words
    # A blade with other nodes, and a mesh that differs by a few nodes alone: what is refused then may have that cause.
    read = _ansys._read

    def renumbered(path):
        own, nodes = read(examples.fullfile)
        by = 5000 * (path == "blade.full")
        return Matrices([(node + by, axis) for node, axis in own.rows], own.stiffness, own.mass), {node + by for node in nodes}

    monkeypatch.setattr(_ansys, "_read", renumbered)
    words = refusal(blade_full="blade.full")
    assert words.startswith(f"blade.full and {full} are not of one model: blade.full has 321 nodes, of which 321 are not among the 321")
    assert "accepted: the same model with the blade's elements selected" in words
    own, nodes = read(examples.fullfile)
    monkeypatch.setattr(_ansys, "_read", lambda path: (own, nodes - {27}))
    words = refusal()
    assert words.startswith(f"{full} and {examples.hexarchivefile} may not be of one model: {full} has 320 nodes")
    assert "\nno node of the blisk lies where another one lies" in words


def test_each_step_of_an_import_is_told_with_its_time(solid, tmp_path, capfd, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def told(**more):
        blisk.Sector.from_arrays(
            solid.stiffness, solid.mass, solid.blade_stiffness, solid.positions, out="bundle", sectors=6,
            held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS, **more,
        )  # fmt: skip
        shown = capfd.readouterr()
        assert shown.out == ""
        return shown.err.splitlines()

    lines = told()
    assert all(re.match(r" +\d+ s  \S", line) for line in lines), lines
    checks = [f"checking nodal diameter {diameter} by SciPy ({diameter + 1} of 4)" for diameter in range(4)]
    steps = [
        "reading the arrays",
        "finding the cut faces",
        f"writing what the bundle is made of: {Path('bundle') / 'import'}",
        "making the bundle, with 6 frequencies per nodal diameter: bundle",
        *checks,
        "ready",
    ]
    assert [line.partition(" s  ")[2] for line in lines] == steps
    assert told(progress=False) == []
    assert not any("SciPy" in line for line in told(check=False))


def test_the_steps_of_ansys_name_its_files(beam, tmp_path, capfd):
    _, _, _, held, _ = beam
    blisk.Sector.from_ansys(
        examples.fullfile, examples.hexarchivefile, blade_full=examples.fullfile, rst=examples.rstfile, sectors=5,
        out=tmp_path, axis="x", low_face="LOW", high_face="HIGH", sets={"LOW": held, "HIGH": held, "TIP": [27]}, **WORDS,
    )  # fmt: skip
    shown = [line.partition(" s  ")[2] for line in capfd.readouterr().err.splitlines()]
    assert f"reading {examples.fullfile} and {examples.hexarchivefile}" in shown
    assert shown[-2:] == [f"comparing with {examples.rstfile}", "ready"]


def test_frequencies_that_differ_from_those_of_the_matrices_fail_the_check(solid, tmp_path, monkeypatch):
    native = blisk._sector._native.import_sector

    def detuned(*own):
        values, text = native(*own)
        report = json.loads(values)
        report["frequencies_hz"] = [[1.00001 * hz for hz in each] for each in report["frequencies_hz"]]
        return json.dumps(report), text

    monkeypatch.setattr(blisk._sector._native, "import_sector", detuned)
    with pytest.raises(blisk.BliskError, match="of nodal diameter .* Hz in the bundle and .* by a cyclic") as refused:
        blisk.Sector.from_arrays(
            solid.stiffness, solid.mass, solid.blade_stiffness, solid.positions, out=tmp_path, sectors=6,
            held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS,
        )  # fmt: skip
    assert refused.value.exit_code == 11


def test_a_large_sector_is_checked_at_three_nodal_diameters_unless_others_are_named(solid, tmp_path, monkeypatch):
    monkeypatch.setattr(blisk._import._write, "_ROWS_OF_ALL", 10)
    for check, expected in ((True, [0, 1, 3]), ([2], [2]), ([], None), (False, None)):
        sector = blisk.Sector.from_arrays(
            solid.stiffness, solid.mass, solid.blade_stiffness, solid.positions, out=tmp_path, sectors=6, check=check,
            held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS,
        )  # fmt: skip
        assert sector.check.get("nodal_diameters") == expected
    with pytest.raises(ValueError, match="nodal diameters from 0 to 3"):
        blisk.Sector.from_arrays(
            solid.stiffness, solid.mass, solid.blade_stiffness, solid.positions, out=tmp_path, sectors=6, check=[4],
            held=[node + 1 for node in solid.held], sets={"TIP": [solid.tip + 1]}, **WORDS,
        )  # fmt: skip


def test_a_cyclic_result_has_each_pair_of_modes_twice():
    index = [0, 0, 1, -1, 2, -2, 3, 3]
    hz = [10.0, 20.0, 11.0, 11.0, 12.0, 12.0, 13.0, 23.0]
    assert _ansys.of_diameters(index, hz, 6) == {0: [10.0, 20.0], 1: [11.0], 2: [12.0], 3: [13.0, 23.0]}


class FakeElements:
    """An ``.emat`` file as ansys-mapdl-reader gives it, of bricks; elements are stored in another order."""

    def __init__(self, solid, factor=1.0):
        self.header = {"numdof": 3}
        self.neqv = numpy.array(labels(range(len(solid.positions)))[::-1])
        self.eeqv = numpy.arange(len(solid.elements), 0, -1)
        self.elements = [(element, factor * brick(solid.positions[element])[0]) for element in solid.elements]
        self.places = {node: len(solid.positions) - 1 - node for node in range(len(solid.positions))}

    def read_element(self, index):
        element, stiffness = self.elements[self.eeqv[index] - 1]
        dofs = numpy.array([3 * self.places[node] + axis for node in element for axis in range(3)])
        return dofs, {"stress": stiffness[numpy.tril_indices(24)]}


def test_the_blade_is_made_of_element_matrices(solid, monkeypatch):
    class FakeReader:
        Archive = staticmethod(
            lambda path, parse_vtk: type("", (), {"element_components": {"BLADE": numpy.array([7])}})
        )
        read_binary = staticmethod(lambda path: FakeElements(solid, {"one.emat": 1.0, "other.emat": 1.01}[path]))

    monkeypatch.setattr(_ansys, "reader", lambda: FakeReader)
    assert solid.blade.index(True) == 6
    rows = [(node, axis) for node in labels(range(len(solid.positions))) for axis in range(3)]
    matrices = Matrices(rows, solid.stiffness, solid.mass).without_held(labels(solid.held))
    own = Run("ansys", "", {}, [], {}, matrices)
    blade = _ansys.blade_of_elements(own, "wheel.cdb", "one.emat", "blade")
    kept = [rows.index(row) for row in blade.rows]
    assert len(kept) == 24
    expected = solid.blade_stiffness[kept][:, kept]
    assert abs(blade.stiffness - expected).max() < 1e-12 * abs(expected).max()
    with pytest.raises(blisk.InputError, match="do not add up to the stiffness"):
        _ansys.blade_of_elements(own, "wheel.cdb", "other.emat", "BLADE")
    with pytest.raises(blisk.InputError, match="accepted: BLADE"):
        _ansys.blade_of_elements(own, "wheel.cdb", "one.emat", "VANE")


def test_what_ansys_writes_and_cannot_be_used_is_refused(tmp_path):
    def refusal(full=examples.fullfile, cdb=examples.hexarchivefile, **more):
        with pytest.raises(blisk.InputError) as refused:
            blisk.Sector.from_ansys(
                full,
                cdb,
                out=tmp_path,
                sectors=more.pop("sectors", 5),
                axis="x",
                **{"blade_full": full, **more},
                **WORDS,
            )
        return str(refused.value)

    assert "is no .full file but holds Result" in refusal(full=examples.rstfile)
    assert "no node of the blisk lies where" in refusal()
    assert "blade_full, or blade_emat and blade" in refusal(blade_full=None)
    assert "cannot be told apart" in refusal(sectors=2)
    assert "low_face = 'NO' is not a set of the mesh" in refusal(low_face="NO", high_face="NO")


# What is the same for all


def test_the_import_file_of_calculix_gives_the_numbers_of_the_command(tmp_path):
    sector = blisk.Sector.from_import_file(CCX / "wheel_rest.toml", tmp_path / "own", frequencies=3)
    ended = called("import", CCX / "wheel_rest.toml", "--out", tmp_path / "other", "--frequencies", 3, "--json")
    assert ended.returncode == 0, ended.stderr
    assert sector.report == json.loads(ended.stdout)
    shown = called("import", CCX / "wheel_rest.toml", "--out", tmp_path / "other", "--frequencies", 3)
    assert str(sector.report) == shown.stdout.rstrip("\n")
    names = sorted(path.name for path in (tmp_path / "other").iterdir())
    assert sorted(path.name for path in (tmp_path / "own").iterdir()) == names
    assert all((tmp_path / "own" / name).read_bytes() == (tmp_path / "other" / name).read_bytes() for name in names)


def test_a_refused_import_file_has_findings(tmp_path):
    text = (CCX / "wheel_rest.toml").read_text()
    (tmp_path / "wheel.toml").write_text(text.replace("sectors", "sektors"))
    with pytest.raises(blisk.InputError) as refused:
        blisk.Sector.from_import_file(tmp_path / "wheel.toml", tmp_path / "out")
    ended = called("import", tmp_path / "wheel.toml", "--out", tmp_path / "out")
    assert ended.returncode == refused.value.exit_code
    assert ended.stderr == f"error: {refused.value}\n"
    by_key = {finding.key: finding for finding in refused.value.findings}
    assert by_key["sektors"].problem == "unknown_key" and by_key["sektors"].suggestion == "sectors"
    assert by_key["sektors"].line and by_key["sektors"].file == str(tmp_path / "wheel.toml")
    with pytest.raises(ValueError, match="blisk import --template ansys"):
        blisk.Sector.from_import_file(examples.hexarchivefile, tmp_path / "out")
    with pytest.raises(blisk.BliskError) as refused:
        blisk.Sector.from_bundle(tmp_path / "nothing")
    assert refused.value.exit_code == 7


def test_a_missing_package_is_named(monkeypatch, tmp_path):
    def without(name):
        raise ImportError(name)

    monkeypatch.setattr(importlib, "import_module", without)
    where = {"out": tmp_path, "sectors": 5, **WORDS}
    with pytest.raises(ImportError, match="pip install ansys-mapdl-reader scipy"):
        blisk.Sector.from_ansys("file.full", "wheel.cdb", **where)
    with pytest.raises(ImportError, match="pip install pyyeti"):
        blisk.Sector.from_nastran("wheel.bdf", "wheel.op4", **where)
    with pytest.raises(ImportError, match="pip install numpy"):
        blisk.Sector.from_arrays([[1.0]], [[1.0]], [[1.0]], [[0, 0, 0]], **where)


def test_importing_the_package_needs_no_other_package():
    # Python alone has it: what is imported by `import blisk` is of Python or of blisk.
    code = "import sys; before = set(sys.modules); import blisk; print(sorted({m.split('.')[0] for m in set(sys.modules) - before}))"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    found = set(re.findall(r"'(\w+)'", ended.stdout)) - set(sys.stdlib_module_names)
    assert found == {"blisk"}
