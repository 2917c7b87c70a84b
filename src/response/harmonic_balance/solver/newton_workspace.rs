//! Buffers of Newton's method for one system, and the choice of where it starts.

use super::Steps;
use super::contact_motions::{ContactMotions, MotionSolver};
use super::kept_jacobian::KeptJacobian;
use super::newton_iteration::{DEPTH, DEPTH_OF_ONCE, NewtonBuffers};
use crate::response::harmonic_balance::equation::{HarmonicSystem, SystemWorkspace};
use crate::response::harmonic_balance::pairs::ContactShares;

/// Buffers of Newton's method for one system.
pub struct NewtonWorkspace {
    pub(super) system: SystemWorkspace,
    /// Factors of the Jacobian, of the last point at which it was factored.
    pub(super) jacobian: KeptJacobian,
    pub(super) buffers: NewtonBuffers,
    /// The start of the solve that follows, where several were compared.
    pub(super) start: Option<Start>,
    /// Solver for the motions at the contact rows.
    pub(super) motions: MotionSolver,
}

/// A start with what its choice has found.
pub(super) struct Start {
    pub(super) omega: f64,
    pub(super) x: Vec<f64>,
    pub(super) residual: Vec<f64>,
    pub(super) norm: f64,
    pub(super) shares: ContactShares,
}

impl NewtonWorkspace {
    /// Buffers for `system`.
    #[must_use]
    pub fn new(system: &HarmonicSystem) -> Self {
        let n = system.unknowns();
        Self {
            system: system.workspace(),
            jacobian: KeptJacobian::new(),
            buffers: NewtonBuffers::accelerated(n, DEPTH),
            start: None,
            motions: MotionSolver::default(),
        }
    }

    /// The one of `starts` with the smallest residual at angular frequency `omega`, for a [`super::solve`] that follows at once;
    /// none if none has one.
    pub fn of_least_residual(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        mut starts: Vec<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        self.start = None;
        self.motions.forget_start();
        if self.moves_contact(system) {
            let (workspace, jacobian) = (&mut self.system, &mut self.jacobian);
            let mut equation = ContactMotions::new(system, omega, workspace, jacobian)?;
            return self.motions.of_least_motion(&mut equation, starts);
        }
        if let [_] = starts[..] {
            return starts.pop();
        }
        for x in starts {
            let mut residual = vec![0.0; system.unknowns()];
            let (norm, shares) = system.residual(omega, &x, &mut residual, false, &mut self.system);
            if self.start.as_ref().is_none_or(|best| norm < best.norm) {
                self.start = Some(Start {
                    omega,
                    x,
                    residual,
                    norm,
                    shares,
                });
            }
        }
        self.start.as_ref().map(|best| best.x.clone())
    }

    /// Whether the motions at the contact rows are what is solved for.
    pub(super) fn moves_contact(&self, system: &HarmonicSystem) -> bool {
        self.steps() == Steps::Renewed && system.condenses()
    }

    /// The response with every pair stuck, where what it takes is needed anyway; none where it is not, or is singular.
    pub fn stuck_response(&mut self, system: &HarmonicSystem, omega: f64) -> Option<Vec<f64>> {
        if !self.moves_contact(system) {
            return None;
        }
        let condensed = self.jacobian.condensed();
        condensed.factor_linear(system, omega).then(|| {
            let forces = vec![0.0; self.system.contact.displacement.len()];
            condensed.response_of(system, &forces)
        })
    }

    /// Buffers of the system itself, whose residual was last taken anywhere.
    pub fn system_mut(&mut self) -> &mut SystemWorkspace {
        &mut self.system
    }

    /// How steps are made.
    #[must_use]
    pub fn steps(&self) -> Steps {
        self.buffers.steps
    }

    /// How steps are made from now on; at first they are accelerated.
    pub fn set_steps(&mut self, steps: Steps) {
        if self.buffers.steps == steps {
            return;
        }
        if steps.keep_jacobian() || self.buffers.steps.keep_jacobian() {
            // Factors of another kind are of no use.
            self.jacobian.forget();
            let n = self.buffers.step.len();
            self.buffers = if steps.keep_jacobian() {
                NewtonBuffers::accelerated(n, DEPTH_OF_ONCE)
            } else {
                NewtonBuffers::accelerated(n, DEPTH)
            };
        }
        self.buffers.steps = steps;
    }

    /// Assembles and factors the Jacobian of `system` at `x`; false if it is singular.
    pub fn factor_at(&mut self, system: &HarmonicSystem, omega: f64, x: &[f64]) -> bool {
        if system.condenses() {
            // Factors need the derivatives of the contact alone, not the residual.
            system.contact_at(x, true, &mut self.system);
        } else {
            system.residual(omega, x, &mut self.buffers.residual, true, &mut self.system);
        }
        self.jacobian
            .factor_cheaply(system, omega, &mut self.system)
    }

    /// `J^-1 residual` with the factors at hand, in place.
    pub fn solve_linear(&mut self, residual: &mut [f64]) {
        self.jacobian.solve(residual);
    }
}
