"""Condition of the joint stick and slide modes of the lumped wheel, by numpy and scipy alone.

    python tests/data/lumped24/condition.py > tests/data/lumped24/condition.csv

Of the wheel in physical coordinates (72 dofs, K and M rebuilt from case.toml and compared with K.mtx
and M.mtx) the modes of the stuck wheel, with a spring between disk and ring of every sector, and those
of the free one, each set mass-orthonormal. Of either set the 24 modes are taken in which the blades have
the largest share of the kinetic energy. The table has the condition number of the Gram matrix
Phi^T M Phi of these 48 modes, for a ring whose mass and whose springs (ring to ring, ring to disk) are
those of the case times `ring`, and contact springs of `contact_n_per_m`.

Columns: ring, contact_n_per_m, condition (M metric), condition_euclidean (Phi^T Phi), and
condition_lowest (the 24 lowest modes of either set in place of those of the blades).
"""

import tomllib
from pathlib import Path

import numpy
import scipy.io
import scipy.linalg

HERE = Path(__file__).resolve().parent
CASE = tomllib.loads((HERE / "case.toml").read_text())
VALUES = CASE["parameters"]
SECTORS = CASE["sectors"]


def wheel(ring):
    """K and M with a ring of other mass and stiffness."""
    size = 3 * SECTORS
    stiffness = numpy.zeros((size, size))

    def spring(a, b, k):
        stiffness[a, a] += k
        stiffness[b, b] += k
        stiffness[a, b] -= k
        stiffness[b, a] -= k

    for sector in range(SECTORS):
        blade, disk, own = (3 * sector + i for i in range(3))
        following = 3 * ((sector + 1) % SECTORS)
        spring(blade, disk, VALUES["k_blade"])
        stiffness[disk, disk] += VALUES["k_disk_ground"]
        spring(disk, following + 1, VALUES["k_disk_disk"])
        spring(own, following + 2, ring * VALUES["k_ring_ring"])
        spring(own, disk, ring * VALUES["k_ring_disk_locating"])
    masses = [VALUES["m_blade"], VALUES["m_disk"], ring * VALUES["m_ring"]]
    return stiffness, numpy.diag(masses * SECTORS)


def stuck(stiffness, contact):
    sum_of_both = stiffness.copy()
    for sector in range(SECTORS):
        disk, ring = 3 * sector + 1, 3 * sector + 2
        sum_of_both[disk, disk] += contact
        sum_of_both[ring, ring] += contact
        sum_of_both[disk, ring] -= contact
        sum_of_both[ring, disk] -= contact
    return sum_of_both


def modes(stiffness, mass, of_blades):
    _, shapes = scipy.linalg.eigh(stiffness, mass)
    if not of_blades:
        return shapes[:, :SECTORS]
    energy = (mass.diagonal()[0] * shapes[0::3] ** 2).sum(axis=0)
    return shapes[:, numpy.argsort(-energy, kind="stable")[:SECTORS]]


def main():
    stiffness, mass = wheel(1.0)
    for own, name in ((stiffness, "K"), (mass, "M")):
        stored = scipy.io.mmread(HERE / f"{name}.mtx").toarray()
        assert numpy.array_equal(own, stored), name
    print("ring,contact_n_per_m,condition,condition_euclidean,condition_lowest")
    for ring in (1.0, 1e-2, 1e-4):
        stiffness, mass = wheel(ring)
        for contact in (3e3, 3e5, 3e9):
            both = [stuck(stiffness, contact), stiffness]
            blades = numpy.hstack([modes(own, mass, True) for own in both])
            lowest = numpy.hstack([modes(own, mass, False) for own in both])
            cells = [
                numpy.linalg.cond(blades.T @ mass @ blades),
                numpy.linalg.cond(blades.T @ blades),
                numpy.linalg.cond(lowest.T @ mass @ lowest),
            ]
            print(f"{ring:g},{contact:g}," + ",".join(f"{cell:.4e}" for cell in cells))


main()
