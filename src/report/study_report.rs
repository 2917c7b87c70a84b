//! Every number of the report on a finished study.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::words::excitation_and_deviation;
use super::{
    AccuracyTrials, BestLoads, CommonErrors, PercentileError, ShownModel, StatedErrors,
    StudySummary, WheelReport,
};
use crate::population::monte_carlo::LoadCaseName;
use crate::population::statistics::{Percentile, Quantity, TailFit};
use crate::population::table::AccuracyLadder;

/// The report on a finished study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyReport {
    /// The summary: statistics per scenario, counts by status, warnings.
    pub summary: StudySummary,
    /// Engine orders and standard deviations, each with its loads.
    pub groups: Vec<GroupReport>,
    /// The model of the study.
    pub model: ShownModel,
    /// What accuracy costs, where it was measured.
    pub accuracy_ladder: Option<AccuracyLadder>,
    /// What was tried before the settings were chosen, where `[accuracy]` chose them.
    pub accuracy_trials: Option<AccuracyTrials>,
    /// What the numbers were made from.
    pub provenance: Provenance,
}

/// What the numbers of a report were made from; no clock, host or thread count.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Provenance {
    /// Version of the program that solved the rows.
    pub version: String,
    /// Identity of the build that solved the rows.
    pub build: String,
    /// Random number generator.
    pub generator: String,
    /// Digests of the input files, by path as written in the study.
    pub inputs: BTreeMap<String, String>,
    /// Digests of the tables, by file name.
    pub tables: BTreeMap<String, String>,
    /// The study with every default filled in.
    pub study: Value,
    /// Settings that the program chose where the study says `auto`.
    pub chosen: Value,
}

/// The loads of one engine order and standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupReport {
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation, if the study has one.
    pub standard_deviation: Option<f64>,
    /// Its scenarios.
    pub scenarios: Vec<usize>,
    /// Which load to choose for each percentile of the peak amplitude, the highest percentile first.
    pub choices: Vec<LoadChoice>,
    /// Errors of the numbers of every scenario, in their order.
    pub errors: Vec<ScenarioErrors>,
    /// Scenario that the distributions and wheels are of: the best by the first choice with
    /// a value, or by the tuned peak where there is none.
    pub shown: usize,
    /// Distributions of both quantities there.
    pub distributions: Vec<DistributionReport>,
    /// Wheels solved again there.
    pub wheels: Wheels,
    /// Peak of each wheel of `mistuning.file` under each scenario, where it holds few.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<MeasuredPeak>,
}

/// The peak of one wheel of `mistuning.file` under one scenario.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeasuredPeak {
    /// The scenario.
    pub scenario: usize,
    /// Id of the wheel in the file.
    pub pattern: u32,
    /// Its peak amplitude, m; null: the row failed.
    pub peak_amplitude_m: Option<f64>,
}

/// Which load to choose for one percentile of the peak amplitude.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoadChoice {
    /// The percentile in percent.
    pub percent: f64,
    /// Loads that could be best; none where the percentile is not estimable, or there is one load.
    pub best: Option<BestLoads>,
    /// Smallest number of patterns with an interval of this percentile.
    pub needed_patterns: u64,
    /// Smallest number of patterns that bounds this percentile at the truly best load.
    pub patterns_of_best: u64,
    /// Scenario with the lowest value, if any has one.
    pub lowest: Option<usize>,
    /// Whether a lower and a higher normal load than that were studied.
    pub enclosed: bool,
}

/// Percentile below which a choice of the load says too little of the highest blades.
const LEAST_OF_A_DESIGN: f64 = 90.0;

impl LoadChoice {
    /// Whether the percentile says enough of the highest blades to design for.
    pub(super) fn is_of_a_design(&self) -> bool {
        self.percent >= LEAST_OF_A_DESIGN
    }
}

/// Numerical and statistical error of the percentiles of one scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioErrors {
    /// The scenario.
    pub scenario: usize,
    /// Errors that its rows state.
    pub rows: StatedErrors,
    /// Errors that every row of the scenario states at least.
    pub common: CommonErrors,
    /// What the errors come to in percentiles of the peak amplitude.
    pub percentiles: Vec<PercentileError>,
}

/// The distribution of a quantity in one scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DistributionReport {
    /// The quantity.
    pub quantity: Quantity,
    /// Half width of the 95 % band, a probability.
    pub half_width: Option<f64>,
    /// Value, share of smaller ones, lower and upper edge of the band.
    pub points: Vec<[f64; 4]>,
    /// Percentiles with their bounds.
    pub percentiles: Vec<Percentile>,
    /// Laws fitted to it.
    pub fits: Vec<TailFit>,
    /// The generalised extreme value law drawn: value and share of smaller ones.
    pub law: Vec<[f64; 2]>,
}

/// The wheels of a group that were solved again.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "wheels", rename_all = "snake_case")]
pub enum Wheels {
    /// The wheels were solved again.
    Solved(Box<WheelReport>),
    /// The wheels were not solved again, and why.
    NotSolved {
        /// Why.
        reason: String,
    },
}

/// Load case, engine order and standard deviation of a group, in words.
#[must_use]
pub fn setting(group: &GroupReport) -> String {
    let words = excitation_and_deviation(
        group.load_case,
        group.engine_order,
        group.standard_deviation,
    );
    // What deviates: a page is read without the study beside it.
    words.replace(
        "standard deviation",
        "standard deviation of blade stiffness",
    )
}
