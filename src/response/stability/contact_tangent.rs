//! What a small disturbance does to the friction of a pair in one step of its periodic motion, the memory of the slider
//! included.
//!
//! With d the relative displacement and w the position of a slider, `T = kt (d_t - w)` wherever the pair is closed. A step from
//! d to d' leaves the friction T' and the slider `w' = d'_t - T' / kt`:
//!
//! ```text
//! stick      dT' = kt (d(d'_t) - dw)                     w stays
//! slip       dT' = +-mu kn d(d'_n)                       w follows
//! open       dT' = 0                                     w goes with d'_t
//! closes     T' = kt s (d'_t - d_t),  s = L'/(L' - L)    with the loads L < 0 < L' before and after
//! ```
//!
//! Both tangents of `coulomb_3d` slip round the friction circle together: there the step itself is differenced.

use crate::response::friction::{ContactLaw, PairMemory, PairParameters, march};

/// Disturbance of the differences, relative to the size of the motion.
const DISTURBANCE: f64 = 1e-6;

/// Friction along one tangent at the end of a step, as a disturbance changes it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum FrictionChange {
    /// No friction: the slider goes with the pair.
    #[default]
    None,
    /// The slider stays.
    Stick,
    /// Any other.
    Moves(FrictionSlopes),
}

/// `dT' = memory . dw + after . dd' + before . dd`, N/m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct FrictionSlopes {
    /// By the sliders along t1 and t2.
    pub(super) memory: [f64; 2],
    /// By the displacement along n, t1, t2 after the step.
    pub(super) after: [f64; 3],
    /// By that before the step.
    pub(super) before: [f64; 3],
}

/// What a disturbance does to the forces of a pair in one step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct StepChange {
    /// Slope of the normal force by the normal displacement after the step, N/m.
    pub(super) normal: f64,
    /// Whether the pair is closed after the step.
    pub(super) closed: bool,
    /// Along t1 and t2.
    pub(super) friction: [FrictionChange; 2],
}

/// The change of a step of the law from `before` to `after`.
pub(super) fn step_change(
    law: ContactLaw,
    pair: &PairParameters,
    before: &PairMemory,
    after: &PairMemory,
) -> StepChange {
    let closed = !(law.has_variable_load() && after.separated());
    if !closed {
        return StepChange::default();
    }
    let normal = pair.normal_stiffness_n_per_m;
    let mut friction = [FrictionChange::None; 2];
    if law.couples_tangents() && (after.slipping || before.separated()) {
        friction = differenced(law, pair, before, after).map(FrictionChange::Moves);
    } else {
        for (tangent, change) in friction.iter_mut().take(law.tangents()).enumerate() {
            *change = if law.has_variable_load() && before.separated() {
                FrictionChange::Moves(closing(pair, before, after, tangent))
            } else {
                by_itself(law, pair, before, after, tangent)
            };
        }
    }
    StepChange {
        normal,
        closed,
        friction,
    }
}

/// Along a tangent of its own, the pair closed before and after.
fn by_itself(
    law: ContactLaw,
    pair: &PairParameters,
    before: &PairMemory,
    after: &PairMemory,
    tangent: usize,
) -> FrictionChange {
    let path = after.displacement_m[1 + tangent] - before.displacement_m[1 + tangent];
    let trial = before.friction_n[tangent] + pair.tangential_stiffness_n_per_m * path;
    let limit = pair.friction_coefficient * after.signed_load_n;
    if trial.abs() <= limit {
        return FrictionChange::Stick;
    }
    let mut slopes = FrictionSlopes::default();
    if law.has_variable_load() {
        let growth = pair.friction_coefficient * pair.normal_stiffness_n_per_m;
        slopes.after[0] = trial.signum() * growth;
    }
    FrictionChange::Moves(slopes)
}

/// Along a tangent of its own, the pair open before.
fn closing(
    pair: &PairParameters,
    before: &PairMemory,
    after: &PairMemory,
    tangent: usize,
) -> FrictionSlopes {
    let (kn, kt) = (
        pair.normal_stiffness_n_per_m,
        pair.tangential_stiffness_n_per_m,
    );
    let (load, load_before) = (after.signed_load_n, before.signed_load_n);
    let span = load - load_before;
    let path = after.displacement_m[1 + tangent] - before.displacement_m[1 + tangent];
    let share = load / span;
    let trial = kt * share * path;
    let mut slopes = FrictionSlopes::default();
    if trial.abs() > pair.friction_coefficient * load {
        slopes.after[0] = trial.signum() * pair.friction_coefficient * kn;
    } else {
        slopes.after[0] = -kt * path * load_before / (span * span) * kn;
        slopes.before[0] = kt * path * load / (span * span) * kn;
        slopes.after[1 + tangent] = kt * share;
        slopes.before[1 + tangent] = -kt * share;
    }
    slopes
}

/// By central differences of the step.
fn differenced(
    law: ContactLaw,
    pair: &PairParameters,
    before: &PairMemory,
    after: &PairMemory,
) -> [FrictionSlopes; 2] {
    let (kn, kt) = (
        pair.normal_stiffness_n_per_m,
        pair.tangential_stiffness_n_per_m,
    );
    let slip_m = pair.friction_coefficient * after.signed_load_n / kt;
    let paths = after.displacement_m.iter().zip(before.displacement_m);
    let size = paths.map(|(a, b)| (a - b).abs()).fold(slip_m, f64::max);
    let step = DISTURBANCE * size;
    // Displaced by sliders, then n, t1, t2 after the step, then before it.
    let friction = |moved: [f64; 8]| {
        let [w1, w2, to @ .., _, _, _] = moved;
        let from = [moved[5], moved[6], moved[7]];
        let mut start = *before;
        for (place, by) in start.displacement_m.iter_mut().zip(from) {
            *place += by;
        }
        start.signed_load_n += kn * from[0];
        if !before.separated() {
            for (force, by) in start
                .friction_n
                .iter_mut()
                .zip([from[1] - w1, from[2] - w2])
            {
                *force += kt * by;
            }
        }
        let end = [0, 1, 2].map(|axis| after.displacement_m[axis] + to[axis]);
        march(law, pair, &start, end).friction_n
    };
    let slopes: [[f64; 2]; 8] = std::array::from_fn(|place| {
        let at = |size: f64| friction(std::array::from_fn(|i| if i == place { size } else { 0.0 }));
        let (up, down) = (at(step), at(-step));
        [0, 1].map(|tangent| (up[tangent] - down[tangent]) / (2.0 * step))
    });
    [0, 1].map(|tangent| {
        let [w1, w2, a0, a1, a2, b0, b1, b2] = slopes.map(|slope| slope[tangent]);
        FrictionSlopes {
            memory: [w1, w2],
            after: [a0, a1, a2],
            before: [b0, b1, b2],
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair() -> PairParameters {
        PairParameters {
            normal_load_n: 1.0,
            normal_stiffness_n_per_m: 2.0,
            tangential_stiffness_n_per_m: 3.0,
            friction_coefficient: 0.4,
        }
    }

    fn before(displacement_m: [f64; 3], friction_n: [f64; 2]) -> PairMemory {
        PairMemory {
            displacement_m,
            signed_load_n: 1.0 + 2.0 * displacement_m[0],
            friction_n,
            slipping: false,
        }
    }

    /// Every kind of step of every law: the slopes are those of the step differenced.
    #[test]
    fn slopes_are_differences_of_the_step() {
        let starts = [
            before([0.1, 0.2, -0.1], [0.3, -0.2]),
            before([-0.9, 0.2, -0.1], [0.0, 0.0]),
        ];
        let ends = [
            [0.15, 0.21, -0.12],
            [0.05, 0.6, -0.5],
            [-0.8, 0.3, 0.0],
            [0.3, 0.25, 0.9],
        ];
        let (mut sticking, mut moving) = (0, 0);
        for law in ContactLaw::ALL {
            for mut start in starts {
                if !law.has_variable_load() {
                    start.signed_load_n = 1.0;
                }
                for end in ends {
                    let after = march(law, &pair(), &start, end);
                    let found = step_change(law, &pair(), &start, &after);
                    let expected = differenced(law, &pair(), &start, &after);
                    for (found, expected) in found.friction.into_iter().zip(expected) {
                        let (memory, to) = match found {
                            FrictionChange::None => ([0.0; 2], [0.0; 3]),
                            FrictionChange::Stick => {
                                sticking += 1;
                                assert!(expected.before.iter().all(|slope| slope.abs() < 1e-6));
                                continue;
                            }
                            FrictionChange::Moves(slopes) => {
                                moving += 1;
                                for (a, b) in slopes.before.into_iter().zip(expected.before) {
                                    assert!(
                                        (a - b).abs() < 1e-5,
                                        "{law:?} {slopes:?} {expected:?}"
                                    );
                                }
                                (slopes.memory, slopes.after)
                            }
                        };
                        for (a, b) in memory.into_iter().zip(expected.memory) {
                            assert!((a - b).abs() < 1e-5, "{law:?} {found:?} {expected:?}");
                        }
                        for (a, b) in to.into_iter().zip(expected.after) {
                            assert!((a - b).abs() < 1e-5, "{law:?} {found:?} {expected:?}");
                        }
                    }
                }
            }
        }
        assert!(sticking > 5 && moving > 10);
    }
}
