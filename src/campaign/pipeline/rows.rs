//! The rows of one pattern, whatever happens while they are solved.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::population::monte_carlo::{ResponseRow, Scenario, TunedReference};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::{Pattern, PatternSource};
use crate::settings::{Engine, Progress};

/// All that the solution of rows needs.
pub(in crate::campaign) struct RowWork<'a> {
    pub(in crate::campaign) engine: &'a dyn Engine,
    pub(in crate::campaign) patterns: &'a PatternSource,
    pub(in crate::campaign) scenarios: &'a [Scenario],
    /// One for each scenario.
    pub(in crate::campaign) tuned: &'a [TunedReference],
    pub(in crate::campaign) progress: &'a dyn Progress,
}

impl RowWork<'_> {
    /// Rows of one pattern under the scenarios `wanted`, in their order; the engine sees the
    /// scenarios of each standard deviation together.
    pub(in crate::campaign) fn of_pattern(&self, id: u32, wanted: &[usize]) -> Vec<ResponseRow> {
        let mut standard_deviations: Vec<Option<f64>> = Vec::new();
        for &index in wanted {
            let standard_deviation = self.scenarios[index].standard_deviation;
            if !standard_deviations.contains(&standard_deviation) {
                standard_deviations.push(standard_deviation);
            }
        }
        let mut rows = Vec::with_capacity(wanted.len());
        for standard_deviation in standard_deviations {
            let group: Vec<(&Scenario, &TunedReference)> = wanted
                .iter()
                .map(|&index| (&self.scenarios[index], &self.tuned[index]))
                .filter(|(scenario, _)| scenario.standard_deviation == standard_deviation)
                .collect();
            let pattern = self.patterns.pattern(id, standard_deviation);
            let pattern = pattern.expect("every id of a run is one of its patterns");
            rows.extend(self.rows_or_panicked(&pattern, &group));
        }
        rows.sort_by_key(|row| row.scenario);
        for row in &rows {
            self.progress.row(row.status);
        }
        rows
    }

    /// A panic while one pattern is solved costs the rows of that pattern, not the run.
    fn rows_or_panicked(
        &self,
        pattern: &Pattern,
        scenarios: &[(&Scenario, &TunedReference)],
    ) -> Vec<ResponseRow> {
        let solve = AssertUnwindSafe(|| self.engine.rows(pattern, scenarios));
        catch_unwind(solve).unwrap_or_else(|_| {
            scenarios
                .iter()
                .map(|(scenario, _)| ResponseRow {
                    contact_factors: pattern.contact.means(),
                    ..ResponseRow::without_result(scenario.index, pattern.id, Status::Panicked)
                })
                .collect()
        })
    }
}
