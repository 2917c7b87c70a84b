"""Nastran: bulk data, and matrices of ``.op2``, ``.op4`` and punch files by pyYeti."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Optional

from .._needed import needed
from ._run import Held, Matrices, Path_, Run, held_nodes, refused, symmetric, text_of_file

Rows = Optional[Sequence[Sequence[int]]]
OUTPUT4 = (".op4", *(f".ou{unit}" for unit in range(1, 8)))
"""Endings of files of OUTPUT4: what a run of Nastran names so, and the units 21 to 27 of MYSTRAN."""


def _nastran() -> Any:
    return needed("pyyeti.nastran", "reading files of Nastran")


def grids(bdf: Path_) -> dict[int, tuple[float, float, float]]:
    """Positions of the grid points in the basic system."""
    table = _nastran().rdgrids(os.fspath(bdf))
    if table is None or not len(table):
        raise refused(f"{bdf} has no GRID; accepted: the bulk data of the sector")
    other = table[(table[:, 1] != 0) | (table[:, 5] != 0)]
    if len(other):
        raise refused(f"{bdf}: GRID {int(other[0, 0])} has a system of coordinates of its own; accepted: CP and CD 0")
    return {int(own[0]): (float(own[2]), float(own[3]), float(own[4])) for own in table}


def elements(bdf: Path_) -> list[list[int]]:
    """Grid points of the solid elements."""
    found = []
    for card in ("CHEXA", "CPENTA", "CTETRA"):
        for own in _cards(bdf, card):
            found.append([int(node) for node in own[2:] if isinstance(node, (int, float)) and node > 0])
    if not found:
        raise refused(f"{bdf} has no CHEXA, CPENTA or CTETRA; accepted: solid elements")
    return found


def sets(bdf: Path_) -> dict[str, set[int]]:
    """The SET1 entries by their numbers."""
    found: dict[str, set[int]] = {}
    for own in _cards(bdf, "SET1"):
        words = [word for word in own[1:] if word != ""]
        members: set[int] = set()
        for at, word in enumerate(words):
            if isinstance(word, str):
                if word.strip().upper() == "THRU":
                    members.update(range(int(words[at - 1]), int(words[at + 1]) + 1))
            else:
                members.add(int(word))
        found.setdefault(str(int(own[0])), set()).update(members)
    return found


def _cards(bdf: Path_, name: str) -> list[list[Any]]:
    return list(_nastran().rdcards(os.fspath(bdf), name, return_var="list", no_data_return=[]))


def matrix(path: Path_, name: Optional[str], letter: str, size: Optional[int] = None) -> tuple[Rows, Any]:
    """The matrix ``name`` of a file, or the only one whose name begins with ``letter``; rows where the file says them."""
    ending = Path(path).suffix.lower()
    _nastran()
    if ending in (".pch", ".dmig"):
        tables = _nastran().rddmig(os.fspath(path), square=True)
        frame = tables[_chosen(tables, name, letter, path)]
        return [(int(node), int(dof)) for node, dof in frame.index], frame.to_numpy()
    if ending in OUTPUT4:
        read = needed("pyyeti.nastran.op4", "reading files of Nastran").read(os.fspath(path), sparse=None)
        read = {key.upper(): own for key, own in read.items()}
    elif ending == ".op2":
        file = needed("pyyeti.nastran.op2", "reading files of Nastran").OP2(os.fspath(path))
        read = file.rdop2mats()
    else:
        raise refused(f"{path} is not read; accepted: .op2, .op4 (or .ou1 to .ou7 of MYSTRAN), or a punch file .pch")
    return None, read[_chosen(read, name, letter, path)]


def _chosen(there: Iterable[str], name: Optional[str], letter: str, path: Path_) -> str:
    names = sorted(there)
    fitting = (
        [own for own in names if own.upper() == name.upper()]
        if name
        else [own for own in names if own.upper().startswith(letter)]
    )
    if len(fitting) == 1:
        return fitting[0]
    key = "stiffness_name" if letter == "K" else "mass_name"
    raise refused(f"{path} has the matrices {', '.join(names) or 'none'}; accepted: the name of one as {key}")


def matrices(
    positions: Iterable[int],
    path: Path_,
    mass_path: Optional[Path_],
    rows: Rows,
    names: tuple[Optional[str], Optional[str]],
) -> Matrices:
    """Stiffness, and mass where it is needed, over rows of displacements."""
    own_rows, stiffness = matrix(path, names[0], "K")
    of_grids = sorted(positions)
    rows = own_rows if own_rows is not None else rows
    size = stiffness.shape[0]
    if rows is None:
        for width in (6, 3):
            if size == width * len(of_grids):
                rows = [(node, dof) for node in of_grids for dof in range(1, width + 1)]
    if rows is None or len(rows) != size:
        raise refused(
            f"{path} has {size} rows, and the mesh {len(of_grids)} grid points; accepted: 3 or 6 rows for each in"
            " ascending order, or `rows` with node and direction (1, 2, 3) of each row"
        )
    named = [(int(node), int(dof) - 1) for node, dof in rows]
    kept = [at for at, (_, direction) in enumerate(named) if direction < 3]
    own = symmetric(stiffness, f"the stiffness of {path}")
    turning = [at for at, (_, direction) in enumerate(named) if direction >= 3]
    if turning and abs(own[turning]).sum() > 0.0:
        raise refused(f"{path} has rotations with stiffness; accepted: solid elements alone")
    mass = None
    if mass_path is not None:
        of_mass, mass = matrix(mass_path, names[1], "M")
        if of_mass is not None and [tuple(row) for row in of_mass] != [tuple(row) for row in rows]:
            raise refused(f"the mass of {mass_path} has other rows than the stiffness; accepted: one run")
        mass = symmetric(mass, f"the mass of {mass_path}")
        if mass.shape != own.shape:
            raise refused(f"the mass of {mass_path} has {mass.shape[0]} rows, the stiffness {size}; accepted: one run")
    return Matrices(named, own, mass).keeping(kept)


def run(bdf: Path_, own: Matrices, held: Held, more: Optional[Mapping[str, Iterable[int]]] = None) -> Run:
    """Mesh and matrices of a run of Nastran."""
    positions = grids(bdf)
    unknown = next((node for node, _ in own.rows if node not in positions), None)
    if unknown is not None:
        raise refused(f"the matrices have grid point {unknown}, which is not in {bdf}; accepted: files of one model")
    own_sets = sets(bdf)
    kept = own.without_held(held_nodes(held, own_sets, more))
    return Run("nastran", text_of_file(bdf), positions, elements(bdf), own_sets, kept)
