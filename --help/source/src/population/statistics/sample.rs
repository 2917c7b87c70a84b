//! Moments and percentiles of one quantity over the patterns of a scenario.

use serde::Serialize;

use super::{CONFIDENCE, Percentile, percentile_at};

/// Percentiles that `scenarios.parquet` and every summary give, in percent.
pub const PERCENTILES: [u32; 4] = [5, 50, 95, 99];

/// Percentiles of `percentiles.parquet`, in percent; those of [`PERCENTILES`] among them.
pub const PERCENTILE_LEVELS: [f64; 10] = [1.0, 5.0, 10.0, 25.0, 50.0, 75.0, 90.0, 95.0, 99.0, 99.9];

/// Statistics of one quantity; moments are over the rows that have a value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SampleStatistics {
    /// Mean.
    pub mean: Option<f64>,
    /// Standard deviation with divisor n - 1.
    pub standard_deviation: Option<f64>,
    /// Percentiles in the order of [`PERCENTILE_LEVELS`].
    pub percentiles: Vec<Percentile>,
}

impl SampleStatistics {
    /// Statistics of `values` beside `failed` rows without value.
    #[must_use]
    pub fn new(mut values: Vec<f64>, failed: u64) -> Self {
        values.sort_unstable_by(f64::total_cmp);
        Self::of_sorted(&values, failed, CONFIDENCE)
    }

    /// Statistics of `sorted` values (ascending) beside `failed` rows without value; bounds at the
    /// two-sided `confidence`.
    #[must_use]
    pub fn of_sorted(sorted: &[f64], failed: u64, confidence: f64) -> Self {
        let (mean, standard_deviation) = moments(sorted);
        Self {
            mean,
            standard_deviation,
            percentiles: PERCENTILE_LEVELS
                .iter()
                .map(|&percent| percentile_at(sorted, failed, percent, confidence))
                .collect(),
        }
    }

    /// The percentile of `percent`, one of [`PERCENTILES`].
    #[must_use]
    pub fn percentile(&self, percent: u32) -> Option<&Percentile> {
        self.percentiles
            .iter()
            .find(|found| found.percent.total_cmp(&f64::from(percent)).is_eq())
    }
}

/// Mean and standard deviation in two passes, over values in ascending order: the result does not
/// depend on the order of the rows.
fn moments(sorted: &[f64]) -> (Option<f64>, Option<f64>) {
    if sorted.is_empty() {
        return (None, None);
    }
    let n = sorted.len() as f64;
    let mean = sorted.iter().sum::<f64>() / n;
    let squares: f64 = sorted.iter().map(|value| (value - mean).powi(2)).sum();
    let deviation = (sorted.len() > 1).then(|| (squares / (n - 1.0)).sqrt());
    (Some(mean), deviation)
}
