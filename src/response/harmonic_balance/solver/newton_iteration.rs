//! Damped Newton iteration with a Jacobian kept while it serves, for any equation that can be linearised.

use super::NewtonBounds;
use crate::response::harmonic_balance::Status;
use crate::response::harmonic_balance::pairs::ContactShares;

/// Length of a simplified step over that of the step before, up to which the step is taken, and up to which its Jacobian serves on.
const LONGEST: f64 = 0.75;
const SERVES: f64 = 0.6;

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

/// An equation `R(u) = 0` as the iteration sees it.
pub(in crate::response::harmonic_balance) trait Equation {
    /// Residual at `u` into `residual`; returns its norm relative to the excitation and the shares
    /// of slipping and separated pairs.
    fn residual(&mut self, u: &[f64], residual: &mut [f64]) -> (f64, ContactShares);

    /// Factors the derivative at `u` and fills `residual`; false if the derivative is singular.
    fn linearise(&mut self, u: &[f64], residual: &mut [f64]) -> bool;

    /// Whether factors are at hand, of this or of an earlier solve.
    fn is_linearised(&self) -> bool;

    /// Turns a residual into the step `J^-1 R` with the factors at hand, in place.
    fn step(&mut self, residual: &mut [f64]);

    /// Whether `u` serves its purpose already, where `step` is what it still lacks.
    fn is_settled(&mut self, _u: &[f64], _step: &[f64]) -> bool {
        false
    }
}

/// Whether a solution serves its purpose (first argument) with the next step (second) left undone.
pub type Settled<'a> = &'a dyn Fn(&[f64], &[f64]) -> bool;

/// Vectors of the iteration.
pub(in crate::response::harmonic_balance) struct NewtonBuffers {
    pub(super) residual: Vec<f64>,
    pub(super) step: Vec<f64>,
    trial: Vec<f64>,
    trial_step: Vec<f64>,
}

impl NewtonBuffers {
    /// Vectors for `n` unknowns.
    pub(in crate::response::harmonic_balance) fn new(n: usize) -> Self {
        Self {
            residual: vec![0.0; n],
            step: vec![0.0; n],
            trial: vec![0.0; n],
            trial_step: vec![0.0; n],
        }
    }
}

/// Solves `R(u) = 0` from the given `u`, in place.
///
/// A step is `s = -J^-1 R(u)`, damped by the natural monotonicity test of Deuflhard (2004, Newton
/// Methods for Nonlinear Problems, section 3.3): a damped step is taken where the next simplified
/// step `-J^-1 R(u + factor s)`, with the same Jacobian, is the shorter one. Unlike the residual
/// itself this does not depend on how the equations are scaled, and contact forces are far from
/// well scaled. While the simplified steps become shorter the Jacobian is kept.
pub(in crate::response::harmonic_balance) fn iterate(
    equation: &mut impl Equation,
    u: &mut Vec<f64>,
    bounds: NewtonBounds,
    buffers: &mut NewtonBuffers,
) -> NewtonOutcome {
    let NewtonBuffers {
        residual,
        step,
        trial,
        trial_step,
    } = buffers;
    let (first, shares) = equation.residual(u, residual);
    let mut state = NewtonOutcome {
        status: Status::IterationLimit,
        iterations: 0,
        factorisations: 0,
        residual: first,
        shares,
    };
    let ended = |state: NewtonOutcome, status| NewtonOutcome { status, ..state };
    // Whether `step` holds a simplified step with a kept Jacobian: at first that of an earlier
    // solve, which a neighbouring point often allows to go on with.
    let mut kept = equation.is_linearised() && first.is_finite();
    if kept {
        negative_step(equation, residual, step);
    }
    loop {
        if let Some(status) = bounds.judge(first, state.residual, state.iterations as usize) {
            // Forces of a pair without a periodic state prove nothing, however small the residual.
            let unproven = status == Status::Ok && state.shares.unclosed > 0.0;
            return ended(state, if unproven { Status::Stagnated } else { status });
        }
        if !kept {
            if !equation.linearise(u, residual) {
                return ended(state, Status::SingularJacobian);
            }
            state.factorisations += 1;
            negative_step(equation, residual, step);
        }
        state.iterations += 1;
        let length = norm_of(step);
        let halvings = if kept { 0 } else { bounds.halvings };
        let accepted = (0..=halvings).find_map(|halving| {
            let factor = 0.5_f64.powi(halving as i32);
            add_scaled(trial, u, factor, step);
            let (norm, shares) = equation.residual(trial, residual);
            negative_step(equation, residual, trial_step);
            let contraction = norm_of(trial_step) / length;
            let bound = if kept { LONGEST } else { 1.0 - 0.25 * factor };
            let monotone = contraction <= bound;
            (monotone || norm <= bounds.residual_tolerance).then_some((norm, shares, contraction))
        });
        match accepted {
            Some((norm, shares, contraction)) => {
                std::mem::swap(u, trial);
                (state.residual, state.shares) = (norm, shares);
                // Where contact opens, a step tells little of what is left.
                let proven = shares.separated == 0.0 && shares.unclosed == 0.0;
                if proven && equation.is_settled(u, trial_step) {
                    return ended(state, Status::Ok);
                }
                kept = contraction <= SERVES;
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

/// `-J^-1 residual`, into `step`.
fn negative_step(equation: &mut impl Equation, residual: &[f64], step: &mut [f64]) {
    step.copy_from_slice(residual);
    equation.step(step);
    for step in step {
        *step = -*step;
    }
}

/// `sum = u + factor step`.
fn add_scaled(sum: &mut [f64], u: &[f64], factor: f64, step: &[f64]) {
    for ((sum, u), s) in sum.iter_mut().zip(u).zip(step) {
        *sum = u + factor * s;
    }
}

/// Euclidean norm.
pub(in crate::response::harmonic_balance) fn norm_of(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `u = 0`, under contact of which a share has no periodic state.
    struct Contact {
        unclosed: f64,
    }

    impl Equation for Contact {
        fn residual(&mut self, u: &[f64], residual: &mut [f64]) -> (f64, ContactShares) {
            residual.copy_from_slice(u);
            let shares = ContactShares {
                unclosed: self.unclosed,
                ..ContactShares::default()
            };
            (norm_of(u), shares)
        }

        fn linearise(&mut self, u: &[f64], residual: &mut [f64]) -> bool {
            residual.copy_from_slice(u);
            true
        }

        fn is_linearised(&self) -> bool {
            false
        }

        fn step(&mut self, _residual: &mut [f64]) {}
    }

    #[test]
    fn a_solution_with_a_pair_that_does_not_close_is_none() {
        for (unclosed, status) in [(0.0, Status::Ok), (0.1, Status::Stagnated)] {
            let bounds = NewtonBounds::with_tolerance(1e-8);
            for start in [1.0, 0.0] {
                let mut u = vec![start];
                let mut buffers = NewtonBuffers::new(1);
                let outcome = iterate(&mut Contact { unclosed }, &mut u, bounds, &mut buffers);
                assert_eq!(outcome.status, status, "{unclosed} from {start}");
                assert!(outcome.residual <= bounds.residual_tolerance);
            }
        }
    }
}
