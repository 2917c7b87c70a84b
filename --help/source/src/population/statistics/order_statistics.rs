//! Percentiles as order statistics with exact, distribution-free intervals that bound failures.
//!
//! Of n independent values, `x_(l) <= q_p <= x_(u)` fails below with probability
//! `P(B <= l - 1)` and above with `P(B >= u)`, `B ~ Binomial(n, p)` (David & Nagaraja 2003,
//! section 7.1); ties make it more certain. Failed rows have values too, which nobody knows: they
//! stand at minus infinity for the lower end and at plus infinity for the upper end.

use serde::Serialize;

use super::CONFIDENCE;
use super::binomial::{lower_tail, upper_tail};

/// Ranks of an equal-tailed interval, from 1; none where n values are too few.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PercentileRanks {
    /// Rank of the lower end.
    pub lower: Option<u64>,
    /// Rank of the upper end.
    pub upper: Option<u64>,
    /// Probability that the interval holds the percentile, when both ends exist.
    pub coverage: Option<f64>,
}

/// Whether a percentile has a point value, and why not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PointStatus {
    /// The percentile has a point value.
    Estimated,
    /// The sample is too small for a two-sided interval.
    TooFewPatterns {
        /// Smallest sample that has one.
        needed: u64,
    },
    /// More rows failed than a tenth of the smaller tail.
    TooManyFailures,
}

impl PointStatus {
    /// Name in tables, `snake_case`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Estimated => "estimated",
            Self::TooFewPatterns { .. } => "too_few_patterns",
            Self::TooManyFailures => "too_many_failures",
        }
    }
}

/// A percentile of one quantity over the patterns of a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Percentile {
    /// The percentile in percent.
    pub percent: f64,
    /// Order statistic `x_(ceil(p n))` of the good values.
    pub value: Option<f64>,
    /// Lower bound.
    pub lower: Option<f64>,
    /// Upper bound.
    pub upper: Option<f64>,
    /// Rank of the lower bound among the planned patterns, from 1.
    pub rank_lower: Option<u64>,
    /// Rank of the upper bound among the planned patterns, from 1.
    pub rank_upper: Option<u64>,
    /// Probability that the interval of these ranks holds the percentile, whatever the law is; at
    /// least that wanted.
    pub achieved_coverage: Option<f64>,
    /// Why `value` is there or not.
    pub status: PointStatus,
}

/// Ranks of the equal-tailed interval of the `p`-quantile, `0 < p < 1`, among `n` values, at
/// [`CONFIDENCE`].
#[must_use]
pub fn percentile_ranks(n: u64, p: f64) -> PercentileRanks {
    percentile_ranks_at(n, p, CONFIDENCE)
}

/// Ranks of the equal-tailed interval of the `p`-quantile, `0 < p < 1`, among `n` values, at the
/// two-sided `confidence`.
#[must_use]
pub fn percentile_ranks_at(n: u64, p: f64, confidence: f64) -> PercentileRanks {
    let tail = 0.5 * (1.0 - confidence);
    // Largest l in 1..=n with P(B <= l - 1) <= tail; the tail grows with l.
    let lower = partition_point(n, |l| lower_tail(n, p, l - 1) <= tail);
    // Smallest u in 1..=n with P(B >= u) <= tail; the tail falls with u.
    let upper = partition_point(n, |u| upper_tail(n, p, u) > tail) + 1;
    let lower = (lower >= 1).then_some(lower);
    let upper = (upper <= n).then_some(upper);
    PercentileRanks {
        lower,
        upper,
        coverage: lower
            .zip(upper)
            .map(|(l, u)| 1.0 - lower_tail(n, p, l - 1) - upper_tail(n, p, u)),
    }
}

/// Number of leading ranks of `1..=n` for which `holds`, which is true up to some rank only.
fn partition_point(n: u64, holds: impl Fn(u64) -> bool) -> u64 {
    let (mut yes, mut no) = (0, n + 1);
    while no - yes > 1 {
        let middle = yes + (no - yes) / 2;
        if holds(middle) {
            yes = middle;
        } else {
            no = middle;
        }
    }
    yes
}

/// Largest share of failed rows under which the `p`-quantile keeps its point value.
#[must_use]
pub fn failure_gate(p: f64) -> f64 {
    p.min(1.0 - p) / 10.0
}

/// Smallest n with a two-sided interval: `max(p, 1 - p)^n <= (1 - confidence) / 2`.
#[must_use]
pub fn smallest_sample(p: f64, confidence: f64) -> u64 {
    let tail = 0.5 * (1.0 - confidence);
    (tail.ln() / p.max(1.0 - p).ln()).ceil() as u64
}

/// Smallest n for which the `order`-th largest of n values bounds the `p`-quantile from above with
/// `confidence`, one-sided (Wilks 1941): `P(B <= n - order) >= confidence`, `B ~ Binomial(n, p)`.
#[must_use]
pub fn wilks_sample(p: f64, confidence: f64, order: u64) -> u64 {
    let bounds = |n: u64| n >= order && lower_tail(n, p, n - order) >= confidence;
    let mut enough = order.max(1);
    while !bounds(enough) {
        enough *= 2;
    }
    // The probability grows with n.
    partition_point(enough, |n| !bounds(n)) + 1
}

/// The percentile of `sorted` good values (ascending) beside `failed` rows without value, `percent`
/// between 0 and 100, at [`CONFIDENCE`].
#[must_use]
pub fn percentile(sorted: &[f64], failed: u64, percent: impl Into<f64>) -> Percentile {
    percentile_at(sorted, failed, percent.into(), CONFIDENCE)
}

/// The percentile of `sorted` good values (ascending) beside `failed` rows without value, `percent`
/// between 0 and 100, at the two-sided `confidence`.
#[must_use]
pub fn percentile_at(sorted: &[f64], failed: u64, percent: f64, confidence: f64) -> Percentile {
    let p = percent / 100.0;
    let good = sorted.len() as u64;
    let planned = good + failed;
    let ranks = percentile_ranks_at(planned, p, confidence);
    let at = |rank: u64| -> Option<f64> {
        let place = usize::try_from(rank.checked_sub(1)?).ok()?;
        sorted.get(place).copied()
    };
    let status = if ranks.lower.is_none() || ranks.upper.is_none() {
        PointStatus::TooFewPatterns {
            needed: smallest_sample(p, confidence),
        }
    } else if failed as f64 > failure_gate(p) * planned as f64 * (1.0 + 1e-12) {
        PointStatus::TooManyFailures
    } else {
        PointStatus::Estimated
    };
    Percentile {
        percent,
        value: match status {
            PointStatus::Estimated => at(point_rank(good, percent)),
            _ => None,
        },
        lower: ranks.lower.and_then(|l| at(l.saturating_sub(failed))),
        upper: ranks.upper.and_then(at),
        rank_lower: ranks.lower,
        rank_upper: ranks.upper,
        achieved_coverage: ranks.coverage,
        status,
    }
}

/// Rank `ceil(percent n / 100)` of the point value among `n` values, from 1.
#[must_use]
pub fn point_rank(n: u64, percent: f64) -> u64 {
    // Rounding must not lift a whole number to the next rank.
    let rank = percent * n as f64 / 100.0 * (1.0 - 1e-12);
    (rank.ceil() as u64).max(1)
}
