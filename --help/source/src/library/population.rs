//! The rows of many wheels in memory, and what they say of all wheels.

use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::population::statistics::{
    CONFIDENCE, Percentile, Quantity, ScenarioAccumulator, ScenarioStatistics, percentile_at,
};

/// Rows of the wheels that were solved, under every scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct Population {
    rows: Vec<ResponseRow>,
}

impl Population {
    pub(super) fn new(rows: Vec<ResponseRow>) -> Self {
        Self { rows }
    }

    /// All rows, by wheel, then scenario; failed ones among them.
    #[must_use]
    pub fn rows(&self) -> &[ResponseRow] {
        &self.rows
    }

    /// Rows of one scenario, by wheel.
    pub fn of(&self, scenario: &Scenario) -> impl Iterator<Item = &ResponseRow> {
        let index = scenario.index;
        self.rows.iter().filter(move |row| row.scenario == index)
    }

    /// The percentile of `percent`, between 0 and 100, with the bounds of its distribution-free interval of 95 % confidence
    /// (David & Nagaraja 2003, section 7.1).
    ///
    /// It has a value where the wheels are enough for both bounds, and its status says so. Failed rows widen the interval.
    #[must_use]
    pub fn percentile(&self, scenario: &Scenario, quantity: Quantity, percent: f64) -> Percentile {
        let values = self.of(scenario).map(|row| quantity.of(row));
        let (mut good, mut failed) = (Vec::new(), 0);
        for value in values {
            match value {
                Some(value) => good.push(value),
                None => failed += 1,
            }
        }
        good.sort_unstable_by(f64::total_cmp);
        percentile_at(&good, failed, percent, CONFIDENCE)
    }

    /// Statistics of one scenario, as in `scenarios.parquet`: rows by status, moments, percentiles, stated errors.
    #[must_use]
    pub fn statistics(&self, scenario: &Scenario) -> ScenarioStatistics {
        let mut gathered = ScenarioAccumulator::default();
        for row in self.of(scenario) {
            gathered.add(row);
        }
        gathered.finish()
    }
}
