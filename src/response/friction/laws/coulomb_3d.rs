//! The law `coulomb_3d`: variable normal load with separation, friction circle in the tangential
//! plane.
//!
//! ```text
//! N_j = max(0, N0 + kn g_j)
//! T_j = kt x_j + y_j,    |T_j| <= mu N_j     x, y, T plane vectors along t1, t2
//! ```
//!
//! Contact kinematics of Yang & Menq (1998, J. Sound and Vibration 217(5)). For y see
//! [`CoupledSlider`](crate::response::friction::CoupledSlider). Motion along one tangent alone gives what
//! `simplified_3d` gives; in general that law allows forces up to `sqrt(2) mu N`, since either
//! tangent has a limit of its own, and its answer depends on how the tangents are turned.

use crate::response::friction::contact_march::LoadedStep;
use crate::response::friction::friction_circle::slide_on_circle;
use crate::response::friction::law_parts::LawParts;
use crate::response::friction::{
    ContactHistory, PairDisplacement, PairMemory, PairParameters, PairState, SideBySide,
    TangentialFriction,
};

pub(super) const LAW: LawParts = LawParts {
    name: "coulomb_3d",
    has_variable_load: true,
    friction: TangentialFriction::FrictionCircle,
    side_by_side: SideBySide::No,
    respond,
    march,
};

/// Fills `history` with the response to `displacement`.
fn respond(
    history: &mut ContactHistory,
    parameters: &PairParameters,
    displacement: PairDisplacement<'_>,
) -> PairState {
    let separated = history.press(parameters, displacement.normal);
    let slipping = history.coupled.solve_drifting(
        parameters.tangential_stiffness_n_per_m,
        parameters.friction_coefficient,
        displacement.tangential,
        &history.normal_load,
        history.drift_m,
    );
    PairState {
        slipping,
        separated,
        unclosed: !history.coupled.is_closed(),
    }
}

/// A step in time: both directions on the friction circle of radius `mu N(t)`.
fn march(parameters: &PairParameters, before: &PairMemory, displacement_m: [f64; 3]) -> PairMemory {
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
