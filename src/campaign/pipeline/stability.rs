//! Rows of a finished study that are looked at for the stability of their motions: those nearest to every percentile.

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;

use crate::population::monte_carlo::{
    LoadCaseSolvers, ResponseRow, Scenario, TunedReference, is_row_stable, is_tuned_stable,
};
use crate::population::statistics::{
    PERCENTILES, SampleStatistics, ScenarioStability, nearest_rows,
};
use crate::population::table::{RowStore, TableError};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::PatternSource;
use crate::study::Study;

/// What was found of the motions of a study.
#[derive(Debug, Default)]
pub(super) struct Stabilities {
    /// By pattern and scenario.
    rows: BTreeMap<(u32, usize), Option<bool>>,
    /// Of each scenario; empty where none was looked at.
    scenarios: Vec<ScenarioStability>,
}

/// A finished study whose motions are looked at.
pub(super) struct StabilityWork<'a> {
    pub(super) study: &'a Study,
    pub(super) patterns: &'a PatternSource,
    /// Patterns of the study, ascending.
    pub(super) ids: &'a [u32],
    pub(super) scenarios: &'a [Scenario],
    /// One for each scenario.
    pub(super) tuned: &'a [TunedReference],
}

impl Stabilities {
    /// Whether the motion of a row is stable; none where it was not looked at or that is not settled.
    pub(super) fn of_row(&self, row: &ResponseRow) -> Option<bool> {
        self.rows.get(&(row.pattern, row.scenario)).copied()?
    }

    /// What was found of a scenario; none where nothing was looked at.
    pub(super) fn of_scenario(&self, scenario: usize) -> Option<ScenarioStability> {
        self.scenarios.get(scenario).copied()
    }
}

impl StabilityWork<'_> {
    /// Looks at the tuned wheels and at the rows that follow from those of `store` alone.
    ///
    /// # Errors
    /// The rows cannot be read.
    pub(super) fn find(
        &self,
        store: &RowStore,
        solvers: &LoadCaseSolvers,
    ) -> Result<Stabilities, TableError> {
        let chosen = self.chosen(store)?;
        let mut wanted = Vec::new();
        store.visit(|row| {
            if chosen.contains(&(row.pattern, row.scenario)) {
                wanted.push(row);
            }
            Ok(())
        })?;
        let tuned: Vec<Option<bool>> = self
            .tuned
            .par_iter()
            .zip(self.scenarios)
            .with_max_len(1)
            .map(|(tuned, scenario)| unless_it_panics(|| is_tuned_stable(solvers, scenario, tuned)))
            .collect();
        let rows: Vec<Option<bool>> = wanted
            .par_iter()
            .with_max_len(1)
            .map(|row| {
                let scenario = &self.scenarios[row.scenario];
                let deviation = scenario.standard_deviation;
                let pattern = self.patterns.pattern(row.pattern, deviation)?;
                unless_it_panics(|| is_row_stable(solvers, &pattern, scenario, row))
            })
            .collect();
        let mut found = Stabilities {
            rows: BTreeMap::new(),
            scenarios: tuned.into_iter().map(ScenarioStability::of_tuned).collect(),
        };
        for (row, stable) in wanted.iter().zip(rows) {
            found.rows.insert((row.pattern, row.scenario), stable);
            found.scenarios[row.scenario].add(stable);
        }
        Ok(found)
    }

    /// The rows nearest to the percentiles of the amplitude that have a value.
    fn chosen(&self, store: &RowStore) -> Result<BTreeSet<(u32, usize)>, TableError> {
        let mut amplitudes: Vec<Vec<(f64, u32)>> = vec![Vec::new(); self.scenarios.len()];
        let mut failed = vec![0_u64; self.scenarios.len()];
        store.visit(|row| {
            if self.ids.binary_search(&row.pattern).is_err() {
                return Ok(());
            }
            let amplitude = row.peak_amplitude_m.filter(|_| row.status == Status::Ok);
            match amplitude {
                Some(amplitude) => amplitudes[row.scenario].push((amplitude, row.pattern)),
                None => failed[row.scenario] += 1,
            }
            Ok(())
        })?;
        let count = self.study.output.stability as usize;
        let mut chosen = BTreeSet::new();
        for ((scenario, rows), failed) in amplitudes.iter().enumerate().zip(failed) {
            let values = rows.iter().map(|(amplitude, _)| *amplitude).collect();
            let sample = SampleStatistics::new(values, failed);
            let percentiles = PERCENTILES.into_iter();
            let values = percentiles.filter_map(|percent| sample.percentile(percent)?.value);
            let wanted: Vec<f64> = values.collect();
            for place in nearest_rows(rows, &wanted, count) {
                chosen.insert((rows[place].1, scenario));
            }
        }
        Ok(chosen)
    }
}

/// A panic costs what is known of one motion, not the tables.
fn unless_it_panics(find: impl FnOnce() -> Option<bool>) -> Option<bool> {
    catch_unwind(AssertUnwindSafe(find)).unwrap_or(None)
}
