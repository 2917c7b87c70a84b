//! The contact laws marched from one instant to the next by trial and return.
//!
//! With `d` the relative displacement along n, t1, t2 and the *signed* load
//! `L = N0 + kn d_n`, `N = max(0, L)` (for `macro_slip_1d` and `macro_slip_2d`: `N = N0`),
//!
//! ```text
//! trial    T* = T + kt (d_t' - d_t)
//! return   T' = clip(T*, -mu N', mu N'),    T' = 0 where N' = 0
//! ```
//!
//! for either tangent, and for both together on the friction circle in `coulomb_3d`.
//! On a path that is straight within the step this is exact: bounds and trial force are linear
//! there, so that the slider is pushed last at the end. A pair that comes back into contact within
//! the step starts with T = 0 where L crosses zero, and only the rest of the path counts (Yang, Chu
//! & Menq 1998: slip at once if `kt |d_t'| > mu kn d_n'`, else stick).

use super::friction_circle::slide_on_circle;
use super::{ContactLaw, PairParameters};

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

    /// Contact force on the blisk's side of the equation along n, t1, t2, N, the static load left out.
    #[must_use]
    pub fn force_n(&self, law: ContactLaw, parameters: &PairParameters) -> [f64; 3] {
        let spring = parameters.normal_stiffness_n_per_m * self.displacement_m[0];
        let normal = if law.has_variable_load() && self.separated() {
            -parameters.normal_load_n
        } else {
            spring
        };
        [normal, self.friction_n[0], self.friction_n[1]]
    }
}

/// The pair after a step to `displacement_m` (n, t1, t2), straight from where it was.
#[must_use]
pub fn march(
    law: ContactLaw,
    parameters: &PairParameters,
    before: &PairMemory,
    displacement_m: [f64; 3],
) -> PairMemory {
    match law {
        ContactLaw::MacroSlip1d => macro_slip(parameters, before, displacement_m, 1),
        ContactLaw::MacroSlip2d => macro_slip(parameters, before, displacement_m, 2),
        ContactLaw::Simplified3d => simplified_3d(parameters, before, displacement_m),
        ContactLaw::Coulomb3d => coulomb_3d(parameters, before, displacement_m),
    }
}

/// Friction along the first `tangents`, each by itself, with the limit `mu N0`.
fn macro_slip(
    parameters: &PairParameters,
    before: &PairMemory,
    displacement_m: [f64; 3],
    tangents: usize,
) -> PairMemory {
    let limit = parameters.friction_coefficient * parameters.normal_load_n;
    let mut after = PairMemory {
        displacement_m,
        signed_load_n: parameters.normal_load_n,
        ..PairMemory::default()
    };
    for tangent in 0..tangents {
        let path = displacement_m[1 + tangent] - before.displacement_m[1 + tangent];
        let spring = parameters.tangential_stiffness_n_per_m * path;
        let trial = before.friction_n[tangent] + spring;
        after.friction_n[tangent] = trial.clamp(-limit, limit);
        after.slipping |= trial.abs() > limit;
    }
    after
}

/// Two independent directions with the limit `mu N(t)`.
fn simplified_3d(
    parameters: &PairParameters,
    before: &PairMemory,
    displacement_m: [f64; 3],
) -> PairMemory {
    let step = LoadedStep::new(parameters, before, displacement_m);
    let limit = parameters.friction_coefficient * step.load_after.max(0.0);
    let mut after = step.open(displacement_m);
    if step.load_after > 0.0 {
        for ((friction, start), path) in after.friction_n.iter_mut().zip(step.start).zip(step.path)
        {
            let trial = start + parameters.tangential_stiffness_n_per_m * path;
            *friction = trial.clamp(-limit, limit);
            after.slipping |= trial.abs() > limit;
        }
    }
    after
}

/// Both directions on the friction circle of radius `mu N(t)`.
fn coulomb_3d(
    parameters: &PairParameters,
    before: &PairMemory,
    displacement_m: [f64; 3],
) -> PairMemory {
    let step = LoadedStep::new(parameters, before, displacement_m);
    let mut after = step.open(displacement_m);
    if step.load_after > 0.0 {
        let (mu, kt) = (
            parameters.friction_coefficient,
            parameters.tangential_stiffness_n_per_m,
        );
        (after.friction_n, after.slipping) = slide_on_circle(
            step.start,
            step.path.map(|path| kt * path),
            [mu * step.load_before, mu * step.load_after],
        );
    }
    after
}

/// The part of a step that is spent in contact.
struct LoadedStep {
    /// Load where that part begins, and signed load at the end of the step, N.
    load_before: f64,
    load_after: f64,
    /// Friction where that part begins, N.
    start: [f64; 2],
    /// Tangential path in contact, m.
    path: [f64; 2],
}

impl LoadedStep {
    fn new(parameters: &PairParameters, before: &PairMemory, displacement_m: [f64; 3]) -> Self {
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
    fn open(&self, displacement_m: [f64; 3]) -> PairMemory {
        PairMemory {
            displacement_m,
            signed_load_n: self.load_after,
            friction_n: [0.0; 2],
            slipping: false,
        }
    }
}
