"""The same frequencies on another way: a cyclic eigenproblem of the matrices in x, y, z by SciPy."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from .._errors import BliskError
from .._needed import needed
from ._faces import rotation
from ._run import Matrices, Run

DIFFERENT = 11
"""Exit code of the command for a verification that failed."""


def cyclic_frequencies_hz(
    bodies: Sequence[tuple[Matrices, Sequence[tuple[int, int]], float]],
    axis: str,
    sectors: int,
    count: int,
    diameters: Sequence[int],
    begins: Callable[[str], None] = lambda step: None,
) -> dict[int, list[float]]:
    """Frequencies by nodal diameter of bodies that nothing joins; each has matrices, face pairs and a grounding in Hz.

    ``begins``: told of every nodal diameter before it is solved.
    """
    numpy = needed("numpy", "a check")
    sparse = needed("scipy.sparse", "a check")
    turned = rotation(axis, 2.0 * math.pi / sectors)
    found: dict[int, list[float]] = {}
    for number, diameter in enumerate(diameters, start=1):
        begins(f"checking nodal diameter {diameter} by SciPy ({number} of {len(diameters)})")
        values: list[float] = []
        phase = complex(math.cos(2.0 * math.pi * diameter / sectors), math.sin(2.0 * math.pi * diameter / sectors))
        for matrices, face_pairs, grounding_hz in bodies:
            at = {row: place for place, row in enumerate(matrices.rows)}
            bound: dict[int, list[tuple[int, complex]]] = {}
            for low, high in face_pairs:
                for direction in range(3):
                    if (high, direction) not in at:
                        continue
                    bound[at[high, direction]] = [
                        (at[low, other], phase * turned[direction, other])
                        for other in range(3)
                        if turned[direction, other] != 0.0 and (low, other) in at
                    ]
            independent = [row for row in range(len(matrices.rows)) if row not in bound]
            column = {row: place for place, row in enumerate(independent)}
            entries = [(row, place, 1.0 + 0.0j) for row, place in column.items()]
            for row, terms in bound.items():
                entries += [(row, column[low], value) for low, value in terms]
            i, j, x = zip(*entries)
            reduce = sparse.csr_matrix((x, (i, j)), shape=(len(matrices.rows), len(independent)))
            stiffness = matrices.stiffness + (2.0 * math.pi * grounding_hz) ** 2 * matrices.mass
            own = [(reduce.conj().T @ matrix @ reduce).tocsc() for matrix in (stiffness, matrices.mass)]
            values += lowest(own[0], own[1], count)
        squares = numpy.sort(numpy.array(values))[:count]
        found[diameter] = [float(hz) for hz in numpy.sign(squares) * numpy.sqrt(abs(squares)) / (2.0 * math.pi)]
    return found


def lowest(stiffness: Any, mass: Any, count: int) -> list[float]:
    """The lowest eigenvalues, in 1/s^2."""
    size = stiffness.shape[0]
    if size <= 300 or count >= size - 1:
        linalg = needed("scipy.linalg", "a check")
        last = min(count, size) - 1
        return list(linalg.eigh(stiffness.toarray(), mass.toarray(), eigvals_only=True, subset_by_index=[0, last]))
    eigsh = needed("scipy.sparse.linalg", "a check").eigsh
    # Below the eigenvalues of a body that nothing holds.
    shift = -((2.0 * math.pi) ** 2)
    return sorted(eigsh(stiffness, k=count, M=mass, sigma=shift, return_eigenvectors=False))


def compared(
    ours: Sequence[Sequence[float]], theirs: Mapping[int, Sequence[float]], tolerance: float, reference: str
) -> dict[str, Any]:
    """Both frequencies by nodal diameter and their largest relative difference; refuses more than ``tolerance``."""
    floor = 1e-3 * max(abs(hz) for own in theirs.values() for hz in own)
    worst, place = 0.0, (0, 0)
    for diameter, expected in theirs.items():
        for mode, hz in enumerate(expected[: len(ours[diameter])]):
            # Of a motion that nothing holds it is noise: it is measured against the others.
            off = abs(ours[diameter][mode] - hz) / max(abs(hz), floor)
            if off > worst:
                worst, place = off, (diameter, mode)
    if worst > tolerance:
        diameter, mode = place
        raise BliskError(
            f"frequency {mode + 1} of nodal diameter {diameter} is {ours[diameter][mode]:.9g} Hz in the bundle and"
            f" {theirs[diameter][mode]:.9g} Hz by {reference}; accepted: a relative difference of at most {tolerance:g}",
            DIFFERENT,
        )
    return {
        "reference": reference,
        "nodal_diameters": list(theirs),
        "frequencies_compared": sum(min(len(own), len(ours[diameter])) for diameter, own in theirs.items()),
        "worst_relative_difference": worst,
        "tolerance": tolerance,
    }


def modes_compared(
    run: Run,
    faces: Iterable[int],
    modes: Sequence[tuple[float, Mapping[int, Sequence[float]]]],
    tolerance: float,
    reference: str,
) -> dict[str, Any]:
    """Modes of a result file against the matrices, where nothing else acts: ``K u = omega^2 M u`` of inner rows.

    ``modes``: frequency in Hz, and displacement in x, y, z by node. Rows next to held nodes and to the faces are left
    out, so that it does not matter how the result file was held there.
    """
    numpy = needed("numpy", "a check")
    matrices = run.matrices
    directions: dict[int, int] = {}
    for node, _ in matrices.rows:
        directions[node] = directions.get(node, 0) + 1
    outer = set(faces)
    for element in run.elements:
        outer.update(node for node in element if directions.get(node, 0) < 3)
    near = {node for element in run.elements if outer.intersection(element) for node in element}
    inner = numpy.array([node not in near for node, _ in matrices.rows])
    if not inner.any():
        raise BliskError(
            f"every node is next to a face or to a held node, so that {reference} tells nothing", DIFFERENT
        )
    largest_hz = max(abs(hz) for hz, _ in modes)
    worst, residual, count = 0.0, 0.0, 0
    for number, (hz, shape) in enumerate(modes, start=1):
        if abs(hz) <= 1e-3 * largest_hz:
            # A motion of the body as a whole.
            continue
        mode = numpy.array([shape[node][direction] if node in shape else 0.0 for node, direction in matrices.rows])
        force, inertia = (matrices.stiffness @ mode)[inner], (matrices.mass @ mode)[inner]
        square = float(force @ inertia / (inertia @ inertia))
        own = float(abs(force - square * inertia).max() / abs(force).max())
        found = math.copysign(math.sqrt(abs(square)), square) / (2.0 * math.pi)
        off = abs(found / hz - 1.0)
        if own > 1e-3 or off > tolerance:
            raise BliskError(
                f"mode {number} of {reference}, {hz:.9g} Hz, is not one of the matrices: they make {found:.9g} Hz of"
                f" it and leave {own:.1e} of the force; accepted: files of one model, at most {tolerance:g} apart",
                DIFFERENT,
            )
        worst, residual, count = max(worst, off), max(residual, own), count + 1
    return {
        "reference": reference,
        "modes_compared": count,
        "frequencies_hz": [hz for hz, _ in modes],
        "inner_rows": int(inner.sum()),
        "worst_relative_difference": worst,
        "worst_residual": residual,
        "tolerance": tolerance,
    }


def words(check: Mapping[str, Any]) -> str:
    """What was compared, a line each; empty: nothing was."""
    lines = []
    for of in (check, check.get("result_file", {})):
        off = f"within {of.get('worst_relative_difference', 0.0):.1e} of {of.get('reference')}"
        if "frequencies_compared" in of:
            diameters = ", ".join(str(diameter) for diameter in of["nodal_diameters"])
            lines.append(f"compared: {of['frequencies_compared']} frequencies of nodal diameters {diameters} are {off}")
        elif "modes_compared" in of:
            first = ", ".join(f"{hz:.5g}" for hz in of["frequencies_hz"][:6])
            lines.append(
                f"compared: stiffness and mass give {of['modes_compared']} modes of {of['reference']} their frequencies"
                f" within {of['worst_relative_difference']:.1e}\n"
                f"  (first {first} Hz: the bundle has others where it is held in another way)"
            )
    return "".join(f"{line}\n" for line in lines)
