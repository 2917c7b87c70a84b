//! An engine whose rows are a formula, so that everything around the physics can be tested alone.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use blisk::model::sector::SectorModel;
use blisk::population::monte_carlo::{CurveSettings, ResponseRow, Scenario, TunedReference};
use blisk::population::table::CurvePoint;
use blisk::report::ModelReport;
use blisk::response::forced_response::{ResponseTrace, SearchPlan};
use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::{Deviations, Pattern};
use blisk::settings::{Engine, EngineSource};
use blisk::study::{PipelineError, Study};
use blisk::verification::time_integration::{PointComparison, TimeOptions};
use serde_json::{Value, json};

/// Counts the patterns it solves and panics in pattern `panics_in`.
#[derive(Debug, Default)]
pub struct MockSource {
    /// Calls of [`Engine::rows`] so far.
    pub solved: std::sync::Arc<AtomicU64>,
    /// Pattern in which it panics.
    pub panics_in: Option<u32>,
    /// What its rows are made from.
    pub model: String,
}

struct MockEngine {
    solved: std::sync::Arc<AtomicU64>,
    panics_in: Option<u32>,
    model: String,
}

impl EngineSource for MockSource {
    fn build(
        &self,
        _study: &Study,
        _model: &SectorModel,
        _cache: Option<&Path>,
    ) -> Result<Box<dyn Engine>, PipelineError> {
        Ok(Box::new(MockEngine {
            solved: self.solved.clone(),
            panics_in: self.panics_in,
            model: self.model.clone(),
        }))
    }
}

impl Engine for MockEngine {
    fn model_report(&self) -> ModelReport {
        unreachable!("no test asks for it")
    }

    fn reduction_facts(&self) -> Value {
        json!({ "rank": 6 })
    }

    fn chosen_settings(&self) -> Value {
        json!({ "harmonics": [1] })
    }

    fn rows_made_from(&self, _scenario: &Scenario) -> String {
        self.model.clone()
    }

    fn tuned(&self, scenario: &Scenario) -> TunedReference {
        TunedReference {
            scenario: scenario.index,
            status: Status::Ok,
            amplitude_m: Some(1e-4 * f64::from(scenario.engine_order)),
            frequency_hz: Some(500.0),
            separated_fraction: None,
            slipping_fraction: None,
            harmonics: "1".to_owned(),
            errors: None,
        }
    }

    /// The amplitude grows with the largest deviation; every 97th pattern fails.
    fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        self.solved.fetch_add(1, Ordering::SeqCst);
        assert!(self.panics_in != Some(pattern.id), "a defect on purpose");
        let Deviations::PerBlade(values) = &pattern.deviations else {
            unreachable!("the studies here have no modes");
        };
        let sum: f64 = values.iter().map(|value| value.sin()).sum();
        scenarios
            .iter()
            .map(|(scenario, tuned)| {
                let good = pattern.id % 97 != 96;
                let amplitude = tuned.amplitude_m.map(|tuned| tuned * (1.0 + sum.abs()));
                let status = if good { Status::Ok } else { Status::Stagnated };
                ResponseRow {
                    peak_amplitude_m: amplitude.filter(|_| good),
                    peak_frequency_hz: good.then_some(500.0),
                    peak_blade: good.then_some(pattern.id % 24),
                    amplification_factor: good.then_some(1.0 + sum.abs()),
                    peak_bracketed: good.then_some(true),
                    harmonics: "1".to_owned(),
                    newton_iterations: 7,
                    factorisations: 2,
                    basis: "whole space".to_owned(),
                    ..ResponseRow::without_result(scenario.index, pattern.id, status)
                }
            })
            .collect()
    }

    fn search_plan(
        &self,
        _scenario: &Scenario,
        _pattern: &Pattern,
        _tuned_hz: Option<f64>,
    ) -> Result<SearchPlan, Status> {
        unreachable!("no test asks for it")
    }

    fn curve(
        &self,
        _scenario: &Scenario,
        _pattern: Option<&Pattern>,
        _frequencies_hz: &[f64],
        _settings: CurveSettings,
    ) -> Vec<CurvePoint> {
        Vec::new()
    }

    fn traces(
        &self,
        _scenario: &Scenario,
        _pattern: Option<&Pattern>,
        _frequencies_hz: &[f64],
    ) -> Result<[ResponseTrace; 2], Status> {
        Err(Status::InvalidPattern)
    }

    fn compare_in_time(
        &self,
        _pattern: &Pattern,
        _scenario: &Scenario,
        _row: &ResponseRow,
        _options: &TimeOptions,
    ) -> Result<PointComparison, Status> {
        unreachable!("no test asks for it")
    }
}

/// A study of the lumped chain of blades with two engine orders and two standard deviations.
pub fn study(patterns: u32, edit: impl Fn(String) -> String) -> Study {
    Study::parse(Path::new("chain.toml"), &edit(study_text(patterns))).expect("a valid study")
}

/// Its file.
pub fn study_text(patterns: u32) -> String {
    format!(
        "schema = 1
[study]
name = \"chain\"
seed = 7
patterns = {patterns}
[model]
source = \"lumped\"
[model.lumped]
sectors = 24
blade_mass_kg = 0.0114
blade_stiffness_n_per_m = 430000.0
blade_coupling_stiffness_n_per_m = 45430.0
[damping]
structural_loss_factor = 0.01
[excitation]
engine_orders = [3, 5]
[mistuning]
distribution = {{ kind = \"normal\" }}
[sweep]
normal_load_n = [\"free\"]
standard_deviation = [0.03, 0.01]
"
    )
}
