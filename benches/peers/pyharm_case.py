"""lumped24, pattern 0, in pyHarm 1.2.2: processor time of its curve and of its peak, as `name = value`.

Run by run.py in an environment with pyHarm; takes the folder of the case and the number of repetitions.
"""

import logging
import sys
import time
import tomllib
from pathlib import Path

import numpy as np
from pyHarm.Maestro import Maestro
from pyHarm.Solver import SystemSolution
from scipy.io import mmread

RESIDUAL_TOLERANCE = 1e-8  # relative to the force, as blisk has it
CURVE_TOLERANCE = 1e-6
PEAK_TOLERANCE = 1e-3
TAU = 2 * np.pi


class Case:
    """Matrices with the mistuned blades, forces, contacts and the stored curve."""

    def __init__(self, folder):
        self.data = tomllib.loads((folder / "case.toml").read_text())
        read = lambda name: mmread(folder / name)
        dense = lambda matrix: np.asarray(matrix.todense() if hasattr(matrix, "todense") else matrix)
        self.mass, self.damping, self.stiffness = (dense(read(name)) for name in ("M.mtx", "C.mtx", "K.mtx"))
        for pattern, blade, deviation in np.loadtxt(folder / "mistuning.csv", delimiter=",", skiprows=1):
            if pattern == 0:
                change = self.data["parameters"]["k_blade"] * deviation * np.array([[1, -1], [-1, 1]])
                dofs = np.array([3 * int(blade), 3 * int(blade) + 1])
                self.stiffness[np.ix_(dofs, dofs)] += change
        self.force = np.loadtxt(folder / "force.csv", delimiter=",")
        self.force_norm = np.linalg.norm(self.force[:, 1:])
        self.reference = np.loadtxt(folder / "ref_p0_h3.csv", delimiter=",")

    def maestro(self, solver, options):
        """The system in pyHarm, with one analysis that uses `solver` at fixed frequencies."""
        connectors = {}
        for dof, real, imaginary in self.force:
            if real or imaginary:
                # (re + i im) exp(i omega t) is re cos - im sin.
                connectors[f"force{int(dof)}"] = dict(
                    type="GOForcing", connect={"wheel": [int(dof)]}, dirs=[0], dto=0, ho=1,
                    phi=float(np.arctan2(-imaginary, real)), amp=float(np.hypot(real, imaginary)),
                )
        for number, contact in enumerate(self.data["contact"]):
            connectors[f"contact{number}"] = dict(
                type="Jenkins", connect={"wheel": [contact["dof_a"]], "INTERNAL": [contact["dof_b"]]}, dirs=[0],
                mu=1.0, N0=contact["slip_limit"], k=contact["k_t"],
            )
        analysis = dict(
            study="frf", solver=solver, solver_options=options, verbose=False,
            corrector="nocontinuation",
            puls_inf=TAU * self.reference[0, 0], puls_sup=TAU * self.reference[-1, 0],
        )
        matrices = dict(M=self.mass, C=self.damping, K=self.stiffness)
        solve = self.data["solve"]
        return Maestro(dict(
            system=dict(type="Base", nh=solve["harmonics"], nti=solve["samples_per_period"]),
            substructures=dict(wheel=dict(type="substructure", ndofs=1, matrix=matrices)),
            connectors=connectors, analysis=dict(curve=analysis),
        ))

    def amplitudes(self, maestro, solution):
        """Largest value over a period at every blade, m."""
        instants = np.arange(1024) * TAU / 1024
        motion = np.zeros((24, 1024))
        dofs = maestro.system.expl_dofs
        for value, harmonic, part, dof in zip(solution, dofs["harm"], dofs["cs"], dofs["node_num"]):
            if dof % 3 == 0:
                motion[dof // 3] += value * (np.cos if part == "c" else np.sin)(harmonic * instants)
        return np.abs(motion).max(axis=1)

    def difference(self, maestro, solution, row):
        return np.abs(self.amplitudes(maestro, solution) / row[1:] - 1).max()


class Sweep:
    """Points solved by pyHarm's own solvers until the residual is met: Newton's method, else scipy's hybr, from the
    secant through the nearest two points, else from the nearest; where none converges, a point between is solved first."""

    def __init__(self, case, residual_tolerance=RESIDUAL_TOLERANCE):
        self.case = case
        options = dict(max_iter=12, tol_residual=residual_tolerance * case.force_norm)
        self.maestro = case.maestro("NewtonRaphson", options)
        hybr = case.maestro("scipyroot", {"root": {"method": "hybr", "options": {"xtol": 1e-12}}})
        self.newton, self.hybr = self.maestro.nls["curve"], hybr.nls["curve"]
        self.tolerance = residual_tolerance
        self.points = []

    def residual(self, point):
        return np.linalg.norm(self.maestro.system.Residual(point)) / self.case.force_norm

    def attempt(self, analysis, start, omega):
        solution = SystemSolution(np.append(start, omega), None)
        try:
            analysis.solver.Solve(solution, [])
        except (np.linalg.LinAlgError, ValueError):
            return None
        point = np.asarray(solution.x_red)
        return point if self.residual(point) <= self.tolerance else None

    def starts(self, omega):
        near = sorted(self.points, key=lambda point: abs(point[-1] - omega))[:2]
        if not near:
            self.newton.analysis_options["puls_start"] = omega
            return [self.newton._get_x0(None)[:-1]]
        starts = [near[0][:-1]]
        if len(near) == 2:
            a, b = near
            starts.insert(0, a[:-1] + (omega - a[-1]) / (a[-1] - b[-1]) * (a[:-1] - b[:-1]))
        return starts

    def solve(self, frequency_hz, depth=0):
        omega = TAU * frequency_hz
        for analysis in (self.newton, self.hybr):
            for start in self.starts(omega):
                point = self.attempt(analysis, start, omega)
                if point is not None:
                    self.points.append(point)
                    return point
        if depth == 6 or not self.points:
            raise RuntimeError(f"no solution at {frequency_hz} Hz")
        nearest = min(self.points, key=lambda point: abs(point[-1] - omega))[-1] / TAU
        self.solve(0.5 * (frequency_hz + nearest), depth + 1)
        return self.solve(frequency_hz, depth + 1)

    def height(self, frequency_hz):
        return self.case.amplitudes(self.maestro, self.solve(frequency_hz)[:-1]).max()


def peak(case):
    """A sweep in steps of 1 Hz, then parabolas through the three highest neighbours until one adds less than 1e-4."""
    sweep = Sweep(case, 1e-6)  # far finer than 0.1 % of the amplitude needs
    grid = np.arange(case.reference[0, 0], case.reference[-1, 0] + 0.5, 1.0)
    heights = {frequency: sweep.height(frequency) for frequency in grid}
    while True:
        ordered = sorted(heights)
        best = max(ordered, key=heights.get)
        at = ordered.index(best)
        three = ordered[at - 1 : at + 2]
        fit = np.polyfit(np.array(three) - best, [heights[f] for f in three], 2)
        top, expected = best - fit[1] / (2 * fit[0]), fit[2] - fit[1] ** 2 / (4 * fit[0])
        if abs(expected / heights[best] - 1) < 1e-4 and three[2] - three[0] < 0.6:
            return best, heights[best], len(heights)
        if min(abs(top - f) for f in three) < 0.05:
            left, right = best - three[0], three[2] - best
            top = best + 0.5 * right if right > left else best - 0.5 * left
        heights[top] = sweep.height(top)


def width(heights):
    """How wide the top is within the tolerance, Hz, by straight lines between samples; the top is inside."""
    frequencies = np.array(sorted(heights))
    above = np.array([heights[f] for f in frequencies]) / max(heights.values()) - (1 - PEAK_TOLERANCE)
    crossed = [
        a + (b - a) * x / (x - y)
        for a, b, x, y in zip(frequencies, frequencies[1:], above, above[1:]) if x * y < 0
    ]
    return max(crossed) - min(crossed)


def highest_of(case, points):
    """The highest of a curve of so many points."""
    sweep = Sweep(case, 1e-6)
    return max(sweep.height(f) for f in np.linspace(case.reference[0, 0], case.reference[-1, 0], points))


def timed(work):
    before = time.process_time()
    result = work()
    return time.process_time() - before, result


def main():
    folder, repetitions = Path(sys.argv[1]), int(sys.argv[2])
    case = Case(folder)
    logging.disable(logging.CRITICAL)
    warm = Sweep(case)  # numba compiles
    warm.height(352.0)
    warm.attempt(warm.hybr, warm.points[0][:-1], TAU * 352.1)

    def curve():
        sweep = Sweep(case)
        return sweep, [sweep.solve(frequency) for frequency in case.reference[:, 0]]

    curves = [timed(curve) for _ in range(repetitions)]
    sweep, points = curves[-1][1]
    worst = max(case.difference(sweep.maestro, x[:-1], row) for x, row in zip(points, case.reference))
    assert worst <= CURVE_TOLERANCE, worst
    print(f"curve_s = {min(seconds for seconds, _ in curves):.3f}")
    print(f"curve_difference = {worst:e}")

    peaks = [timed(lambda: peak(case)) for _ in range(repetitions)]
    frequency, height, solves = peaks[-1][1]
    fine = Sweep(case)
    around = {f: fine.height(f) for f in np.arange(frequency - 0.5, frequency + 0.5, 0.02)}
    highest = max(around.values())
    assert abs(height / highest - 1) <= PEAK_TOLERANCE, (height, highest)
    print(f"peak_s = {min(seconds for seconds, _ in peaks):.3f}")
    print(f"peak_hz = {frequency:.6f}")
    print(f"peak_m = {height:e}")
    print(f"peak_solves = {solves}")
    print(f"peak_difference = {abs(height / highest - 1):e}")

    # Wherever its points lie, one of a curve with steps of this width is on the top.
    points = int(np.ceil((case.reference[-1, 0] - case.reference[0, 0]) / width(around))) + 1
    swept = [timed(lambda: highest_of(case, points)) for _ in range(repetitions)]
    assert all(abs(height / highest - 1) <= PEAK_TOLERANCE for _, height in swept), (swept, highest)
    print(f"swept_s = {min(seconds for seconds, _ in swept):.3f}")
    print(f"swept_points = {points}")


main()
