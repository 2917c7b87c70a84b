//! Accounting by status, moments and order statistics with distribution-free intervals.

mod accounting;
mod binomial;
mod main_effects;
mod order_statistics;
mod sample;
mod scenario;

pub use accounting::Accounting;
pub use binomial::proportion_upper_bound;
pub use main_effects::{FEWEST_ROWS, MainEffects, VarianceShare, main_effects};
pub use order_statistics::{
    CONFIDENCE, Percentile, PercentileRanks, PointStatus, failure_gate, percentile,
    percentile_ranks,
};
pub use sample::{PERCENTILES, SampleStatistics};
pub use scenario::{ScenarioAccumulator, ScenarioStatistics};
