//! The law `macro_slip_1d`: one Jenkins element along t1 with the constant limit `mu N0`.
//!
//! The normal spring is bilateral (no correction) and nothing acts along t2, so the linear limits
//! of this law have no spring along t2 either. A pair without normal load counts as separated.

use super::{ContactHistory, PairDisplacement, PairParameters, PairState};

/// Fills `history` with the response to `displacement`.
pub(super) fn respond(
    history: &mut ContactHistory,
    parameters: &PairParameters,
    displacement: PairDisplacement<'_>,
) {
    history.normal_load.fill(parameters.normal_load_n);
    history.normal_correction.fill(0.0);
    let [first, second] = &mut history.sliders;
    let slipping = first.solve(
        parameters.tangential_stiffness_n_per_m,
        parameters.friction_coefficient,
        displacement.tangential[0],
        &history.normal_load,
    );
    second.rest();
    history.state = PairState {
        slipping,
        separated: parameters.normal_load_n <= 0.0,
        unclosed: false,
    };
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
            let state = history.respond(ContactLaw::MacroSlip1d, &parameters, displacement);
            assert_eq!(state.separated, separated, "{normal_load_n} N");
            assert!(history.normal_correction_n().iter().all(|&c| c == 0.0));
        }
    }
}
