//! The laws `macro_slip_1d` and `macro_slip_2d`: Jenkins elements along t1, or along t1 and t2 each by itself, with the
//! constant limit `mu N0`.
//!
//! The normal spring is bilateral (no correction). Under `macro_slip_1d` nothing acts along t2, so its linear limits
//! have no spring along t2 either. A pair without normal load counts as separated.

use crate::response::friction::contact_march::jenkins_step;
use crate::response::friction::law_parts::LawParts;
use crate::response::friction::{
    ContactHistory, PairDisplacement, PairMemory, PairParameters, PairState, SideBySide,
    TangentialFriction,
};

pub(super) const ALONG_ONE: LawParts = LawParts {
    name: "macro_slip_1d",
    has_variable_load: false,
    friction: TangentialFriction::Jenkins { tangents: 1 },
    side_by_side: SideBySide::ConstantLimit,
    respond: |history, parameters, displacement| respond(history, parameters, displacement, 1),
    march: |parameters, before, displacement_m| march(parameters, before, displacement_m, 1),
};
pub(super) const ALONG_BOTH: LawParts = LawParts {
    name: "macro_slip_2d",
    has_variable_load: false,
    friction: TangentialFriction::Jenkins { tangents: 2 },
    side_by_side: SideBySide::ConstantLimit,
    respond: |history, parameters, displacement| respond(history, parameters, displacement, 2),
    march: |parameters, before, displacement_m| march(parameters, before, displacement_m, 2),
};

/// Fills `history` with the response to `displacement`, with friction along the first `tangents`.
fn respond(
    history: &mut ContactHistory,
    parameters: &PairParameters,
    displacement: PairDisplacement<'_>,
    tangents: usize,
) -> PairState {
    history.normal_load.fill(parameters.normal_load_n);
    history.normal_correction.fill(0.0);
    let mut slipping = false;
    for (tangent, slider) in history.sliders.iter_mut().enumerate() {
        if tangent < tangents {
            slipping |= slider.solve_drifting(
                parameters.tangential_stiffness_n_per_m,
                parameters.friction_coefficient,
                displacement.tangential[tangent],
                &history.normal_load,
                history.drift_m[tangent],
            );
        } else {
            slider.rest();
        }
    }
    PairState {
        slipping,
        separated: parameters.normal_load_n <= 0.0,
        unclosed: false,
    }
}

/// A step in time, with friction along the first `tangents`.
fn march(
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
        let (friction, slips) = jenkins_step(before.friction_n[tangent], spring, limit);
        after.friction_n[tangent] = friction;
        after.slipping |= slips;
    }
    after
}

#[cfg(test)]
mod tests {
    use super::super::ContactLaw;
    use super::{ContactHistory, PairDisplacement, PairParameters};

    #[test]
    fn a_pair_without_normal_load_is_separated_and_has_no_normal_correction() {
        let mut history = ContactHistory::new(4);
        for (normal_load_n, separated) in [(0.0, true), (1.0, false)] {
            let parameters = PairParameters {
                normal_load_n,
                normal_stiffness_n_per_m: 1.0,
                tangential_stiffness_n_per_m: 1.0,
                friction_coefficient: 0.5,
            };
            let displacement = PairDisplacement {
                normal: &[0.0; 4],
                tangential: [&[1.0, 0.0, -1.0, 0.0], &[0.0; 4]],
            };
            for law in [ContactLaw::MacroSlip1d, ContactLaw::MacroSlip2d] {
                let state = history.respond(law, &parameters, displacement);
                assert_eq!(state.separated, separated, "{normal_load_n} N");
                assert!(history.normal_correction_n().iter().all(|&c| c == 0.0));
            }
        }
    }

    #[test]
    fn a_constant_load_is_a_variable_one_without_normal_motion() {
        let motion = |phase: f64| -> Vec<f64> {
            let at = |j: usize| (0.1 * j as f64 * std::f64::consts::TAU + phase).cos();
            (0..10).map(at).collect()
        };
        let (first, second, still) = (motion(0.3), motion(1.7), vec![0.0; 10]);
        let displacement = |normal| PairDisplacement {
            normal,
            tangential: [&first, &second],
        };
        let parameters = PairParameters {
            normal_load_n: 1.0,
            normal_stiffness_n_per_m: 3.0,
            tangential_stiffness_n_per_m: 1.0,
            friction_coefficient: 0.4,
        };
        let [mut constant, mut variable] = [10, 10].map(ContactHistory::new);
        let law = ContactLaw::MacroSlip2d;
        let state = constant.respond(law, &parameters, displacement(&first));
        let law = ContactLaw::Simplified3d;
        let expected = variable.respond(law, &parameters, displacement(&still));
        assert!(state.slipping && state == expected);
        assert_eq!(
            constant.tangential_correction_n(),
            variable.tangential_correction_n()
        );
        let offsets = constant.tangential_correction_n();
        assert!(
            offsets
                .iter()
                .all(|offset| offset.iter().any(|&y| y != 0.0))
        );
    }
}
