//! What a sample of numerical errors says of the errors of all rows.

use serde::{Deserialize, Serialize};

use super::{CONFIDENCE, percentile_ranks_at, point_rank};
use crate::population::monte_carlo::LoadCaseName;

/// Share of the rows whose errors a bound is to hold for.
const SHARE: f64 = 0.95;
/// Standard normal quantile of the confidence of a bound, 0.95, one-sided.
const CONFIDENCE_QUANTILE: f64 = 1.644_853_626_951_472_7;
/// Standard normal quantile of 0.975: 95 % of a normal law lie within as many standard deviations on
/// both sides of its mean.
const SHARE_QUANTILE: f64 = 1.959_963_984_540_054;
/// Share of the rows whose errors are called the worst of all.
const NEARLY_ALL: f64 = 0.999;
/// Standard normal quantile of 0.9995.
const NEARLY_ALL_QUANTILE: f64 = 3.290_526_731_491_895;
/// Fewest errors of which a tolerance bound is made.
const FEWEST: usize = 4;

/// Sizes of the relative errors of a sample of rows. A row without result has an infinite error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorBound {
    /// Rows of the sample.
    pub rows: u64,
    /// Rows without a result.
    pub failed: u64,
    /// Median.
    pub median: f64,
    /// 95th percentile of the sample, `x_(ceil(0.95 n))`.
    pub p95: f64,
    /// Upper bound, with 95 % confidence, of the 95th percentile over all rows: an order statistic from
    /// 59 rows on; of fewer the tolerance bound of a normal law, and at least the largest error seen.
    pub p95_upper: f64,
    /// Largest.
    pub worst: f64,
    /// Upper bound, with 95 % confidence, of the 99.9th percentile over all rows: an order statistic from
    /// 2995 rows on; of fewer the tolerance bound of a normal law, and at least the largest error seen.
    pub p999_upper: f64,
}

/// Errors of the rows of one load case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LoadCaseErrors {
    /// The load case.
    pub load_case: LoadCaseName,
    /// Errors of the peak amplitude; none where no row has a reference.
    pub amplitude: Option<ErrorBound>,
}

impl ErrorBound {
    /// Of signed relative errors; `None` is a row without result. None without any row.
    #[must_use]
    pub fn of(errors: &[Option<f64>]) -> Option<Self> {
        let mut sizes: Vec<f64> = errors
            .iter()
            .map(|error| error.map_or(f64::INFINITY, f64::abs))
            .collect();
        sizes.sort_by(f64::total_cmp);
        let worst = *sizes.last()?;
        let n = sizes.len() as u64;
        let at = |percent: f64| sizes[point_rank(n, percent) as usize - 1];
        let upper =
            |share: f64, quantile: f64| match percentile_ranks_at(n, share, 2.0 * CONFIDENCE - 1.0)
                .upper
            {
                Some(rank) => sizes[rank as usize - 1],
                None => tolerance_bound(errors, quantile).max(worst),
            };
        Some(Self {
            rows: n,
            failed: errors.iter().filter(|error| error.is_none()).count() as u64,
            median: at(50.0),
            p95: at(100.0 * SHARE),
            p95_upper: upper(SHARE, SHARE_QUANTILE),
            worst,
            p999_upper: upper(NEARLY_ALL, NEARLY_ALL_QUANTILE),
        })
    }

    /// What the worst amplitude error of a setting is claimed to be at most: the bound of the 99.9th
    /// percentile, and `peak_tolerance`, which a search may be short by in rows too rare to be in a sample.
    #[must_use]
    pub fn worst_upper(&self, peak_tolerance: f64) -> f64 {
        self.p999_upper + peak_tolerance
    }
}

/// `|mean| + k s` with the factor k of a one-sided tolerance bound of a normal law (Natrella 1963, NBS
/// Handbook 91, section 2-5.3): `k = (z_p + sqrt(z_p^2 - a b)) / a`, `a = 1 - z_c^2 / (2 (n - 1))`,
/// `b = z_p^2 - z_c^2 / n`, where `share` is `z_p`.
fn tolerance_bound(errors: &[Option<f64>], share: f64) -> f64 {
    let Some(values) = errors.iter().copied().collect::<Option<Vec<f64>>>() else {
        return f64::INFINITY;
    };
    if values.len() < FEWEST {
        return f64::INFINITY;
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let deviation = (square / (n - 1.0)).sqrt();
    let confidence = CONFIDENCE_QUANTILE.powi(2);
    let a = 1.0 - confidence / (2.0 * (n - 1.0));
    let b = share * share - confidence / n;
    let factor = (share + (share * share - a * b).sqrt()) / a;
    mean.abs() + factor * deviation
}

#[cfg(test)]
mod tests {
    use super::ErrorBound;

    fn of(errors: impl IntoIterator<Item = f64>) -> ErrorBound {
        let errors: Vec<Option<f64>> = errors.into_iter().map(Some).collect();
        ErrorBound::of(&errors).expect("not empty")
    }

    #[test]
    fn sizes_are_ranked_and_a_failed_row_is_the_worst() {
        let bound = of([0.1, -0.4, 0.2, -0.3]);
        assert_eq!((bound.median, bound.p95, bound.worst), (0.2, 0.4, 0.4));
        let failed = ErrorBound::of(&[Some(0.1), None, Some(0.2)]).expect("not empty");
        assert_eq!((failed.failed, failed.median), (1, 0.2));
        assert!(failed.worst.is_infinite() && failed.p95_upper.is_infinite());
        assert!(ErrorBound::of(&[]).is_none());
    }

    #[test]
    fn from_59_rows_on_the_bound_is_an_order_statistic() {
        // 1 - 0.95^59 = 0.9515 >= 0.95 > 1 - 0.95^58.
        let ramp = |n: u32| of((1..=n).map(|i| f64::from(i) / f64::from(n)));
        assert!((ramp(59).p95_upper - 1.0).abs() < 1e-15);
        assert!(ramp(58).p95_upper > 1.0);
        // Of 200 rows P(B >= 196) <= 0.05 < P(B >= 195) for B ~ Binomial(200, 0.95).
        assert!((ramp(200).p95_upper - 196.0 / 200.0).abs() < 1e-15);
    }

    #[test]
    fn the_tolerance_factor_is_that_of_the_tables() {
        // One-sided factors for 97.5 % of a normal law with 95 % confidence, from the noncentral t law.
        for (n, exact) in [(10_u32, 3.402), (24, 2.710)] {
            let half = f64::from(n - 1).sqrt() / f64::from(n).sqrt();
            let bound = of((0..n).map(|i| if i % 2 == 0 { half } else { -half }));
            assert!(
                (bound.p95_upper / exact - 1.0).abs() < 0.02,
                "{n}: {}",
                bound.p95_upper
            );
        }
    }

    /// One-sided factors for 99.95 % of a normal law with 95 % confidence, from the noncentral t law.
    #[test]
    fn the_worst_is_bounded_beyond_what_was_seen_and_by_the_tolerance_of_the_search() {
        for (n, exact) in [(10_u32, 5.526), (24, 4.433)] {
            let half = f64::from(n - 1).sqrt() / f64::from(n).sqrt();
            let bound = of((0..n).map(|i| if i % 2 == 0 { half } else { -half }));
            assert!(
                (bound.p999_upper / exact - 1.0).abs() < 0.02,
                "{n}: {}",
                bound.p999_upper
            );
            assert!((bound.worst_upper(0.5) - bound.p999_upper - 0.5).abs() < 1e-15);
        }
        // 1 - 0.999^2995 = 0.9500 >= 0.95 > 1 - 0.999^2994.
        let ramp = |n: u32| of((1..=n).map(|i| f64::from(i) / f64::from(n)));
        assert!((ramp(2995).p999_upper - 1.0).abs() < 1e-15);
        assert!(ramp(2994).p999_upper > 1.0);
    }

    #[test]
    fn few_rows_bound_nothing() {
        assert!(of([0.1, 0.2, 0.3]).p95_upper.is_infinite());
    }
}
