//! A pair of contact nodes marched from one instant to the next by trial and return.
//!
//! With `d` the relative displacement along n, t1, t2 and the *signed* load
//! `L = N0 + kn d_n`, `N = max(0, L)` (for `macro_slip_1d` and `macro_slip_2d`: `N = N0`),
//!
//! ```text
//! trial    T* = T + kt (d_t' - d_t)
//! return   T' = clip(T*, -mu N', mu N'),    T' = 0 where N' = 0
//! ```
//!
//! for either tangent, and for both together on the friction circle in `coulomb_3d`. The step of a law stands in its file; here is
//! what a pair remembers between steps, and what laws with a variable load share.
//!
//! On a path that is straight within the step this is exact: bounds and trial force are linear
//! there, so that the slider is pushed last at the end. A pair that comes back into contact within
//! the step starts with T = 0 where L crosses zero, and only the rest of the path counts (Yang, Chu
//! & Menq 1998: slip at once if `kt |d_t'| > mu kn d_n'`, else stick).

use super::PairParameters;

/// What a pair remembers of an instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PairMemory {
    /// Relative displacement along n, t1, t2, m.
    pub displacement_m: [f64; 3],
    /// Signed load `N0 + kn d_n` (`N0` where the law has no variable load), N; negative: a gap.
    pub signed_load_n: f64,
    /// Friction force along t1 and t2, N.
    pub friction_n: [f64; 2],
    /// Whether the friction limit was reached in the step that led here.
    pub slipping: bool,
}

impl PairMemory {
    /// A pair at rest: no displacement, no friction.
    #[must_use]
    pub fn at_rest(parameters: &PairParameters) -> Self {
        Self {
            signed_load_n: parameters.normal_load_n,
            ..Self::default()
        }
    }

    /// Whether the pair is open.
    #[must_use]
    pub fn separated(&self) -> bool {
        self.signed_load_n <= 0.0
    }
}

/// A step of a Jenkins element whose spring is stretched by `spring_n` more: friction after it, N, and whether the limit was reached.
pub(super) fn jenkins_step(before_n: f64, spring_n: f64, limit_n: f64) -> (f64, bool) {
    let trial = before_n + spring_n;
    (trial.clamp(-limit_n, limit_n), trial.abs() > limit_n)
}

/// The part of a step that is spent in contact.
pub(super) struct LoadedStep {
    /// Load where that part begins, and signed load at the end of the step, N.
    pub(super) load_before: f64,
    pub(super) load_after: f64,
    /// Friction where that part begins, N.
    pub(super) start: [f64; 2],
    /// Tangential path in contact, m.
    pub(super) path: [f64; 2],
}

impl LoadedStep {
    pub(super) fn new(
        parameters: &PairParameters,
        before: &PairMemory,
        displacement_m: [f64; 3],
    ) -> Self {
        let load_after =
            parameters.normal_load_n + parameters.normal_stiffness_n_per_m * displacement_m[0];
        let path = [1, 2].map(|axis| displacement_m[axis] - before.displacement_m[axis]);
        if before.separated() {
            // Share of the step after the load has crossed zero.
            let share = (load_after / (load_after - before.signed_load_n)).clamp(0.0, 1.0);
            Self {
                load_before: 0.0,
                load_after,
                start: [0.0; 2],
                path: path.map(|path| share * path),
            }
        } else {
            Self {
                load_before: before.signed_load_n,
                load_after,
                start: before.friction_n,
                path,
            }
        }
    }

    /// The pair at the end of the step, without friction.
    pub(super) fn open(&self, displacement_m: [f64; 3]) -> PairMemory {
        PairMemory {
            displacement_m,
            signed_load_n: self.load_after,
            friction_n: [0.0; 2],
            slipping: false,
        }
    }
}
