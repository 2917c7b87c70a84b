//! A study on the full-contact model: every contact dof of the whole wheel, at a high price per row.

use std::sync::Arc;

use super::fixed_interface::reduction_of;
use super::harmonics_on_basis::choose_harmonics;
use super::reduced_study::is_on_receptances;
use super::row_settings::{reference_settings, row_settings};
use crate::model::ReducedModel;
use crate::model::reduction::BasisChoice;
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{LoadCaseName, RowSettings, RowSolver, Scenario};
use crate::population::table::CurvePoint;
use crate::response::forced_response::{FrequencyBand, Harmonics};
use crate::response::friction::ContactLaw;
use crate::response::harmonic_balance::{EnlargedSet, HarmonicTransform, Status, TransformError};
use crate::response::mistuning::Pattern;
use crate::study::{PipelineError, Study, excitations};
use crate::verification::reference::{
    ReferencePeak, ReferenceSettings, ReferenceSolver, reference_peak,
};

/// Modes of either kind of the small model whose linear resonances bound the search for a peak.
const SCOUT_MODES: usize = 6;

/// The Craig-Bampton model with every contact dof, and the settings of a study.
pub struct FullModel {
    /// Under each force vector of the study.
    cases: Vec<FullCase>,
    /// Settings of the rows, but for the amplitude of the force.
    row: RowSettings,
    samples_per_period: usize,
    /// Whether the harmonics are those that the tuned wheel chooses: no set was asked for, and rows have not all harmonics.
    automatic: bool,
}

/// The model under one force vector.
struct FullCase {
    name: Option<LoadCaseName>,
    model: Arc<ReducedModel>,
    amplitude_n: f64,
    /// Says where the linear limits of a row resonate; no nonlinear solution is taken from it.
    scout: RowSolver,
}

/// Temporal harmonics and samples of a solution on the full-contact model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FullSettings {
    /// Harmonic set, ascending, with 1; none = that of the study.
    pub harmonics: Option<Vec<u32>>,
    /// Samples per period; at least those of the study.
    pub samples_per_period: usize,
}

impl Default for FullSettings {
    fn default() -> Self {
        Self {
            harmonics: None,
            samples_per_period: ReferenceSettings::SAMPLES_PER_PERIOD,
        }
    }
}

/// What is to be solved on the full-contact model, and what is known of it beforehand.
#[derive(Debug, Clone, Copy)]
pub struct FullRow<'a> {
    /// Scenario.
    pub scenario: &'a Scenario,
    /// Pattern; none for the tuned wheel.
    pub pattern: Option<&'a Pattern>,
    /// Settings, see [`FullModel::settings`].
    pub settings: &'a ReferenceSettings,
    /// Frequency of the tuned peak, Hz.
    pub tuned_hz: Option<f64>,
    /// Where the fast path found the peak, Hz: one of the first frequencies tried.
    pub expected_hz: Option<f64>,
}

impl FullModel {
    /// The full-contact model of `study`.
    ///
    /// # Errors
    /// The model cannot be reduced, or the samples cannot tell the harmonics apart.
    pub fn build(
        study: &Study,
        sector: &SectorModel,
        options: &FullSettings,
    ) -> Result<Self, PipelineError> {
        let reduction = reduction_of(study, sector)?;
        let cantilever = study.mistuning.cantilever_mode_count;
        let mut settings = row_settings(study);
        let mut automatic = study.solver.harmonics == Harmonics::Auto;
        if let Some(harmonics) = &options.harmonics {
            settings.harmonics.clone_from(harmonics);
            automatic = false;
        } else if automatic && is_on_receptances(study, sector) {
            let law = study.contact.as_ref().map(|contact| contact.law);
            settings.harmonics =
                EnlargedSet::everything(law.is_some_and(ContactLaw::has_variable_load));
            automatic = false;
        }
        let scout = BasisChoice::StickSlide {
            stick: SCOUT_MODES,
            slide: SCOUT_MODES,
        };
        let whole = reduction.reduce(BasisChoice::CraigBampton, cantilever)?;
        let scout = reduction.reduce(scout, cantilever)?;
        let cases = excitations(study).into_iter().map(|case| {
            let amplitude_n = case.study.amplitude_n;
            let settings = RowSettings {
                amplitude_n,
                ..settings.clone()
            };
            Ok(FullCase {
                name: case.name,
                model: Arc::new(case.of(&whole)),
                amplitude_n,
                scout: RowSolver::new(Arc::new(case.of(&scout)), settings)?,
            })
        });
        let full = Self {
            cases: cases.collect::<Result<_, PipelineError>>()?,
            samples_per_period: options.samples_per_period,
            automatic,
            row: settings,
        };
        full.settings(&full.row.harmonics)?;
        Ok(full)
    }

    /// The force vector of a scenario, or the first.
    fn case(&self, scenario: &Scenario) -> &FullCase {
        let of = |case: &&FullCase| case.name == scenario.load_case;
        self.cases.iter().find(of).unwrap_or(&self.cases[0])
    }

    /// Harmonic set under the excitation and contact condition of a scenario: the one asked for, else that of the
    /// study. An automatic set is the one that a run of the study begins with: all harmonics on tuned receptances, else the choice of the
    /// tuned wheel.
    ///
    /// # Errors
    /// The samples per period of the study cannot tell the harmonics apart.
    pub fn harmonics(&self, scenario: &Scenario) -> Result<Vec<u32>, PipelineError> {
        let given = &self.row.harmonics;
        if !self.automatic {
            return Ok(given.clone());
        }
        let case = self.case(scenario);
        let row = RowSettings {
            amplitude_n: case.amplitude_n,
            ..self.row.clone()
        };
        let chosen = choose_harmonics(
            &case.model,
            &row,
            &[scenario.engine_order],
            &[scenario.contact],
            given,
            Some(self.row.solver.harmonic_tolerance),
        )?;
        // A linear limit has the fundamental alone, and nothing is chosen there.
        Ok(chosen
            .into_iter()
            .next()
            .map_or_else(|| given.clone(), |choice| choice.harmonics))
    }

    /// Number of complex coordinates of the wheel.
    #[must_use]
    pub fn size(&self) -> usize {
        self.cases[0].model.wheel_size()
    }

    /// Samples per period.
    #[must_use]
    pub fn samples_per_period(&self) -> usize {
        self.samples_per_period
    }

    /// Peak of one row, or of the tuned wheel.
    #[must_use]
    pub fn peak(&self, row: FullRow<'_>) -> ReferencePeak {
        let plan =
            self.case(row.scenario)
                .scout
                .search_plan(row.scenario, row.pattern, row.tuned_hz);
        let solver = self.solver(row.scenario, row.pattern, row.settings);
        match (plan, solver) {
            (Ok(plan), Ok(mut solver)) => {
                // A frequency that the fast path found outside of a fixed band is none of ours.
                let inside = |f: &f64| match self.row.solver.frequency_band {
                    FrequencyBand::Fixed { start_hz, stop_hz } => *f >= start_hz && *f <= stop_hz,
                    FrequencyBand::Auto => true,
                };
                let expected = row.expected_hz.filter(inside);
                reference_peak(&mut solver, &plan, expected)
            }
            (Err(status), _) | (_, Err(status)) => ReferencePeak::failed(status),
        }
    }

    /// Amplitude of every blade at each frequency, ordered by frequency, then blade; no pattern means
    /// the tuned wheel.
    #[must_use]
    pub fn curve(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        settings: &ReferenceSettings,
        frequencies_hz: &[f64],
    ) -> Vec<CurvePoint> {
        let sectors = self.cases[0].model.sectors as u32;
        let mut solver = self.solver(scenario, pattern, settings);
        let mut points = Vec::new();
        for &frequency_hz in frequencies_hz {
            let solved = match &mut solver {
                Ok(solver) => solver
                    .solve(frequency_hz)
                    .map(|point| point.amplitudes_m.clone()),
                Err(status) => Err(*status),
            };
            points.extend((0..sectors).map(|blade| CurvePoint {
                frequency_hz,
                blade,
                amplitude_m: match solved.as_deref() {
                    Ok([one]) => Some(*one),
                    Ok(all) => Some(all[blade as usize]),
                    Err(_) => None,
                },
                status: solved.as_ref().err().copied().unwrap_or(Status::Ok),
            }));
        }
        points
    }

    /// Settings of the study with a harmonic set of its own.
    ///
    /// # Errors
    /// The samples per period cannot tell the harmonics apart.
    pub fn settings(&self, harmonics: &[u32]) -> Result<ReferenceSettings, TransformError> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let transform = HarmonicTransform::new(&set, self.samples_per_period)?;
        Ok(reference_settings(&self.row, transform))
    }

    fn solver(
        &self,
        scenario: &Scenario,
        pattern: Option<&Pattern>,
        settings: &ReferenceSettings,
    ) -> Result<ReferenceSolver, Status> {
        let Scenario {
            engine_order,
            contact,
            ..
        } = *scenario;
        let case = self.case(scenario);
        let settings = ReferenceSettings {
            amplitude_n: case.amplitude_n,
            ..settings.clone()
        };
        ReferenceSolver::new(&case.model, &settings, engine_order, contact, pattern)
    }
}
