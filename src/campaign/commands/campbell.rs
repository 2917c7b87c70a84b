//! The Campbell table of a study: its wheel, or prestressed models of it at several speeds.

use crate::model::cyclic::natural_frequencies_hz;
use crate::model::sector::SectorModel;
use crate::report::{
    CampbellMode, CampbellReport, DiagramRange, Figure, FigureName, diagram_of_model,
};
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

impl CampbellRequest<'_> {
    /// The engine orders asked for, or those of the study.
    #[must_use]
    pub fn orders(&self) -> &[u32] {
        if self.engine_orders.is_empty() {
            &self.study.engine_orders
        } else {
            self.engine_orders
        }
    }

    /// The Campbell or SAFE diagram of the report of this request, with frequencies up to `top_hz`.
    ///
    /// # Errors
    /// There is nothing to draw; or a SAFE diagram is asked for models at several speeds.
    pub fn diagram(
        &self,
        report: &CampbellReport,
        name: FigureName,
        top_hz: Option<f64>,
    ) -> Result<Figure, PipelineError> {
        if name == FigureName::Safe && self.models.len() > 1 {
            return Err(PipelineError::NoCampbell {
                reason: format!(
                    "a SAFE diagram has the frequencies of one model, and there are {}; accepted: the model of the study, or one \
                     at one speed",
                    self.models.len()
                ),
            });
        }
        let range = DiagramRange {
            top_hz,
            top_rpm: self.range_rpm.map(|[_, high]| high),
        };
        diagram_of_model(report, self.orders(), range, name).ok_or_else(|| {
            PipelineError::NoCampbell {
                reason: format!(
                    "there is nothing to draw in the figure {}: no engine order meets a first mode; accepted: other engine orders, \
                     or a range of speeds",
                    name.name()
                ),
            }
        })
    }
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
    Ok(CampbellReport::new(
        first.name.clone(),
        first.sectors,
        models.iter().filter_map(|(speed, _)| *speed).collect(),
        request.range_rpm,
        modes,
        request.orders(),
    ))
}
