"""lumped24, pattern 0, for a program in Python: what it is given, the stored curve, and the steps over the frequencies."""

import time
import tomllib

import numpy as np
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

    def amplitudes(self, terms):
        """Largest value over a period at every blade, m, of terms (value, harmonic, "c" or "s", dof)."""
        instants = np.arange(1024) * TAU / 1024
        motion = np.zeros((24, 1024))
        for value, harmonic, part, dof in terms:
            if dof % 3 == 0:
                motion[dof // 3] += value * (np.cos if part == "c" else np.sin)(harmonic * instants)
        return np.abs(motion).max(axis=1)


class Sweep:
    """Points solved by a program's own solvers until the residual is met: the first solver, else the second, from the
    secant through the nearest two points, else from the nearest; where none converges, a point between is solved first.

    A program gives `solvers` (each takes a start and a circular frequency, and returns a point or `None`), `residual` of
    a point relative to the force, `first` (the start of the first point) and `terms` of a solution. A point is the
    unknowns and, last, the circular frequency."""

    def __init__(self, case, residual_tolerance=RESIDUAL_TOLERANCE):
        self.case = case
        self.tolerance = residual_tolerance
        self.points = []

    def attempt(self, solver, start, omega):
        point = solver(start, omega)
        return point if point is not None and self.residual(point) <= self.tolerance else None

    def starts(self, omega):
        near = sorted(self.points, key=lambda point: abs(point[-1] - omega))[:2]
        if not near:
            return [self.first(omega)]
        starts = [near[0][:-1]]
        if len(near) == 2:
            a, b = near
            starts.insert(0, a[:-1] + (omega - a[-1]) / (a[-1] - b[-1]) * (a[:-1] - b[:-1]))
        return starts

    def solve(self, frequency_hz, depth=0):
        omega = TAU * frequency_hz
        for solver in self.solvers:
            for start in self.starts(omega):
                point = self.attempt(solver, start, omega)
                if point is not None:
                    self.points.append(point)
                    return point
        if depth == 6 or not self.points:
            raise RuntimeError(f"no solution at {frequency_hz} Hz")
        nearest = min(self.points, key=lambda point: abs(point[-1] - omega))[-1] / TAU
        self.solve(0.5 * (frequency_hz + nearest), depth + 1)
        return self.solve(frequency_hz, depth + 1)

    def amplitudes(self, point):
        return self.case.amplitudes(self.terms(point[:-1]))

    def height(self, frequency_hz):
        return self.amplitudes(self.solve(frequency_hz)).max()


def peak(case, sweep_type):
    """A sweep in steps of 1 Hz, then parabolas through the three highest neighbours until one adds less than 1e-4."""
    sweep = sweep_type(case, 1e-6)  # far finer than 0.1 % of the amplitude needs
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


def timed(work):
    before = time.process_time()
    result = work()
    return time.process_time() - before, result


def print_curve(case, sweep_type, repetitions):
    """The smallest processor time of the stored curve, and its worst blade; an error where a blade is wrong."""

    def curve():
        sweep = sweep_type(case)
        return sweep, [sweep.solve(frequency) for frequency in case.reference[:, 0]]

    curves = [timed(curve) for _ in range(repetitions)]
    sweep, points = curves[-1][1]
    worst = max(np.abs(sweep.amplitudes(x) / row[1:] - 1).max() for x, row in zip(points, case.reference))
    assert worst <= CURVE_TOLERANCE, worst
    print(f"curve_s = {min(seconds for seconds, _ in curves):.3f}")
    print(f"curve_difference = {worst:e}")
    print(f"curve_solves = {len(sweep.points)}", flush=True)


def print_peak(case, sweep_type, repetitions):
    """The smallest processor time of the peak, held against a fine curve around it, which is given back with its top."""
    peaks = [timed(lambda: peak(case, sweep_type)) for _ in range(repetitions)]
    frequency, height, solves = peaks[-1][1]
    fine = sweep_type(case)
    around = {f: fine.height(f) for f in np.arange(frequency - 0.5, frequency + 0.5, 0.02)}
    highest = max(around.values())
    assert abs(height / highest - 1) <= PEAK_TOLERANCE, (height, highest)
    print(f"peak_s = {min(seconds for seconds, _ in peaks):.3f}")
    print(f"peak_hz = {frequency:.6f}")
    print(f"peak_m = {height:e}")
    print(f"peak_solves = {solves}")
    print(f"peak_difference = {abs(height / highest - 1):e}", flush=True)
    return around, highest
