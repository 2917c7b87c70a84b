//! Difference and ratio of a percentile between two populations, with intervals.
//!
//! Percentile intervals of a bootstrap (Efron & Tibshirani 1993, chapter 13) over pairs of rows of the
//! same pattern, or over both populations apart. A failed row stands where it does most harm: for the
//! lower bound at minus infinity in the candidate and at plus infinity in the baseline, for the upper
//! bound the other way round, so that no pair is dropped.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

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
    /// Percentile of the baseline, as an order statistic.
    pub baseline: Percentile,
    /// Percentile of the candidate, as an order statistic.
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
    /// Smallest value that `p_value` can have: the one where no resample has the other sign. There the
    /// probability is this or less.
    pub p_value_floor: Option<f64>,
}

impl PercentileComparison {
    /// Whether `p_value` is as small as it can be, so that it is an upper bound.
    #[must_use]
    pub fn is_at_floor(&self) -> bool {
        self.p_value
            .zip(self.p_value_floor)
            .is_some_and(|(value, floor)| value <= floor)
    }
}

/// Values beyond a percentile from which on percentile intervals of resamples are taken as they are.
const MANY_BEYOND: f64 = 10.0;

/// Degrees of freedom for each value beyond the percentile, where these are fewer.
const DEGREES_PER_VALUE: f64 = 2.5;

/// Percentile intervals of resamples are too narrow where few values lie beyond the percentile: a test
/// of size 5 % has 9 % with four. They are then expanded (Hesterberg 2015, section 3.3): tails are those
/// of Student's t instead of the normal law, its degrees of freedom in proportion to these values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Expansion {
    law: Option<StudentsT>,
}

impl Expansion {
    /// The expansion for the percentile `percent` of `n` values.
    #[must_use]
    pub fn of(n: u64, percent: f64) -> Self {
        let beyond = n as f64 * percent.min(100.0 - percent) / 100.0;
        // Rounding must not make ten into less.
        let few = beyond < MANY_BEYOND * (1.0 - 1e-12);
        let law = few.then(|| StudentsT::new(0.0, 1.0, DEGREES_PER_VALUE * beyond).ok());
        Self { law: law.flatten() }
    }

    /// One-sided share of resamples to leave out in place of `tail`.
    #[must_use]
    pub fn tail(&self, tail: f64) -> f64 {
        let normal = Normal::standard();
        self.law
            .map_or(tail, |law| normal.cdf(law.inverse_cdf(tail)))
    }

    /// One-sided probability that a share of resamples stands for; the inverse of [`Self::tail`].
    #[must_use]
    pub fn probability(&self, share: f64) -> f64 {
        let normal = Normal::standard();
        self.law
            .map_or(share, |law| law.cdf(normal.inverse_cdf(share)))
    }
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
        p_value_floor: None,
    };
    let Some((x, y)) = resamples else {
        return comparison;
    };
    let points = match estimator {
        PercentileEstimator::SmoothedOrderStatistics => Some((x.low, y.low)),
        PercentileEstimator::OrderStatistic => baseline.value.zip(candidate.value),
    };
    let size = baseline_values.len().min(candidate_values.len()) as u64;
    let expansion = match estimator {
        PercentileEstimator::SmoothedOrderStatistics => Expansion::of(size, percent),
        // Conservative as it is.
        PercentileEstimator::OrderStatistic => Expansion::default(),
    };
    let bounds = |contrast: fn(f64, f64) -> f64| Bounds::new(&x, &y, contrast, expansion);
    let differences = bounds(|x, y| y - x);
    comparison.p_value = Some(differences.p_value(0.0));
    comparison.p_value_floor = Some(differences.p_value_floor());
    comparison.difference = Some(differences.estimate(points.map(|(x, y)| y - x)));
    // A ratio has a sense, and grows with the candidate, for positive values only.
    let positive = |values: &[f64]| values.first().is_some_and(|&lowest| lowest > 0.0);
    if positive(&baseline_values) && positive(&candidate_values) {
        let ratios = bounds(ratio);
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
    expansion: Expansion,
}

impl Bounds {
    fn new(
        baseline: &PercentileResamples,
        candidate: &PercentileResamples,
        contrast: fn(f64, f64) -> f64,
        expansion: Expansion,
    ) -> Self {
        let of = |x: &[f64], y: &[f64]| -> Vec<f64> {
            let mut values: Vec<f64> = x.iter().zip(y).map(|(&x, &y)| contrast(x, y)).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        Self {
            lowest: of(&baseline.high_resamples, &candidate.low_resamples),
            highest: of(&baseline.low_resamples, &candidate.high_resamples),
            expansion,
        }
    }

    fn estimate(&self, value: Option<f64>) -> IntervalEstimate {
        let count = self.lowest.len();
        let tail = self.expansion.tail(0.5 * (1.0 - CONFIDENCE)) * (count as f64 + 1.0);
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
        self.two_sided(share(not_above).min(share(not_below)))
    }

    /// Two-sided probability where no resample is on the other side of the contrast: the smallest that
    /// so many resamples can give.
    fn p_value_floor(&self) -> f64 {
        self.two_sided(1.0 / (1.0 + self.lowest.len() as f64))
    }

    fn two_sided(&self, share: f64) -> f64 {
        (2.0 * self.expansion.probability(share)).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Expansion;

    #[test]
    fn tails_are_expanded_where_few_values_lie_beyond_the_percentile() {
        for (n, percent) in [(200, 95.0), (1000, 99.0), (400, 97.5), (20, 50.0)] {
            assert_eq!(
                Expansion::of(n, percent),
                Expansion::default(),
                "{n}, P{percent}"
            );
        }
        assert!((Expansion::default().tail(0.025) - 0.025).abs() < 1e-15);
        // 4 values, 10 degrees of freedom: t = 2.228139, and the normal law beyond it 0.012936.
        for (n, percent) in [(80, 95.0), (80, 5.0), (400, 99.0)] {
            let expansion = Expansion::of(n, percent);
            assert!((expansion.tail(0.025) - 0.012_936).abs() < 1e-5);
            for share in [0.3, 0.025, 0.001] {
                let there = expansion.probability(expansion.tail(share));
                assert!((there / share - 1.0).abs() < 1e-6, "{there}, {share}");
            }
        }
    }
}
