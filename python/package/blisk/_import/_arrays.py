"""Matrices and a mesh in memory: arrays, or a mesh of meshio."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Optional

from .._needed import needed
from ._abaqus import deck_text
from ._run import Held, Matrices, Run, held_nodes, refused, symmetric

_KINDS = {
    "tetra": "C3D4",
    "wedge": "C3D6",
    "hexahedron": "C3D8",
    "tetra10": "C3D10",
    "wedge15": "C3D15",
    "hexahedron20": "C3D20",
}
"""Names of elements in meshio; nodes are in the same order."""


def mesh(
    nodes: Any, elements: Optional[Mapping[str, Any]]
) -> tuple[dict[int, tuple[float, float, float]], list[tuple[int, str, list[int]]], dict[str, list[int]]]:
    """Positions, elements and sets by node numbers."""
    numpy = needed("numpy", "an import")
    sets: dict[str, list[int]] = {}
    if hasattr(nodes, "points") and hasattr(nodes, "cells"):
        if elements is not None:
            raise ValueError("elements is given beside a mesh that has its own; accepted: one of both")
        sets = {name: [int(at) + 1 for at in own] for name, own in getattr(nodes, "point_sets", {}).items()}
        # Numbers of a mesh of meshio count from 0.
        blocks = [(block.type, numpy.asarray(block.data) + 1) for block in nodes.cells]
        elements_of = [(kind, own) for kind, own in blocks if kind in _KINDS]
        nodes = nodes.points
    else:
        elements_of = [(kind, numpy.asarray(own)) for kind, own in (elements or {}).items()]
    if isinstance(nodes, Mapping):
        positions = {int(node): tuple(map(float, xyz)) for node, xyz in nodes.items()}
    else:
        positions = {number: tuple(map(float, xyz)) for number, xyz in enumerate(numpy.asarray(nodes), start=1)}
    if any(len(xyz) != 3 for xyz in positions.values()):
        raise ValueError("nodes is not accepted; accepted: positions with x, y and z, of shape (n, 3) or by number")
    found: list[tuple[int, str, list[int]]] = []
    for kind, own in elements_of:
        name = _KINDS.get(kind, kind.upper())
        if name not in _KINDS.values():
            raise ValueError(f"elements has the type {kind}; accepted: {', '.join([*_KINDS, *_KINDS.values()])}")
        for element in own.tolist():
            found.append((len(found) + 1, name, [int(node) for node in element]))
    return positions, found, sets  # type: ignore[return-value]


def run(
    stiffness: Any,
    mass: Any,
    rows: Optional[Sequence[Sequence[int]]],
    nodes: Any,
    elements: Optional[Mapping[str, Any]],
    held: Held,
    more: Optional[Mapping[str, Iterable[int]]] = None,
) -> tuple[Run, list[tuple[int, int]]]:
    """Mesh and matrices in memory, and the rows of the matrices as they were given."""
    positions, own, sets = mesh(nodes, elements)
    k, m = symmetric(stiffness, "stiffness"), symmetric(mass, "mass")
    named = named_rows(rows, positions, k.shape[0])
    if m.shape != k.shape:
        raise refused(f"mass has {m.shape[0]} rows, stiffness {k.shape[0]}; accepted: the same rows")
    matrices = Matrices(named, k, m).without_held(held_nodes(held, sets, more))
    text = deck_text(positions, own, {})
    made = Run("calculix", text, positions, [nodes_ for _, _, nodes_ in own], {}, matrices)
    made.add_sets({name: members for name, members in sets.items() if members})
    return made, named


def named_rows(
    rows: Optional[Sequence[Sequence[int]]], positions: Mapping[int, Any], size: int
) -> list[tuple[int, int]]:
    """Node and direction of each row; x, y, z of each node in order unless said."""
    if rows is None:
        if size != 3 * len(positions):
            raise ValueError(
                f"the matrices have {size} rows, and there are {len(positions)} nodes; accepted: 3 rows for each, or"
                " `rows` with node and direction (1, 2, 3) of each row"
            )
        return [(node, direction) for node in positions for direction in range(3)]
    named = [(int(node), int(direction) - 1) for node, direction in rows]
    if len(named) != size or any(node not in positions or not 0 <= direction < 3 for node, direction in named):
        raise ValueError("rows is not accepted; accepted: a node of `nodes` and a direction 1, 2 or 3 for each row")
    return named
