//! Newton's method for the harmonic balance equation at one frequency.

use super::contact_motions::ContactMotions;
use super::kept_jacobian::KeptJacobian;
use super::newton_iteration::{Equation, iterate};
use super::newton_workspace::Start;
use super::{NewtonBounds, NewtonOutcome, NewtonWorkspace, Settled, Steps};
use crate::response::harmonic_balance::Status;
use crate::response::harmonic_balance::equation::{
    HarmonicSystem, LARGEST_WHOLE_JACOBIAN, SystemWorkspace,
};
use crate::response::harmonic_balance::pairs::ContactShares;

/// The harmonic balance equation at one frequency.
struct FixedFrequency<'a> {
    system: &'a HarmonicSystem,
    omega: f64,
    workspace: &'a mut SystemWorkspace,
    jacobian: &'a mut KeptJacobian,
    steps: Steps,
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
        let small = self.system.unknowns() <= LARGEST_WHOLE_JACOBIAN || !self.system.is_shared();
        let by_harmonic = self.steps == Steps::ByHarmonic && !small;
        if by_harmonic {
            let leading = self.system.leading_coefficients();
            self.workspace.couple_first(leading);
        } else {
            self.workspace.couple_all();
        }
        let (_, shares) = self
            .system
            .residual(self.omega, x, residual, true, self.workspace);
        let (system, omega) = (self.system, self.omega);
        // Contact that opens couples the harmonics closely.
        if by_harmonic && shares.separated > 0.0 {
            self.workspace.couple_all();
            system.residual(omega, x, residual, true, self.workspace);
        }
        let whole = small || shares.separated > 0.0;
        match self.steps {
            Steps::Renewed => self.jacobian.factor_cheaply(system, omega, self.workspace),
            Steps::ByHarmonic if !whole => {
                self.jacobian
                    .factor_by_harmonic(system, omega, self.workspace)
            }
            Steps::Accelerated if !whole => {
                self.jacobian.factor_triangle(system, omega, self.workspace)
            }
            _ => self.jacobian.factor_whole(system, omega, self.workspace),
        }
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
    let mut before = None;
    if workspace.moves_contact(system) {
        let (buffers, jacobian) = (&mut workspace.system, &mut workspace.jacobian);
        let (outcome, done) = match ContactMotions::new(system, omega, buffers, jacobian) {
            Some(mut equation) => {
                equation.settled = settled;
                workspace.motions.solve(equation, x, bounds)
            }
            None => (NewtonOutcome::failed(Status::SingularJacobian), false),
        };
        if done {
            return outcome;
        }
        before = Some(outcome);
    }
    let same = |start: &Start| start.omega.total_cmp(&omega).is_eq() && start.x == *x;
    let mut equation = FixedFrequency {
        start: workspace.start.take().filter(same),
        system,
        omega,
        workspace: &mut workspace.system,
        jacobian: &mut workspace.jacobian,
        steps: workspace.buffers.steps,
        settled,
    };
    let mut outcome = iterate(&mut equation, x, bounds, &mut workspace.buffers);
    if let Some(before) = before {
        outcome.iterations += before.iterations;
        outcome.factorisations += before.factorisations;
    }
    outcome
}
