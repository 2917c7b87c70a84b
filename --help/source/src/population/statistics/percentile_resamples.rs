//! Resamples of a percentile of several quantities over the same patterns.
//!
//! A resample draws patterns with replacement and takes the rows of all quantities along, so that what
//! they share stays shared. Of a resample the percentile is a weighted mean of neighbouring order
//! statistics (Harrell & Davis 1982, with their window twice as wide and cut off at 2.5 of its
//! standard deviations): with the single order statistic the intervals of differences are far too wide
//! where quantities are correlated (a test of size 5 % has 2 %), with this window they are not. Where
//! rows failed it is the single order statistic all the same, whose bounds stay finite.

use rand::RngExt;
use rayon::prelude::*;
use serde::Serialize;

use super::beta_law::beta_below;
use super::point_rank;
use super::resampling::resampling_stream;

/// Width of the window over that of Harrell and Davis.
const WIDENING: f64 = 2.0;

/// Standard deviations of the window at which it is cut off.
const CUT_OFF: f64 = 2.5;

/// How the percentile of a resample is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PercentileEstimator {
    /// Weighted mean of neighbouring order statistics; no row failed.
    SmoothedOrderStatistics,
    /// One order statistic; failed rows stand at either infinity.
    OrderStatistic,
}

impl PercentileEstimator {
    /// The estimator for these columns.
    #[must_use]
    pub fn of(columns: &[&[Option<f64>]]) -> Self {
        if columns
            .iter()
            .all(|column| column.iter().all(Option::is_some))
        {
            Self::SmoothedOrderStatistics
        } else {
            Self::OrderStatistic
        }
    }
}

/// A percentile of one quantity: the estimate and its resamples, with failed rows at minus infinity
/// (`low`) and at plus infinity (`high`); both are the same without failures.
#[derive(Debug, Clone, PartialEq)]
pub struct PercentileResamples {
    /// Estimate, failed rows at minus infinity.
    pub low: f64,
    /// Estimate, failed rows at plus infinity.
    pub high: f64,
    /// Resamples of `low`.
    pub low_resamples: Vec<f64>,
    /// Resamples of `high`.
    pub high_resamples: Vec<f64>,
}

/// Resamples the percentile of every column; a column has a value, or none, for each of the same
/// patterns. Resamples come from the streams of `topic` under `seed`.
#[must_use]
pub fn resample_percentile(
    columns: &[&[Option<f64>]],
    percent: f64,
    estimator: PercentileEstimator,
    resamples: u32,
    (seed, topic): (u64, u32),
) -> Vec<PercentileResamples> {
    let n = columns.first().map_or(0, |column| column.len());
    if n == 0 {
        return Vec::new();
    }
    let window = Window::new(n, percent, estimator);
    let placed: Vec<[Placed; 2]> = columns
        .iter()
        .map(|column| [f64::NEG_INFINITY, f64::INFINITY].map(|at| Placed::new(column, at)))
        .collect();
    let failures = |place: usize| columns[place].iter().any(Option::is_none);
    // Both placements of every column, the second only where it differs.
    let estimates = |counts: &[u32]| -> Vec<[f64; 2]> {
        let of = |(place, [low, high]): (usize, &[Placed; 2])| {
            let low = window.estimate(low, counts);
            [
                low,
                if failures(place) {
                    window.estimate(high, counts)
                } else {
                    low
                },
            ]
        };
        placed.iter().enumerate().map(of).collect()
    };
    let whole = estimates(&vec![1; n]);
    let drawn: Vec<Vec<[f64; 2]>> = (0..resamples)
        .into_par_iter()
        .map(|resample| {
            let mut stream = resampling_stream(seed, topic, resample);
            let mut counts = vec![0_u32; n];
            for _ in 0..n {
                counts[stream.random_range(0..n as u32) as usize] += 1;
            }
            estimates(&counts)
        })
        .collect();
    let column = |place: usize| PercentileResamples {
        low: whole[place][0],
        high: whole[place][1],
        low_resamples: drawn.iter().map(|all| all[place][0]).collect(),
        high_resamples: drawn.iter().map(|all| all[place][1]).collect(),
    };
    (0..columns.len()).map(column).collect()
}

/// A column in ascending order, its failed rows at one infinity.
struct Placed {
    /// Rows in ascending order of their value.
    order: Vec<u32>,
    /// Values in that order.
    values: Vec<f64>,
}

impl Placed {
    fn new(column: &[Option<f64>], failed_at: f64) -> Self {
        let value = |row: u32| column[row as usize].unwrap_or(failed_at);
        let mut order: Vec<u32> = (0..column.len() as u32).collect();
        order.sort_by(|&a, &b| value(a).total_cmp(&value(b)));
        let values = order.iter().map(|&row| value(row)).collect();
        Self { order, values }
    }
}

/// Weights of neighbouring ranks.
struct Window {
    sample: usize,
    /// First rank with a weight, from 1.
    first: usize,
    weights: Vec<f64>,
}

impl Window {
    fn new(n: usize, percent: f64, estimator: PercentileEstimator) -> Self {
        match estimator {
            PercentileEstimator::OrderStatistic => Self {
                sample: n,
                first: point_rank(n as u64, percent) as usize,
                weights: vec![1.0],
            },
            PercentileEstimator::SmoothedOrderStatistics => Self::smoothed(n, percent / 100.0),
        }
    }

    /// Weight of rank i: the mass of Beta(m p, m (1 - p)) between (i - 1)/n and i/n, `m = (n + 1)` over
    /// the square of the widening.
    fn smoothed(n: usize, p: f64) -> Self {
        let m = (n as f64 + 1.0) / (WIDENING * WIDENING);
        let (a, b) = (m * p, m * (1.0 - p));
        let reach = CUT_OFF * (p * (1.0 - p) / (m + 1.0)).sqrt();
        let size = n as f64;
        let from = ((p - reach) * size).floor().max(0.0) as usize;
        let to = ((p + reach) * size).ceil().min(size) as usize;
        let mass = |rank: usize| beta_below(a, b, rank as f64 / size);
        let mut weights: Vec<f64> = (from..to).map(|rank| mass(rank + 1) - mass(rank)).collect();
        let total: f64 = weights.iter().sum();
        for weight in &mut weights {
            *weight /= total;
        }
        Self {
            sample: n,
            first: from + 1,
            weights,
        }
    }

    /// Estimate of a resample in which row i stands `counts[i]` times.
    fn estimate(&self, placed: &Placed, counts: &[u32]) -> f64 {
        let last = self.first + self.weights.len() - 1;
        let mut sum = 0.0;
        // Ranks of the resample, from the end that is nearer.
        if 2 * self.first > self.sample {
            let mut rank = self.sample;
            for (&row, &value) in placed.order.iter().zip(&placed.values).rev() {
                let lowest = rank - counts[row as usize] as usize;
                sum += self.weight(lowest + 1, rank.min(last), value);
                rank = lowest;
                if rank < self.first {
                    break;
                }
            }
        } else {
            let mut rank = 1;
            for (&row, &value) in placed.order.iter().zip(&placed.values) {
                let next = rank + counts[row as usize] as usize;
                sum += self.weight(rank, (next - 1).min(last), value);
                rank = next;
                if rank > last {
                    break;
                }
            }
        }
        sum
    }

    /// `value` times the weights of the ranks from `from` to `to`.
    fn weight(&self, from: usize, to: usize, value: f64) -> f64 {
        let from = from.max(self.first);
        if from > to {
            return 0.0;
        }
        let weights = &self.weights[from - self.first..=to - self.first];
        value * weights.iter().sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::{PercentileEstimator, Placed, Window};

    #[test]
    fn the_weights_are_a_mean_around_the_percentile() {
        for (n, percent) in [
            (72, 95.0),
            (200, 5.0),
            (1000, 50.0),
            (1000, 99.0),
            (100_000, 99.9),
        ] {
            let smoothed = PercentileEstimator::SmoothedOrderStatistics;
            let window = Window::new(n, percent, smoothed);
            let weights = &window.weights;
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let last = window.first + weights.len() - 1;
            assert!(window.first >= 1 && last <= n, "{n}, {percent}");
            let ranks = weights.iter().zip(window.first..);
            let centre: f64 = ranks.map(|(weight, rank)| weight * rank as f64).sum();
            let spread = (n as f64 * percent / 100.0 * (1.0 - percent / 100.0)).sqrt();
            assert!((centre - n as f64 * percent / 100.0).abs() < 0.5 + 0.25 * spread);
        }
    }

    #[test]
    fn an_estimate_of_counts_is_that_of_the_rows_written_out() {
        let column: Vec<Option<f64>> = (0..40).map(|i| Some(f64::from(i * 7 % 40))).collect();
        let counts: Vec<u32> = (0..40).map(|i| [0, 2, 1, 1][i % 4]).collect();
        let mut written: Vec<f64> = Vec::new();
        for (value, &count) in column.iter().zip(&counts) {
            written.extend(std::iter::repeat_n(value.unwrap_or(0.0), count as usize));
        }
        written.sort_by(f64::total_cmp);
        assert_eq!(written.len(), 40);
        let placed = Placed::new(&column, f64::INFINITY);
        for percent in [10.0, 50.0, 60.0, 90.0] {
            for estimator in [
                PercentileEstimator::OrderStatistic,
                PercentileEstimator::SmoothedOrderStatistics,
            ] {
                let window = Window::new(40, percent, estimator);
                let ranks = window.weights.iter().zip(window.first - 1..);
                let expected: f64 = ranks.map(|(weight, place)| weight * written[place]).sum();
                let found = window.estimate(&placed, &counts);
                assert!(
                    (found - expected).abs() < 1e-12,
                    "P{percent}: {found}, {expected}"
                );
            }
        }
    }
}
