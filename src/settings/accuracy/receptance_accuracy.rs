//! Settings on tuned receptances by an accepted error, held against enlarged ones on mistuned wheels.
//!
//! Every tolerance of the engine is a fixed share of the accepted error. Rows of the study at these settings are compared with the
//! same rows in harmonics up to 15, with twice the blade shapes and twice the samples, each climbed from its own peak. Where the
//! upper bound of the 95th percentile of their errors is not accepted, the tolerance of the peak is halved; where that does not do
//! either, halved once more, with twice the samples. What the study says itself stays. Modes and shapes stay too: their error
//! was measured when they were chosen.

use std::path::Path;

use rayon::prelude::*;

use super::receptance_setting::enlarged_harmonics;
use super::{AccuracyChoice, AccuracyEvidence, ReceptanceSetting, TriedSetting};
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{LoadCaseSolvers, Scenario};
use crate::population::statistics::ErrorBound;
use crate::response::forced_response::ContactCondition;
use crate::response::mistuning::PatternSource;
use crate::settings::ladder::{
    Compared, LadderEngine, LadderRow, LadderSample, LadderValues, Remainders, error_bound,
    errors_of_load_cases, sampled_scenarios,
};
use crate::settings::reduced_study::{Stored, solver_of, stored_for};
use crate::study::{PipelineError, Study};

/// Share of the rows whose values at the enlarged settings are known, at least.
const SETTLED: f64 = 0.5;

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
        let stored = stored_for(&setting.applied_to(study), sector, cache, &())?;
        let choice = |met, evidence| AccuracyChoice {
            accepted,
            craig_bampton_modes: stored.fixed_interface.modes,
            met,
            evidence,
            setting: setting.clone(),
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
        let applied = setting.applied_to(study);
        let solver = solver_of(&applied, stored)?;
        let load_cases = applied.excited_orders().into_iter().map(|case| case.0);
        let choices = solver
            .all()
            .map(|of_case| of_case.rows().choices().cloned());
        let remainders: Vec<Remainders> = load_cases
            .zip(choices.map(Iterator::collect::<Vec<_>>))
            .collect();
        let sample = LadderSample {
            scenarios: sampled_scenarios(&in_contact(applied, &solver), &remainders),
            patterns: ids.to_vec(),
        };
        let harmonics = enlarged_harmonics(study);
        let enlarged = solver_of(
            &setting.enlarged(study, &harmonics),
            &stored.enlarged(&harmonics),
        )?;
        let engine = LadderEngine::new(solver, &sample.scenarios, &());
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
        let values: Vec<LadderValues> = self.own.iter().map(|row| row.values).collect();
        error_bound(&values, &self.enlarged, quantity)
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
fn in_contact(study: Study, solver: &LoadCaseSolvers) -> Study {
    let scenarios = study.scenarios();
    let excited: Vec<&Scenario> = scenarios
        .iter()
        .filter(|scenario| scenario.contact.normal_load_n().is_some())
        .filter(|scenario| scenario.standard_deviation == scenarios[0].standard_deviation)
        .collect();
    let separates = excited.par_iter().map(|scenario| {
        let tuned = solver.tuned(scenario);
        tuned.separated_fraction.is_none_or(|share| share > 0.0)
    });
    let separates: Vec<bool> = separates.collect();
    let lost = |contact: &ContactCondition| {
        let mut separations = excited.iter().zip(&separates);
        separations.any(|(scenario, &separates)| separates && scenario.contact == *contact)
    };
    let mut loaded = study.clone();
    loaded.contacts.retain(|contact| !lost(contact));
    if loaded.has_friction() { loaded } else { study }
}

fn mean_operations(rows: &[LadderRow]) -> f64 {
    let sum: f64 = rows.iter().map(|row| row.operations).sum();
    sum / rows.len().max(1) as f64
}
