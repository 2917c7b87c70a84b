//! The engine of the program: a sector model reduced for a study, cached, and ready to be solved.

use std::path::Path;

use serde_json::{Value, json};

use super::accurate_engine::accurate_engine;
use super::{Engine, EngineSource, SurrogateOf};
use crate::model::reduction::Basis;
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{
    CurveResult, CurveSettings, LoadCaseName, LoadCaseSolver, LoadCaseSolvers, ResponseRow,
    RowSolver, Scenario, Surrogate, TunedReference, compare_in_time,
};
use crate::population::table::CurvePoint;
use crate::report::{BasisSummary, ModelReport, NodalDiameterFacts};
use crate::response::forced_response::{ResponseTrace, SearchPlan};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::Pattern;
use crate::settings::SHAPES_BETWEEN;
use crate::settings::basis_choice::BasisEvidence;
use crate::settings::fixed_interface::FixedInterface;
use crate::settings::progress::Progress;
use crate::settings::reduced_study::{models_digest, solver_of, stored_digest, stored_for};
use crate::study::{PipelineError, Study};
use crate::verification::time_integration::{PointComparison, TimeOptions};

/// Reduces a model for a study with the basis that the study asks for.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReducedEngineSource;

/// A reduced model with the settings of a study.
struct ReducedEngine {
    solver: LoadCaseSolvers,
    evidence: BasisEvidence,
    fixed_interface: FixedInterface,
    /// Names of the load cases; one absent name where there are none.
    load_cases: Vec<Option<LoadCaseName>>,
    /// Whether the study says how many fixed-interface modes there are.
    fixed_modes: bool,
    wanted_error: f64,
    /// Whether the study names a basis whose place the receptances take.
    is_replaced: bool,
    digest: String,
    /// What the model leaves out of peaks under linear limits, on tuned receptances.
    linear_limit_error: Option<f64>,
    /// Digest of the models that rows are solved on; on a basis with its error.
    models: String,
    sector_dofs: usize,
    observed: Vec<String>,
}

impl EngineSource for ReducedEngineSource {
    fn build(
        &self,
        study: &Study,
        model: &SectorModel,
        cache: Option<&Path>,
    ) -> Result<Box<dyn Engine>, PipelineError> {
        self.build_watched(study, model, cache, &())
    }

    fn build_watched(
        &self,
        study: &Study,
        model: &SectorModel,
        cache: Option<&Path>,
        progress: &dyn Progress,
    ) -> Result<Box<dyn Engine>, PipelineError> {
        if let Some(accuracy) = study.accuracy {
            return accurate_engine(study, accuracy, self, (model, cache), progress);
        }
        let digest = stored_digest(study, model)?;
        let stored = stored_for(study, model, cache, progress)?;
        progress.step("receptances and harmonics of the rows");
        Ok(Box::new(ReducedEngine {
            evidence: stored.evidence.clone(),
            fixed_interface: stored.fixed_interface.clone(),
            linear_limit_error: stored.of_limits,
            models: models_digest(study, &stored),
            load_cases: study
                .excited_orders()
                .into_iter()
                .map(|case| case.0)
                .collect(),
            fixed_modes: study.reduction.craig_bampton_modes.is_some(),
            solver: solver_of(study, &stored)?,
            wanted_error: study.reduction.error,
            is_replaced: stored.is_on_receptances()
                && study.reduction.basis == Basis::StickAttachment,
            digest,
            sector_dofs: model.dofs.len(),
            observed: model
                .observed
                .iter()
                .map(|node| node.name.clone())
                .collect(),
        }))
    }
}

impl ReducedEngine {
    /// The solver of the first load case, whose model is that of all.
    fn rows(&self) -> &RowSolver {
        self.solver.first().rows()
    }

    /// The points of a curve, blade after blade.
    fn points_of(&self, curve: Vec<CurveResult>) -> Vec<CurvePoint> {
        let sectors = self.rows().basis().model().sectors as u32;
        let points = curve.into_iter().flat_map(|(frequency_hz, amplitudes)| {
            (0..sectors).map(move |blade| CurvePoint {
                frequency_hz,
                blade,
                amplitude_m: amplitudes.as_ref().ok().map(|all| all[blade as usize]),
                status: amplitudes.as_ref().err().copied().unwrap_or(Status::Ok),
            })
        });
        points.collect()
    }
}

impl Engine for ReducedEngine {
    fn model_report(&self) -> ModelReport {
        let model = self.rows().basis().model();
        let basis = if self.evidence.whole_space {
            "whole space".to_owned()
        } else {
            self.rows().rows_on()
        };
        let taken = self.evidence.tried.last();
        let error = taken.and_then(|taken| taken.error);
        let craig_bampton_reach = self.evidence.craig_bampton_reach;
        let summary = BasisSummary {
            name: basis.clone(),
            tuned_peak_error: error,
            craig_bampton_reach,
            craig_bampton_error: self.fixed_interface.error.filter(|_| self.fixed_modes),
            wanted_error: self.wanted_error,
            wanted_peak_error: if self.linear_limit_error.is_some() {
                SHAPES_BETWEEN * self.wanted_error
            } else {
                self.wanted_error
            },
            is_replaced: self.is_replaced,
        };
        ModelReport {
            name: model.name.clone(),
            sectors: model.sectors,
            sector_dofs: self.sector_dofs,
            contact_pairs: model.contact.weights.len(),
            observed: self.observed.clone(),
            basis,
            reduced_coordinates: self.rows().basis().size(),
            error,
            craig_bampton_modes: self.fixed_interface.modes,
            craig_bampton_error: self.fixed_interface.error,
            craig_bampton_reach,
            rotation: None,
            warnings: summary.warnings(),
            memory_bytes: model.memory_bytes(),
            digest: self.digest.clone(),
            nodal_diameters: model
                .report
                .iter()
                .map(|line| NodalDiameterFacts {
                    nodal_diameter: line.nodal_diameter,
                    dofs: line.craig_bampton_size,
                    candidates: line.candidates,
                    rank: line.rank,
                    condition: line.condition,
                    stick_frequencies_hz: line.stick_frequencies_hz.clone(),
                    slide_frequencies_hz: line.slide_frequencies_hz.clone(),
                })
                .collect(),
        }
    }

    fn reduction_facts(&self) -> Value {
        json!({
            "digest": self.digest,
            "basis": self.rows().rows_on(),
            "whole_space": self.evidence.whole_space,
            "reduced_coordinates": self.rows().basis().size(),
            "tuned_peak_errors": self.evidence.tried,
            "craig_bampton_modes": self.fixed_interface.modes,
            "craig_bampton_error": self.fixed_interface.error,
            "craig_bampton_modes_tried": self.fixed_interface.tried,
            "craig_bampton_reach": self.evidence.craig_bampton_reach,
            "linear_limit_error": self.linear_limit_error,
        })
    }

    fn chosen_settings(&self) -> Value {
        let sets = |of: &dyn Fn(&LoadCaseSolver) -> Vec<Value>| -> Vec<Value> {
            let solvers = self.load_cases.iter().zip(self.solver.all());
            let named = solvers.flat_map(|(name, solver)| {
                let sets = of(solver).into_iter();
                sets.map(move |mut set| {
                    if let Some(name) = name {
                        set["load_case"] = json!(name);
                    }
                    set
                })
            });
            named.collect()
        };
        let choices = |solver: &RowSolver| -> Vec<Value> {
            let choices = solver.choices().map(|choice| json!(choice));
            choices.collect()
        };
        json!({
            "basis": self.rows().rows_on(),
            "harmonics": sets(&|solver| choices(solver.rows())),
            "beyond": self.solver.first().fallbacks().next().map(|beyond| json!({
                "basis": beyond.basis().model().basis_name(),
                "harmonics": sets(&|solver| solver.fallbacks().flat_map(choices).collect()),
            })),
        })
    }

    fn rows_made_from(&self, scenario: &Scenario) -> String {
        let of_case = self.solver.under(scenario);
        let of = |solver: &RowSolver| -> Vec<String> {
            solver
                .choices()
                .filter(|choice| {
                    choice.engine_order == scenario.engine_order
                        && choice.contact == scenario.contact
                })
                .map(|choice| format!("{choice:?}"))
                .collect()
        };
        let fallbacks: Vec<_> = of_case.fallbacks().map(of).collect();
        let is_limit = scenario.contact.normal_load_n().is_none();
        let of_limit = is_limit.then(|| of_case.rows().model_error(scenario));
        format!(
            "{} {:?} {fallbacks:?} {of_limit:?}",
            self.models,
            of(of_case.rows())
        )
    }

    fn tuned(&self, scenario: &Scenario) -> TunedReference {
        self.solver.tuned(scenario)
    }

    fn rows(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        self.solver.rows(pattern, scenarios)
    }

    fn surrogate<'a>(
        &'a self,
        scenario: &Scenario,
        tuned: &TunedReference,
    ) -> Option<SurrogateOf<'a>> {
        let solver = self.solver.under(scenario).rows();
        let surrogate = Surrogate::new(solver, scenario, tuned)?;
        Some(Box::new(move |pattern| surrogate.peak(pattern)))
    }

    fn solvers(&self) -> Option<&LoadCaseSolvers> {
        Some(&self.solver)
    }

    fn search_plan(
        &self,
        scenario: &Scenario,
        pattern: &Pattern,
        tuned_hz: Option<f64>,
    ) -> Result<SearchPlan, Status> {
        let solver = self.solver.under(scenario).rows();
        solver.search_plan(scenario, Some(pattern), tuned_hz)
    }

    fn curve(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
        settings: CurveSettings,
    ) -> Vec<CurvePoint> {
        let solver = self.solver.under(scenario);
        self.points_of(solver.curve(scenario, pattern, frequencies_hz, settings))
    }

    fn traces(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        frequencies_hz: &[f64],
    ) -> Result<[ResponseTrace; 2], Status> {
        self.solver.under(scenario).rows().traces(
            scenario.engine_order,
            scenario.contact,
            pattern,
            frequencies_hz,
        )
    }

    fn compare_in_time(
        &self,
        pattern: &Pattern,
        scenario: &Scenario,
        row: &ResponseRow,
        options: &TimeOptions,
    ) -> Result<PointComparison, Status> {
        compare_in_time(&self.solver, pattern, scenario, row, options)
    }
}
