//! What a few patterns say about many: expected width of an interval, and expected time.
//!
//! The width of an order-statistic interval is the distance of two quantiles of the sample. Where the
//! distribution is smooth it is proportional to the distance of their levels, `(u - l)/(n + 1)`, which is
//! known for every n. Times of patterns are independent; their mean and spread bound those of others.

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::{CONFIDENCE, Percentile, percentile_ranks_at};

/// Expected width over value of the interval of `pilot`'s percentile among `n` patterns, at the
/// two-sided `confidence`; none where the pilot, or n patterns, have no interval.
#[must_use]
pub fn expected_relative_width(
    pilot: &Percentile,
    pilot_patterns: u64,
    n: u64,
    confidence: f64,
) -> Option<f64> {
    let width = pilot.upper? - pilot.lower?;
    let (lower, upper) = (pilot.rank_lower?, pilot.rank_upper?);
    let of_pilot = (upper - lower) as f64 / (pilot_patterns as f64 + 1.0);
    let ranks = percentile_ranks_at(n, pilot.percent / 100.0, confidence);
    let of_n = (ranks.upper? - ranks.lower?) as f64 / (n as f64 + 1.0);
    Some(width / pilot.value?.abs() * of_n / of_pilot)
}

/// An expected sum with the interval that it lies in with [`CONFIDENCE`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ExpectedSum {
    /// Expected value.
    pub value: f64,
    /// Lower bound, at least 0.
    pub lower: f64,
    /// Upper bound; null where one value cannot say.
    pub upper: Option<f64>,
}

/// Expected sum of `n` values that are drawn like `sample`, those taken as normal: the error of the
/// mean and the spread of the sum itself.
#[must_use]
pub fn expected_sum(sample: &[f64], n: u64) -> ExpectedSum {
    let (m, n) = (sample.len() as f64, n as f64);
    let mean = sample.iter().sum::<f64>() / m.max(1.0);
    let squares: f64 = sample.iter().map(|value| (value - mean).powi(2)).sum();
    let reach = StudentsT::new(0.0, 1.0, m - 1.0).ok().map(|law| {
        let deviation = (squares / (m - 1.0)).sqrt();
        let t = law.inverse_cdf(0.5 + 0.5 * CONFIDENCE);
        t * deviation * (n * n / m + n).sqrt()
    });
    let value = n * mean;
    ExpectedSum {
        value,
        lower: reach.map_or(0.0, |reach| (value - reach).max(0.0)),
        upper: reach.map(|reach| value + reach),
    }
}

#[cfg(test)]
mod tests {
    use super::{expected_relative_width, expected_sum};
    use crate::population::statistics::{CONFIDENCE, percentile};

    #[test]
    fn the_width_of_a_uniform_sample_is_foretold() {
        let uniform =
            |n: u64| -> Vec<f64> { (1..=n).map(|i| 1.0 + i as f64 / (n + 1) as f64).collect() };
        let small = percentile(&uniform(100), 0, 50.0);
        let large = percentile(&uniform(1600), 0, 50.0);
        let width =
            (large.upper.unwrap_or(0.0) - large.lower.unwrap_or(0.0)) / large.value.unwrap_or(1.0);
        let expected = expected_relative_width(&small, 100, 1600, CONFIDENCE);
        assert!(
            (expected.unwrap_or(0.0) / width - 1.0).abs() < 0.02,
            "{expected:?}, {width}"
        );
        // Too few patterns on either side.
        assert_eq!(
            expected_relative_width(&percentile(&uniform(20), 0, 95.0), 20, 1600, CONFIDENCE),
            None
        );
        assert_eq!(expected_relative_width(&small, 100, 4, CONFIDENCE), None);
    }

    #[test]
    fn a_sum_has_the_error_of_the_mean_and_its_own() {
        // Mean 2, variance 1 of 4 values: t(3) = 3.182446.
        let sample = [
            1.0,
            1.0 + 2.0_f64.sqrt() / 2.0,
            3.0 - 2.0_f64.sqrt() / 2.0,
            3.0,
        ];
        let squares: f64 = sample.iter().map(|x| (x - 2.0_f64).powi(2)).sum();
        let sum = expected_sum(&sample, 10);
        let reach = 3.182_446 * (squares / 3.0).sqrt() * (25.0_f64 + 10.0).sqrt();
        assert!((sum.value - 20.0).abs() < 1e-12);
        assert!((sum.lower - (20.0 - reach).max(0.0)).abs() < 1e-4);
        assert!((sum.upper.unwrap_or(0.0) - 20.0 - reach).abs() < 1e-4);
        assert_eq!(expected_sum(&[3.0], 10).upper, None);
    }
}
