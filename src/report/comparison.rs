//! What a comparison of scenarios found: the numbers of the report.

use std::path::PathBuf;

use serde::Serialize;

use crate::population::monte_carlo::{LoadCaseName, Scenario};
use crate::population::statistics::{
    PairFacts, Percentile, PercentileComparison, PointStatus, Quantity,
};

/// A results folder of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedFolder {
    /// The folder.
    pub folder: PathBuf,
    /// Name of its study.
    pub name: String,
    /// Digest of its study.
    pub study_digest: String,
    /// Identity of the build that solved it.
    pub build: String,
    /// Patterns of its study.
    pub patterns: u64,
}

/// A scenario of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedScenario {
    /// Place of its folder in the list, from 0.
    pub folder: usize,
    /// Index in its folder.
    pub scenario: usize,
    /// Load case; absent: the study has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation, if the study has one.
    pub standard_deviation: Option<f64>,
    /// `full`, `stuck`, `slide` or `free`.
    pub contact: &'static str,
    /// Normal load per sector, N.
    pub normal_load_n: Option<f64>,
}

impl ComparedScenario {
    /// The scenario of a folder.
    #[must_use]
    pub fn new(folder: usize, scenario: &Scenario) -> Self {
        Self {
            folder,
            scenario: scenario.index,
            load_case: scenario.load_case,
            engine_order: scenario.engine_order,
            standard_deviation: scenario.standard_deviation,
            contact: scenario.contact.name(),
            normal_load_n: scenario.contact.normal_load_n(),
        }
    }
}

/// One candidate against its baseline.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioComparison {
    /// The baseline.
    pub baseline: ComparedScenario,
    /// The candidate.
    pub candidate: ComparedScenario,
    /// `same_patterns`: pairs of the same wheels; `same_blades`: pairs of the same blades with other
    /// random contact; `same_unit_draws`: pairs at two standard deviations;
    /// `independent`: no pattern in common.
    pub pairing: &'static str,
    /// Patterns used, of the baseline and of the candidate.
    pub patterns: [u64; 2],
    /// Patterns of the baseline that the candidate lacks, and of the candidate that the baseline
    /// lacks.
    pub patterns_left_out: [u64; 2],
    /// The percentile, its difference and its ratio.
    pub percentile: PercentileComparison,
    /// Largest value of the patterns used, of the baseline and of the candidate; null where a row has no value. What is
    /// compared where the percentile has no value for lack of patterns.
    pub largest: [Option<f64>; 2],
    /// `p_value` adjusted for all comparisons of this quantity (Holm 1979).
    pub adjusted_p_value: Option<f64>,
    /// Whether the adjusted one comes from a `p_value` at its floor: it is then an upper bound.
    pub adjusted_p_value_is_bound: bool,
    /// Facts about the pairs; null for independent populations.
    pub pairs: Option<PairFacts>,
}

impl ScenarioComparison {
    /// How many patterns the percentile needs, where there are fewer on a side.
    pub(super) fn needed_patterns(&self) -> Option<u64> {
        let sides = [&self.percentile.baseline, &self.percentile.candidate];
        sides.into_iter().find_map(|side| match side.status {
            PointStatus::TooFewPatterns { needed } => Some(needed),
            _ => None,
        })
    }
}

/// A load among those of which one is the best.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoadOfSet {
    /// The scenario.
    #[serde(flatten)]
    pub scenario: ComparedScenario,
    /// Percentile of the load.
    pub percentile: Percentile,
    /// Not significantly worse than any other: with 95 % confidence the best of all is among these.
    pub could_be_best: bool,
}

/// Which of the loads of one engine order and standard deviation could be the best.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BestLoads {
    /// Scenario with the lowest percentile of the sample.
    pub lowest: Option<usize>,
    /// Lower 95 % bound on the percentile at the truly best load; the choice is allowed for.
    pub lower: Option<f64>,
    /// Upper 95 % bound on it.
    pub upper: Option<f64>,
    /// The loads, in the order of the study.
    pub loads: Vec<LoadOfSet>,
}

/// All comparisons of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityComparison {
    /// The quantity.
    pub quantity: Quantity,
    /// Candidates against their baselines.
    pub comparisons: Vec<ScenarioComparison>,
    /// Best loads of every folder, engine order and standard deviation with several.
    pub best: Vec<BestLoads>,
}

/// How the baselines of a comparison were chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BaselineChoice {
    /// In each group the load with the lowest percentile of the peak amplitude; the first one where no
    /// percentile has a value.
    Lowest,
    /// In each group the load with the lowest of the largest peak amplitudes, because there are too few patterns for the
    /// percentile.
    LowestOfLargest,
    /// The scenario that the user names.
    Named,
    /// The scenario of the first folder with the same keys.
    SameKeys,
}

/// A comparison of scenarios.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparisonReport {
    /// The percentile compared, in percent.
    pub percent: f64,
    /// Resamples behind the intervals.
    pub resamples: u32,
    /// Seed of the resamples, that of the first study.
    pub seed: u64,
    /// How the baselines were chosen.
    pub baseline_choice: BaselineChoice,
    /// The folders.
    pub folders: Vec<ComparedFolder>,
    /// Scenarios without a counterpart in the first folder.
    pub unmatched: Vec<ComparedScenario>,
    /// Peak amplitude and amplification factor.
    pub quantities: Vec<QuantityComparison>,
}

impl ComparisonReport {
    /// Whether the folders were not all solved by the same build of the program.
    #[must_use]
    pub fn builds_differ(&self) -> bool {
        let mut pairs = self.folders.windows(2);
        pairs.any(|pair| pair[0].build != pair[1].build)
    }

    /// Whether failed rows leave a comparison without a value.
    #[must_use]
    pub fn failures_cost_a_comparison(&self) -> bool {
        let all = self.quantities.iter().flat_map(|found| &found.comparisons);
        all.filter_map(|comparison| comparison.percentile.difference)
            .any(|difference| difference.value.is_none())
    }
}
