//! Newton's method on the harmonic balance equation, damped, with a Jacobian kept while it serves.

use super::{ContactShares, HarmonicSystem, NewtonBounds, Status, SystemWorkspace};
use crate::linalg::LuWorkspace;

/// A kept Jacobian must reduce the residual at least to this share, else it is renewed.
const KEPT_JACOBIAN_CONTRACTION: f64 = 0.6;

/// Outcome of one nonlinear solve; the solution itself is left in the caller's vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonOutcome {
    /// How the iteration ended.
    pub status: Status,
    /// Newton steps taken.
    pub iterations: u64,
    /// Jacobians assembled and factored.
    pub factorisations: u64,
    /// Residual norm relative to the excitation.
    pub residual: f64,
    /// Shares of slipping and separated pairs.
    pub shares: ContactShares,
}

/// Buffers of Newton's method for one system.
pub struct NewtonWorkspace {
    system: SystemWorkspace,
    jacobian: LuWorkspace<f64>,
    /// Whether `jacobian` holds the factors of an earlier point.
    factored: bool,
    residual: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
    trial_step: Vec<f64>,
}

impl NewtonWorkspace {
    /// Buffers for `system`.
    #[must_use]
    pub fn new(system: &HarmonicSystem) -> Self {
        let n = system.unknowns();
        Self {
            system: system.workspace(),
            jacobian: LuWorkspace::new(n),
            factored: false,
            residual: vec![0.0; n],
            step: vec![0.0; n],
            trial: vec![0.0; n],
            trial_step: vec![0.0; n],
        }
    }

    /// Assembles and factors the Jacobian of `system` at `x`; false if it is singular.
    pub fn factor_at(&mut self, system: &HarmonicSystem, omega: f64, x: &[f64]) -> bool {
        system.residual(omega, x, &mut self.residual, true, &mut self.system);
        system.jacobian(omega, &mut self.system, self.jacobian.matrix_mut());
        self.factored = self.jacobian.factor();
        self.factored
    }

    /// `J^-1 residual` with the factors at hand, in place.
    pub fn solve_linear(&mut self, residual: &mut [f64]) {
        self.jacobian.solve(residual);
    }
}

/// Solves `R(x) = 0` at angular frequency `omega` from the given `x`, in place.
///
/// A step is `s = -J^-1 R(x)`, damped by the natural monotonicity test of Deuflhard (2004, Newton
/// Methods for Nonlinear Problems, section 3.3): a damped step is taken where the next simplified
/// step `-J^-1 R(x + factor s)`, with the same Jacobian, is the shorter one. Unlike the residual
/// itself this does not depend on how the equations are scaled, and contact forces are far from
/// well scaled. While the simplified step is much shorter, it is taken as the next step and the
/// Jacobian is kept, also from one frequency to the next.
pub fn solve(
    system: &HarmonicSystem,
    omega: f64,
    x: &mut Vec<f64>,
    bounds: NewtonBounds,
    workspace: &mut NewtonWorkspace,
) -> NewtonOutcome {
    let NewtonWorkspace {
        system: buffers,
        jacobian,
        factored,
        residual,
        step,
        trial,
        trial_step,
    } = workspace;
    let (first, shares) = system.residual(omega, x, residual, false, buffers);
    let mut state = NewtonOutcome {
        status: Status::IterationLimit,
        iterations: 0,
        factorisations: 0,
        residual: first,
        shares,
    };
    let ended = |state: NewtonOutcome, status| NewtonOutcome { status, ..state };
    // Whether `step` holds a simplified step with the kept Jacobian: at first that of an earlier
    // solve of the same workspace, which a neighbouring frequency often allows to go on with.
    let mut kept = *factored && first.is_finite();
    if kept {
        step.copy_from_slice(residual);
        jacobian.solve(step);
    }
    loop {
        if let Some(status) = bounds.judge(first, state.residual, state.iterations as usize) {
            return ended(state, status);
        }
        if !kept {
            system.residual(omega, x, residual, true, buffers);
            system.jacobian(omega, buffers, jacobian.matrix_mut());
            *factored = jacobian.factor();
            if !*factored {
                return ended(state, Status::SingularJacobian);
            }
            state.factorisations += 1;
            step.copy_from_slice(residual);
            jacobian.solve(step);
        }
        state.iterations += 1;
        let length = norm_of(step);
        let halvings = if kept { 0 } else { bounds.halvings };
        let accepted = (0..=halvings).find_map(|halving| {
            let factor = 0.5_f64.powi(halving as i32);
            for ((t, x), s) in trial.iter_mut().zip(x.iter()).zip(step.iter()) {
                *t = x - factor * s;
            }
            let (norm, shares) = system.residual(omega, trial, residual, false, buffers);
            trial_step.copy_from_slice(residual);
            jacobian.solve(trial_step);
            let contraction = norm_of(trial_step) / length;
            let monotone = contraction <= 1.0 - 0.25 * factor;
            (monotone || norm <= bounds.residual_tolerance).then_some((norm, shares, contraction))
        });
        match accepted {
            Some((norm, shares, contraction)) => {
                std::mem::swap(x, trial);
                (state.residual, state.shares) = (norm, shares);
                kept = contraction <= KEPT_JACOBIAN_CONTRACTION;
                if kept {
                    std::mem::swap(step, trial_step);
                }
            }
            None if kept => kept = false,
            None if state.residual.is_finite() => return ended(state, Status::Stagnated),
            None => return ended(state, Status::NonFinite),
        }
    }
}

fn norm_of(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
