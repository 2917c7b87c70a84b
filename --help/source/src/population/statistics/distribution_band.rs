//! A band that holds the whole distribution at once, and bounds failures.
//!
//! With `n` independent values the largest distance between the empirical and the true distribution
//! exceeds `sqrt(ln(2 / alpha) / (2 n))` with probability at most `alpha` (Dvoretzky, Kiefer &
//! Wolfowitz 1956 with the constant of Massart 1990). Failed rows stand at plus infinity for the
//! lower edge and at minus infinity for the upper one. The width is the same everywhere, so that the
//! band says nothing about percentiles beyond `1 - half width`: those have order statistics.

use super::CONFIDENCE;

/// Most points that a band is given at.
const MOST_POINTS: usize = 1000;

/// Points at each end of a thinned band that are kept one by one.
const END_POINTS: usize = 100;

/// The distribution of one quantity with its simultaneous band.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DistributionBand {
    /// Half width of the band, a probability; none without rows.
    pub half_width: Option<f64>,
    /// Points in ascending order of their value.
    pub points: Vec<BandPoint>,
}

/// The distribution function at one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandPoint {
    /// The value, one of the sample.
    pub value: f64,
    /// Share of the rows with a result that are at most `value`.
    pub cumulative: f64,
    /// Lower edge of the band at `value`.
    pub lower: f64,
    /// Upper edge of the band at `value`.
    pub upper: f64,
}

/// Half width of the band of `n` values at the two-sided `confidence`.
#[must_use]
pub fn dkw_half_width(n: u64, confidence: f64) -> f64 {
    ((2.0 / (1.0 - confidence)).ln() / (2.0 * n as f64)).sqrt()
}

impl DistributionBand {
    /// The band at [`CONFIDENCE`] of `sorted` values (ascending) beside `failed` rows without value, at
    /// every value of a small sample, and at 1000 of a large one, those of the tails among them.
    #[must_use]
    pub fn new(sorted: &[f64], failed: u64) -> Self {
        Self::at(sorted, failed, CONFIDENCE)
    }

    /// The band at `confidence` of `sorted` values (ascending) beside `failed` rows without value, at
    /// every value of a small sample, and at 1000 of a large one, those of the tails among them.
    #[must_use]
    pub fn at(sorted: &[f64], failed: u64, confidence: f64) -> Self {
        let good = sorted.len();
        let planned = good as f64 + failed as f64;
        if planned < 1.0 {
            return Self::default();
        }
        let half_width = dkw_half_width(good as u64 + failed, confidence);
        let point = |rank: usize| {
            let value = sorted[rank - 1];
            // Ties count all: the distribution function is continuous from the right.
            let below = sorted.partition_point(|other| other.total_cmp(&value).is_le());
            BandPoint {
                value,
                cumulative: below as f64 / good as f64,
                lower: (below as f64 / planned - half_width).max(0.0),
                upper: ((below as f64 + failed as f64) / planned + half_width).min(1.0),
            }
        };
        let mut points: Vec<BandPoint> = shown_ranks(good).into_iter().map(point).collect();
        points.dedup_by(|a, b| a.value.total_cmp(&b.value).is_eq());
        Self {
            half_width: Some(half_width),
            points,
        }
    }
}

/// Ranks at which a band of `n` values is given, ascending, from 1.
fn shown_ranks(n: usize) -> Vec<usize> {
    if n <= MOST_POINTS {
        return (1..=n).collect();
    }
    let between = MOST_POINTS - 2 * END_POINTS;
    let inner = n - 2 * END_POINTS;
    (1..=END_POINTS)
        .chain((0..between).map(|step| END_POINTS + 1 + step * inner / between))
        .chain(n - END_POINTS + 1..=n)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{DistributionBand, dkw_half_width, shown_ranks};

    #[test]
    fn half_widths_are_those_of_the_published_table() {
        for (n, half_width) in [(1_000, 0.0430), (10_000, 0.0136), (100_000, 0.0043)] {
            assert!((dkw_half_width(n, 0.95) - half_width).abs() < 6e-5, "{n}");
        }
    }

    #[test]
    fn a_thinned_band_keeps_both_tails_and_ascends() {
        for n in [1000, 1001, 1199, 5000, 1_000_003] {
            let ranks = shown_ranks(n);
            assert_eq!(ranks.len(), 1000);
            assert!(ranks.windows(2).all(|pair| pair[0] < pair[1]), "{n}");
            assert_eq!((ranks[99], ranks[900], ranks[999]), (100, n - 99, n));
        }
    }

    #[test]
    fn ties_are_one_step_and_failures_widen_the_band_on_both_sides() {
        let band = DistributionBand::new(&[1.0, 2.0, 2.0, 2.0, 5.0], 5);
        let half_width = dkw_half_width(10, 0.95);
        assert_eq!(band.half_width, Some(half_width));
        let values: Vec<f64> = band.points.iter().map(|point| point.value).collect();
        assert_eq!(values, [1.0, 2.0, 5.0]);
        let middle = band.points[1];
        assert!((middle.cumulative - 0.8).abs() < 1e-15);
        assert!((middle.lower - (0.4 - half_width).max(0.0)).abs() < 1e-15);
        assert!((middle.upper - (0.9 + half_width).min(1.0)).abs() < 1e-15);
        assert_eq!(DistributionBand::new(&[], 0), DistributionBand::default());
        assert!(DistributionBand::new(&[], 3).points.is_empty());
    }
}
