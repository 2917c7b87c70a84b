//! What a search for the best normal load found.

use std::fmt;

use serde::Serialize;

use super::BestLoads;
use super::text_table::TextTable;
use super::words::{LengthUnit, excitation, four_digits, paragraph, trimmed};
use crate::population::monte_carlo::LoadCaseName;
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
    /// All loads with their percentiles, and which could be best. Of several load cases and engine orders: the
    /// percentile of the largest value of each wheel over them; each load names those of the highest percentile.
    pub best: BestLoads,
    /// The loads of the search under each load case and engine order alone; empty, and absent in JSON, where
    /// there is only one of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub excitations: Vec<OptimumExcitation>,
}

/// The loads of a search under one load case and engine order alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OptimumExcitation {
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Of the loads solved, that with its lowest percentile, N.
    pub normal_load_n: Option<f64>,
    /// Its percentile at every load solved, and which of these could be its best.
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
        let several = !self.excitations.is_empty();
        let values = self.best.loads.iter();
        let unit = (self.quantity == Quantity::PeakAmplitudeM)
            .then(|| LengthUnit::of(values.filter_map(|load| load.percentile.value)));
        let quantity = match unit {
            Some(unit) => format!("the peak amplitude in {}", unit.name()),
            None => "the amplification factor".to_owned(),
        };
        let heading = format!(
            "study {}: P{percent} of {quantity}{} over the same {} patterns at every load; N is the normal \
             load per sector",
            self.name,
            if several {
                ", each wheel by its largest over load cases and engine orders,"
            } else {
                ""
            },
            self.patterns
        );
        writeln!(f, "{}\n", paragraph(&heading))?;
        let shown = |value: Option<f64>| {
            let digits =
                |value: f64| unit.map_or_else(|| four_digits(value), |unit| unit.number(value));
            value.map_or_else(|| "-".to_owned(), digits)
        };
        let heading = format!("P{percent}");
        let mut headings = vec!["load N", &heading, "lower", "upper", "could be best"];
        headings.extend(several.then_some("highest under"));
        let mut table = TextTable::new(&headings);
        for load in &self.best.loads {
            let highest = excitation(load.scenario.load_case, load.scenario.engine_order);
            let mut row = vec![
                load.scenario
                    .normal_load_n
                    .map_or_else(String::new, trimmed),
                shown(load.percentile.value),
                shown(load.percentile.lower),
                shown(load.percentile.upper),
                if load.could_be_best { "yes" } else { "no" }.to_owned(),
            ];
            row.extend(several.then_some(highest));
            table.row(row);
        }
        write!(f, "{table}")?;
        let load = |load: Option<f64>| load.map_or_else(|| "-".to_owned(), trimmed);
        let verdict = format!(
            "lowest at {} N per sector; with 95 % confidence the best load lies in [{} {}] N, its \
             P{percent} in [{} {}]; the bounds of the load hold if the percentile has one minimum, - = \
             not enclosed",
            load(self.normal_load_n),
            load(self.normal_load_lower_n),
            load(self.normal_load_upper_n),
            shown(self.best.lower),
            shown(self.best.upper),
        );
        writeln!(f, "\n{}", paragraph(&verdict))?;
        if !self.resolved {
            writeln!(
                f,
                "the search ended before the loads were as close as wanted"
            )?;
        }
        if several {
            writeln!(
                f,
                "\nP{percent} under each alone, of the loads solved; * = could be best for it\n"
            )?;
            let names = self.excitations.iter();
            let names: Vec<String> = names
                .map(|own| excitation(own.load_case, own.engine_order))
                .collect();
            let mut headings = vec!["load N"];
            headings.extend(names.iter().map(String::as_str));
            let mut table = TextTable::new(&headings);
            for (place, load) in self.best.loads.iter().enumerate() {
                let mut row = vec![
                    load.scenario
                        .normal_load_n
                        .map_or_else(String::new, trimmed),
                ];
                row.extend(self.excitations.iter().map(|own| {
                    let own = &own.best.loads[place];
                    let mark = if own.could_be_best { " *" } else { "  " };
                    format!("{}{mark}", shown(own.percentile.value))
                }));
                table.row(row);
            }
            let mut row = vec!["lowest at".to_owned()];
            row.extend(self.excitations.iter().map(|own| load(own.normal_load_n)));
            table.row(row);
            write!(f, "{table}")?;
        }
        Ok(())
    }
}
