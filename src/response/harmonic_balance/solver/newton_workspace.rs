//! Buffers of Newton's method for one system, the factors of its Jacobian, and the choice of where it starts.

use super::newton_iteration::NewtonBuffers;
use crate::linalg::LuWorkspace;
use crate::response::harmonic_balance::equation::{HarmonicSystem, SystemWorkspace};
use crate::response::harmonic_balance::pairs::ContactShares;

/// Factors of the Jacobian of one system, of the last point at which it was factored.
#[derive(Default)]
pub(super) struct WholeJacobian {
    factors: Option<LuWorkspace<f64>>,
    is_factored: bool,
}

impl WholeJacobian {
    /// Factors the Jacobian at the point last given to [`HarmonicSystem::residual`] with derivative; false if it is singular.
    pub(super) fn factor(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        let unknowns = system.unknowns();
        let factors = self
            .factors
            .get_or_insert_with(|| LuWorkspace::new(unknowns));
        system.jacobian(omega, workspace, factors.matrix_mut());
        self.is_factored = factors.factor();
        self.is_factored
    }

    /// Whether there are factors, of this or of an earlier point.
    pub(super) fn is_factored(&self) -> bool {
        self.is_factored
    }

    /// `J^-1 residual` with the factors at hand, in place.
    pub(super) fn solve(&mut self, residual: &mut [f64]) {
        if let Some(factors) = &mut self.factors {
            factors.solve(residual);
        }
    }
}

/// Buffers of Newton's method for one system.
pub struct NewtonWorkspace {
    pub(super) system: SystemWorkspace,
    pub(super) jacobian: WholeJacobian,
    pub(super) buffers: NewtonBuffers,
    /// The start of the solve that follows, where several were compared.
    pub(super) start: Option<Start>,
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
        Self {
            system: system.workspace(),
            jacobian: WholeJacobian::default(),
            buffers: NewtonBuffers::new(system.unknowns()),
            start: None,
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

    /// Buffers of the system itself, whose residual was last taken anywhere.
    pub fn system_mut(&mut self) -> &mut SystemWorkspace {
        &mut self.system
    }

    /// Assembles and factors the Jacobian of `system` at `x`; false if it is singular.
    pub fn factor_at(&mut self, system: &HarmonicSystem, omega: f64, x: &[f64]) -> bool {
        system.residual(omega, x, &mut self.buffers.residual, true, &mut self.system);
        self.jacobian.factor(system, omega, &mut self.system)
    }

    /// `J^-1 residual` with the factors at hand, in place.
    pub fn solve_linear(&mut self, residual: &mut [f64]) {
        self.jacobian.solve(residual);
    }
}
