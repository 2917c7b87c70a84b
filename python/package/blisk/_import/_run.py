"""One run of another code: its mesh and its matrices."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional, Union

from .._errors import BliskError, InputError
from .._needed import needed

Path_ = Union[str, "os.PathLike[str]"]
Row = tuple[int, int]
"""Node and direction (0, 1, 2 for x, y, z) of a row of a matrix."""

_LARGEST_SPRING = 1e30
"""A diagonal stiffness from here on is a penalty that holds a direction, as Abaqus writes it."""


def refused(message: str) -> InputError:
    """The exception of files that are not accepted."""
    return InputError(message, 4)


@contextmanager
def saying_first(*doubts: str) -> Iterator[None]:
    """What is refused meanwhile is refused with the doubts before the words, where there are some."""
    said = "".join(f"{doubt}\n" for doubt in doubts if doubt)
    try:
        yield
    except InputError as error:
        if not said:
            raise
        raise InputError(f"{said}{error}", error.exit_code, error.findings) from error
    except BliskError as error:
        if not said:
            raise
        raise BliskError(f"{said}{error}", error.exit_code) from error


@dataclass
class Matrices:
    """Stiffness and mass with both triangles, in the units of the code; the mass is not always needed."""

    rows: list[Row]
    stiffness: Any
    mass: Any = None

    def keeping(self, kept: Sequence[int]) -> Matrices:
        """The matrices of some of the rows."""
        cut = [None if own is None else own[kept][:, kept].tocsr() for own in (self.stiffness, self.mass)]
        return Matrices([self.rows[row] for row in kept], *cut)

    def without_held(self, held: Iterable[int]) -> Matrices:
        """The matrices without the rows of these nodes, of empty rows, and of rows that a penalty holds."""
        nodes = set(held)
        stiffness = self.stiffness
        diagonal = stiffness.diagonal()
        entries = abs(stiffness).sum(axis=1)
        entries = entries.A1 if hasattr(entries, "A1") else entries
        kept = [
            row
            for row, (node, _) in enumerate(self.rows)
            if node not in nodes and 0.0 < entries[row] and diagonal[row] < _LARGEST_SPRING
        ]
        if not kept:
            raise refused("the stiffness has no row that is free; accepted: a sector that is held at most in part")
        return self if len(kept) == len(self.rows) else self.keeping(kept)


@dataclass
class Run:
    """Mesh and matrices of one run, with the node numbers, axes and units of the code."""

    mesh_format: str
    """``calculix``, ``ansys`` or ``nastran``."""
    mesh: str
    """Text of the mesh file, without sets that are added."""
    positions: dict[int, tuple[float, float, float]]
    elements: list[list[int]]
    """Nodes of each solid element."""
    sets: dict[str, set[int]]
    """Node sets, and nodes of element sets, by their names in capitals."""
    matrices: Matrices
    added: dict[str, list[int]] = field(default_factory=dict)
    """Sets that stand in no file of the code."""
    doubt: str = ""
    """Why its files may be of two models; what is refused later is likely to come from it."""

    def add_sets(self, sets: Mapping[str, Iterable[int]]) -> None:
        """Adds node sets; a name may not be there already."""
        for name, nodes in sets.items():
            key = name.upper()
            if key in self.sets:
                raise ValueError(f"sets has {name}, which is a set of the mesh as well; accepted: another name")
            numbers = sorted({int(node) for node in nodes})
            unknown = [node for node in numbers if node not in self.positions]
            if unknown or not numbers:
                raise ValueError(
                    f"sets[{name!r}] has the nodes {unknown[:5]}; accepted: nodes of the mesh, at least one"
                )
            self.added[key] = numbers
            self.sets[key] = set(numbers)

    def nodes_of(self, name: str, key: str) -> set[int]:
        """The nodes of a set."""
        found = self.sets.get(name.upper())
        if found is None:
            names = ", ".join(sorted(self.sets)) or "none: the mesh has no sets"
            raise refused(f"{key} = {name!r} is not a set of the mesh; accepted: {names}")
        return found

    def text(self) -> str:
        """The mesh file with the sets that were added."""
        if not self.added:
            return self.mesh
        writer = {"calculix": _nset, "ansys": _component, "nastran": _set1}[self.mesh_format]
        added = "".join(writer(name, nodes) for name, nodes in self.added.items())
        mesh = self.mesh if self.mesh.endswith("\n") else self.mesh + "\n"
        end = mesh.upper().rfind("\nENDDATA") + 1 if self.mesh_format == "nastran" else 0
        return mesh[:end] + added + mesh[end:] if end else mesh + added


def _component(name: str, nodes: list[int]) -> str:
    """A component of nodes as ``CDWRITE`` of Ansys writes it."""
    lines = [f"CMBLOCK,{name:<8},NODE,{len(nodes):8d}", "(8i10)"]
    lines += ["".join(f"{node:10d}" for node in nodes[at : at + 8]) for at in range(0, len(nodes), 8)]
    return "\n".join(lines) + "\n"


def _nset(name: str, nodes: list[int]) -> str:
    """A node set of a deck of CalculiX or Abaqus."""
    lines = [f"*NSET, NSET={name}"]
    lines += [", ".join(map(str, nodes[at : at + 8])) for at in range(0, len(nodes), 8)]
    return "\n".join(lines) + "\n"


def _set1(name: str, nodes: list[int]) -> str:
    """A set of grid points of Nastran; its name is its number."""
    words = [name, *map(str, nodes)]
    lines = [",".join(["SET1" if at == 0 else "", *words[at : at + 8]]) for at in range(0, len(words), 8)]
    return "\n".join(lines) + "\n"


Held = Union[str, Iterable[int]]
"""Nodes whose rows are taken out: a set by its name, or node numbers."""


def held_nodes(
    held: Held, sets: Mapping[str, Iterable[int]], more: Optional[Mapping[str, Iterable[int]]] = None
) -> set[int]:
    """The nodes of ``held``; ``more``: sets that stand in no file of the code."""
    if not isinstance(held, str):
        return {int(node) for node in held}
    known = {name.upper(): nodes for name, nodes in {**sets, **(more or {})}.items()}
    if held.upper() not in known:
        names = ", ".join(sorted(known)) or "none: the mesh has no sets"
        raise refused(f"held = {held!r} is not a set of the mesh; accepted: node numbers, or {names}")
    return {int(node) for node in known[held.upper()]}


def symmetric(matrix: Any, what: str) -> Any:
    """Both triangles of a matrix, of which one is stored, or both."""
    sparse = needed("scipy.sparse", "an import")
    matrix = sparse.csr_matrix(matrix, dtype=float)
    if matrix.shape[0] != matrix.shape[1]:
        raise refused(f"{what} is {matrix.shape[0]} x {matrix.shape[1]}; accepted: a square matrix")
    above, below = sparse.triu(matrix, 1).tocsr(), sparse.tril(matrix, -1).tocsr()
    if above.count_nonzero() == 0 or below.count_nonzero() == 0:
        return (sparse.diags(matrix.diagonal()) + above + above.T + below + below.T).tocsr()
    off = abs(above - below.T)
    largest, scale = off.max(), abs(matrix).max()
    if largest > 1e-9 * scale:
        raise refused(
            f"{what} is not symmetric: the largest difference of its triangles is {largest:.3e}, its largest entry"
            f" {scale:.3e}"
        )
    # What differs in the last digits was written by the code; the lower triangle counts.
    return (sparse.diags(matrix.diagonal()) + below + below.T).tocsr()


def text_of_file(path: Path_) -> str:
    """The text of a file, whatever encoding its comments have."""
    return Path(path).read_text(encoding="utf-8", errors="replace")


def name_of(name: Optional[str], path: Path_) -> str:
    """The name of the model: that of the file unless given."""
    return Path(path).stem if name is None else name
