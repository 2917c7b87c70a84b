//! The seam between a study and the solution of one row: all that the pipeline asks of the physics.

use std::path::Path;

use serde_json::Value;

use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{
    CurveSettings, LoadCaseSolvers, ResponseRow, Scenario, SurrogatePeak, TunedReference,
};
use crate::population::table::CurvePoint;
use crate::report::ModelReport;
use crate::response::forced_response::{ResponseTrace, SearchPlan};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;
use crate::settings::progress::Progress;
use crate::study::{PipelineError, Study};
use crate::verification::time_integration::{PointComparison, TimeOptions};

/// Approximate peak of a pattern.
pub type SurrogateOf<'a> = Box<dyn Fn(&Pattern) -> Option<SurrogatePeak> + Send + Sync + 'a>;

/// A reduced model with the settings of a study, ready to be solved; shared between threads.
pub trait Engine: Send + Sync {
    /// Sizes, frequencies, rank and condition of the reduced model.
    fn model_report(&self) -> ModelReport;

    /// Facts about the reduction for the manifest; the same on every machine.
    fn reduction_facts(&self) -> Value;

    /// Settings chosen where the study says `auto`.
    fn chosen_settings(&self) -> Value;

    /// Digest of all that the rows of a scenario depend on beside the study's keys: the reduced model
    /// and the settings chosen for the scenario. Stored rows are used again where it is the same.
    fn rows_made_from(&self, _scenario: &Scenario) -> String {
        String::new()
    }

    /// Peak of the tuned wheel.
    fn tuned(&self, scenario: &Scenario) -> TunedReference;

    /// Rows of one pattern under scenarios of the same standard deviation, in their order.
    ///
    /// What a pattern costs once (its projected stiffness, its modes) is paid once here.
    fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow>;

    /// The approximate peak amplitude, m, of any pattern under a scenario: cheap, for ranking
    /// alone; none where there is no such thing.
    fn surrogate<'a>(
        &'a self,
        _scenario: &Scenario,
        _tuned: &TunedReference,
    ) -> Option<SurrogateOf<'a>> {
        None
    }

    /// Where the linear limits of a row say that its peak can lie. `tuned_hz` is the frequency of
    /// the tuned peak.
    ///
    /// # Errors
    /// The pattern cannot be applied, or nothing answers the excitation.
    fn search_plan(
        &self,
        scenario: &Scenario,
        pattern: &Pattern,
        tuned_hz: Option<f64>,
    ) -> Result<SearchPlan, Status>;

    /// Amplitude of every blade at each frequency, ordered by frequency, then blade; no pattern
    /// means the tuned wheel.
    fn curve(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
        settings: CurveSettings,
    ) -> Vec<CurvePoint>;

    /// The curve followed by continuation between the first and the last frequency, upwards and
    /// downwards.
    ///
    /// # Errors
    /// The status of a pattern that cannot be applied.
    fn traces(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<[ResponseTrace; 2], Status>;

    /// The solvers of the rows, for looking into single ones; none where there is no such thing.
    fn solvers(&self) -> Option<&LoadCaseSolvers> {
        None
    }

    /// The point of a delivered row, its pattern at its peak frequency, by harmonic balance and by
    /// time integration.
    ///
    /// # Errors
    /// The status of the harmonic balance where it has no solution to start from.
    fn compare_in_time(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
        options: &TimeOptions,
    ) -> Result<PointComparison, Status>;
}

/// Maker of engines.
pub trait EngineSource: Sync {
    /// Reduces `model` for `study`, or takes the reduced model from the folder `cache`.
    ///
    /// # Errors
    /// The model cannot be reduced, or the cache not be read or written.
    fn build(
        &self,
        study: &Study,
        model: &SectorModel,
        cache: Option<&Path>,
    ) -> Result<Box<dyn Engine>, PipelineError>;

    /// The same engine; `progress` is told what the reduction is at.
    ///
    /// # Errors
    /// As [`Self::build`].
    fn build_watched(
        &self,
        study: &Study,
        model: &SectorModel,
        cache: Option<&Path>,
        _progress: &dyn Progress,
    ) -> Result<Box<dyn Engine>, PipelineError> {
        self.build(study, model, cache)
    }
}
