"""Imports the real files that the package ansys-mapdl-reader ships: a .full, an .rst and a .cdb of one beam.

    python ansys_files.py BLISK

BLISK is the program. studies/ansys/full_to_matrix_market.py turns the .full file into matrices. The imported bundle must
have the frequencies of scipy, those of Ansys' own .rst file, and, as a sector of four, those of a cyclic
reduction in scipy. What an earlier recipe wrote must be refused: one triangle of the matrices.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
from ansys.mapdl import reader
from ansys.mapdl.reader import examples
from scipy.io import mmread, mmwrite
from scipy.sparse import csr_matrix, tril, triu
from scipy.sparse.linalg import eigsh

RECIPE = Path(__file__).resolve().parents[2] / "studies" / "ansys" / "full_to_matrix_market.py"
HZ = 2.0 * numpy.pi


def check(condition, *words):
    if not condition:
        sys.exit("FAILED: " + " ".join(str(word) for word in words))


def component(name, nodes):
    """A component of nodes as CDWRITE writes it."""
    lines = [f"CMBLOCK,{name:<8},NODE,{len(nodes):8d}", "(8i10)"]
    for start in range(0, len(nodes), 8):
        lines.append("".join(f"{node:10d}" for node in nodes[start : start + 8]))
    return "\n".join(lines) + "\n"


class Beam:
    """The beam: mesh, upper triangles with their rows, and which rows are held."""

    def __init__(self):
        archive = reader.Archive(examples.hexarchivefile)
        self.position = dict(zip(archive.nnum.tolist(), archive.nodes[:, :3].tolist()))
        self.elements = [element[10:].tolist() for element in archive.elem]
        full = reader.read_binary(examples.fullfile)
        self.dofs, self.k, self.m = full.load_km()
        held = set(map(tuple, full.const.tolist()))
        self.held_nodes = sorted({node for node, _ in held})
        self.free = [row for row, dof in enumerate(self.dofs.tolist()) if tuple(dof) not in held]

    def whole(self, upper):
        """Both triangles over the free rows."""
        upper = upper.tocsr()[self.free][:, self.free]
        return (upper + triu(upper, 1).T).tocsr()

    def rows(self):
        return [tuple(dof) for dof in self.dofs[self.free].tolist()]

    def mesh(self, sets):
        """The .cdb with more components."""
        text = Path(examples.hexarchivefile).read_text()
        return text + "".join(component(name, nodes) for name, nodes in sets.items())


def write_matrices(folder, name, rows, k, m, symmetry="symmetric"):
    """Matrices as they are, without a word on triangles, and their table of rows."""
    for letter, matrix in (("k", k), ("m", m)):
        mmwrite(folder / f"{name}_{letter}.mtx", matrix.tocoo(), field="real", precision=17, symmetry=symmetry)
    lines = [f"{number},{node},{direction + 1}\n" for number, (node, direction) in enumerate(rows, start=1)]
    (folder / f"{name}_dofs.csv").write_text("row,node,direction\n" + "".join(lines))


def import_file(folder, name, axis, sectors, blade):
    text = f"""code = "ansys"
matrix_format = "matrix_market"
name = "{name}"
sectors = {sectors}
axis = "{axis}"
[blisk]
mesh = "beam.cdb"
stiffness = "{name}_k.mtx"
mass = "{name}_m.mtx"
dofs = "{name}_dofs.csv"
blade_stiffness = "{blade}_k.mtx"
blade_dofs = "{blade}_dofs.csv"
low_face = "LOW"
high_face = "HIGH"
[[force]]
set = "TIP"
component = "t"
[[observe]]
name = "tip"
set = "TIP"
"""
    path = folder / f"{name}.toml"
    path.write_text(text)
    return path.name


def blisk(folder, *arguments):
    return subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True)


def frequencies(folder):
    found = {}
    for row in csv.DictReader(open(folder / "frequencies.csv")):
        found.setdefault(int(row["nodal_diameter"]), []).append(float(row["frequency_hz"]))
    return found


def lowest(k, m, count):
    values = eigsh(k.tocsc(), k=count, M=m.tocsc(), sigma=0.0, return_eigenvectors=False)
    return numpy.sqrt(numpy.sort(values)) / HZ


def worst(found, expected):
    check(len(found) == len(expected) > 0, "frequencies", found, expected)
    return max(abs(a / b - 1.0) for a, b in zip(found, expected))


def recipe_yields_whole_matrices(beam, folder):
    ended = subprocess.run([sys.executable, RECIPE, examples.fullfile, "beam"], cwd=folder)
    check(ended.returncode == 0, "the recipe ends with", ended.returncode)
    table = [tuple(int(word) for word in line.split(",")) for line in (folder / "beam_dofs.csv").read_text().split()[1:]]
    check([(node, direction - 1) for _, node, direction in table] == beam.rows(), "the table of rows")
    check(len(table) == 900 and {direction for _, _, direction in table} == {1, 2, 3}, "rows and directions")
    for letter, upper, lower_entries in (("k", beam.k, 38960), ("m", beam.m, 16452)):
        read = mmread(folder / f"beam_{letter}.mtx").tocsr()
        whole = beam.whole(upper)
        check(read.nnz == 2 * lower_entries - 900, letter, "has", read.nnz, "entries")
        check((read != read.T).nnz == 0 and (read != whole).nnz == 0, letter, "is not the mirrored triangle")
    print("recipe: 77020 entries of K, 32004 of M, both triangles, as load_km gives one mirrored")


def blades_have_the_frequencies_of_scipy_and_of_ansys(beam, folder):
    # The held end is the root of a blade; nothing couples the blades, so every nodal diameter has those of one.
    sets = {"LOW": beam.held_nodes, "HIGH": beam.held_nodes, "TIP": [27]}
    (folder / "beam.cdb").write_text(beam.mesh(sets))
    name = import_file(folder, "beam", "x", 5, "beam")
    ended = blisk(folder, "import", name, "--out", "bundle", "--frequencies", "8", "--json")
    check(ended.returncode == 0, ended.stderr)
    report = json.loads(ended.stdout)
    check(report["bodies"][0]["dofs"] == 900 and not report["bodies"][0]["mass_is_lumped"], report)
    expected = lowest(beam.whole(beam.k), beam.whole(beam.m), 8)
    off = max(worst(found, expected) for found in frequencies(folder / "bundle").values())
    check(off < 1e-8, "frequencies are off those of scipy by", off)
    print(f"blades: 8 frequencies of 3 nodal diameters within {off:.1e} of scipy")
    # The modes in the .rst file are those of the free beam. Away from the held end they satisfy the same
    # equations, (K - omega^2 M) u = 0, which gives Ansys' frequency from the matrices of the bundle.
    k, m = (mmread(folder / "bundle" / f"{letter}.mtx").tocsr() for letter in "KM")
    held = set(beam.held_nodes)
    near = {node for element in beam.elements if held & set(element) for node in element}
    result = reader.read_binary(examples.rstfile)
    dofs = list(csv.DictReader(open(folder / "bundle" / "dofs.csv")))
    inner = numpy.array([int(dof["node"]) not in near for dof in dofs])
    check(inner.sum() == 810, inner.sum(), "rows away from the held end")
    off = 0.0
    for index in range(result.nsets):
        numbers, shape = result.nodal_solution(index)
        of_node = dict(zip(numbers.tolist(), shape[:, :3].tolist()))
        mode = numpy.zeros(len(dofs))
        for row, dof in enumerate(dofs):
            # The axis of rotation is x of the files and z of the bundle.
            ux, uy, uz = of_node[int(dof["node"])]
            x, y = float(dof["x"]), float(dof["y"])
            radius = numpy.hypot(x, y)
            along = {"r": (x * uy + y * uz) / radius, "t": (x * uz - y * uy) / radius, "z": ux}
            mode[row] = along[dof["component"]]
        force, inertia = (k @ mode)[inner], (m @ mode)[inner]
        square = force @ inertia / (inertia @ inertia)
        check(abs(force - square * inertia).max() < 1e-5 * abs(force).max(), "mode", index, "is no mode of the matrices")
        off = max(off, abs(numpy.sqrt(square) / HZ / result.time_values[index] - 1.0))
    check(off < 1e-6, "frequencies are off those of Ansys by", off)
    print(f"blades: {result.nsets} frequencies of the .rst file of Ansys within {off:.1e}")


def sector_of_four_has_the_frequencies_of_scipy(beam, folder):
    # Turned by 90 degrees about one of its edges, the beam is a quarter of a block. Nodes on the edge lie on the
    # axis, where r and theta mean nothing: they are held here.
    on_axis = {node for node, (x, y, _) in beam.position.items() if x == 0.0 and y == 0.0}
    low = [node for node, (x, y, _) in beam.position.items() if y == 0.0 and x > 0.0]
    high = [node for node, (x, y, _) in beam.position.items() if x == 0.0 and y > 0.0]
    (folder / "beam.cdb").write_text(beam.mesh({"LOW": low, "HIGH": high, "TIP": [27]}))
    name = import_file(folder, "beam", "z", 4, "beam")
    ended = blisk(folder, "import", name, "--out", "axis")
    check(ended.returncode == 4 and "lies on the axis" in ended.stderr, ended.returncode, ended.stderr)
    rows = beam.rows()
    kept = [row for row, (node, _) in enumerate(rows) if node not in on_axis]
    k, m = (beam.whole(upper)[kept][:, kept] for upper in (beam.k, beam.m))
    rows = [rows[row] for row in kept]
    write_matrices(folder, "quarter", rows, k, m)
    outer = [row for row, (node, _) in enumerate(rows) if min(beam.position[node][:2]) >= 0.5]
    write_matrices(folder, "outer", [rows[row] for row in outer], k[outer][:, outer], m[outer][:, outer])
    name = import_file(folder, "quarter", "z", 4, "outer")
    ended = blisk(folder, "import", name, "--out", "sector", "--frequencies", "8", "--json")
    check(ended.returncode == 0, ended.stderr)
    report = json.loads(ended.stdout)
    at = {dof: row for row, dof in enumerate(rows)}
    partner = {}
    for node in low:
        x, _, z = beam.position[node]
        partner[node] = next(other for other in high if beam.position[other][1:] == [x, z])
    free_low = [node for node in low if (node, 0) in at]
    check(report["bodies"][0]["cyclic_node_pairs"] == len(free_low) == 60, report["bodies"])
    highs = {at[partner[node], direction] for node in free_low for direction in range(3)}
    independent = [row for row in range(len(rows)) if row not in highs]
    place = {row: column for column, row in enumerate(independent)}
    off = 0.0
    for diameter, found in frequencies(folder / "sector").items():
        phase = numpy.exp(0.5j * numpy.pi * diameter)
        entries = [(row, column, 1.0) for row, column in place.items()]
        for node in free_low:
            # u_high = R u_low e^{i h alpha}, R a turn by 90 degrees about z.
            u, v, w = (at[partner[node], direction] for direction in range(3))
            x, y, z = (place[at[node, direction]] for direction in range(3))
            entries += [(u, y, -phase), (v, x, phase), (w, z, phase)]
        i, j, values = zip(*entries)
        t = csr_matrix((values, (i, j)), shape=(len(rows), len(independent)), dtype=complex)
        expected = lowest((t.conj().T @ k @ t), (t.conj().T @ m @ t), len(found))
        off = max(off, worst(found, expected))
    check(off < 1e-8, "frequencies are off those of scipy by", off)
    print(f"sector of four: 60 pairs of face nodes, 8 frequencies of 3 nodal diameters within {off:.1e} of scipy")


def broken_matrices_are_refused(beam, folder):
    sets = {"LOW": beam.held_nodes, "HIGH": beam.held_nodes, "TIP": [27]}
    (folder / "beam.cdb").write_text(beam.mesh(sets))
    rows = beam.rows()
    k, m = beam.whole(beam.k), beam.whole(beam.m)
    upper_k, upper_m = triu(k), triu(m)
    order = sorted(range(len(rows)), key=rows.__getitem__)
    every = [tuple(dof) for dof in beam.dofs.tolist()]

    def by_order(upper):
        return upper.tocsr()[order][:, order]

    # What was written, and what the message must say.
    cases = {
        "held": (every, beam.k, beam.m, "symmetric", "without the rows of held directions"),
        "triangle": (rows, upper_k, upper_m, "symmetric", "only one triangle written"),
        "triangle of K": (rows, upper_k, m, "symmetric", "only one triangle written"),
        "sorted": ([rows[row] for row in order], by_order(upper_k), by_order(upper_m), "symmetric", "pairs of its nodes are coupled"),
        "sorted M": ([rows[row] for row in order], by_order(k), by_order(upper_m), "symmetric", "M does not couple"),
        "sorted table": (sorted(rows), k, m, "symmetric", "the table's"),
        "general": (rows, upper_k, upper_m, "general", "none on the other side"),
    }
    for case, (table, stiffness, mass, symmetry, words) in cases.items():
        kept = tril if symmetry == "symmetric" else (lambda matrix: matrix)
        write_matrices(folder, "broken", table, kept(stiffness), kept(mass), symmetry)
        name = import_file(folder, "broken", "x", 5, "broken")
        ended = blisk(folder, "import", name, "--out", "refused")
        check(ended.returncode == 4 and words in ended.stderr, case, ended.returncode, ended.stderr)
        check(not (folder / "refused").exists(), case, "wrote a bundle")
    # The blade's alone.
    write_matrices(folder, "broken", rows, tril(k), tril(m))
    write_matrices(folder, "blade", rows, tril(upper_k), tril(upper_m))
    name = import_file(folder, "broken", "x", 5, "blade")
    ended = blisk(folder, "import", name, "--out", "refused")
    check(ended.returncode == 4 and "K_blade" in ended.stderr, ended.returncode, ended.stderr)
    # Directions as the package counts them.
    table = (folder / "broken_dofs.csv").read_text().split()
    lowered = [",".join((*line.split(",")[:2], str(int(line.split(",")[2]) - 1))) for line in table[1:]]
    (folder / "broken_dofs.csv").write_text("\n".join([table[0], *lowered]) + "\n")
    name = import_file(folder, "broken", "x", 5, "broken")
    ended = blisk(folder, "import", name, "--out", "refused")
    check(ended.returncode == 4 and "directions count from 1" in ended.stderr, ended.returncode, ended.stderr)
    print(f"refused: {len(cases) + 2} ways to write these matrices wrongly")


def files_of_ansys_are_answered_with_a_command(folder):
    for path, command in (
        (examples.fullfile, "full_to_matrix_market.py"),
        (examples.rstfile, "full_to_matrix_market.py"),
        (examples.hexarchivefile, "blisk import --template ansys"),
        (examples.sector_archive_file, "blisk import --template ansys"),
    ):
        ended = blisk(folder, "import", path, "--out", "refused")
        check(ended.returncode == 2 and command in ended.stderr, path, ended.returncode, ended.stderr)
    print("answered: .full, .rst and .cdb in the place of an import file")


def main():
    beam = Beam()
    check(len(beam.free) == 900 and len(beam.held_nodes) == 21, "the beam is another one")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        recipe_yields_whole_matrices(beam, folder)
        blades_have_the_frequencies_of_scipy_and_of_ansys(beam, folder)
        sector_of_four_has_the_frequencies_of_scipy(beam, folder)
        broken_matrices_are_refused(beam, folder)
        files_of_ansys_are_answered_with_a_command(folder)


PROGRAM = str(Path(sys.argv[1]).resolve())
main()
