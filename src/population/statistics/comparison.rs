//! Difference and ratio of a percentile between two populations, with intervals.
//!
//! Percentile intervals of a bootstrap (Efron & Tibshirani 1993, chapter 13) over pairs of rows of the
//! same pattern, or over both populations apart. A failed row stands where it does most harm: for the
//! lower bound at minus infinity in the candidate and at plus infinity in the baseline, for the upper
//! bound the other way round, so that no pair is dropped.

use serde::Serialize;

use super::percentile_resamples::{PercentileEstimator, PercentileResamples, resample_percentile};
use super::{CONFIDENCE, Percentile, PointStatus, percentile};

/// An estimate with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct IntervalEstimate {
    /// The estimate; null where too many rows failed.
    pub value: Option<f64>,
    /// Lower bound; null = there is none.
    pub lower: Option<f64>,
    /// Upper bound; null = there is none.
    pub upper: Option<f64>,
}

/// A percentile of a candidate compared with that of a baseline.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PercentileComparison {
    /// Of the baseline, as an order statistic.
    pub baseline: Percentile,
    /// Of the candidate, as an order statistic.
    pub candidate: Percentile,
    /// How the percentiles of difference and ratio are taken.
    pub estimator: PercentileEstimator,
    /// Candidate minus baseline; null where either is not estimable.
    pub difference: Option<IntervalEstimate>,
    /// Candidate over baseline; null where either is not estimable.
    pub ratio: Option<IntervalEstimate>,
    /// Two-sided probability of such a difference if there were none, failed rows at their worst;
    /// at most 0.05 where the interval of the difference excludes 0.
    pub p_value: Option<f64>,
}

/// Compares over pairs: both columns have a value, or none, for each of the same patterns.
#[must_use]
pub fn compare_paired(
    baseline: &[Option<f64>],
    candidate: &[Option<f64>],
    percent: f64,
    resamples: u32,
    (seed, topic): (u64, u32),
) -> PercentileComparison {
    let columns = [baseline, candidate];
    let estimator = PercentileEstimator::of(&columns);
    let mut both = resample_percentile(&columns, percent, estimator, resamples, (seed, topic));
    let last = both.pop();
    compare(columns, percent, estimator, both.pop().zip(last))
}

/// Compares populations that share no pattern: each is resampled by itself, from the streams of
/// `topic` and `topic + 1`.
#[must_use]
pub fn compare_independent(
    baseline: &[Option<f64>],
    candidate: &[Option<f64>],
    percent: f64,
    resamples: u32,
    (seed, topic): (u64, u32),
) -> PercentileComparison {
    let columns = [baseline, candidate];
    let estimator = PercentileEstimator::of(&columns);
    let alone = |column: &[Option<f64>], topic: u32| {
        resample_percentile(&[column], percent, estimator, resamples, (seed, topic)).pop()
    };
    let both = alone(baseline, topic).zip(alone(candidate, topic + 1));
    compare(columns, percent, estimator, both)
}

fn compare(
    [baseline, candidate]: [&[Option<f64>]; 2],
    percent: f64,
    estimator: PercentileEstimator,
    resamples: Option<(PercentileResamples, PercentileResamples)>,
) -> PercentileComparison {
    let of = |column: &[Option<f64>]| {
        let mut good: Vec<f64> = column.iter().flatten().copied().collect();
        good.sort_unstable_by(f64::total_cmp);
        let failed = (column.len() - good.len()) as u64;
        (percentile(&good, failed, percent), good)
    };
    let ((baseline, baseline_values), (candidate, candidate_values)) =
        (of(baseline), of(candidate));
    let few = |found: &Percentile| matches!(found.status, PointStatus::TooFewPatterns { .. });
    let resamples = resamples.filter(|_| !few(&baseline) && !few(&candidate));
    let mut comparison = PercentileComparison {
        baseline,
        candidate,
        estimator,
        difference: None,
        ratio: None,
        p_value: None,
    };
    let Some((x, y)) = resamples else {
        return comparison;
    };
    let points = match estimator {
        PercentileEstimator::SmoothedOrderStatistics => Some((x.low, y.low)),
        PercentileEstimator::OrderStatistic => baseline.value.zip(candidate.value),
    };
    let differences = Bounds::new(&x, &y, |x, y| y - x);
    comparison.p_value = Some(differences.p_value(0.0));
    comparison.difference = Some(differences.estimate(points.map(|(x, y)| y - x)));
    // A ratio has a sense, and grows with the candidate, for positive values only.
    let positive = |values: &[f64]| values.first().is_some_and(|&lowest| lowest > 0.0);
    if positive(&baseline_values) && positive(&candidate_values) {
        let ratios = Bounds::new(&x, &y, ratio);
        comparison.ratio = Some(ratios.estimate(points.map(|(x, y)| y / x)));
    }
    comparison
}

/// `y / x` of positive values, one of which may be an infinity that stands for a failed row.
fn ratio(x: f64, y: f64) -> f64 {
    if y < 0.0 || x == f64::INFINITY {
        0.0
    } else if x < 0.0 {
        f64::INFINITY
    } else {
        y / x
    }
}

/// Resamples of a contrast that grows with the candidate and falls with the baseline, at the worst of
/// the failed rows for either bound, ascending.
struct Bounds {
    lowest: Vec<f64>,
    highest: Vec<f64>,
}

impl Bounds {
    fn new(
        baseline: &PercentileResamples,
        candidate: &PercentileResamples,
        contrast: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let of = |x: &[f64], y: &[f64]| -> Vec<f64> {
            let mut values: Vec<f64> = x.iter().zip(y).map(|(&x, &y)| contrast(x, y)).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        Self {
            lowest: of(&baseline.high_resamples, &candidate.low_resamples),
            highest: of(&baseline.low_resamples, &candidate.high_resamples),
        }
    }

    fn estimate(&self, value: Option<f64>) -> IntervalEstimate {
        let count = self.lowest.len();
        let tail = 0.5 * (1.0 - CONFIDENCE) * (count as f64 + 1.0);
        let place = (tail.floor() as usize).max(1);
        let finite = |value: f64| value.is_finite().then_some(value);
        IntervalEstimate {
            value,
            lower: finite(self.lowest[place - 1]),
            upper: finite(self.highest[count - place]),
        }
    }

    /// Two-sided, against the contrast `null`; the interval excludes it where this is at most 0.05.
    fn p_value(&self, null: f64) -> f64 {
        let share = |count: usize| (1.0 + count as f64) / (1.0 + self.lowest.len() as f64);
        let not_above = self.lowest.partition_point(|&value| value <= null);
        let not_below = self.highest.len() - self.highest.partition_point(|&value| value < null);
        (2.0 * share(not_above).min(share(not_below))).min(1.0)
    }
}
