//! What an estimate with few solves found.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;
use serde_json::Value;

use super::text_table::TextTable;
use super::words::{LengthUnit, excitation, four_digits, load_per_sector, trimmed};
use crate::population::monte_carlo::LoadCaseName;
use crate::population::statistics::{
    Accounting, Allocation, EstimateTarget, MeanEstimate, PointStatus, Quantity, SamplingMethod,
    SurrogateWorth, TwoPhasePercentile,
};

/// Mean and percentiles of a study from a sample of its patterns.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EstimateReport {
    /// Name of the study.
    pub name: String,
    /// Version of the program.
    pub version: String,
    /// Identity of the build that solved its rows.
    pub build: String,
    /// Digest of the study.
    pub study_digest: String,
    /// Its seed.
    pub seed: u64,
    /// Patterns of the population.
    pub patterns: u64,
    /// Patterns that are solved in each scenario at most.
    pub solves: u64,
    /// What they are to tell best.
    pub target: EstimateTarget,
    /// The resolved study.
    pub study: Value,
    /// Digests of its input files.
    pub inputs: BTreeMap<String, String>,
    /// Facts about the reduction.
    pub reduction: Value,
    /// Settings chosen where the study says `auto`.
    pub chosen: Value,
    /// Digest of `sample.parquet`.
    pub sample_digest: String,
    /// The scenarios.
    pub scenarios: Vec<ScenarioEstimate>,
}

/// The estimate of one scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioEstimate {
    /// Index in the study.
    pub scenario: usize,
    /// `full`, or the linear limit.
    pub contact: String,
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Normal load per sector, N.
    pub normal_load_n: Option<f64>,
    /// Standard deviation of the deviations.
    pub standard_deviation: Option<f64>,
    /// Peak amplitude of the tuned wheel, m.
    pub tuned_amplitude_m: Option<f64>,
    /// Patterns without a surrogate.
    pub without_surrogate: u64,
    /// Rows of the pilot.
    pub pilot: u64,
    /// How many of each stratum were solved, and why.
    pub allocation: Allocation,
    /// What surrogates of all patterns were predicted to be worth; none: the pilot could not tell, and they were not found.
    pub surrogates: Option<SurrogateWorth>,
    /// Patterns of each stratum.
    pub strata: Vec<u64>,
    /// The solved rows by status.
    pub rows: Accounting,
    /// Estimated share of the population whose rows fail.
    pub failed_share: f64,
    /// Share of the population that one solved row stands for, at most.
    pub largest_weight: f64,
    /// Both quantities.
    pub quantities: Vec<QuantityEstimate>,
}

/// The estimate of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityEstimate {
    /// The quantity.
    pub quantity: Quantity,
    /// Mean of the rows with a value.
    pub mean: Option<MeanEstimate>,
    /// Percentiles, ascending.
    pub percentiles: Vec<TwoPhasePercentile>,
}

impl EstimateReport {
    /// Whether failed rows leave a percentile without a value.
    #[must_use]
    pub fn failures_cost_a_value(&self) -> bool {
        let quantities = self.scenarios.iter().flat_map(|found| &found.quantities);
        quantities
            .flat_map(|quantity| &quantity.percentiles)
            .any(|percentile| percentile.status == PointStatus::TooManyFailures)
    }
}

impl fmt::Display for EstimateReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let target = match self.target {
            EstimateTarget::Mean => "the mean".to_owned(),
            EstimateTarget::Percentile(percent) => format!("P{}", trimmed(percent)),
        };
        writeln!(
            f,
            "study {}: {} patterns, at most {} solved for {target}, seed {}",
            self.name, self.patterns, self.solves, self.seed
        )?;
        for found in &self.scenarios {
            write!(f, "{found}")?;
        }
        writeln!(
            f,
            "\n95 % bounds in brackets; patterns = size of a simple random sample that is as sharp."
        )
    }
}

impl fmt::Display for ScenarioEstimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let deviation = self.standard_deviation.map_or_else(String::new, |s| {
            format!(", standard deviation {} %", trimmed(100.0 * s))
        });
        writeln!(
            f,
            "\n{}{deviation}, {}: {} rows solved, {} failed",
            excitation(self.load_case, self.engine_order),
            load_per_sector(&self.contact, self.normal_load_n),
            self.rows.planned(),
            self.rows.failed()
        )?;
        let gain = self
            .allocation
            .predicted_gain
            .map_or_else(String::new, |gain| format!(", predicted gain {gain:.1}"));
        match self.allocation.method {
            SamplingMethod::TwoPhase => writeln!(
                f,
                "two-phase sample in {} strata{gain}; one row stands for at most {:.2} % of the patterns",
                self.strata.len(),
                100.0 * self.largest_weight
            )?,
            SamplingMethod::Crude => writeln!(f, "simple random sample{gain}")?,
        }
        match self.surrogates {
            None => writeln!(
                f,
                "no surrogates: the pilot does not tell what they are worth"
            )?,
            Some(worth) => writeln!(
                f,
                "{}: by the pilot a solve would be worth {:.1} with them, {:.1} in time (a surrogate takes {:.2} of a row, counted)",
                if worth.pays() {
                    "a surrogate of every pattern"
                } else {
                    "no surrogates"
                },
                worth.gain,
                worth.gain_in_time,
                worth.cost
            )?,
        }
        let mut table = TextTable::new(&["", "value", "95 % bounds", "patterns"]);
        let means = self.quantities.iter().filter_map(|own| {
            let length = own.quantity == Quantity::PeakAmplitudeM;
            own.mean.as_ref().filter(|_| length).map(|mean| mean.value)
        });
        let unit = LengthUnit::of(means);
        for quantity in &self.quantities {
            let shown = |value: Option<f64>| {
                value.map_or_else(
                    || "-".to_owned(),
                    |value| match quantity.quantity {
                        Quantity::PeakAmplitudeM => unit.length(value),
                        Quantity::AmplificationFactor => four_digits(value),
                    },
                )
            };
            let name = match quantity.quantity {
                Quantity::PeakAmplitudeM => "amplitude",
                Quantity::AmplificationFactor => "amplification",
            };
            let worth = |patterns: Option<f64>| {
                patterns.map_or_else(|| "-".to_owned(), |patterns| format!("{patterns:.0}"))
            };
            if let Some(mean) = &quantity.mean {
                table.row(vec![
                    format!("{name} mean"),
                    shown(Some(mean.value)),
                    format!("[{} {}]", shown(Some(mean.lower)), shown(Some(mean.upper))),
                    worth(mean.equivalent_patterns),
                ]);
            }
            for percentile in &quantity.percentiles {
                table.row(vec![
                    format!("{name} P{}", trimmed(percentile.percent)),
                    shown(percentile.value),
                    format!("[{} {}]", shown(percentile.lower), shown(percentile.upper)),
                    worth(percentile.equivalent_patterns),
                ]);
            }
        }
        write!(f, "{table}")
    }
}
