"""lumped24, pattern 0, in pyHarm 1.2.2: processor time of its curve and of its peak, as `name = value`.

Run by run.py in an environment with pyHarm; takes the folder of the case and the number of repetitions.
"""

import logging
import sys
from pathlib import Path

import numpy as np
from pyHarm.Maestro import Maestro
from pyHarm.Solver import SystemSolution
from wheel import PEAK_TOLERANCE, TAU, Case, Sweep, print_curve, print_peak, timed, width


class PyharmCase(Case):
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


class PyharmSweep(Sweep):
    """pyHarm's Newton method, else scipy's hybr through pyHarm."""

    def __init__(self, case, *tolerance):
        super().__init__(case, *tolerance)
        options = dict(max_iter=12, tol_residual=self.tolerance * case.force_norm)
        self.maestro = case.maestro("NewtonRaphson", options)
        hybr = case.maestro("scipyroot", {"root": {"method": "hybr", "options": {"xtol": 1e-12}}})
        self.newton, self.hybr = self.maestro.nls["curve"], hybr.nls["curve"]
        by = lambda analysis: lambda start, omega: self.by(analysis, start, omega)
        self.solvers = [by(self.newton), by(self.hybr)]

    def residual(self, point):
        return np.linalg.norm(self.maestro.system.Residual(point)) / self.case.force_norm

    def by(self, analysis, start, omega):
        solution = SystemSolution(np.append(start, omega), None)
        try:
            analysis.solver.Solve(solution, [])
        except (np.linalg.LinAlgError, ValueError):
            return None
        return np.asarray(solution.x_red)

    def first(self, omega):
        self.newton.analysis_options["puls_start"] = omega
        return self.newton._get_x0(None)[:-1]

    def terms(self, solution):
        dofs = self.maestro.system.expl_dofs
        return zip(solution, dofs["harm"], dofs["cs"], dofs["node_num"])


def highest_of(case, points):
    """The highest of a curve of so many points."""
    sweep = PyharmSweep(case, 1e-6)
    return max(sweep.height(f) for f in np.linspace(case.reference[0, 0], case.reference[-1, 0], points))


def main():
    folder, repetitions = Path(sys.argv[1]), int(sys.argv[2])
    case = PyharmCase(folder)
    logging.disable(logging.CRITICAL)
    warm = PyharmSweep(case)  # numba compiles
    warm.height(352.0)
    warm.attempt(warm.solvers[1], warm.points[0][:-1], TAU * 352.1)

    print_curve(case, PyharmSweep, repetitions)
    around, highest = print_peak(case, PyharmSweep, repetitions)

    # Wherever its points lie, one of a curve with steps of this width is on the top.
    points = int(np.ceil((case.reference[-1, 0] - case.reference[0, 0]) / width(around))) + 1
    swept = [timed(lambda: highest_of(case, points)) for _ in range(repetitions)]
    assert all(abs(height / highest - 1) <= PEAK_TOLERANCE for _, height in swept), (swept, highest)
    print(f"swept_s = {min(seconds for seconds, _ in swept):.3f}")
    print(f"swept_points = {points}")


main()
