//! Solves the rows of a sample at any setting of the ladder: one reduction, many small models.
//!
//! A row here is the row that a run of the study at that setting delivers, bit for bit; only what does
//! not touch its amplitude (the measured error of the basis, which goes into its stated error) is left
//! out.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use rayon::prelude::*;

use super::sample::{LadderSample, Remainders, distinct, of_sample, sampled_scenarios};
use super::setting::LadderSpace;
use super::{HarmonicLevel, LadderSetting};
use crate::model::ReducedModel;
use crate::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use crate::model::sector::SectorModel;
use crate::platform::thread_processor_time_s;
use crate::population::monte_carlo::{
    LoadCaseSolver, LoadCaseSolvers, ResponseRow, RowSolver, RowWork, Scenario, SystemSize,
    TunedReference,
};
use crate::response::forced_response::Harmonics;
use crate::response::friction::ContactLaw;
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{Pattern, PatternSource};
use crate::settings::Progress;
use crate::settings::basis_choice::judged_conditions;
use crate::settings::fixed_interface::{FixedInterface, reduce_sector, sensitivity_vectors};
use crate::settings::harmonics_on_basis::{choose_harmonics, with_separation};
use crate::settings::receptances_of_basis::on_receptances_of_basis;
use crate::settings::row_settings::{contact_stiffness, row_settings};
use crate::study::{Excitation, PipelineError, Study, excitations, solver_under};

/// Largest relative change of a tuned peak by more fixed-interface modes.
const FIXED_INTERFACE_ERROR: f64 = 1e-3;

/// What a row of the sample came to at one setting; values are none where it failed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LadderValues {
    /// Peak amplitude, m.
    pub amplitude_m: Option<f64>,
    /// Frequency of the peak, Hz.
    pub frequency_hz: Option<f64>,
    /// Amplification factor.
    pub amplification_factor: Option<f64>,
}

/// One row of the sample at one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct LadderRow {
    /// Place of the scenario in the sample.
    pub scenario: usize,
    /// Pattern id.
    pub pattern: u32,
    /// How the solution ended.
    pub status: Status,
    /// Harmonic set, like `"1-3"`.
    pub harmonics: String,
    /// Results.
    pub values: LadderValues,
    /// Work counts.
    pub work: RowWork,
    /// Estimated floating-point operations.
    pub operations: f64,
    /// Processor time, s; that of the pattern shared out evenly over its scenarios.
    pub cpu_s: f64,
}

/// A sector model reduced once for all settings.
pub struct LadderBench<'a> {
    study: Study,
    sector: &'a SectorModel,
    sample: LadderSample,
    /// One reduction for each set of linear contact springs; that of the study first.
    reductions: Vec<(ContactStiffness, Reduction<'a>)>,
    fixed_interface: FixedInterface,
    models: Vec<(ModelKey, Arc<ReducedModel>)>,
    progress: &'a dyn Progress,
}

/// What a reduced model is made from besides the sector.
type ModelKey = (usize, BasisChoice, Option<usize>);

/// A setting ready to be solved.
pub struct LadderEngine<'a> {
    solver: LoadCaseSolvers,
    scenarios: Vec<Scenario>,
    tuned: Vec<TunedReference>,
    progress: &'a dyn Progress,
}

impl<'a> LadderBench<'a> {
    /// Reduces the sector of `study` for rows of `sample`.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub fn new(
        study: &Study,
        sector: &'a SectorModel,
        patterns: Vec<u32>,
        progress: &'a dyn Progress,
    ) -> Result<Self, PipelineError> {
        // These modes cost nothing per row, so they are not traded.
        let mut bench_study = study.clone();
        bench_study.reduction.error = bench_study.reduction.error.min(FIXED_INTERFACE_ERROR);
        let (reduction, fixed_interface) = reduce_sector(&bench_study, sector)?;
        let mut bench = Self {
            reductions: vec![(contact_stiffness(study.contact.as_ref()), reduction)],
            study: bench_study,
            sector,
            sample: LadderSample {
                scenarios: Vec::new(),
                patterns,
            },
            fixed_interface,
            models: Vec::new(),
            progress,
        };
        bench.study.contacts = judged_conditions(&study.contacts);
        let scenarios = sampled_scenarios(study, &bench.remainders()?);
        // A study of linear limits alone has a basis to choose, by these.
        if !scenarios.is_empty() {
            bench.study = of_sample(&bench.study, &scenarios);
        }
        bench.sample.scenarios = scenarios;
        Ok(bench)
    }

    /// The rows it solves.
    #[must_use]
    pub fn sample(&self) -> &LadderSample {
        &self.sample
    }

    /// The study on the scenarios of the sample.
    #[must_use]
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The reduction of the study.
    #[must_use]
    pub fn reduction(&self) -> &Reduction<'a> {
        &self.reductions[0].1
    }

    /// The number of fixed-interface modes, which is that of the study at every setting.
    #[must_use]
    pub fn fixed_interface(&self) -> &FixedInterface {
        &self.fixed_interface
    }

    /// What the levels of its ladder depend on; `best` is the largest basis.
    #[must_use]
    pub fn space(&self, best: BasisChoice) -> LadderSpace {
        let space = LadderSpace {
            whole_space: self.reduction().is_whole_space(),
            contact_rows: self.reduction().contact_rows(),
            most_vectors: 0,
            law: self.law(),
            projection: self.study.mistuning.projection,
        };
        LadderSpace {
            most_vectors: space.vectors(best),
            ..space
        }
    }

    /// Contact law of the study.
    #[must_use]
    pub fn law(&self) -> ContactLaw {
        let contact = self.study.contact.as_ref();
        contact.map_or(ContactLaw::Simplified3d, |contact| contact.law)
    }

    /// The engine of a setting, with the tuned wheel of every scenario solved.
    ///
    /// # Errors
    /// The model cannot be reduced, or the samples cannot tell the harmonics apart.
    pub fn engine(&mut self, setting: &LadderSetting) -> Result<LadderEngine<'a>, PipelineError> {
        let study = setting.applied_to(&self.study);
        let place = self.reduction_for(contact_stiffness(study.contact.as_ref()))?;
        let modes = study.mistuning.cantilever_mode_count;
        let model = self.model((place, setting.basis, modes))?;
        let full = match setting.harmonics {
            HarmonicLevel::Automatic(_) => {
                Some(self.reductions[place].1.tuned(BasisChoice::CraigBampton)?)
            }
            HarmonicLevel::Set(_) => None,
        };
        let solver = solver_under(&excitations(&study), |case| {
            let settings = row_settings(&case.study);
            let on_engine = |solver: RowSolver| on_receptances_of_basis(solver, case, &model);
            let model = Arc::new(case.of(&model));
            let solver = RowSolver::new(Arc::clone(&model), settings.clone())?;
            let (HarmonicLevel::Automatic(tolerance), Some(full)) = (&setting.harmonics, &full)
            else {
                return Ok(LoadCaseSolver::from(on_engine(solver)?));
            };
            let full = Arc::new(case.of(full));
            let sets = choose_harmonics(
                &full,
                &settings,
                &case.study.engine_orders,
                &study.contacts,
                &settings.harmonics,
                Some(*tolerance),
            )?;
            let solver = on_engine(solver.with_choices(sets.clone(), 0.0)?)?;
            let solver = LoadCaseSolver::from(solver);
            if !setting.law.has_variable_load() {
                return Ok(solver);
            }
            let sets = with_separation(&full, &settings, sets)?;
            let finer = RowSolver::new(model, settings)?.with_choices(sets, 0.0)?;
            Ok::<_, PipelineError>(solver.with_fallback(on_engine(finer)?, false))
        })?;
        Ok(LadderEngine::new(
            solver,
            &self.sample.scenarios,
            self.progress,
        ))
    }

    /// What harmonic 1 alone leaves out of the tuned peaks, under every force vector.
    fn remainders(&self) -> Result<Vec<Remainders>, PipelineError> {
        let full = self.reduction().tuned(BasisChoice::CraigBampton)?;
        let of_case = |case: &Excitation| {
            let study = &case.study;
            let settings = row_settings(study);
            let choices = choose_harmonics(
                &Arc::new(case.of(&full)),
                &settings,
                &study.engine_orders,
                &study.contacts,
                &settings.harmonics,
                None,
            )?;
            Ok((case.name, choices))
        };
        excitations(&alone(&self.study))
            .iter()
            .map(of_case)
            .collect()
    }

    /// Place of the reduction with the given linear contact springs, made if it is not there.
    fn reduction_for(&mut self, stiffness: ContactStiffness) -> Result<usize, PipelineError> {
        if let Some(place) = self
            .reductions
            .iter()
            .position(|(known, _)| *known == stiffness)
        {
            return Ok(place);
        }
        let reduction = Reduction::new(
            self.sector,
            stiffness,
            self.fixed_interface.modes,
            sensitivity_vectors(&self.study),
        )?
        .with_damping(self.study.added_damping())
        .with_force_factors(self.study.force_factors());
        self.reductions.push((stiffness, reduction));
        Ok(self.reductions.len() - 1)
    }

    fn model(&mut self, key: ModelKey) -> Result<Arc<ReducedModel>, PipelineError> {
        if let Some((_, model)) = self.models.iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(model));
        }
        let (place, basis, modes) = key;
        let model = Arc::new(self.reductions[place].1.reduce(basis, modes)?);
        self.models.push((key, Arc::clone(&model)));
        Ok(model)
    }
}

impl<'a> LadderEngine<'a> {
    /// A solver with the tuned wheel of every scenario solved.
    pub(in crate::settings) fn new(
        solver: LoadCaseSolvers,
        scenarios: &[Scenario],
        progress: &'a dyn Progress,
    ) -> Self {
        let mut tuned: Vec<TunedReference> = Vec::new();
        for scenario in scenarios {
            let same = scenarios[..tuned.len()].iter().position(|other| {
                other.same_excitation(scenario) && other.contact == scenario.contact
            });
            tuned.push(match same {
                Some(same) => tuned[same].clone(),
                None => solver.tuned(scenario),
            });
        }
        Self {
            solver,
            scenarios: scenarios.to_vec(),
            tuned,
            progress,
        }
    }

    /// Tuned reference of each scenario.
    #[must_use]
    pub fn tuned(&self) -> &[TunedReference] {
        &self.tuned
    }

    /// What solves the rows.
    pub(in crate::settings) fn solver(&self) -> &LoadCaseSolvers {
        &self.solver
    }

    /// Whether contacts of a tuned wheel separate.
    #[must_use]
    pub fn separates(&self) -> bool {
        let shares = self
            .tuned
            .iter()
            .filter_map(|tuned| tuned.separated_fraction);
        shares.fold(0.0, f64::max) > 0.0
    }

    /// Size of the equation in each scenario.
    #[must_use]
    pub fn sizes(&self) -> Vec<SystemSize> {
        let scenarios = self.scenarios.iter();
        scenarios
            .map(|scenario| SystemSize::of_rows(self.solver.under(scenario).rows(), scenario))
            .collect()
    }

    /// Rows of the patterns `ids`, ordered by pattern, then scenario.
    #[must_use]
    pub fn rows(&self, patterns: &PatternSource, ids: &[u32]) -> Vec<LadderRow> {
        let solved: Vec<Vec<LadderRow>> = ids
            .par_iter()
            .with_max_len(1)
            .map(|&id| self.rows_of(patterns, id))
            .collect();
        solved.into_iter().flatten().collect()
    }

    fn rows_of(&self, patterns: &PatternSource, id: u32) -> Vec<LadderRow> {
        let mut rows = Vec::new();
        let deviations = distinct(
            self.scenarios
                .iter()
                .map(|scenario| scenario.standard_deviation),
        );
        for standard_deviation in deviations {
            let Some(pattern) = patterns.pattern(id, standard_deviation) else {
                continue;
            };
            let of_group = |scenario: &Scenario| scenario.standard_deviation == standard_deviation;
            let places: Vec<usize> = (0..self.scenarios.len())
                .filter(|&place| of_group(&self.scenarios[place]))
                .collect();
            rows.extend(self.group(&pattern, &places));
        }
        rows.sort_by_key(|row| row.scenario);
        for row in &rows {
            self.progress.row(row.status);
        }
        rows
    }

    /// Rows of one pattern under the scenarios at `places`, of one standard deviation.
    fn group(&self, pattern: &Pattern, places: &[usize]) -> Vec<LadderRow> {
        let wanted: Vec<(&Scenario, &TunedReference)> = places
            .iter()
            .map(|&place| (&self.scenarios[place], &self.tuned[place]))
            .collect();
        let before = thread_processor_time_s();
        let solve = AssertUnwindSafe(|| self.solver.rows(pattern, &wanted));
        let solved = catch_unwind(solve);
        let cpu_s = before
            .zip(thread_processor_time_s())
            .map_or(0.0, |(a, b)| b - a);
        let share = cpu_s / places.len() as f64;
        let row = |(at, &place): (usize, &usize)| match &solved {
            Ok(rows) => self.row(place, &rows[at], share),
            Err(_) => LadderRow {
                scenario: place,
                pattern: pattern.id,
                status: Status::Panicked,
                harmonics: String::new(),
                values: LadderValues::default(),
                work: RowWork::default(),
                operations: 0.0,
                cpu_s: share,
            },
        };
        places.iter().enumerate().map(row).collect()
    }

    fn row(&self, place: usize, row: &ResponseRow, cpu_s: f64) -> LadderRow {
        let work = RowWork::of(row);
        LadderRow {
            scenario: place,
            pattern: row.pattern,
            status: row.status,
            harmonics: row.harmonics.clone(),
            values: LadderValues {
                amplitude_m: row.peak_amplitude_m,
                frequency_hz: row.peak_frequency_hz,
                amplification_factor: row.amplification_factor,
            },
            operations: {
                let scenario = &self.scenarios[place];
                let solver = self.solver.under(scenario).rows();
                SystemSize::of_rows(solver, scenario).operations(&work)
            },
            work,
            cpu_s,
        }
    }
}

/// The study with harmonic 1 alone.
fn alone(study: &Study) -> Study {
    let mut single = study.clone();
    single.solver.harmonics = Harmonics::Set(vec![1]);
    single
}
