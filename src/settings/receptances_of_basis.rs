//! Rows on a basis, solved on the receptances that the tuned wheel has in its coordinates.

use std::ops::Range;
use std::sync::Arc;

use super::tuned_receptances::{engine_options, no_modes};
use crate::model::ReducedModel;
use crate::population::monte_carlo::RowSolver;
use crate::response::friction::ContactLaw;
use crate::response::receptance::ReceptanceEngine;
use crate::study::{Excitation, PipelineError, Study};

/// Factor on the number of blade shapes on a basis, where nothing judges what they leave out.
const SHAPES_ON_BASIS: usize = 4;

/// `solver`, which is on the basis that `model` has, with rows solved on the receptances of that basis under the force vector of `case`; as it
/// is where no pair can act. The receptances are made for that force vector alone, so that rows do not depend
/// on the others of a study.
///
/// # Errors
/// If modes are not found, or the harmonics of a search cannot be told apart.
pub(super) fn on_receptances_of_basis(
    solver: RowSolver,
    case: &Excitation,
    model: &ReducedModel,
) -> Result<RowSolver, PipelineError> {
    if !has_receptances(&case.study, model) {
        return Ok(solver);
    }
    let options = engine_options(&case.study, std::slice::from_ref(case), model);
    let made = ReceptanceEngine::of_model(model.clone(), &options, SHAPES_ON_BASIS);
    let (own, engine) = made.ok_or_else(no_modes)?;
    let (engine, orders) = (Arc::new(engine), &case.study.engine_orders);
    Ok(solver.with_engine_of_basis(engine, &case.of(&own.model), orders)?)
}

/// Whether rows of `study` on a basis are solved on receptances in its coordinates: those whose pairs can act.
fn has_receptances(study: &Study, model: &ReducedModel) -> bool {
    let contact = study.contact.as_ref();
    let [rubs, presses] = [1..3, 0..1].map(|directions: Range<usize>| {
        let rows = model.contact.rows.iter();
        rows.flat_map(|rows| &rows[directions.clone()])
            .any(Option::is_some)
    });
    let acts = |law: ContactLaw| rubs || law.has_variable_load() && presses;
    contact.is_none_or(|contact| acts(contact.law)) && (rubs || presses)
}
