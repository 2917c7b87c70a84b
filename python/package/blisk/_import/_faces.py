"""Cyclic faces: the nodes that are those of the other face, turned by one sector."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, Optional

from .._needed import needed
from ._run import refused

PLACES = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}
"""By the axis of rotation: which coordinates lie in the plane of rotation, and which along the axis."""


def rotation(axis: str, angle: float) -> Any:
    """The matrix that turns a vector in x, y, z by ``angle`` about the axis."""
    numpy = needed("numpy", "an import")
    first, second, _ = PLACES[axis]
    turned = numpy.eye(3)
    turned[first, first] = turned[second, second] = math.cos(angle)
    turned[first, second], turned[second, first] = -math.sin(angle), math.sin(angle)
    return turned


def pairs(
    positions: Mapping[int, tuple[float, float, float]],
    nodes: Iterable[int],
    high: Optional[Iterable[int]],
    axis: str,
    sectors: int,
    tolerance: float,
) -> list[tuple[int, int]]:
    """Pairs of a low and a high node: the high one is where the low one is after a turn by a sector.

    ``nodes``: candidates for low nodes. ``high``: for high nodes; the same unless given.
    """
    numpy = needed("numpy", "an import")
    low = sorted(nodes)
    others = low if high is None else sorted(high)
    if not low or not others:
        return []
    spatial = needed("scipy.spatial", "an import")
    own = numpy.array([positions[node] for node in low])
    turned = own @ rotation(axis, 2.0 * math.pi / sectors).T
    distance, nearest = spatial.cKDTree(numpy.array([positions[node] for node in others])).query(turned)
    first, second, _ = PLACES[axis]
    radius = numpy.hypot(own[:, first], own[:, second])
    return [
        (low[at], others[nearest[at]])
        for at in range(len(low))
        # A node on the axis is its own image.
        if distance[at] <= tolerance and radius[at] > tolerance
    ]


def found(
    positions: Mapping[int, tuple[float, float, float]],
    nodes: Iterable[int],
    axis: str,
    sectors: int,
    tolerance: float,
    body: str,
) -> list[tuple[int, int]]:
    """Pairs of the faces of a body whose faces have no names."""
    if sectors < 3:
        raise refused(
            f"the faces of the {body} of a wheel of {sectors} sectors cannot be told apart by a turn; accepted:"
            " low_face and high_face"
        )
    own = pairs(positions, nodes, None, axis, sectors, tolerance)
    if not own:
        raise refused(
            f"no node of the {body} lies where another one lies after a turn by 360/{sectors} degrees about {axis},"
            f" within {tolerance:.3e} (the unit of the mesh); accepted: the number of sectors and the axis of this"
            " mesh, a larger position_tolerance_m, or low_face and high_face"
        )
    both = {low for low, _ in own} & {high for _, high in own}
    if both:
        raise refused(
            f"node {min(both)} of the {body} lies between two others that a turn by 360/{sectors} degrees takes to"
            " each other: the mesh is more than one sector; accepted: one sector"
        )
    return own
