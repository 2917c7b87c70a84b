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
    let directions = displacement.tangential.into_iter().zip(history.drift_m);
    for (slider, (x, drift)) in history.sliders.iter_mut().zip(directions) {
        slipping |= slider.solve_drifting(
            parameters.tangential_stiffness_n_per_m,
            parameters.friction_coefficient,
            x,
            &history.normal_load,
            drift,
        );
    }
    history.state = PairState {
        slipping,
        separated,
        unclosed: false,
    };
}
