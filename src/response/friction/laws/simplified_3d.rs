//! The law `simplified_3d`: variable normal load with separation, two independent Jenkins elements.
//!
//! ```text
//! N_j = max(0, N0 + kn g_j)
//! T_j = kt x_j + y_j,    |T_j| <= mu N_j                 tangential correction y_j, per direction
//! ```
//!
//! For y see [`PeriodicSlider`](crate::response::friction::PeriodicSlider).

use crate::response::friction::contact_march::{LoadedStep, jenkins_step};
use crate::response::friction::law_parts::LawParts;
use crate::response::friction::{
    ContactHistory, PairDisplacement, PairMemory, PairParameters, PairState, SideBySide,
    TangentialFriction,
};

pub(super) const LAW: LawParts = LawParts {
    name: "simplified_3d",
    has_variable_load: true,
    friction: TangentialFriction::Jenkins { tangents: 2 },
    side_by_side: SideBySide::VariableLimit,
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
    PairState {
        slipping,
        separated,
        unclosed: false,
    }
}

/// A step in time: two independent directions with the limit `mu N(t)`.
fn march(parameters: &PairParameters, before: &PairMemory, displacement_m: [f64; 3]) -> PairMemory {
    let step = LoadedStep::new(parameters, before, displacement_m);
    let limit = parameters.friction_coefficient * step.load_after.max(0.0);
    let mut after = step.open(displacement_m);
    if step.load_after > 0.0 {
        for ((friction, start), path) in after.friction_n.iter_mut().zip(step.start).zip(step.path)
        {
            let spring = parameters.tangential_stiffness_n_per_m * path;
            let (force, slips) = jenkins_step(start, spring, limit);
            *friction = force;
            after.slipping |= slips;
        }
    }
    after
}
