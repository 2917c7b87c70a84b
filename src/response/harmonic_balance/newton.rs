//! Newton's method on the harmonic balance equation, damped, with a Jacobian kept while it serves.

use super::{ContactShares, HarmonicSystem, NewtonBounds, Status, SystemWorkspace};
use crate::linalg::LuWorkspace;

/// A kept Jacobian must reduce the residual at least to this share, else it is renewed.
const KEPT_JACOBIAN_CONTRACTION: f64 = 0.4;

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
    residual: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
    trial_residual: Vec<f64>,
}

impl NewtonWorkspace {
    /// Buffers for `system`.
    #[must_use]
    pub fn new(system: &HarmonicSystem) -> Self {
        let n = system.unknowns();
        Self {
            system: system.workspace(),
            jacobian: LuWorkspace::new(n),
            residual: vec![0.0; n],
            step: vec![0.0; n],
            trial: vec![0.0; n],
            trial_residual: vec![0.0; n],
        }
    }
}

/// Solves `R(x) = 0` at angular frequency `omega` from the given `x`, in place.
///
/// A step is `-J^-1 R`, halved while the residual does not fall. The Jacobian of an earlier step
/// is used again as long as it reduces the residual well; one that does not is renewed.
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
        residual,
        step,
        trial,
        trial_residual,
    } = workspace;
    let (mut norm, mut shares) = system.residual(omega, x, residual, true, buffers);
    let first = norm;
    let (mut iterations, mut factorisations) = (0, 0);
    let mut renew = true;
    loop {
        let outcome = |status| NewtonOutcome {
            status,
            iterations,
            factorisations,
            residual: norm,
            shares,
        };
        if std::env::var("NEWTON").is_ok() { eprintln!("   it {iterations} norm {norm:e} renew {renew} shares {shares:?}"); }
        if let Some(status) = bounds.judge(first, norm, iterations as usize) {
            return outcome(status);
        }
        let fresh = renew;
        if fresh {
            system.jacobian(omega, buffers, jacobian.matrix_mut());
            if !jacobian.factor() {
                return outcome(Status::SingularJacobian);
            }
            factorisations += 1;
        }
        step.copy_from_slice(residual);
        jacobian.solve(step);
        iterations += 1;

        let halvings = if fresh { bounds.halvings } else { 0 };
        let accepted = (0..=halvings).find_map(|halving| {
            let scale = 0.5_f64.powi(halving as i32);
            for ((t, x), s) in trial.iter_mut().zip(x.iter()).zip(step.iter()) {
                *t = x - scale * s;
            }
            let (trial_norm, trial_shares) =
                system.residual(omega, trial, trial_residual, true, buffers);
            (trial_norm < norm).then_some((trial_norm, trial_shares))
        });
        match accepted {
            Some((trial_norm, trial_shares)) => {
                renew = trial_norm > KEPT_JACOBIAN_CONTRACTION * norm;
                std::mem::swap(x, trial);
                std::mem::swap(residual, trial_residual);
                (norm, shares) = (trial_norm, trial_shares);
            }
            None if fresh => {
                let status = if norm.is_finite() {
                    Status::Stagnated
                } else {
                    Status::NonFinite
                };
                return NewtonOutcome {
                    status,
                    iterations,
                    factorisations,
                    residual: norm,
                    shares,
                };
            }
            None => {
                // The kept Jacobian failed: its derivative data must be those of x again.
                system.residual(omega, x, residual, true, buffers);
                renew = true;
            }
        }
    }
}
