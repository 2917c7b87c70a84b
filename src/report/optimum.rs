//! What a search for the best normal load found.

use std::fmt;

use serde::Serialize;

use super::BestLoads;
use super::summary_text::{four_digits, trimmed};
use super::text_table::TextTable;
use crate::population::statistics::Quantity;

/// The normal load with the lowest percentile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OptimumReport {
    /// Name of the study.
    pub name: String,
    /// Its seed.
    pub seed: u64,
    /// Patterns, the same at every load.
    pub patterns: u64,
    /// The percentile in percent.
    pub percent: f64,
    /// The quantity.
    pub quantity: Quantity,
    /// Load with the lowest percentile of the sample, per sector, N.
    pub normal_load_n: Option<f64>,
    /// Highest load that is below all that could be best, N: where the percentile has one minimum,
    /// the best load is above, with 95 % confidence. Null if the search has none.
    pub normal_load_lower_n: Option<f64>,
    /// Lowest load that is above all that could be best, N.
    pub normal_load_upper_n: Option<f64>,
    /// Whether the loads next to the lowest are as close as wanted.
    pub resolved: bool,
    /// All loads with their percentiles, and which could be best.
    pub best: BestLoads,
}

impl OptimumReport {
    /// Whether failed rows leave a load without a percentile.
    #[must_use]
    pub fn failures_cost_a_load(&self) -> bool {
        self.best
            .loads
            .iter()
            .any(|load| load.percentile.value.is_none())
    }
}

impl fmt::Display for OptimumReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = trimmed(self.percent);
        writeln!(
            f,
            "study {}: P{percent} of {} over the same {} patterns at every load\n",
            self.name,
            self.quantity.name(),
            self.patterns
        )?;
        let shown = |value: Option<f64>| {
            value.map_or_else(
                || "-".to_owned(),
                |value| match self.quantity {
                    Quantity::PeakAmplitudeM => format!("{value:.4e}"),
                    Quantity::AmplificationFactor => four_digits(value),
                },
            )
        };
        let heading = format!("P{percent}");
        let mut table = TextTable::new(&["load N", &heading, "lower", "upper", "could be best"]);
        for load in &self.best.loads {
            table.row(vec![
                load.scenario
                    .normal_load_n
                    .map_or_else(String::new, trimmed),
                shown(load.percentile.value),
                shown(load.percentile.lower),
                shown(load.percentile.upper),
                if load.could_be_best { "yes" } else { "no" }.to_owned(),
            ]);
        }
        write!(f, "{table}")?;
        let load = |load: Option<f64>| load.map_or_else(|| "-".to_owned(), trimmed);
        writeln!(
            f,
            "\nlowest at {} N; with 95 % confidence the best load lies in [{} {}] N, its P{percent} in \
             [{} {}];\nthe bounds of the load hold if the percentile has one minimum, - = not enclosed",
            load(self.normal_load_n),
            load(self.normal_load_lower_n),
            load(self.normal_load_upper_n),
            shown(self.best.lower),
            shown(self.best.upper),
        )?;
        if !self.resolved {
            writeln!(
                f,
                "the search ended before the loads were as close as wanted"
            )?;
        }
        Ok(())
    }
}
