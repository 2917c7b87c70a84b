//! Settings on tuned receptances by an accepted error, held against enlarged ones on mistuned wheels.
//!
//! Every tolerance of the engine is a fixed share of the accepted error. Rows of the study at these settings are compared with the
//! same rows in harmonics up to 15, with twice the blade shapes and twice the samples, each climbed from its own peak. Where the
//! upper bound of the 95th percentile of their errors is not accepted, the tolerance of the peak is halved; where that does not do
//! either, halved once more, with twice the samples. What the study says itself stays. Modes and shapes stay too: their error
//! was measured when they were chosen.

use std::path::Path;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::accuracy_choice::{
    AccuracyChoice, AccuracyEvidence, ChosenSetting, TriedSetting, Unwatched,
};
use super::ladder_bench::{LadderEngine, LadderRow, LadderValues};
use super::ladder_measure::{Compared, error_bound, errors_of_load_cases};
use super::ladder_sample::{LadderSample, Remainders, sampled_scenarios};
use super::reduced_engine::stored_for;
use super::reduced_study::{Stored, solver_of};
use super::{PipelineError, Study};
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{RowSolver, Scenario, TUNED_RECEPTANCES, harmonics_name};
use crate::population::statistics::ErrorBound;
use crate::response::forced_response::{
    ContactCondition, Harmonics, RowsBeyondTolerance, TopBeside,
};
use crate::response::mistuning::PatternSource;

/// Tolerance of the harmonics over the accepted error, beyond which rows are marked.
const HARMONICS: f64 = 2.0;
/// Tolerance of fixed-interface modes and blade shapes over the accepted error.
const REDUCTION: f64 = 0.1;
/// Tolerance of the peak over the accepted error.
const PEAK: f64 = 0.1;
/// Samples per period, and an error below which twice as many are taken.
const SAMPLES: usize = 128;
const FINER_SAMPLES_BELOW: f64 = 0.004;
/// Harmonics that rows are compared with go to this one; those that the study says are among them.
const ENLARGED_HARMONIC: u32 = 15;
/// Samples of these rows at least.
const ENLARGED_SAMPLES: usize = 256;
/// What a top of these rows may be off by because a solution had not settled, over the peak tolerance of the settings.
const UNSETTLED: f64 = 1.0;

/// Share of the rows whose values at the enlarged settings are known, at least.
const SETTLED: f64 = 0.5;

/// Settings of rows on tuned receptances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReceptanceSetting {
    /// `reduction.error`, by which fixed-interface modes and blade shapes are chosen.
    pub reduction_error: f64,
    /// `solver.harmonic_tolerance`.
    pub harmonic_tolerance: f64,
    /// `solver.harmonics`, where the study says them.
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

    /// These settings but for those that `study` says itself.
    fn but_for_those_of(mut self, study: &Study) -> Self {
        let solver = &study.solver;
        if study.states("reduction.error") {
            self.reduction_error = study.reduction.error;
        }
        if study.states("solver.harmonic_tolerance") {
            self.harmonic_tolerance = solver.harmonic_tolerance;
        }
        if study.states("solver.harmonics") {
            self.harmonics = match &solver.harmonics {
                Harmonics::Auto => None,
                Harmonics::Set(set) => Some(set.clone()),
            };
        }
        if study.states("solver.samples_per_period") {
            self.samples_per_period = solver.samples_per_period;
        }
        if study.states("solver.peak_tolerance") {
            self.peak_tolerance = solver.peak_tolerance;
        }
        self
    }

    /// The settings tried for `amplitude_error`, in order: those for it, then half the tolerance of the peak, then a quarter and twice
    /// the samples. Where `study` says what a step would change, there is no such step.
    fn tried_for(amplitude_error: f64, study: &Study) -> Vec<Self> {
        let first = Self::within(amplitude_error);
        let second = Self {
            peak_tolerance: 0.5 * first.peak_tolerance,
            ..first.clone()
        };
        let third = Self {
            peak_tolerance: 0.5 * second.peak_tolerance,
            samples_per_period: 2 * second.samples_per_period,
            ..second.clone()
        };
        let mut tried: Vec<Self> = Vec::new();
        for setting in [first, second, third] {
            let setting = setting.but_for_those_of(study);
            if tried.last() != Some(&setting) {
                tried.push(setting);
            }
        }
        tried
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
        if !study.states("solver.rows_beyond_tolerance") {
            solver.rows_beyond_tolerance = RowsBeyondTolerance::Flag;
        }
        solver.samples_per_period = self.samples_per_period;
        solver.peak_tolerance = self.peak_tolerance;
        own
    }

    /// `study` as rows at these settings are held against.
    fn enlarged(&self, study: &Study, harmonics: &[u32]) -> Study {
        let mut own = self.applied_to(study);
        own.solver.harmonics = Harmonics::Set(harmonics.to_vec());
        own.solver.samples_per_period = ENLARGED_SAMPLES.max(2 * self.samples_per_period);
        own
    }

    /// `top` where it is known well enough to tell an error by.
    fn settled(&self, top: TopBeside) -> Option<TopBeside> {
        (top.unsettled <= UNSETTLED * self.peak_tolerance).then_some(top)
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
            Some(set) => harmonics_name(set),
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

/// The settings for `accepted`, by rows of patterns with these ids. What the study is solved on goes to `cache`.
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
    let mut left = ReceptanceSetting::tried_for(accepted, study).into_iter();
    let mut setting = ReceptanceSetting::within(accepted).but_for_those_of(study);
    let mut tried = Vec::new();
    let mut operations = 0.0;
    loop {
        setting = left.next().unwrap_or(setting);
        let stored = stored_for(&setting.applied_to(study), sector, cache)?;
        let choice = |met, evidence| AccuracyChoice {
            accepted,
            craig_bampton_modes: stored.fixed_interface.modes,
            met,
            evidence,
            setting: ChosenSetting::Receptances(setting.clone()),
        };
        if !study.has_friction() {
            // Linear limits know none of these settings but modes and shapes.
            return Ok(choice(true, None));
        }
        let compared = Rows::compared(study, &setting, &stored, patterns, &ids)?;
        operations += compared.operations();
        let Some(amplitude) = compared.bound(Compared::Amplitude) else {
            return Ok(choice(false, None));
        };
        tried.push(TriedSetting {
            setting: setting.words(),
            rows: amplitude.rows,
            worst: amplitude.worst,
            operations: mean_operations(&compared.own),
        });
        let known = SETTLED * compared.own.len() as f64;
        let unsettled = (amplitude.rows as f64) < known;
        let met = amplitude.p95_upper <= accepted && !unsettled;
        // What does not settle settles no better by smaller tolerances: it asks for no more.
        if met || (unsettled && amplitude.worst <= accepted) || left.len() == 0 {
            let evidence = compared.evidence(&setting, amplitude, operations, tried);
            return Ok(choice(met, Some(evidence)));
        }
    }
}

/// Rows of a sample at some settings with their values at the enlarged ones, ordered by pattern, then scenario.
struct Rows {
    sample: LadderSample,
    own: Vec<LadderRow>,
    enlarged: Vec<LadderValues>,
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
            scenarios: sampled_scenarios(&in_contact(own, &solver), &remainders),
            patterns: ids.to_vec(),
        };
        let harmonics = enlarged_harmonics(study);
        let enlarged = solver_of(
            &setting.enlarged(study, &harmonics),
            &stored.enlarged(&harmonics),
        )?;
        let engine = LadderEngine::new(solver, &sample.scenarios, &Unwatched);
        let rows = engine.rows(patterns, ids);
        let tuned: Vec<Option<f64>> = sample
            .scenarios
            .par_iter()
            .zip(engine.tuned())
            .map(|(scenario, tuned)| {
                let found = (tuned.frequency_hz?, tuned.harmonics.as_str());
                let top = enlarged.top_beside(engine.solver(), None, scenario, found)?;
                setting.settled(top).map(|top| top.amplitude_m)
            })
            .collect();
        let values = rows.par_iter().map(|row| {
            let scenario = &sample.scenarios[row.scenario];
            let pattern = patterns.pattern(row.pattern, scenario.standard_deviation)?;
            let found = (row.values.frequency_hz?, row.harmonics.as_str());
            let top = enlarged.top_beside(engine.solver(), Some(&pattern), scenario, found)?;
            let top = setting.settled(top)?;
            Some(LadderValues {
                amplitude_m: Some(top.amplitude_m),
                frequency_hz: Some(top.frequency_hz),
                amplification_factor: tuned[row.scenario].map(|tuned| top.amplitude_m / tuned),
            })
        });
        Ok(Self {
            enlarged: values.map(Option::unwrap_or_default).collect(),
            own: rows,
            sample,
        })
    }

    fn bound(&self, quantity: Compared) -> Option<ErrorBound> {
        let own: Vec<LadderValues> = self.own.iter().map(|row| row.values).collect();
        error_bound(&own, &self.enlarged, quantity)
    }

    fn operations(&self) -> f64 {
        self.own.iter().map(|row| row.operations).sum()
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
            errors_of_load_cases: errors_of_load_cases(&self.own, &self.enlarged, &self.sample),
        }
    }
}

/// `study` without the loads under which contacts of a tuned wheel separate, if there are others: with every harmonic such rows seldom
/// settle, and each takes as long as all others.
fn in_contact(study: Study, solver: &RowSolver) -> Study {
    let scenarios = study.scenarios();
    let excited: Vec<&Scenario> = scenarios
        .iter()
        .filter(|own| own.contact.normal_load_n().is_some())
        .filter(|own| own.standard_deviation == scenarios[0].standard_deviation)
        .collect();
    let separates = excited.par_iter().map(|own| {
        let tuned = solver.tuned(own);
        tuned.separated_fraction.is_none_or(|share| share > 0.0)
    });
    let separates: Vec<bool> = separates.collect();
    let lost = |contact: &ContactCondition| {
        let mut own = excited.iter().zip(&separates);
        own.any(|(own, &separates)| separates && own.contact == *contact)
    };
    let mut own = study.clone();
    own.contacts.retain(|contact| !lost(contact));
    if own.has_friction() { own } else { study }
}

/// Every harmonic that the law of `study` can excite, to the highest of the comparison, and those that the study says.
fn enlarged_harmonics(study: &Study) -> Vec<u32> {
    let contact = study.contact.as_ref();
    let varies = contact.is_some_and(|contact| contact.law.has_variable_load());
    let all = (0..=ENLARGED_HARMONIC).filter(|harmonic| varies || harmonic % 2 == 1);
    let mut harmonics: Vec<u32> = all.collect();
    if let Harmonics::Set(set) = &study.solver.harmonics {
        harmonics.extend(set);
    }
    harmonics.sort_unstable();
    harmonics.dedup();
    harmonics
}

fn mean_operations(rows: &[LadderRow]) -> f64 {
    let sum: f64 = rows.iter().map(|row| row.operations).sum();
    sum / rows.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::AccuracyOptions;
    use super::*;

    /// The built-in wheel with these lines at the end of its study.
    fn study(lines: &str) -> Study {
        let text = format!(
            "schema = 1\n[study]\nname = \"a\"\nseed = 1\npatterns = 3\n[model]\nsource = \"parametric\"\n\
             [contact]\nlaw = \"simplified_3d\"\nfriction_coefficient = 0.3\ntangential_stiffness_n_per_m = 1e8\n\
             normal_stiffness_n_per_m = 1e8\n[damping]\nstructural_loss_factor = 0.01\n\
             [excitation]\nengine_orders = [2]\n[mistuning]\ndistribution = {{ kind = \"normal\" }}\n\
             [sweep]\nnormal_load_n = [10]\nstandard_deviation = [0.01]\n{lines}"
        );
        Study::parse(Path::new("study.toml"), &text).expect("a study")
    }

    fn tried(study: &Study) -> Vec<ReceptanceSetting> {
        ReceptanceSetting::tried_for(0.01, study)
    }

    #[test]
    fn a_study_without_an_accepted_error_has_the_settings_of_the_default_one() {
        let study = study("");
        let default = ReceptanceSetting {
            reduction_error: study.reduction.error,
            harmonic_tolerance: study.solver.harmonic_tolerance,
            harmonics: None,
            samples_per_period: study.solver.samples_per_period,
            peak_tolerance: study.solver.peak_tolerance,
        };
        assert_eq!(ReceptanceSetting::within(AccuracyOptions::DEFAULT), default);
        let applied = default.applied_to(&study);
        assert_eq!(applied.resolved(), study.resolved());
    }

    #[test]
    fn what_the_study_says_stays_at_every_step() {
        let free = tried(&study(""));
        assert_eq!(free.len(), 3);
        assert_eq!(free[2].samples_per_period, 256);
        assert_eq!(free[2].peak_tolerance.to_bits(), 2.5e-4_f64.to_bits());
        let coarse = tried(&study("[solver]\nsamples_per_period = 40"));
        assert!(coarse.iter().all(|own| own.samples_per_period == 40));
        let stated = study(
            "[reduction]\nerror = 3e-3\n[solver]\nharmonics = [1, 3, 5]\nharmonic_tolerance = 0.1\npeak_tolerance = 2e-4\nsamples_per_period = 64",
        );
        let [only] = tried(&stated).try_into().expect("one setting");
        assert_eq!(only.harmonics, Some(vec![1, 3, 5]));
        let numbers = [
            only.reduction_error,
            only.harmonic_tolerance,
            only.peak_tolerance,
        ];
        assert_eq!(
            numbers.map(f64::to_bits),
            [3e-3, 0.1, 2e-4].map(f64::to_bits)
        );
        let resolves = study("[solver]\nrows_beyond_tolerance = \"resolve\"");
        let own = free[0].applied_to(&resolves).solver.rows_beyond_tolerance;
        assert_eq!(own, RowsBeyondTolerance::Resolve);
    }

    #[test]
    fn rows_are_held_against_more_harmonics_and_samples_than_they_have() {
        let study = study("[solver]\nharmonics = [1, 3, 21]");
        let setting = tried(&study).remove(0);
        let enlarged = setting.enlarged(&study, &enlarged_harmonics(&study));
        let all = Harmonics::Set((0..=15).chain([21]).collect());
        assert_eq!(enlarged.solver.harmonics, all);
        assert_eq!(enlarged.solver.samples_per_period, 256);
    }
}
