//! How many fixed-interface modes a study takes, and what the others would change of the tuned peak.
//!
//! The number of these modes costs nothing per row: it is reduced further by the basis. A contact
//! resonance that a higher harmonic meets must be placed within a part of its width, though, which
//! takes many more modes than its frequency suggests. So the tuned peak itself is compared, on the
//! condensed full-contact sector, with all harmonics that the a-posteriori error looks at: M modes
//! against 1.5 M and 2.25 M.

use std::sync::Arc;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::basis_choice::judged_conditions;
use super::row_settings::{contact_stiffness, reference_settings, row_settings};
use crate::model::ReducedModel;
use crate::model::cyclic::nodal_diameter_of;
use crate::model::reduction::{BasisChoice, Reduction, ReductionOptions};
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{RowSettings, RowSolver, Scenario};
use crate::response::forced_response::{SearchEnd, SearchPlan, SearchSettings, find_peak};
use crate::response::friction::ContactLaw;
use crate::response::harmonic_balance::HarmonicTransform;
use crate::study::{Excitation, MistuningSource, PipelineError, Study, excitations};
use crate::verification::reference::{ReferenceSettings, ReferenceSolver};

/// Modes beyond which none are added without being asked for.
const MOST_MODES: usize = 200;
/// Highest harmonic of the compared peaks, that of the a-posteriori error.
const HIGHEST_HARMONIC: usize = 15;
/// Samples per period of the compared peaks; their error is the same on either side.
const SAMPLES: usize = 256;
/// Tolerance of the compared peaks.
const PEAK_TOLERANCE: f64 = 1e-4;
/// Frequencies of one peak at most.
const EVALUATIONS: usize = 100;
/// Half-bandwidths on either side of a known peak in which that of more modes is sought first.
const NEAR: f64 = 1.0;
/// Standard deviation from which on sensitivity vectors are added by default.
const LARGE_MISTUNING: f64 = 0.05;
/// Sensitivity vectors added by default to a large mistuning.
const SENSITIVITY_VECTORS: usize = 2;

/// The number of fixed-interface modes that was taken, and the evidence for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FixedInterface {
    /// Modes per nodal diameter.
    pub modes: usize,
    /// Largest relative change of a tuned peak by half as many modes more and by half of those
    /// again; zero where no mode is left out, none where no tuned peak was found.
    pub error: Option<f64>,
    /// Largest relative change of a tuned peak by half as many modes more, for each number tried.
    pub tried: Vec<ModesTried>,
}

/// One number of modes that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModesTried {
    /// Modes per nodal diameter.
    pub modes: usize,
    /// Largest relative change of a tuned peak by half as many modes more.
    pub change: Option<f64>,
}

/// The Craig-Bampton models of a study, and how many modes they have.
///
/// The number is that of the study, or the first of 25, 37, 55, ... (each half as many again) at
/// which half as many modes more change no tuned peak by more than `reduction.error`.
///
/// # Errors
/// If a mass or stiffness is not positive definite, or the samples per period cannot tell the harmonics apart.
pub fn reduce_sector<'a>(
    study: &Study,
    sector: &'a SectorModel,
) -> Result<(Reduction<'a>, FixedInterface), PipelineError> {
    let fixed = study.reduction.craig_bampton_modes;
    let compared = ComparedCases::new(study)?;
    let mut tried = Vec::new();
    let first = fixed.unwrap_or(ReductionOptions::FIRST_CRAIG_BAMPTON_MODES);
    let mut coarse = Rung::new(study, sector, first);
    let waves = compared.waves(sector.sectors);
    let model = coarse.model(&waves)?;
    if coarse.reduction.is_whole_space() {
        return coarse.taken(Some(0.0), tried);
    }
    let mut peaks = compared.peaks(&model, None)?;
    let mut next = Rung::new(study, sector, coarse.more_modes());
    let mut next_peaks = compared.peaks(&next.model(&waves)?, Some(&peaks))?;
    loop {
        let finest = Rung::new(study, sector, next.more_modes());
        let finest_peaks = compared.peaks(&finest.model(&waves)?, Some(&next_peaks))?;
        let change = largest_change(&peaks, &next_peaks);
        tried.push(ModesTried {
            modes: coarse.modes,
            change,
        });
        let enough = change.is_none_or(|change| change <= study.reduction.error);
        if enough || fixed.is_some() || next.modes > MOST_MODES {
            let further = largest_change(&peaks, &finest_peaks);
            let error = change.zip(further).map(|(a, b)| a.max(b));
            return coarse.taken(error, tried);
        }
        (coarse, peaks) = (next, next_peaks);
        (next, next_peaks) = (finest, finest_peaks);
    }
}

/// The models of [`reduce_sector`] alone: where the study says how many modes, nothing is measured.
///
/// # Errors
/// If a mass or stiffness is not positive definite, or the samples per period cannot tell the harmonics apart.
pub fn reduction_of<'a>(
    study: &Study,
    sector: &'a SectorModel,
) -> Result<Reduction<'a>, PipelineError> {
    match study.reduction.craig_bampton_modes {
        Some(modes) => Ok(Rung::new(study, sector, modes).reduction.completed()?),
        None => Ok(reduce_sector(study, sector)?.0),
    }
}

/// The Craig-Bampton models of a study with so many fixed-interface modes; no nodal diameter is reduced yet.
pub(super) fn reduction_with<'a>(
    study: &Study,
    sector: &'a SectorModel,
    modes: usize,
) -> Reduction<'a> {
    Reduction::on_demand(
        sector,
        contact_stiffness(study.contact.as_ref()),
        modes,
        sensitivity_vectors(study),
    )
    .with_damping(study.added_damping())
    .with_force_factors(study.force_factors())
}

/// One number of fixed-interface modes.
struct Rung<'a> {
    modes: usize,
    reduction: Reduction<'a>,
}

impl<'a> Rung<'a> {
    /// No nodal diameter is reduced yet.
    fn new(study: &Study, sector: &'a SectorModel, modes: usize) -> Self {
        Self {
            modes,
            reduction: reduction_with(study, sector, modes),
        }
    }

    fn more_modes(&self) -> usize {
        (3 * self.modes).div_ceil(2)
    }

    /// The tuned wheel with every contact dof, in the nodal diameters `waves`.
    fn model(&self, waves: &[usize]) -> Result<ReducedModel, PipelineError> {
        Ok(self.reduction.tuned_in(BasisChoice::CraigBampton, waves)?)
    }

    fn taken(
        self,
        error: Option<f64>,
        tried: Vec<ModesTried>,
    ) -> Result<(Reduction<'a>, FixedInterface), PipelineError> {
        let evidence = FixedInterface {
            modes: self.modes,
            error,
            tried,
        };
        Ok((self.reduction.completed()?, evidence))
    }
}

/// A tuned peak, and the harmonic set that it was found with.
#[derive(Clone, Copy)]
struct TunedPeak {
    amplitude_m: f64,
    frequency_hz: f64,
    set: usize,
}

/// Largest relative difference of the peaks that both have; none without any.
fn largest_change(peaks: &[Option<TunedPeak>], other: &[Option<TunedPeak>]) -> Option<f64> {
    peaks
        .iter()
        .zip(other)
        .filter_map(|(peak, other)| Some((peak.as_ref()?, other.as_ref()?)))
        .map(|(peak, other)| (other.amplitude_m / peak.amplitude_m - 1.0).abs())
        .reduce(f64::max)
}

/// The tuned peaks that are compared, under every force vector of the study.
struct ComparedCases(Vec<(Excitation, Compared)>);

impl ComparedCases {
    fn new(study: &Study) -> Result<Self, PipelineError> {
        let cases = excitations(study).into_iter().map(|case| {
            let compared = Compared::new(&case.study)?;
            Ok((case, compared))
        });
        cases.collect::<Result<_, PipelineError>>().map(Self)
    }

    fn waves(&self, sectors: usize) -> Vec<usize> {
        let cases = self.0.iter();
        let mut waves: Vec<usize> = cases
            .flat_map(|(_, compared)| compared.waves(sectors))
            .collect();
        waves.sort_unstable();
        waves.dedup();
        waves
    }

    /// The tuned peaks under all force vectors, vector after vector.
    fn peaks(
        &self,
        model: &ReducedModel,
        known: Option<&[Option<TunedPeak>]>,
    ) -> Result<Vec<Option<TunedPeak>>, PipelineError> {
        let mut peaks = Vec::new();
        for (case, compared) in &self.0 {
            let places = peaks.len()..peaks.len() + compared.cases.len();
            let known = known.map(|known| &known[places]);
            peaks.extend(compared.peaks(&Arc::new(case.of(model)), known)?);
        }
        Ok(peaks)
    }
}

/// The tuned peaks that are compared under one force vector: of every engine order, at the loads that judge a basis too.
struct Compared {
    row: RowSettings,
    cases: Vec<Scenario>,
    /// Harmonic sets to try in this order: light contact may have no solution with the first.
    sets: Vec<ReferenceSettings>,
}

impl Compared {
    fn new(study: &Study) -> Result<Self, PipelineError> {
        let row = row_settings(study);
        let law = row.contact.map(|(law, _)| law);
        let all: Vec<usize> = if law.is_some_and(ContactLaw::has_variable_load) {
            (0..=HIGHEST_HARMONIC).collect()
        } else {
            (1..=HIGHEST_HARMONIC).step_by(2).collect()
        };
        let few = all.iter().copied().filter(|&k| k <= 3).collect();
        let sets = [all, few, vec![1]]
            .iter()
            .map(|set| {
                Ok(reference_settings(
                    &row,
                    HarmonicTransform::new(set, SAMPLES)?,
                ))
            })
            .collect::<Result<_, PipelineError>>()?;
        let conditions = judged_conditions(&study.contacts);
        let cases = study.engine_orders.iter().flat_map(|&engine_order| {
            conditions.iter().map(move |&contact| Scenario {
                index: 0,
                load_case: None,
                engine_order,
                standard_deviation: None,
                contact,
            })
        });
        Ok(Self {
            cases: cases.collect(),
            row,
            sets,
        })
    }

    /// Nodal diameters that the tuned wheel answers in, in any harmonic of any set.
    fn waves(&self, sectors: usize) -> Vec<usize> {
        let harmonics = 0..=HIGHEST_HARMONIC as u32;
        let mut waves: Vec<usize> = harmonics
            .flat_map(|harmonic| {
                let of = move |case: &Scenario| {
                    nodal_diameter_of(harmonic, case.engine_order, sectors).index
                };
                self.cases.iter().map(of)
            })
            .collect();
        waves.sort_unstable();
        waves.dedup();
        waves
    }

    /// Peaks with the sets of those `known` before, or with the first set that has one.
    fn peaks(
        &self,
        model: &Arc<ReducedModel>,
        known: Option<&[Option<TunedPeak>]>,
    ) -> Result<Vec<Option<TunedPeak>>, PipelineError> {
        let scout = RowSolver::new(Arc::clone(model), self.row.clone())?;
        let peaks = self.cases.par_iter().enumerate().map(|(place, case)| {
            let with = |set, expected_hz| self.peak(model, &scout, case, set, expected_hz);
            match known {
                None => (0..self.sets.len()).find_map(|set| with(set, None)),
                Some(known) => {
                    known[place].and_then(|known| with(known.set, Some(known.frequency_hz)))
                }
            }
        });
        Ok(peaks.collect())
    }

    fn peak(
        &self,
        model: &ReducedModel,
        scout: &RowSolver,
        case: &Scenario,
        set: usize,
        expected_hz: Option<f64>,
    ) -> Option<TunedPeak> {
        let plan = scout.search_plan(case, None, None).ok()?;
        let (engine_order, contact) = (case.engine_order, case.contact);
        let mut solver =
            ReferenceSolver::new(model, &self.sets[set], engine_order, contact, None).ok()?;
        let (band_hz, starts_hz) = sought(&plan, expected_hz);
        let settings = SearchSettings {
            tolerance: PEAK_TOLERANCE,
            evaluations: EVALUATIONS,
            extensions: plan.extensions,
            rivals_from: 1.0,
        };
        let found = find_peak(
            band_hz,
            &starts_hz,
            plan.envelope,
            settings,
            |frequency_hz| {
                let point = solver.solve(frequency_hz).ok();
                point.map(|point| point.amplitudes_m.clone())
            },
        );
        let best = found
            .best
            .filter(|_| found.end == SearchEnd::Found && found.bracketed)?;
        let sample = &found.samples[best];
        Some(TunedPeak {
            amplitude_m: sample.largest,
            frequency_hz: sample.frequency_hz,
            set,
        })
    }
}

/// Band and first frequencies, Hz: all of the plan, or next to a peak known with fewer modes.
fn sought(plan: &SearchPlan, expected_hz: Option<f64>) -> ((f64, f64), Vec<f64>) {
    let Some(expected) = expected_hz else {
        return (plan.band_hz, plan.starts_hz.clone());
    };
    let near = NEAR * plan.envelope.linear_half_bandwidth_hz;
    let (low, high) = plan.band_hz;
    let band = (low.max(expected - near), high.min(expected + near));
    (band, vec![band.0, expected, band.1])
}

/// Largest standard deviation of the blades' stiffness in a study.
pub(super) fn expected_deviation(study: &Study) -> f64 {
    let largest = study
        .standard_deviations
        .iter()
        .flatten()
        .copied()
        .fold(0.0, f64::max);
    let of_file = match &study.mistuning.source {
        MistuningSource::Law(_) => 0.0,
        MistuningSource::File { records, .. } => records.root_mean_square(),
    };
    f64::max(largest, of_file)
}

/// Sensitivity vectors to blade stiffness per nodal diameter: as the study says, or by the size of its mistuning.
pub(super) fn sensitivity_vectors(study: &Study) -> usize {
    study
        .reduction
        .sensitivity_vectors
        .unwrap_or(if expected_deviation(study) >= LARGE_MISTUNING {
            SENSITIVITY_VECTORS
        } else {
            0
        })
}
