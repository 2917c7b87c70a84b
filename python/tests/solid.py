"""A sector of bricks, assembled here: matrices that nothing of the program has touched.

Eight-node bricks with full integration, in x, y, z. The whole wheel is assembled as well, so that frequencies are
compared without any cyclic reduction.
"""

import itertools
import math
from dataclasses import dataclass, field

import numpy
import scipy.linalg
from scipy.sparse import coo_matrix, diags

YOUNG_PA, POISSON, DENSITY = 2.0e11, 0.3, 7800.0
CORNERS = numpy.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
)


def brick(positions):
    """Stiffness and mass of an element with the rows x, y, z of each node."""
    g = 1.0 / math.sqrt(3.0)
    lame = YOUNG_PA * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    shear = YOUNG_PA / (2 * (1 + POISSON))
    law = numpy.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lame
    stiffness, mass = numpy.zeros((24, 24)), numpy.zeros((24, 24))
    for point in itertools.product((-g, g), repeat=3):
        factors = 1 + CORNERS * point
        shape = factors.prod(axis=1) / 8
        slope = numpy.array([CORNERS[:, a] * factors.prod(axis=1) / factors[:, a] / 8 for a in range(3)])
        jacobian = slope @ positions
        volume = numpy.linalg.det(jacobian)
        assert volume > 0
        d = numpy.linalg.solve(jacobian, slope)
        strain = numpy.zeros((6, 24))
        for a in range(3):
            strain[a, a::3] = d[a]
        for row, (a, b) in enumerate(((0, 1), (1, 2), (0, 2)), start=3):
            strain[row, a::3], strain[row, b::3] = d[b], d[a]
        stiffness += volume * strain.T @ law @ strain
        mass += volume * DENSITY * numpy.kron(numpy.outer(shape, shape), numpy.eye(3))
    return stiffness, mass


def assembled(positions, elements, size=None):
    """Matrices over x, y, z of each node, nodes counted from 0."""
    size = 3 * len(positions) if size is None else size
    rows, columns, values = [], [], ([], [])
    for element in elements:
        own = numpy.array([3 * node + axis for node in element for axis in range(3)])
        i, j = numpy.meshgrid(own, own, indexing="ij")
        rows.append(i.ravel())
        columns.append(j.ravel())
        for kept, matrix in zip(values, brick(positions[element])):
            kept.append(matrix.ravel())
    place = numpy.concatenate(rows), numpy.concatenate(columns)
    return [coo_matrix((numpy.concatenate(own), place), shape=(size, size)).tocsr() for own in values]


@dataclass
class Solid:
    """A disk sector of 2 x 3 x 1 bricks that is held at the bore, a blade of one brick on it, and a ring below the rim."""

    sectors: int = 6
    with_ring: bool = False
    positions: numpy.ndarray = None
    elements: list = field(default_factory=list)
    blade: list = field(default_factory=list)
    """Which elements are the blade's."""

    def __post_init__(self):
        alpha = 2 * math.pi / self.sectors
        angles, radii, heights = numpy.linspace(0, alpha, 4), [0.1, 0.15, 0.2, 0.26], [0.0, 0.03]
        number, positions = {}, []
        for i, j, k in itertools.product(range(4), range(4), range(2)):
            # The blade stands in the middle third.
            if i == 3 and j not in (1, 2):
                continue
            number[i, j, k] = len(positions)
            positions.append((radii[i] * math.cos(angles[j]), radii[i] * math.sin(angles[j]), heights[k]))
        self.ring = []
        if self.with_ring:
            for i, j, k in itertools.product((1, 2), range(4), range(2)):
                number["ring", i, j, k] = len(positions)
                self.ring.append(len(positions))
                positions.append((radii[i] * math.cos(angles[j]), radii[i] * math.sin(angles[j]), (-0.01, 0.0)[k]))
        self.positions = numpy.array(positions)
        for i, j in itertools.product(range(3), range(3)):
            if i == 2 and j != 1:
                continue
            self.blade.append(i == 2)
            base = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            self.elements.append([number[a, b, k] for k in range(2) for a, b in base])
        for j in range(3) if self.with_ring else ():
            self.blade.append(False)
            base = [(1, j), (2, j), (2, j + 1), (1, j + 1)]
            self.elements.append([number["ring", a, b, k] for k in range(2) for a, b in base])
        self.held = [node for place, node in number.items() if place[0] == 0]
        self.low = [node for place, node in number.items() if place[-2] == 0]
        self.high = [node for place, node in number.items() if place[-2] == 3]
        self.landing = [number[i, j, 0] for i in (1, 2) for j in range(4)]
        self.ring_top = [node for place, node in number.items() if place[0] == "ring" and place[-1] == 1]
        self.tip = number[3, 1, 1]
        self.stiffness, self.mass = assembled(self.positions, self.elements)
        own = [element for element, is_blade in zip(self.elements, self.blade) if is_blade]
        self.blade_stiffness = assembled(self.positions, own, 3 * len(positions))[0]

    def wheel_hz(self, ring_grounding_hz=0.0):
        """All frequencies of the whole wheel, ascending: its sectors assembled side by side."""
        place, positions, elements, held = {}, [], [], set()
        for sector in range(self.sectors):
            angle = 2 * math.pi * sector / self.sectors
            turn = numpy.array(
                [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
            )
            own = {}
            for node, position in enumerate(self.positions @ turn.T):
                key = (node in self.ring, *(numpy.round(position, 9) + 0.0))
                if key not in place:
                    place[key] = len(positions)
                    positions.append(position)
                own[node] = place[key]
            elements += [[own[node] for node in element] for element in self.elements]
            held.update(own[node] for node in self.held)
        stiffness, mass = assembled(numpy.array(positions), elements)
        of_ring = {place[key] for key in place if key[0]}
        springs = numpy.repeat([float(node in of_ring) for node in range(len(positions))], 3)
        stiffness = stiffness + (2 * math.pi * ring_grounding_hz) ** 2 * diags(springs) @ mass
        free = [3 * node + axis for node in range(len(positions)) if node not in held for axis in range(3)]
        squares = scipy.linalg.eigh(
            stiffness[free][:, free].toarray(), mass[free][:, free].toarray(), eigvals_only=True
        )
        return numpy.sqrt(squares) / (2 * math.pi)


def of_wheel(by_diameter, sectors):
    """Frequencies of the wheel from those by nodal diameter: those between 0 and N/2 stand for two modes."""
    found = []
    for diameter, own in enumerate(by_diameter):
        found += list(own) * (2 if 0 < 2 * diameter < sectors else 1)
    return numpy.sort(found)
