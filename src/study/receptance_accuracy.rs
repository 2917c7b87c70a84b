//! Settings on tuned receptances by an accepted error, held against enlarged ones on mistuned wheels.
//!
//! Every tolerance of the engine is a fixed share of the accepted error. Rows of the study at these settings are compared with the
//! same rows in harmonics up to 15, with twice the blade shapes and twice the samples, found by a search of their own. Where the
//! upper bound of the 95th percentile of the amplitude error is not accepted, those of harmonics and peak are halved; where that
//! does not do either, every harmonic is taken. Modes and shapes stay: their error was measured when they were chosen.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::accuracy_choice::{
    AccuracyChoice, AccuracyEvidence, ChosenSetting, TriedSetting, Unwatched,
};
use super::ladder_bench::{LadderEngine, LadderRow, LadderValues};
use super::ladder_measure::{Compared, error_bound, errors_of_load_cases};
use super::ladder_sample::{LadderSample, Remainders, sampled_scenarios};
use super::reduced_engine::stored_digest;
use super::reduced_study::{Stored, reduced_on_receptances, solver_of};
use super::{PipelineError, Study};
use crate::model::sector::SectorModel;
use crate::model::write_cached;
use crate::population::monte_carlo::TUNED_RECEPTANCES;
use crate::population::statistics::ErrorBound;
use crate::response::forced_response::{Harmonics, RowsBeyondTolerance};
use crate::response::mistuning::PatternSource;

/// Tolerance of the harmonics over the accepted error; judged wheels are held to a fifth of it.
const HARMONICS: f64 = 2.0;
/// Tolerance of fixed-interface modes and blade shapes over the accepted error.
const REDUCTION: f64 = 0.1;
/// Tolerance of the peak over the accepted error.
const PEAK: f64 = 0.1;
/// Samples per period, and an error from which on twice as many are taken.
const SAMPLES: usize = 128;
const FINER_SAMPLES_BELOW: f64 = 0.004;
/// Harmonics that rows are compared with go to this one.
const ENLARGED_HARMONIC: u32 = 15;
/// Peak tolerance of these rows over that of the settings.
const ENLARGED_PEAK: f64 = 0.2;

/// Settings of rows on tuned receptances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReceptanceSetting {
    /// `reduction.error`, by which fixed-interface modes and blade shapes are chosen.
    pub reduction_error: f64,
    /// `solver.harmonic_tolerance`, by which harmonics are chosen.
    pub harmonic_tolerance: f64,
    /// `solver.harmonics`, where no tolerance of them was enough.
    pub harmonics: Option<Vec<u32>>,
    /// `solver.samples_per_period`, at least.
    pub samples_per_period: usize,
    /// `solver.peak_tolerance`.
    pub peak_tolerance: f64,
}

impl ReceptanceSetting {
    /// The settings for an error of the amplitude.
    #[must_use]
    pub fn within(amplitude_error: f64) -> Self {
        let is_fine = amplitude_error < FINER_SAMPLES_BELOW;
        Self {
            reduction_error: REDUCTION * amplitude_error,
            harmonic_tolerance: HARMONICS * amplitude_error,
            harmonics: None,
            samples_per_period: if is_fine { 2 * SAMPLES } else { SAMPLES },
            peak_tolerance: PEAK * amplitude_error,
        }
    }

    /// What is tried next after as many as `tried`: half the tolerances of harmonics and peak, then `all_harmonics` besides; nothing
    /// more after that.
    fn tighter(self, tried: usize, all_harmonics: &[u32]) -> Option<Self> {
        match tried {
            1 => Some(Self {
                harmonic_tolerance: 0.5 * self.harmonic_tolerance,
                peak_tolerance: 0.5 * self.peak_tolerance,
                ..self
            }),
            2 => Some(Self {
                harmonics: Some(all_harmonics.to_vec()),
                ..self
            }),
            _ => None,
        }
    }

    /// `study` solved at these settings. What they do not say stays.
    #[must_use]
    pub fn applied_to(&self, study: &Study) -> Study {
        let mut own = study.clone();
        own.accuracy = None;
        own.reduction.error = self.reduction_error;
        let solver = &mut own.solver;
        solver.harmonics = match &self.harmonics {
            None => Harmonics::Auto,
            Some(set) => Harmonics::Set(set.clone()),
        };
        solver.harmonic_tolerance = self.harmonic_tolerance;
        solver.rows_beyond_tolerance = RowsBeyondTolerance::Flag;
        solver.samples_per_period = self.samples_per_period;
        solver.peak_tolerance = self.peak_tolerance;
        own
    }

    /// `study` as rows at these settings are held against.
    fn enlarged(&self, study: &Study, harmonics: &[u32]) -> Study {
        let mut own = self.applied_to(study);
        own.solver.harmonics = Harmonics::Set(harmonics.to_vec());
        own.solver.samples_per_period = 2 * self.samples_per_period;
        own.solver.peak_tolerance = ENLARGED_PEAK * self.peak_tolerance;
        own
    }

    /// The settings for the manifest, under the names of the ladder's where it has them.
    #[must_use]
    pub fn facts(&self) -> Value {
        json!({
            "basis": TUNED_RECEPTANCES,
            "reduction_error": format!("{:e}", self.reduction_error),
            "harmonics": self.harmonics_in_words(),
            "samples_per_period": self.samples_per_period.to_string(),
            "peak_tolerance": format!("{:e}", self.peak_tolerance),
        })
    }

    fn harmonics_in_words(&self) -> String {
        match &self.harmonics {
            None => format!("auto {}", self.harmonic_tolerance),
            Some(set) => {
                let set: Vec<String> = set.iter().map(u32::to_string).collect();
                set.join(", ")
            }
        }
    }

    fn words(&self) -> String {
        format!(
            "{TUNED_RECEPTANCES} to {:e}, harmonics {}, {} samples, peak to {:e}",
            self.reduction_error,
            self.harmonics_in_words(),
            self.samples_per_period,
            self.peak_tolerance
        )
    }
}

/// The settings for `accepted`, by rows of `sample`: patterns with the ids to take. What the study is solved on goes to `cache`.
///
/// # Errors
/// The model cannot be reduced, or the cache not be written.
pub(super) fn on_receptances(
    study: &Study,
    accepted: f64,
    sector: &SectorModel,
    (patterns, ids): (&PatternSource, Vec<u32>),
    cache: Option<&Path>,
) -> Result<AccuracyChoice, PipelineError> {
    let mut tried = Vec::new();
    let mut operations = 0.0;
    let all_harmonics = enlarged_harmonics(study);
    let mut setting = ReceptanceSetting::within(accepted);
    loop {
        let own = setting.applied_to(study);
        let stored = reduced_on_receptances(&own, sector)?;
        let compared = Rows::compared(study, &setting, &stored, patterns, &ids)?;
        operations += compared.operations();
        let amplitude = compared.bound(Compared::Amplitude);
        if let Some(amplitude) = amplitude {
            tried.push(TriedSetting {
                setting: setting.words(),
                rows: amplitude.rows,
                worst: amplitude.worst,
                operations: mean_operations(&compared.own),
            });
        }
        // Linear limits have nothing to compare.
        let has_rows = !compared.sample.scenarios.is_empty();
        let met = !has_rows || amplitude.is_some_and(|own| own.p95_upper <= accepted);
        if !met && amplitude.is_some() {
            if let Some(tighter) = setting.clone().tighter(tried.len(), &all_harmonics) {
                setting = tighter;
                continue;
            }
        }
        if let Some(folder) = cache {
            write_cached(folder, &stored_digest(&own, sector), &stored)?;
        }
        let evidence =
            amplitude.map(|amplitude| compared.evidence(&setting, amplitude, operations, tried));
        return Ok(AccuracyChoice {
            accepted,
            craig_bampton_modes: stored.fixed_interface.modes,
            met,
            evidence,
            setting: ChosenSetting::Receptances(setting),
        });
    }
}

/// Rows of a sample at some settings and at the enlarged ones, ordered by pattern, then scenario.
struct Rows {
    sample: LadderSample,
    own: Vec<LadderRow>,
    enlarged: Vec<LadderRow>,
}

impl Rows {
    fn compared(
        study: &Study,
        setting: &ReceptanceSetting,
        stored: &Stored,
        patterns: &PatternSource,
        ids: &[u32],
    ) -> Result<Self, PipelineError> {
        let own = setting.applied_to(study);
        let solver = solver_of(&own, stored)?;
        let load_cases = own.excited_orders().into_iter().map(|case| case.0);
        let choices = solver.of_load_cases().map(|own| own.choices().cloned());
        let remainders: Vec<Remainders> = load_cases
            .zip(choices.map(Iterator::collect::<Vec<_>>))
            .collect();
        let sample = LadderSample {
            scenarios: sampled_scenarios(&own, &remainders),
            patterns: ids.to_vec(),
        };
        let harmonics = enlarged_harmonics(study);
        let enlarged = solver_of(
            &setting.enlarged(study, &harmonics),
            &stored.enlarged(&harmonics),
        )?;
        let [own, enlarged] = [solver, enlarged].map(|solver| {
            let engine = LadderEngine::new(solver, &sample.scenarios, &Unwatched);
            engine.rows(patterns, ids)
        });
        Ok(Self {
            sample,
            own,
            enlarged,
        })
    }

    fn bound(&self, quantity: Compared) -> Option<ErrorBound> {
        error_bound(&values(&self.own), &values(&self.enlarged), quantity)
    }

    fn operations(&self) -> f64 {
        let rows = self.own.iter().chain(&self.enlarged);
        rows.map(|row| row.operations).sum()
    }

    fn evidence(
        &self,
        setting: &ReceptanceSetting,
        amplitude: ErrorBound,
        operations_of_choice: f64,
        tried: Vec<TriedSetting>,
    ) -> AccuracyEvidence {
        let scenarios = self.sample.scenarios.iter();
        AccuracyEvidence {
            patterns: self.sample.patterns.clone(),
            normal_loads_n: scenarios
                .clone()
                .filter_map(|scenario| scenario.contact.normal_load_n())
                .collect(),
            reference_tolerance: None,
            reference: "enlarged".to_owned(),
            amplitude,
            amplitude_worst_upper: amplitude.worst_upper(setting.peak_tolerance),
            frequency: self.bound(Compared::Frequency),
            amplification_factor: self.bound(Compared::AmplificationFactor),
            operations_per_row: mean_operations(&self.own),
            operations_of_choice,
            tried,
            load_cases: scenarios
                .filter_map(|scenario| scenario.load_case)
                .collect(),
            errors_of_load_cases: errors_of_load_cases(
                &self.own,
                &values(&self.enlarged),
                &self.sample,
            ),
        }
    }
}

/// Every harmonic that the law of `study` can excite, to the highest of the comparison.
fn enlarged_harmonics(study: &Study) -> Vec<u32> {
    let contact = study.contact.as_ref();
    if contact.is_some_and(|contact| contact.law.has_variable_load()) {
        (0..=ENLARGED_HARMONIC).collect()
    } else {
        (1..=ENLARGED_HARMONIC).step_by(2).collect()
    }
}

fn values(rows: &[LadderRow]) -> Vec<LadderValues> {
    rows.iter().map(|row| row.values).collect()
}

fn mean_operations(rows: &[LadderRow]) -> f64 {
    let sum: f64 = rows.iter().map(|row| row.operations).sum();
    sum / rows.len().max(1) as f64
}
