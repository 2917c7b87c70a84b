//! The Campbell table of a study: its wheel, or prestressed models of it at several speeds.

use crate::model::cyclic::natural_frequencies_hz;
use crate::model::sector::SectorModel;
use crate::report::{CampbellMode, CampbellReport};
use crate::settings::contact_stiffness;
use crate::study::{PipelineError, Study};

/// What to put into the table.
#[derive(Debug, Clone, Copy)]
pub struct CampbellRequest<'a> {
    /// The study: contact stiffness, and engine orders where none are asked for.
    pub study: &'a Study,
    /// Models with their speeds, revolutions per minute, ascending; one without speed holds at every speed.
    pub models: &'a [(Option<f64>, SectorModel)],
    /// Engine orders; empty: those of the study.
    pub engine_orders: &'a [u32],
    /// Modes per nodal diameter and contact.
    pub modes: usize,
    /// Range of speeds, revolutions per minute.
    pub range_rpm: Option<[f64; 2]>,
}

/// Natural frequencies with stuck and with sliding contact (without contact where the study has none), and the
/// speeds at which engine orders cross them.
///
/// # Errors
/// A mass or stiffness is not positive definite, or the models are of different wheels.
pub fn campbell(request: &CampbellRequest<'_>) -> Result<CampbellReport, PipelineError> {
    let CampbellRequest { study, models, .. } = *request;
    let Some((_, first)) = models.first() else {
        return Err(PipelineError::NoCampbell {
            reason: "there is no model; accepted: one, or one per speed".to_owned(),
        });
    };
    if let Some((_, other)) = models
        .iter()
        .find(|(_, model)| model.sectors != first.sectors)
    {
        return Err(PipelineError::NoCampbell {
            reason: format!(
                "models of {} and of {} sectors are no one wheel; accepted: the same wheel at several speeds",
                first.sectors, other.sectors
            ),
        });
    }
    let stiffness = contact_stiffness(study.contact.as_ref());
    let stuck = [
        stiffness.normal_n_per_m,
        stiffness.tangential_1_n_per_m,
        stiffness.tangential_2_n_per_m,
    ];
    let has_contact = study.contact.is_some() && !first.contact_pairs.is_empty();
    let conditions = if has_contact {
        vec![("stuck", stuck), ("slide", [stuck[0], 0.0, 0.0])]
    } else {
        vec![("free", [0.0; 3])]
    };
    let mut modes = Vec::new();
    for (contact, springs) in conditions {
        let of_models = models
            .iter()
            .map(|(_, model)| natural_frequencies_hz(model, springs, request.modes))
            .collect::<Result<Vec<_>, _>>()?;
        for nodal_diameter in 0..=first.sectors / 2 {
            let found = || of_models.iter().map(|model| &model[nodal_diameter]);
            let count = found().map(Vec::len).min().unwrap_or(0);
            modes.extend((0..count).map(|place| CampbellMode {
                contact,
                nodal_diameter,
                mode: place + 1,
                frequency_hz: found().map(|frequencies| frequencies[place]).collect(),
            }));
        }
    }
    let engine_orders = if request.engine_orders.is_empty() {
        &study.engine_orders
    } else {
        request.engine_orders
    };
    Ok(CampbellReport::new(
        first.name.clone(),
        first.sectors,
        models.iter().filter_map(|(speed, _)| *speed).collect(),
        request.range_rpm,
        modes,
        engine_orders,
    ))
}
