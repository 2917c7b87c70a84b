//! The law `simplified_3d`: variable normal load with separation, two independent Jenkins elements.
//!
//! ```text
//! N_j = max(0, N0 + kn g_j)
//! T_j = kt x_j + y_j,    |T_j| <= mu N_j                 tangential correction y_j, per direction
//! ```
//!
//! For y see [`PeriodicSlider`](super::PeriodicSlider).

use super::{ContactHistory, PairDisplacement, PairParameters, PairState};

/// Fills `history` with the response to `displacement`.
pub(super) fn respond(
    history: &mut ContactHistory,
    parameters: &PairParameters,
    displacement: PairDisplacement<'_>,
) {
    let separated = history.press(parameters, displacement.normal);
    let mut slipping = false;
    for (slider, x) in history.sliders.iter_mut().zip(displacement.tangential) {
        slipping |= slider.solve(
            parameters.tangential_stiffness_n_per_m,
            parameters.friction_coefficient,
            x,
            &history.normal_load,
        );
    }
    history.state = PairState {
        slipping,
        separated,
        unclosed: false,
    };
}
