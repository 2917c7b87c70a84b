//! Choice of the reduction basis of a study: fixed by the user, or the cheapest that meets the wanted error.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::model::ReducedModel;
use crate::model::cyclic::nodal_diameter_of;
use crate::model::reduction::{
    BasisChoice, ContactSprings, Reduction, ReductionOptions, wanted_reach_hz,
};
use crate::population::monte_carlo::{HarmonicChoice, RowSettings, RowSolver};
use crate::response::forced_response::{ContactCondition, Peak};
use crate::response::mistuning::{ContactFactors, ContactQuantity, ContactVariation, PairFactors};
use crate::study::{Excitation, PipelineError};

/// Numbers of stick and of slide modes that are tried, ascending.
const STICK_SLIDE_LADDER: [usize; 9] = [2, 3, 4, 6, 8, 10, 14, 20, 28];
/// Loads of a study by which a basis is judged at most.
const LOADS_JUDGED: usize = 8;
/// Standard deviations at which a varied contact stiffness is judged: 90 % of a normal law lie within.
const END_OF_VARIATION: f64 = 1.645;
/// Factor below which none is judged.
const SMALLEST_FACTOR: f64 = 0.05;
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
    /// Smallest ratio, over the harmonics of the tuned peaks, of the highest fixed-interface
    /// frequency in the harmonic's nodal diameter to the [`wanted_reach_hz`]; none where no mode is left out.
    pub craig_bampton_reach: Option<f64>,
    /// Errors of the bases that were tried; the one that was taken stands last.
    pub tried: Vec<BasisError>,
}

/// The tuned peaks by which a basis is judged.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// Settings of the rows.
    pub settings: &'a RowSettings,
    /// Engine orders.
    pub engine_orders: &'a [u32],
    /// Conditions, each under every engine order.
    pub conditions: &'a [ContactCondition],
    /// Harmonic sets that differ from that of the settings.
    pub sets: &'a [HarmonicChoice],
    /// Factors on the contact stiffness besides the nominal one.
    pub varied: &'a [PairFactors],
}

impl<'a> Judged<'a> {
    /// Every engine order with every condition.
    fn each(self) -> impl Iterator<Item = (u32, ContactCondition)> + 'a {
        self.engine_orders.iter().flat_map(move |&engine_order| {
            let conditions = self.conditions.iter();
            conditions.map(move |&condition| (engine_order, condition))
        })
    }

    /// Harmonic set of one engine order and condition.
    fn harmonics(self, engine_order: u32, condition: ContactCondition) -> &'a [u32] {
        self.sets
            .iter()
            .find(|set| set.engine_order == engine_order && set.contact == condition)
            .map_or(&self.settings.harmonics, |set| &set.harmonics)
    }
}

/// Chooses the basis for `options` by the tuned nonlinear peak on one sector, against the whole
/// Craig-Bampton sector with every contact dof, under every force vector with its engine orders and conditions, each
/// with its harmonic set: the largest of all errors counts.
///
/// # Errors
/// If a mass or stiffness is not positive definite.
pub(super) fn choose_basis_under(
    reduction: &Reduction<'_>,
    options: &ReductionOptions,
    cases: &[(&Excitation, Judged<'_>)],
) -> Result<(BasisChoice, BasisEvidence), PipelineError> {
    if reduction.is_whole_space() {
        let evidence = BasisEvidence {
            whole_space: true,
            craig_bampton_reach: None,
            tried: Vec::new(),
        };
        return Ok((BasisChoice::CraigBampton, evidence));
    }
    let whole = reduction.tuned(BasisChoice::CraigBampton)?;
    let wholes: Vec<ReducedModel> = cases.iter().map(|(case, _)| case.of(&whole)).collect();
    let of_cases = |models: &[ReducedModel]| -> Result<Vec<Peaks>, PipelineError> {
        let models = models.iter().zip(cases);
        models
            .map(|(model, (_, judged))| Peaks::of(model, *judged))
            .collect()
    };
    let reference = of_cases(&wholes)?;
    let mut tried: Vec<(BasisChoice, BasisError, f64)> = Vec::new();
    for choice in candidates(options) {
        let model = reduction.tuned(choice)?;
        let models: Vec<ReducedModel> = cases.iter().map(|(case, _)| case.of(&model)).collect();
        let errors = of_cases(&models)?;
        let errors = errors.iter().zip(&reference);
        let error = errors
            .map(|(peaks, reference)| peaks.error(reference))
            .try_fold(0.0, |largest: f64, error| Some(largest.max(error?)));
        let tried_choice = BasisError {
            basis: choice.to_string(),
            vectors: vectors(reduction, choice),
            error,
        };
        let error = error.unwrap_or(f64::INFINITY);
        tried.push((choice, tried_choice, error));
        if error <= options.error {
            break;
        }
    }
    // The last one where it meets the wanted error, else the best of all.
    let best = (0..tried.len())
        .rev()
        .min_by(|&a, &b| tried[a].2.total_cmp(&tried[b].2));
    if let Some(best) = best {
        let taken = tried.remove(best);
        tried.push(taken);
    }
    let choice = tried
        .last()
        .map_or(BasisChoice::CraigBampton, |(choice, ..)| *choice);
    Ok((
        choice,
        BasisEvidence {
            whole_space: false,
            craig_bampton_reach: reference
                .iter()
                .zip(cases)
                .filter_map(|(peaks, (_, judged))| peaks.reach(reduction, *judged))
                .min_by(f64::total_cmp),
            tried: tried
                .into_iter()
                .map(|(_, tried_choice, _)| tried_choice)
                .collect(),
        },
    ))
}

/// Bases to try, the cheapest first; one that the user fixed stands alone.
fn candidates(options: &ReductionOptions) -> Vec<BasisChoice> {
    let ladder = STICK_SLIDE_LADDER.map(|modes| BasisChoice::StickSlide {
        stick: modes,
        slide: modes,
    });
    match (options.stick_modes, options.slide_modes) {
        (Some(stick), Some(slide)) => vec![BasisChoice::StickSlide { stick, slide }],
        (Some(modes), None) | (None, Some(modes)) => vec![BasisChoice::StickSlide {
            stick: modes,
            slide: modes,
        }],
        (None, None) => ladder.to_vec(),
    }
}

fn vectors(reduction: &Reduction<'_>, choice: BasisChoice) -> usize {
    match choice {
        BasisChoice::StickSlide { stick, slide } => stick + slide,
        BasisChoice::StickAttachment { stick } => stick + reduction.contact_rows(),
        BasisChoice::CraigBampton => reduction
            .models()
            .map(crate::model::reduction::CraigBampton::size)
            .max()
            .unwrap_or(0),
    }
}

/// Tuned peaks, one per engine order and condition, those under the nominal contact first.
struct Peaks(Vec<Peak>);

impl Peaks {
    fn of(model: &ReducedModel, judged: Judged<'_>) -> Result<Self, PipelineError> {
        let mut peaks = Vec::new();
        let nominal = PairFactors::default();
        for factors in std::iter::once(&nominal).chain(judged.varied) {
            let mut settings = judged.settings.clone();
            settings.solver.peak_tolerance = PEAK_TOLERANCE;
            settings.contact = settings
                .contact
                .map(|(law, sector)| (law, sector.varied(factors)));
            let mut varied = model.clone();
            let of_sector = ContactFactors::new(vec![*factors; model.contact.weights.len()]);
            varied.springs = ContactSprings {
                stick: of_sector.springs(&model.springs.stick, &model.contact.rows),
                slide: of_sector.springs(&model.springs.slide, &model.contact.rows),
            };
            let solver = RowSolver::new(Arc::new(varied), settings)?
                .with_choices(judged.sets.to_vec(), 0.0)?;
            peaks.extend(
                judged
                    .each()
                    .map(|(engine_order, condition)| solver.tuned_peak(engine_order, condition)),
            );
        }
        Ok(Self(peaks))
    }

    /// Largest relative difference; none if a peak of either is missing.
    fn error(&self, reference: &Self) -> Option<f64> {
        self.0
            .iter()
            .zip(&reference.0)
            .map(|(peak, reference)| {
                Some((peak.amplitude_m()? / reference.amplitude_m()? - 1.0).abs())
            })
            .try_fold(0.0, |largest: f64, error| Some(largest.max(error?)))
    }

    /// How far the fixed-interface modes reach beyond the harmonics of the peaks.
    fn reach(&self, reduction: &Reduction<'_>, judged: Judged<'_>) -> Option<f64> {
        let models: &[_] = &reduction.models().collect::<Vec<_>>();
        let sectors = reduction.sectors();
        judged
            .each()
            .zip(&self.0)
            .filter_map(|((engine_order, condition), peak)| {
                Some((engine_order, condition, peak.point.as_ref()?.frequency_hz))
            })
            .flat_map(|(engine_order, condition, frequency_hz)| {
                let linear = condition.normal_load_n().is_none();
                let harmonics = judged.harmonics(engine_order, condition);
                harmonics
                    .iter()
                    .copied()
                    .filter(move |&k| k == 1 || (k > 1 && !linear))
                    .filter_map(move |k| {
                        let h = nodal_diameter_of(k, engine_order, sectors).index;
                        let highest = models[h].highest_fixed_interface_hz?;
                        Some(highest / wanted_reach_hz(k, frequency_hz))
                    })
            })
            .min_by(f64::total_cmp)
    }
}

/// The conditions by which a basis is judged: the loads of the study, or [`LOADS_JUDGED`] spread over
/// them from the lowest to the highest, and every linear limit in it.
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
            let count = loads.len().min(LOADS_JUDGED);
            (0..count)
                .map(|i| i * (loads.len() - 1) / (count - 1).max(1))
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

/// Contact by which a basis is judged besides the nominal one: all stiffnesses that vary at their
/// lower, then at their upper end.
#[must_use]
pub fn judged_variations(variations: &[ContactVariation]) -> Vec<PairFactors> {
    let at = |unit: f64| {
        let mut factors = PairFactors::default();
        for variation in variations {
            let factor = variation.factor(unit).max(SMALLEST_FACTOR);
            match variation.quantity {
                ContactQuantity::TangentialStiffness => factors.tangential_stiffness = factor,
                ContactQuantity::NormalStiffness => factors.normal_stiffness = factor,
                ContactQuantity::FrictionCoefficient | ContactQuantity::NormalLoad => {}
            }
        }
        factors
    };
    [at(-END_OF_VARIATION), at(END_OF_VARIATION)]
        .into_iter()
        .filter(|factors| *factors != PairFactors::default())
        .collect()
}
