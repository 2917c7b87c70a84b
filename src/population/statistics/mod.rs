//! Accounting by status, moments and order statistics with distribution-free intervals.

mod accounting;
mod binomial;
mod order_statistics;
mod sample;
mod scenario;

pub use accounting::Accounting;
pub use order_statistics::{
    CONFIDENCE, Percentile, PercentileRanks, PointStatus, failure_gate, percentile,
    percentile_ranks,
};
pub use sample::{PERCENTILES, SampleStatistics};
pub use scenario::{ScenarioAccumulator, ScenarioStatistics};
