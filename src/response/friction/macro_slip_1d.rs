//! The law `macro_slip_1d`: one Jenkins element along t1 with the constant limit `mu N0`.
//!
//! The normal spring is bilateral (no correction) and nothing acts along t2, so the linear limits
//! of this law have no spring along t2 either.

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
    };
}
