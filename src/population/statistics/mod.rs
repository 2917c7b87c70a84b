//! Accounting by status, moments and order statistics with distribution-free intervals.

mod accounting;
mod binomial;
mod distribution_band;
mod order_statistics;
mod sample;
mod scenario;

pub use accounting::Accounting;
pub use binomial::{proportion_interval, proportion_upper_bound};
pub use distribution_band::{BandPoint, DistributionBand, dkw_half_width};
pub use order_statistics::{
    CONFIDENCE, Percentile, PercentileRanks, PointStatus, failure_gate, percentile, percentile_at,
    percentile_ranks, percentile_ranks_at, point_rank, smallest_sample, wilks_sample,
};
pub use sample::{PERCENTILE_LEVELS, PERCENTILES, SampleStatistics};
pub use scenario::{ScenarioAccumulator, ScenarioStatistics};
