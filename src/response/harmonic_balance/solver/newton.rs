//! Newton's method for the harmonic balance equation at one frequency.

use super::newton_iteration::{Equation, iterate};
use super::newton_workspace::{Start, WholeJacobian};
use super::{NewtonBounds, NewtonOutcome, NewtonWorkspace, Settled};
use crate::response::harmonic_balance::equation::{HarmonicSystem, SystemWorkspace};
use crate::response::harmonic_balance::pairs::ContactShares;

/// The harmonic balance equation at one frequency.
struct FixedFrequency<'a> {
    system: &'a HarmonicSystem,
    omega: f64,
    workspace: &'a mut SystemWorkspace,
    jacobian: &'a mut WholeJacobian,
    settled: Option<Settled<'a>>,
    start: Option<Start>,
}

impl Equation for FixedFrequency<'_> {
    fn residual(&mut self, x: &[f64], residual: &mut [f64]) -> (f64, ContactShares) {
        if let Some(start) = self.start.take() {
            residual.copy_from_slice(&start.residual);
            return (start.norm, start.shares);
        }
        self.system
            .residual(self.omega, x, residual, false, self.workspace)
    }

    fn linearise(&mut self, x: &[f64], residual: &mut [f64]) -> bool {
        self.system
            .residual(self.omega, x, residual, true, self.workspace);
        self.jacobian
            .factor(self.system, self.omega, self.workspace)
    }

    fn is_linearised(&self) -> bool {
        self.jacobian.is_factored()
    }

    fn step(&mut self, residual: &mut [f64]) {
        self.jacobian.solve(residual);
    }

    fn is_settled(&mut self, x: &[f64], step: &[f64]) -> bool {
        self.settled.is_some_and(|settled| settled(x, step))
    }
}

/// Solves `R(x) = 0` at angular frequency `omega` from the given `x`, in place, or until it is `settled`; the
/// factors of the last Jacobian serve again at the next, neighbouring frequency.
pub fn solve(
    system: &HarmonicSystem,
    omega: f64,
    x: &mut Vec<f64>,
    bounds: NewtonBounds,
    settled: Option<Settled<'_>>,
    workspace: &mut NewtonWorkspace,
) -> NewtonOutcome {
    let same = |start: &Start| start.omega.total_cmp(&omega).is_eq() && start.x == *x;
    let mut equation = FixedFrequency {
        start: workspace.start.take().filter(same),
        system,
        omega,
        workspace: &mut workspace.system,
        jacobian: &mut workspace.jacobian,
        settled,
    };
    iterate(&mut equation, x, bounds, &mut workspace.buffers)
}
