//! Choice of the reduction basis of a study: fixed by the user, or the cheapest that meets the wanted error.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::PipelineError;
use super::contact_displacement::{ContactDisplacementErrors, ContactMotion};
use crate::model::ReducedModel;
use crate::model::reduction::{Basis, BasisChoice, Reduction, ReductionOptions};
use crate::population::monte_carlo::{RowSettings, RowSolver};
use crate::response::forced_response::{ContactCondition, Peak};

/// Stick modes of `stick_attachment` where the study does not say.
const ATTACHMENT_STICK_MODES: usize = 4;
/// Numbers of stick and of slide modes that are tried, ascending.
const STICK_SLIDE_LADDER: [usize; 9] = [2, 3, 4, 6, 8, 10, 14, 20, 28];
/// Relative tolerance of the peaks that are compared.
const PEAK_TOLERANCE: f64 = 1e-5;

/// Relative error of the tuned peak of one basis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BasisError {
    /// The basis, in words.
    pub basis: String,
    /// Number of vectors per nodal diameter offered.
    pub vectors: usize,
    /// Largest relative error of the tuned peak over the conditions compared; none if a peak was
    /// not found.
    pub error: Option<f64>,
    /// Largest error of the relative displacement at the contact over the same conditions under
    /// friction; none if there is none or a peak was not found.
    pub contact_displacement: Option<ContactDisplacementErrors>,
}

/// The chosen basis and the evidence for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BasisEvidence {
    /// Whether the basis is the whole space of every nodal diameter.
    pub whole_space: bool,
    /// Errors of the bases that were tried; the last one was taken.
    pub tried: Vec<BasisError>,
}

/// Chooses the basis for `options` by the tuned nonlinear peak on one sector, against the whole
/// Craig-Bampton sector with every contact dof, under the given engine orders and conditions.
///
/// # Errors
/// If a mass or stiffness is not positive definite.
pub fn choose_basis(
    reduction: &Reduction<'_>,
    options: &ReductionOptions,
    settings: &RowSettings,
    engine_orders: &[u32],
    conditions: &[ContactCondition],
) -> Result<(BasisChoice, BasisEvidence), PipelineError> {
    if reduction.is_whole_space() {
        let evidence = BasisEvidence {
            whole_space: true,
            tried: Vec::new(),
        };
        return Ok((BasisChoice::CraigBampton, evidence));
    }
    let whole = Arc::new(reduction.tuned(BasisChoice::CraigBampton)?);
    let reference = Peaks::of(Arc::clone(&whole), settings, engine_orders, conditions)?;
    let motions = reference.contact_motions(&whole, settings, engine_orders, conditions)?;
    let mut tried = Vec::new();
    let mut chosen = None;
    for choice in candidates(reduction, options) {
        let model = Arc::new(reduction.tuned(choice)?);
        let peaks = Peaks::of(Arc::clone(&model), settings, engine_orders, conditions)?;
        let error = peaks.error(&reference);
        tried.push(BasisError {
            basis: choice.to_string(),
            vectors: vectors(reduction, choice),
            error,
            contact_displacement: largest_displacement_error(&motions, &model),
        });
        chosen = Some(choice);
        if error.is_some_and(|error| error <= options.error) {
            break;
        }
    }
    let choice = chosen.unwrap_or(BasisChoice::StickAttachment {
        stick: ATTACHMENT_STICK_MODES,
    });
    Ok((
        choice,
        BasisEvidence {
            whole_space: false,
            tried,
        },
    ))
}

/// Bases to try, the cheapest first; one that the user fixed stands alone.
fn candidates(reduction: &Reduction<'_>, options: &ReductionOptions) -> Vec<BasisChoice> {
    let attachment = BasisChoice::StickAttachment {
        stick: options.stick_modes.unwrap_or(ATTACHMENT_STICK_MODES),
    };
    let ladder = STICK_SLIDE_LADDER
        .iter()
        .map(|&modes| BasisChoice::StickSlide {
            stick: modes,
            slide: modes,
        });
    match (options.basis, options.stick_modes, options.slide_modes) {
        (Basis::StickAttachment, ..) => vec![attachment],
        (_, Some(stick), Some(slide)) => vec![BasisChoice::StickSlide { stick, slide }],
        (_, Some(modes), None) | (_, None, Some(modes)) => vec![BasisChoice::StickSlide {
            stick: modes,
            slide: modes,
        }],
        (Basis::StickSlide, None, None) => ladder.collect(),
        (Basis::Auto, None, None) if reduction.contact_rows() == 0 => ladder.collect(),
        (Basis::Auto, None, None) => {
            let size = vectors(reduction, attachment);
            ladder
                .filter(|&choice| vectors(reduction, choice) < size)
                .chain([attachment])
                .collect()
        }
    }
}

fn vectors(reduction: &Reduction<'_>, choice: BasisChoice) -> usize {
    match choice {
        BasisChoice::StickSlide { stick, slide } => stick + slide,
        BasisChoice::StickAttachment { stick } => stick + reduction.contact_rows(),
        BasisChoice::CraigBampton => reduction
            .models()
            .iter()
            .map(crate::model::reduction::CraigBampton::size)
            .max()
            .unwrap_or(0),
    }
}

/// Largest error of the contact displacement over the tuned peaks; none without any.
fn largest_displacement_error(
    motions: &[ContactMotion<'_>],
    model: &ReducedModel,
) -> Option<ContactDisplacementErrors> {
    motions
        .iter()
        .map(|motion| motion.errors_of(model))
        .reduce(|a, b| Some(a?.larger(b?)))?
}

/// Tuned peaks, one per engine order and condition.
struct Peaks(Vec<Peak>);

impl Peaks {
    fn of(
        model: Arc<ReducedModel>,
        settings: &RowSettings,
        engine_orders: &[u32],
        conditions: &[ContactCondition],
    ) -> Result<Self, PipelineError> {
        let mut settings = settings.clone();
        settings.solver.peak_tolerance = PEAK_TOLERANCE;
        let solver = RowSolver::new(model, settings)?;
        Ok(Self(
            each(engine_orders, conditions)
                .map(|(engine_order, condition)| solver.tuned_peak(engine_order, condition))
                .collect(),
        ))
    }

    /// Largest relative difference; none if a peak of either is missing.
    fn error(&self, reference: &Self) -> Option<f64> {
        self.0
            .iter()
            .zip(&reference.0)
            .map(|(own, reference)| {
                Some((own.amplitude_m()? / reference.amplitude_m()? - 1.0).abs())
            })
            .try_fold(0.0, |largest: f64, error| Some(largest.max(error?)))
    }

    /// What happens at the contact at those that are nonlinear.
    fn contact_motions<'a>(
        &self,
        model: &'a ReducedModel,
        settings: &'a RowSettings,
        engine_orders: &[u32],
        conditions: &[ContactCondition],
    ) -> Result<Vec<ContactMotion<'a>>, PipelineError> {
        let mut motions = Vec::new();
        for ((engine_order, condition), peak) in each(engine_orders, conditions).zip(&self.0) {
            let harmonics = &settings.harmonics;
            motions.extend(ContactMotion::of_peak(
                model,
                settings,
                harmonics,
                engine_order,
                condition,
                peak,
            )?);
        }
        Ok(motions)
    }
}

/// Every engine order with every condition.
fn each<'a>(
    engine_orders: &'a [u32],
    conditions: &'a [ContactCondition],
) -> impl Iterator<Item = (u32, ContactCondition)> + 'a {
    engine_orders.iter().flat_map(|&engine_order| {
        conditions
            .iter()
            .map(move |&condition| (engine_order, condition))
    })
}

/// The conditions by which a basis is judged: lowest, middle and highest load of the study, and
/// every linear limit in it.
#[must_use]
pub fn judged_conditions(conditions: &[ContactCondition]) -> Vec<ContactCondition> {
    let mut loads: Vec<f64> = conditions
        .iter()
        .filter_map(|condition| condition.normal_load_n())
        .collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    let mut judged: Vec<ContactCondition> = match loads.as_slice() {
        [] => Vec::new(),
        loads => {
            let mut places = vec![0, loads.len() / 2, loads.len() - 1];
            places.dedup();
            places
                .into_iter()
                .map(|place| ContactCondition::Full {
                    normal_load_n: loads[place],
                })
                .collect()
        }
    };
    for &condition in conditions {
        if condition.normal_load_n().is_none() && !judged.contains(&condition) {
            judged.push(condition);
        }
    }
    judged
}
