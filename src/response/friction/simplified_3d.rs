//! The law `simplified_3d`: variable normal load with separation, two independent Jenkins elements.
//!
//! ```text
//! N_j = max(0, N0 + kn g_j)
//! c_j = (N_j - N0) - kn g_j = max(0, -(N0 + kn g_j))     normal correction
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
    let PairParameters {
        normal_load_n: n0,
        normal_stiffness_n_per_m: kn,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: mu,
    } = *parameters;
    let mut separated = false;
    let outputs = history
        .normal_load
        .iter_mut()
        .zip(&mut history.normal_correction);
    for ((load, correction), &g) in outputs.zip(displacement.normal) {
        let bilateral = n0 + kn * g;
        separated |= bilateral <= 0.0;
        *load = if bilateral > 0.0 { bilateral } else { 0.0 };
        *correction = if bilateral > 0.0 {
            0.0
        } else {
            0.0 - bilateral
        };
    }
    let mut slipping = false;
    for (slider, x) in history.sliders.iter_mut().zip(displacement.tangential) {
        slipping |= slider.solve(kt, mu, x, &history.normal_load);
    }
    history.state = PairState {
        slipping,
        separated,
    };
}
