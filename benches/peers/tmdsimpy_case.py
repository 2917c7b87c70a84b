"""lumped24, pattern 0, in tmdsimpy: processor time of its curve and of its peak, as `name = value`.

Run by run.py in an environment with what tmdsimpy needs; takes the folder of the case, the number of repetitions and the
folder of tmdsimpy.
"""

import sys
from pathlib import Path

import numpy as np
from wheel import Case, Sweep, print_curve, print_peak

sys.path.insert(0, sys.argv[3])
from tmdsimpy import NonlinearSolver, VibrationSystem
from tmdsimpy.jax.solvers import NonlinearSolverOMP
from tmdsimpy.nlforces.vector_jenkins import VectorJenkins


class TmdsimpySweep(Sweep):
    """tmdsimpy's residual with its analytical Jacobian, its Newton method (`NonlinearSolverOMP`), else its hybr."""

    def __init__(self, case, *tolerance):
        super().__init__(case, *tolerance)
        dofs = len(case.mass)
        solve = case.data["solve"]
        self.harmonics, self.samples = np.array(solve["harmonics"]), solve["samples_per_period"]
        self.system = VibrationSystem(case.mass, case.stiffness, C=case.damping)
        self.stuck = case.stiffness.copy()
        for contact in case.data["contact"]:
            direction = np.zeros((1, dofs))
            direction[0, [contact["dof_a"], contact["dof_b"]]] = 1, -1
            self.system.add_nl_force(VectorJenkins(direction, direction.T, contact["k_t"], contact["slip_limit"]))
            self.stuck += contact["k_t"] * direction.T @ direction
        # (re + i im) exp(i omega t) is re cos - im sin.
        self.load = np.zeros(2 * len(self.harmonics) * dofs)
        self.load[case.force[:, 0].astype(int)] = case.force[:, 1]
        self.load[dofs + case.force[:, 0].astype(int)] = -case.force[:, 2]
        newton = NonlinearSolverOMP(dict(max_steps=12, rtol=self.tolerance * case.force_norm, stopping_tol=["rtol"], verbose=False))
        hybr = NonlinearSolver()
        by = lambda solver: lambda start, omega: self.by(solver, start, omega)
        self.solvers = [by(newton), by(hybr)]

    def equations(self, point):
        return self.system.hbm_res(point, self.load, self.harmonics, Nt=self.samples)

    def residual(self, point):
        return np.linalg.norm(self.equations(point)[0]) / self.case.force_norm

    def by(self, solver, start, omega):
        try:
            found = solver.nsolve(lambda x: self.equations(np.append(x, omega))[:2], start, verbose=False, xtol=1e-12)
        except (np.linalg.LinAlgError, ValueError):
            return None
        return np.append(np.asarray(found[0]), omega)

    def first(self, omega):
        """The linear response with stuck contacts."""
        case, dofs = self.case, len(self.case.mass)
        dynamic = self.stuck - omega**2 * case.mass + 1j * omega * case.damping
        response = np.linalg.solve(dynamic, self.load[:dofs] - 1j * self.load[dofs : 2 * dofs])
        start = np.zeros_like(self.load)
        start[: 2 * dofs] = np.append(response.real, -response.imag)
        return start

    def terms(self, solution):
        dofs = len(self.case.mass)
        blocks = solution.reshape(-1, dofs)
        for number, block in enumerate(blocks):
            for dof in range(0, dofs, 3):
                yield block[dof], self.harmonics[number // 2], "cs"[number % 2], dof


def main():
    case = Case(Path(sys.argv[1]))
    warm = TmdsimpySweep(case)  # JAX compiles
    warm.height(352.0)
    print_curve(case, TmdsimpySweep, int(sys.argv[2]))
    print_peak(case, TmdsimpySweep, int(sys.argv[2]))


main()
