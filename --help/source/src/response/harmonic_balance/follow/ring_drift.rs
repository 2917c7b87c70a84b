//! Solutions in which a free ring creeps: one drift rate per rigid motion of the ring, such that
//! friction has no mean along it.
//!
//! Let the ring move on by `s_r` per period along its rigid motion r (rotation, axial). The relative
//! tangential displacement of a pair then falls by `motion_r s_r` per period, the sliders come back
//! to the same *force*, and the harmonics of the force depend on s. With `M_r(x, s)` the mean
//! friction force on the ring, the pair (x, s) solves
//!
//! ```text
//! R(x, s) = 0,    M_r(x, s) = 0  or  s_r = 0 and M_r(x, 0+) <= 0 <= M_r(x, 0-)
//! ```
//!
//! Friction opposes the drift, so `M_r` falls with `s_r`; where pairs stick it is a whole interval
//! at `s = 0`, since their constant offsets can take up a mean. The second alternative is a ring
//! that its sticking pairs hold: the solution is then that of the locked ring. Otherwise s is found
//! by Broyden's method on M, every value of it from a full solution of `R(x, s) = 0`.

use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::Status;
use crate::response::harmonic_balance::equation::HarmonicSystem;
use crate::response::harmonic_balance::solver::{
    NewtonBounds, NewtonOutcome, NewtonWorkspace, solve,
};

/// Mean friction that counts as none, relative to the friction limit `mu N0` of a sector.
const NO_FRICTION: f64 = 1e-7;
/// A drift that is as good as none, as a share of `mu N0 / kt`.
const SMALL_DRIFT: f64 = 1e-9;
/// First guess of `-dM/ds` as a share of kt.
const FIRST_SLOPE: f64 = 0.3;
/// Solutions at most.
const SOLUTIONS: usize = 40;

/// Sizes of a sector: friction limit, N, and tangential stiffness, N/m.
struct Sizes {
    limit_n: f64,
    stiffness_n_per_m: f64,
}

impl Sizes {
    fn of(pairs: &[PairParameters]) -> Self {
        Self {
            limit_n: pairs
                .iter()
                .map(|pair| pair.friction_coefficient * pair.normal_load_n)
                .sum(),
            stiffness_n_per_m: pairs
                .iter()
                .map(|pair| pair.tangential_stiffness_n_per_m)
                .sum(),
        }
    }
}

/// Solves `R(x, s) = 0` with a ring that is free to creep along its free rigid motions, in place
/// from `x`; the drift is left in `system`. Starts from the locked ring.
pub fn solve_creeping(
    system: &mut HarmonicSystem,
    omega: f64,
    x: &mut Vec<f64>,
    bounds: NewtonBounds,
    workspace: &mut NewtonWorkspace,
) -> NewtonOutcome {
    system.set_ring_drift([0.0; 2]);
    let mut outcome = solve(system, omega, x, bounds, None, workspace);
    let free = system.free_ring_motions();
    let sizes = Sizes::of(system.pairs());
    let mut drifting = [false; 2];
    for _ in 0..2 {
        if outcome.status != Status::Ok {
            return outcome;
        }
        let (mut begin, mut begins) = ([0.0; 2], false);
        for motion in 0..2 {
            if free[motion]
                && !drifting[motion]
                && let Some(force) = unheld_friction(system, x, motion, &sizes, workspace)
            {
                begin[motion] = force;
                drifting[motion] = true;
                begins = true;
            }
        }
        if !begins {
            return outcome;
        }
        let found = balance(
            system,
            omega,
            x,
            bounds,
            workspace,
            (drifting, begin),
            &sizes,
        );
        outcome = NewtonOutcome {
            iterations: outcome.iterations + found.iterations,
            factorisations: outcome.factorisations + found.factorisations,
            ..found
        };
    }
    outcome
}

/// Mean friction on the ring along `motion` that no sticking pair can take up, at the present
/// drift of the other motion; none where the ring is held.
fn unheld_friction(
    system: &mut HarmonicSystem,
    x: &[f64],
    motion: usize,
    sizes: &Sizes,
    workspace: &mut NewtonWorkspace,
) -> Option<f64> {
    let before = system.ring_drift_m();
    let small = SMALL_DRIFT * sizes.limit_n / sizes.stiffness_n_per_m;
    let [forwards, backwards] = [small, -small].map(|drift| {
        let mut tried = before;
        tried[motion] = drift;
        system.set_ring_drift(tried);
        system.mean_friction_n(x, workspace.system_mut())[motion]
    });
    system.set_ring_drift(before);
    let negligible = NO_FRICTION * sizes.limit_n;
    if forwards > negligible {
        Some(forwards)
    } else if backwards < -negligible {
        Some(backwards)
    } else {
        None
    }
}

/// Broyden's method on the mean friction of the drifting motions; `friction` is that without drift
/// for those that only begin to drift.
fn balance(
    system: &mut HarmonicSystem,
    omega: f64,
    x: &mut Vec<f64>,
    bounds: NewtonBounds,
    workspace: &mut NewtonWorkspace,
    (drifting, mut friction): ([bool; 2], [f64; 2]),
    sizes: &Sizes,
) -> NewtonOutcome {
    // Rows of dM/ds.
    let slope = -FIRST_SLOPE * sizes.stiffness_n_per_m;
    let mut slopes = [[slope, 0.0], [0.0, slope]];
    let negligible = NO_FRICTION * sizes.limit_n;
    let (mut iterations, mut factorisations) = (0, 0);
    let mut status = Status::Stagnated;
    let mut last = None;
    for _ in 0..SOLUTIONS {
        let drift = system.ring_drift_m();
        let determinant = slopes[0][0] * slopes[1][1] - slopes[0][1] * slopes[1][0];
        let full = [
            (slopes[0][1] * friction[1] - slopes[1][1] * friction[0]) / determinant,
            (slopes[1][0] * friction[0] - slopes[0][0] * friction[1]) / determinant,
        ];
        let mut next = drift;
        for motion in 0..2 {
            if drifting[motion] {
                next[motion] += full[motion];
                // Friction opposes drift: it does not turn round.
                if drift[motion] * next[motion] < 0.0 {
                    next[motion] = 0.1 * drift[motion];
                }
            }
        }
        system.set_ring_drift(next);
        let outcome = solve(system, omega, x, bounds, None, workspace);
        iterations += outcome.iterations;
        factorisations += outcome.factorisations;
        last = Some(outcome);
        if outcome.status != Status::Ok {
            status = outcome.status;
            break;
        }
        let mut now = system.mean_friction_n(x, workspace.system_mut());
        for motion in 0..2 {
            if !drifting[motion] {
                now[motion] = 0.0;
            }
        }
        if now.iter().all(|force| force.abs() <= negligible) {
            status = Status::Ok;
            break;
        }
        let step = [next[0] - drift[0], next[1] - drift[1]];
        let square = step[0] * step[0] + step[1] * step[1];
        for motion in 0..2 {
            if drifting[motion] && square > 0.0 {
                let row = slopes[motion];
                let miss = now[motion] - friction[motion] - row[0] * step[0] - row[1] * step[1];
                slopes[motion] = [0, 1].map(|k| row[k] + miss * step[k] / square);
            }
        }
        friction = now;
    }
    let outcome = last.unwrap_or(NewtonOutcome {
        status,
        iterations,
        factorisations,
        residual: f64::NAN,
        shares: crate::response::harmonic_balance::pairs::ContactShares::default(),
    });
    NewtonOutcome {
        status,
        iterations,
        factorisations,
        ..outcome
    }
}
