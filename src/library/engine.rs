//! A sector reduced for a problem, ready to solve wheels: built upon what a study file leads to.

use std::path::Path;
use std::sync::Arc;

use toml::Table;

use super::population::Population;
use super::problem::NAME;
use super::{Numerics, Problem};
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{
    Interruption, MemorySink, ResponseRow, Scenario, StoredRows, TunedReference, block_size,
    plan_blocks, solve_blocks,
};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{Pattern, PatternSource};
use crate::settings::{
    EngineSource, Progress, ReducedEngineSource, RowWork, Stage, rows_of, tuned_references,
};
use crate::study::{Given, PipelineError, Study, StudyError, load_sector_model, pattern_source};

/// A reduced sector with its numerics and the tuned peak of every scenario, ready to solve wheels; shared between threads.
pub struct Engine {
    study: Study,
    sector: SectorModel,
    rows: Box<dyn crate::settings::Engine>,
    scenarios: Vec<Scenario>,
    tuned: Vec<TunedReference>,
}

impl Engine {
    /// Checks `problem` and `numerics` as a study file is checked, reduces `sector` for them, and solves the tuned wheels.
    ///
    /// # Errors
    /// Everything in them that is not accepted, each with its value and what is accepted, named as the key of a study file; a sector
    /// that is refused or cannot be reduced.
    pub fn build(
        sector: &SectorModel,
        problem: &Problem,
        numerics: &Numerics,
    ) -> Result<Self, PipelineError> {
        let mut study = Table::new();
        problem.write(&mut study);
        numerics.write(&mut study);
        let given = Given {
            model: Some(Arc::new(sector.clone())),
            records: problem.records()?,
        };
        Self::of_study(&Study::parse_with(
            Path::new(NAME),
            &study.to_string(),
            given,
        )?)
    }

    /// The engine that a run of `study` solves its rows with.
    ///
    /// # Errors
    /// The sector is refused or cannot be reduced, or the study does not fit to it.
    pub fn of_study(study: &Study) -> Result<Self, PipelineError> {
        let sector = load_sector_model(study)?;
        // Measured wheels may not fit to the sector.
        pattern_source(study, &sector)?;
        let rows = ReducedEngineSource.build(study, &sector, None)?;
        let scenarios = study.scenarios();
        Ok(Self {
            tuned: tuned_references(rows.as_ref(), &scenarios, &()),
            study: study.clone(),
            sector,
            rows,
            scenarios,
        })
    }

    /// The scenarios, in the product order engine order, standard deviation, contact condition.
    #[must_use]
    pub fn scenarios(&self) -> &[Scenario] {
        &self.scenarios
    }

    /// The peak of the tuned wheel under `scenario`, one of [`Self::scenarios`]; none for another.
    #[must_use]
    pub fn tuned(&self, scenario: &Scenario) -> Option<&TunedReference> {
        let is_own = self.scenarios.get(scenario.index) == Some(scenario);
        is_own.then(|| &self.tuned[scenario.index])
    }

    /// The wheel `id` of the problem under a scenario, which says how large its deviations are.
    ///
    /// # Errors
    /// There is no such wheel, or measured wheels do not have a deviation for every blade.
    pub fn wheel(&self, id: u32, scenario: &Scenario) -> Result<Pattern, PipelineError> {
        let patterns = self.wheels(u32::MAX)?;
        let found = patterns.pattern(id, scenario.standard_deviation);
        found.ok_or_else(|| PipelineError::NoPattern {
            id,
            accepted: match patterns.ids().last() {
                Some(last) => format!("an id from 0 to {last}"),
                None => "none".to_owned(),
            },
        })
    }

    /// The peak of one wheel under one scenario, as the row that a study would have of it.
    ///
    /// A row that failed says so in its status; so does one of a wheel that has not a deviation for every blade, or under a scenario
    /// that is not of [`Self::scenarios`], by [`Status::InvalidPattern`].
    #[must_use]
    pub fn peak(&self, wheel: &Pattern, scenario: &Scenario) -> ResponseRow {
        let refused =
            || ResponseRow::without_result(scenario.index, wheel.id, Status::InvalidPattern);
        let Some(tuned) = self.tuned(scenario) else {
            return refused();
        };
        if wheel.blades() != self.sector.sectors {
            return refused();
        }
        let rows = rows_of(self.rows.as_ref(), wheel, &[(scenario, tuned)]);
        rows.into_iter().next().unwrap_or_else(refused)
    }

    /// The first `wheels` of the problem under every scenario, on as many threads as rayon has here; of measured wheels not more than
    /// there are. The rows are the same on any number of threads, and those of a study file that says the same.
    ///
    /// `progress` is told of every row, and may ask to stop; `&()` does neither.
    ///
    /// # Errors
    /// The work was stopped, the threads cannot be started, or measured wheels do not have a deviation for every blade.
    pub fn population(
        &self,
        wheels: u32,
        progress: &dyn Progress,
    ) -> Result<Population, PipelineError> {
        let patterns = self.wheels(wheels)?;
        let mut ids = patterns.ids();
        ids.truncate(wheels as usize);
        let count = self.scenarios.len();
        let planned = (ids.len() * count) as u64;
        let threads = rayon::current_num_threads();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| PipelineError::Threads {
            threads,
            reason: error.to_string(),
        })?;
        progress.stage(Stage::Rows);
        progress.rows_at_a_time((threads * count) as u64);
        progress.begin_rows(planned, 0);
        let work = RowWork {
            engine: self.rows.as_ref(),
            patterns: &patterns,
            scenarios: &self.scenarios,
            tuned: &self.tuned,
            progress,
        };
        let blocks = plan_blocks(&ids, &StoredRows::default(), count, block_size(ids.len()));
        let mut sink = MemorySink::default();
        let stop = Stop(progress);
        let Ok(solved) = solve_blocks(
            &pool,
            &blocks,
            |block, id| work.of_pattern(id, &block.scenarios),
            &mut sink,
            &stop,
        );
        if solved < planned {
            return Err(PipelineError::Stopped { solved, planned });
        }
        Ok(Population::new(sink.into_rows()))
    }

    /// The first `count` wheels that are drawn, or all that were measured.
    fn wheels(&self, count: u32) -> Result<PatternSource, StudyError> {
        let mut study = self.study.clone();
        study.patterns = count;
        pattern_source(&study, &self.sector)
    }
}

/// The listener as the one that stops the solution of rows; nothing is stored that would have to be waited for.
struct Stop<'a>(&'a dyn Progress);

impl Interruption for Stop<'_> {
    fn requested(&self) -> bool {
        self.0.stop_requested()
    }

    fn saved(&self) {}
}
