//! The engine of a study with `[accuracy]`: that of the study at the settings chosen.

use std::path::Path;

use serde_json::Value;

use super::{Engine, EngineSource, SurrogateOf};
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{
    CurveSettings, LoadCaseSolvers, ResponseRow, Scenario, TunedReference,
};
use crate::population::table::CurvePoint;
use crate::report::ModelReport;
use crate::response::forced_response::{ResponseTrace, SearchPlan};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;
use crate::settings::accuracy::AccuracyChoice;
use crate::settings::progress::Progress;
use crate::study::{AccuracyOptions, PipelineError, Study};
use crate::verification::time_integration::{PointComparison, TimeOptions};

/// An engine with the choice that made it.
struct AccurateEngine {
    engine: Box<dyn Engine>,
    choice: AccuracyChoice,
}

/// Chooses settings for `accuracy`, or takes them from `cache`, and lets `source` build the engine with them.
///
/// # Errors
/// The model cannot be reduced, or the cache not be read or written.
pub(super) fn accurate_engine(
    study: &Study,
    accuracy: AccuracyOptions,
    source: &dyn EngineSource,
    (model, cache): (&SectorModel, Option<&Path>),
    progress: &dyn Progress,
) -> Result<Box<dyn Engine>, PipelineError> {
    progress.step("choosing settings for the accepted error of [accuracy]");
    let choice = AccuracyChoice::of(study, accuracy, model, cache)?;
    let engine = source.build_watched(&choice.applied_to(study), model, cache, progress)?;
    Ok(Box::new(AccurateEngine { engine, choice }))
}

impl Engine for AccurateEngine {
    fn model_report(&self) -> ModelReport {
        self.engine.model_report()
    }

    fn reduction_facts(&self) -> Value {
        self.engine.reduction_facts()
    }

    fn chosen_settings(&self) -> Value {
        let mut chosen = self.engine.chosen_settings();
        chosen["accuracy"] = self.choice.facts();
        chosen
    }

    fn rows_made_from(&self, scenario: &Scenario) -> String {
        let engine = self.engine.rows_made_from(scenario);
        format!("{engine} {:?}", self.choice.setting)
    }

    fn tuned(&self, scenario: &Scenario) -> TunedReference {
        self.engine.tuned(scenario)
    }

    fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        self.engine.rows(pattern, scenarios)
    }

    fn surrogate<'a>(
        &'a self,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Option<SurrogateOf<'a>> {
        self.engine.surrogate(scenario, tuned)
    }

    fn solvers(&self) -> Option<&LoadCaseSolvers> {
        self.engine.solvers()
    }

    fn search_plan(
        &self,
        scenario: &Scenario,
        pattern: &Pattern,
        tuned_hz: Option<f64>,
    ) -> Result<SearchPlan, Status> {
        self.engine.search_plan(scenario, pattern, tuned_hz)
    }

    fn curve(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
        settings: CurveSettings,
    ) -> Vec<CurvePoint> {
        self.engine
            .curve(scenario, pattern, frequencies_hz, settings)
    }

    fn traces(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<[ResponseTrace; 2], Status> {
        self.engine.traces(scenario, pattern, frequencies_hz)
    }

    fn compare_in_time(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
        options: &TimeOptions,
    ) -> Result<PointComparison, Status> {
        self.engine.compare_in_time(pattern, scenario, row, options)
    }
}
