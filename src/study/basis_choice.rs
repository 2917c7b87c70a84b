//! Choice of the reduction basis of a study: fixed by the user, or the cheapest that meets the wanted error.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::PipelineError;
use crate::model::ReducedModel;
use crate::model::reduction::{Basis, BasisChoice, Reduction, ReductionOptions};
use crate::population::monte_carlo::{HarmonicChoice, RowSettings, RowSolver};
use crate::response::forced_response::ContactCondition;

/// Stick modes of `stick_attachment` where the study does not say.
pub(super) const ATTACHMENT_STICK_MODES: usize = 4;
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
/// Craig-Bampton sector with every contact dof, under the given engine orders and conditions, each
/// with its harmonic set.
///
/// # Errors
/// If a mass or stiffness is not positive definite.
pub fn choose_basis(
    reduction: &Reduction<'_>,
    options: &ReductionOptions,
    settings: &RowSettings,
    engine_orders: &[u32],
    conditions: &[ContactCondition],
    sets: &[HarmonicChoice],
) -> Result<(BasisChoice, BasisEvidence), PipelineError> {
    if reduction.is_whole_space() {
        let evidence = BasisEvidence {
            whole_space: true,
            tried: Vec::new(),
        };
        return Ok((BasisChoice::CraigBampton, evidence));
    }
    let reference = Peaks::of(
        reduction.reduce(BasisChoice::CraigBampton, None)?,
        settings,
        engine_orders,
        conditions,
        sets,
    )?;
    let mut tried = Vec::new();
    let mut chosen = None;
    for choice in candidates(reduction, options) {
        let peaks = Peaks::of(
            reduction.reduce(choice, None)?,
            settings,
            engine_orders,
            conditions,
            sets,
        )?;
        let error = peaks.error(&reference);
        tried.push(BasisError {
            basis: choice.to_string(),
            vectors: vectors(reduction, choice),
            error,
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

/// Tuned peak amplitudes, one per engine order and condition; none where no peak was found.
struct Peaks(Vec<Option<f64>>);

impl Peaks {
    fn of(
        model: ReducedModel,
        settings: &RowSettings,
        engine_orders: &[u32],
        conditions: &[ContactCondition],
        sets: &[HarmonicChoice],
    ) -> Result<Self, PipelineError> {
        let mut settings = settings.clone();
        settings.solver.peak_tolerance = PEAK_TOLERANCE;
        let solver = RowSolver::new(Arc::new(model), settings)?.with_choices(sets.to_vec(), 0.0)?;
        Ok(Self(
            engine_orders
                .iter()
                .flat_map(|&engine_order| {
                    conditions
                        .iter()
                        .map(move |&condition| (engine_order, condition))
                })
                .map(|(engine_order, condition)| {
                    solver.tuned_peak(engine_order, condition).amplitude_m()
                })
                .collect(),
        ))
    }

    /// Largest relative difference; none if a peak of either is missing.
    fn error(&self, reference: &Self) -> Option<f64> {
        self.0
            .iter()
            .zip(&reference.0)
            .map(|(own, reference)| Some(((*own)? / (*reference)? - 1.0).abs()))
            .try_fold(0.0, |largest: f64, error| Some(largest.max(error?)))
    }
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
