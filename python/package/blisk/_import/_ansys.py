"""Ansys: ``.full``, ``.cdb``, ``.emat`` and ``.rst`` by ansys-mapdl-reader."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Optional, Union

from .._needed import needed
from . import _check
from ._run import Held, Matrices, Path_, Run, held_nodes, refused, saying_first, symmetric, text_of_file


def reader() -> Any:
    """The package that reads the files."""
    return needed("ansys.mapdl.reader", "reading files of Ansys")


_ONE_MODEL = "accepted: files of one model, all of them written after the last change of its mesh"
_FEW = 0.1
"""Share of the nodes that may be in one of two files alone: held nodes, and nodes of elements that are not solids."""


def matrices(path: Path_) -> Matrices:
    """Stiffness and mass of a ``.full`` file over its free rows."""
    return _read(path)[0]


def _read(path: Path_) -> tuple[Matrices, set[int]]:
    """Stiffness and mass of a ``.full`` file over its free rows, and all of its nodes."""
    full = reader().read_binary(os.fspath(path))
    if not hasattr(full, "load_km"):
        raise refused(
            f"{path} is no .full file but holds {type(full).__name__}; accepted: the .full file of a modal analysis"
        )
    if full._header["ncefull"]:
        raise refused(f"{path} has constraint equations; accepted: matrices without CE and CP, the cut faces free")
    dofs, stiffness, mass = full.load_km()
    if dofs[:, 1].max() > 2:
        raise refused(f"{path} has other dofs than UX, UY and UZ; accepted: solid elements alone")
    held = set(map(tuple, full.const.tolist()))
    rows = [(int(node), int(direction)) for node, direction in dofs.tolist()]
    kept = [row for row, own in enumerate(rows) if own not in held]
    own = [
        None if matrix is None or not matrix.nnz else symmetric(matrix.tocsr()[kept][:, kept], f"{what} of {path}")
        for matrix, what in ((stiffness, "the stiffness"), (mass, "the mass"))
    ]
    if own[0] is None:
        raise refused(f"{path} holds no stiffness; accepted: the .full file of a modal analysis")
    return Matrices([rows[row] for row in kept], *own), {node for node, _ in rows}


def _doubt(full: Path_, nodes: set[int], cdb: Path_, mesh: set[int], used: set[int]) -> str:
    """Why a ``.full`` and a ``.cdb`` file are not of one model; empty: nothing says so. ``used``: nodes of elements."""
    if nodes == used:
        return ""
    words = (
        f"{full} and {cdb} are not of one model: {full} has {len(nodes)} nodes, and {cdb} has {len(mesh)} nodes, of which"
        f" {len(used)} belong to its elements; {len(nodes & used)} of those are in {full}; {_ONE_MODEL}"
    )
    few = max(len(nodes - used), len(used - nodes)) <= _FEW * min(len(nodes), len(used))
    if nodes <= mesh and few:
        return words.replace("are not of one model", "may not be of one model")
    raise refused(words)


def blade_of_file(run_: Run, full: Path_, blade_full: Path_) -> Matrices:
    """The stiffness of a ``.full`` file with the blade's elements alone."""
    own, nodes = _read(blade_full)
    unknown = nodes.difference(run_.positions)
    if unknown:
        raise refused(
            f"{blade_full} and {full} are not of one model: {blade_full} has {len(nodes)} nodes, of which {len(unknown)}"
            f" are not among the {len(run_.positions)} of the mesh, like node {min(unknown)}; accepted: the same model with"
            " the blade's elements selected, its nodes not renumbered"
        )
    return own


def run(full: Path_, cdb: Path_, held: Held, more: Optional[Mapping[str, Iterable[int]]] = None) -> Run:
    """Mesh and matrices of a run of Ansys."""
    archive = _archive(cdb)
    own, nodes = _read(full)
    if own.mass is None:
        raise refused(f"{full} holds no mass; accepted: the .full file of a modal analysis (WRFULL before SOLVE)")
    number = [int(node) for node in archive.nnum]
    positions = {node: tuple(map(float, xyz[:3])) for node, xyz in zip(number, archive.nodes)}
    elements = [[int(node) for node in element[10:]] for element in archive.elem]
    used = {node for element in elements for node in element if node > 0}
    doubt = _doubt(full, nodes, cdb, set(positions), used)
    of_element = dict(zip((int(own) for own in archive.enum), elements))
    sets = {name.upper(): {int(node) for node in nodes} for name, nodes in archive.node_components.items()}
    for name, numbers in archive.element_components.items():
        sets.setdefault(name.upper(), {node for element in numbers for node in of_element.get(int(element), [])})
    free = own.without_held(held_nodes(held, sets, more))
    return Run("ansys", text_of_file(cdb), positions, elements, sets, free, doubt=doubt)  # type: ignore[arg-type]


def _archive(cdb: Path_) -> Any:
    return reader().Archive(os.fspath(cdb), parse_vtk=False)


def blade_of_elements(run_: Run, cdb: Path_, emat: Path_, blade: Union[str, Iterable[int]]) -> Matrices:
    """The stiffness of the blade's elements from an ``.emat`` file, if those of all elements add up to that of the run."""
    numpy, sparse = needed("numpy", "an import"), needed("scipy.sparse", "an import")
    archive = _archive(cdb)
    if isinstance(blade, str):
        components = {name.upper(): own for name, own in archive.element_components.items()}
        if blade.upper() not in components:
            names = ", ".join(sorted(components)) or "none"
            raise refused(f"blade = {blade!r} is no component of elements of {cdb}; accepted: {names}")
        wanted = {int(element) for element in components[blade.upper()]}
    else:
        wanted = {int(element) for element in blade}
    file = reader().read_binary(os.fspath(emat))
    node, width = numpy.asarray(file.neqv), int(file.header["numdof"]) if hasattr(file, "header") else 3
    place = {row: at for at, row in enumerate(run_.matrices.rows)}
    parts: dict[bool, list[tuple[Any, Any, Any]]] = {True: [], False: []}
    for index, number in enumerate(numpy.asarray(file.eeqv).tolist()):
        dofs, entries = file.read_element(index)
        stiffness = entries.get("stress")
        if stiffness is None:
            continue
        size = len(dofs)
        block = numpy.zeros((size, size))
        if len(stiffness) == size * size:
            block[:] = numpy.reshape(stiffness, (size, size))
        else:
            block[numpy.tril_indices(size)] = stiffness
            block = block + numpy.tril(block, -1).T
        own = numpy.array([place.get((int(node[dof // width]), int(dof % width)), -1) for dof in dofs.tolist()])
        free = own >= 0
        own, block = own[free], block[free][:, free]
        i, j = numpy.meshgrid(own, own, indexing="ij")
        parts[int(number) in wanted].append((i.ravel(), j.ravel(), block.ravel()))
    if not parts[True]:
        raise refused(f"{emat} has none of the blade's elements; accepted: the .emat file of the run (EMATWRITE,YES)")

    def assembled(pieces: list[tuple[Any, Any, Any]]) -> Any:
        i, j, x = (numpy.concatenate(own) for own in zip(*pieces))
        return sparse.coo_matrix((x, (i, j)), shape=run_.matrices.stiffness.shape).tocsr()

    blade_stiffness = assembled(parts[True])
    difference = assembled(parts[True] + parts[False]) - run_.matrices.stiffness
    off = abs(difference).max() / abs(run_.matrices.stiffness).max()
    if off > 1e-8:
        raise refused(
            f"the elements of {emat} do not add up to the stiffness of the .full file (relative difference {off:.1e});"
            " accepted: files of one run without prestress; else the .full file of the blade alone (blade_full)"
        )
    kept = numpy.flatnonzero(abs(blade_stiffness).sum(axis=1)).tolist()
    return Matrices(run_.matrices.rows, symmetric(blade_stiffness, "the blade's stiffness")).keeping(kept)


def result_checked(
    rst: Path_,
    full: Path_,
    run_: Run,
    faces: Iterable[int],
    ours: Callable[[int], list[list[float]]],
    sectors: int,
    tolerance: float = 1e-6,
) -> dict[str, Any]:
    """Frequencies of an ``.rst`` file against the bundle (cyclic), or against the matrices (of one sector)."""
    result = reader().read_binary(os.fspath(rst))
    kind = result._resultheader.get("kan")
    if kind not in (None, 2):
        raise refused(f"{rst} is no result of a modal analysis (its kind is {kind}); accepted: ANTYPE,MODAL")
    free = {node for node, _ in run_.matrices.rows}
    there = {int(node) for node in result.mesh.nnum}
    words = (
        f"{rst} and {full} are not of one model: {rst} has {len(there)} nodes, and {full} has {len(free)} free nodes, of"
        f" which {len(free & there)} are in {rst}; {_ONE_MODEL}"
    )
    if not free <= there:
        raise refused(words)
    same = len(there) == len(run_.positions)
    with saying_first("" if same else words.replace("are not of one", "may not be of one")):
        return _modes_checked(result, run_, faces, ours, sectors, tolerance, rst)


def _modes_checked(
    result: Any,
    run_: Run,
    faces: Iterable[int],
    ours: Callable[[int], list[list[float]]],
    sectors: int,
    tolerance: float,
    rst: Path_,
) -> dict[str, Any]:
    name = os.path.basename(os.fspath(rst))
    frequencies = [float(hz) for hz in result.time_values]
    if type(result).__name__ == "CyclicResult":
        if int(result.n_sector) != sectors:
            raise refused(f"{rst} is of {result.n_sector} sectors; accepted: {sectors}")
        theirs = of_diameters(result._resultheader["hindex"], frequencies, sectors)
        most = max(len(own) for own in theirs.values())
        return _check.compared(ours(most), theirs, tolerance, name)
    modes = []
    for index, hz in enumerate(frequencies):
        numbers, shape = result.nodal_solution(index)
        modes.append((hz, dict(zip((int(node) for node in numbers), shape[:, :3].tolist()))))
    return _check.modes_compared(run_, faces, modes, tolerance, name)


def of_diameters(index: Iterable[int], frequencies: Iterable[float], sectors: int) -> dict[int, list[float]]:
    """Frequencies by nodal diameter from those of a cyclic result, where a pair of modes of one diameter stands twice."""
    grouped: dict[int, list[float]] = {}
    for diameter, hz in zip(index, frequencies):
        grouped.setdefault(abs(int(diameter)), []).append(hz)
    found = {}
    for diameter, own in sorted(grouped.items()):
        own.sort()
        found[diameter] = own[::2] if 0 < diameter and 2 * diameter != sectors else own
    return found
