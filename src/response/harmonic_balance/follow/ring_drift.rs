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

/// Mean friction that counts as none, relative to the friction limit `mu N0` of a sector.
const NO_FRICTION: f64 = 1e-7;
/// A drift that is as good as none, as a share of `mu N0 / kt`.
const SMALL_DRIFT: f64 = 1e-9;
/// First guess of `-dM/ds` as a share of kt.
const FIRST_SLOPE: f64 = 0.3;
/// Solutions at most.
const SOLUTIONS: usize = 40;

/// A wheel at one frequency whose ring may drift.
pub trait DriftingRing {
    /// Parameters of the pairs of a sector, or of the whole wheel where sectors differ: they tell which forces and drifts are small.
    fn pairs(&self) -> &[PairParameters];

    /// Rigid motions of the ring (rotation, axial) that nothing but friction holds.
    fn free_motions(&self) -> [bool; 2];

    /// Drift of the ring along its rigid motions, m per period.
    fn drift_m(&self) -> [f64; 2];

    /// Sets the drift.
    fn set_drift(&mut self, drift_m: [f64; 2]);

    /// Mean friction on the ring along its rigid motions, N per sector, at the motions last solved and the present drift.
    fn mean_friction_n(&mut self) -> [f64; 2];

    /// Solves at the present drift, from the motions last solved.
    fn solve(&mut self) -> Status;
}

/// Solves `R(x, s) = 0` with a ring that is free to creep along its free rigid motions, from the drift that it has; its drift is left in it.
pub fn let_creep(ring: &mut impl DriftingRing) -> Status {
    let sizes = Sizes::of(ring.pairs());
    let known = ring.drift_m().map(|drift| drift.abs() > 0.0);
    if known.contains(&true) && go_on(ring, known, &sizes) == Status::Ok {
        return Status::Ok;
    }
    ring.set_drift([0.0; 2]);
    let status = ring.solve();
    if status == Status::Ok {
        begin(ring, [false; 2], &sizes)
    } else {
        status
    }
}

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

    fn small_drift_m(&self) -> f64 {
        SMALL_DRIFT * self.limit_n / self.stiffness_n_per_m
    }

    /// Whether forces are as good as none.
    fn are_negligible(&self, forces_n: [f64; 2]) -> bool {
        let negligible = NO_FRICTION * self.limit_n;
        forces_n.iter().all(|force| force.abs() <= negligible)
    }
}

/// From the present drift along the motions `drifting`.
fn go_on(ring: &mut impl DriftingRing, drifting: [bool; 2], sizes: &Sizes) -> Status {
    let status = ring.solve();
    if status != Status::Ok {
        return status;
    }
    let friction = friction_along(ring, drifting);
    let status = if sizes.are_negligible(friction) {
        Status::Ok
    } else {
        balance(ring, (drifting, friction), sizes)
    };
    if status == Status::Ok {
        begin(ring, drifting, sizes)
    } else {
        status
    }
}

/// From a solution in which the motions `drifting` drift without mean friction: whether others have to, and then with them.
fn begin(ring: &mut impl DriftingRing, mut drifting: [bool; 2], sizes: &Sizes) -> Status {
    let free = ring.free_motions();
    for _ in 0..2 {
        let (mut friction, mut begins) = ([0.0; 2], false);
        for motion in 0..2 {
            if free[motion]
                && !drifting[motion]
                && let Some(force) = unheld_friction(ring, motion, sizes)
            {
                friction[motion] = force;
                drifting[motion] = true;
                begins = true;
            }
        }
        if !begins {
            return Status::Ok;
        }
        let status = balance(ring, (drifting, friction), sizes);
        if status != Status::Ok {
            return status;
        }
    }
    Status::Ok
}

/// Mean friction on the ring along `motion` that no sticking pair can take up, at the present
/// drift of the other motion; none where the ring is held.
fn unheld_friction(ring: &mut impl DriftingRing, motion: usize, sizes: &Sizes) -> Option<f64> {
    let before = ring.drift_m();
    let small = sizes.small_drift_m();
    let [forwards, backwards] = [small, -small].map(|drift| {
        let mut tried = before;
        tried[motion] = drift;
        ring.set_drift(tried);
        ring.mean_friction_n()[motion]
    });
    ring.set_drift(before);
    let negligible = NO_FRICTION * sizes.limit_n;
    if forwards > negligible {
        Some(forwards)
    } else if backwards < -negligible {
        Some(backwards)
    } else {
        None
    }
}

/// Mean friction along the motions that drift, N per sector.
fn friction_along(ring: &mut impl DriftingRing, drifting: [bool; 2]) -> [f64; 2] {
    let friction = ring.mean_friction_n();
    [0, 1].map(|motion| {
        if drifting[motion] {
            friction[motion]
        } else {
            0.0
        }
    })
}

/// Broyden's method on the mean friction of the drifting motions; `friction` is that at the present drift, without any for those
/// that only begin to drift.
fn balance(
    ring: &mut impl DriftingRing,
    (drifting, mut friction): ([bool; 2], [f64; 2]),
    sizes: &Sizes,
) -> Status {
    // Rows of dM/ds.
    let slope = -FIRST_SLOPE * sizes.stiffness_n_per_m;
    let mut slopes = [[slope, 0.0], [0.0, slope]];
    for _ in 0..SOLUTIONS {
        let drift = ring.drift_m();
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
        let vanishes =
            |motion: usize| drifting[motion] && next[motion].abs() < sizes.small_drift_m();
        if (0..2).any(vanishes) {
            return Status::Stagnated;
        }
        ring.set_drift(next);
        let status = ring.solve();
        if status != Status::Ok {
            return status;
        }
        let now = friction_along(ring, drifting);
        if sizes.are_negligible(now) {
            return Status::Ok;
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
    Status::Stagnated
}
