//! What pairs of rows of the same patterns say beyond a percentile: who improves, and by how much the
//! common patterns sharpen the comparison.

use serde::Serialize;

use super::binomial::{proportion_interval, upper_tail};
use super::point_rank;

/// Facts about the pairs of a baseline and a candidate; smaller values are better.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairFacts {
    /// All pairs; those with a failed row are among them.
    pub pairs: u64,
    /// Pairs in which only the row of the baseline failed.
    pub baseline_failed: u64,
    /// Pairs in which only the row of the candidate failed.
    pub candidate_failed: u64,
    /// Pairs in which both rows failed.
    pub both_failed: u64,
    /// Pairs in which the candidate is smaller.
    pub improved: u64,
    /// Pairs in which the candidate is larger.
    pub worsened: u64,
    /// Pairs with equal values.
    pub equal: u64,
    /// Share of improved pairs among those without a failed row.
    pub improved_share: Option<f64>,
    /// 95 % bounds on that share in the population, exact (Clopper & Pearson 1934), failed pairs
    /// counted as worse for the lower and as better for the upper one.
    pub improved_share_bounds: Option<[f64; 2]>,
    /// Sign test: two-sided probability of so uneven a split if half of the patterns improved, equal
    /// pairs left out, failed pairs on the smaller side.
    pub sign_test_p_value: Option<f64>,
    /// Correlation of the indicators "at most the percentile".
    pub percentile_correlation: Option<f64>,
    /// Size of two independent samples that compare as sharply, `n / (1 - correlation)`; null where
    /// the correlation is 1 or not defined.
    pub effective_sample_size: Option<f64>,
    /// The pattern that suffers most; null if none does.
    pub worst: Option<Deterioration>,
}

/// A pattern whose value grew.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Deterioration {
    /// Pattern.
    pub pattern: u32,
    /// Value in the baseline.
    pub baseline: f64,
    /// Value in the candidate.
    pub candidate: f64,
    /// Candidate minus baseline.
    pub difference: f64,
    /// Candidate over baseline.
    pub ratio: f64,
}

impl PairFacts {
    /// The facts of the pairs of `patterns`, at the percentile `percent`.
    #[must_use]
    pub fn new(
        patterns: &[u32],
        baseline: &[Option<f64>],
        candidate: &[Option<f64>],
        percent: f64,
    ) -> Self {
        let mut both: Vec<(u32, f64, f64)> = Vec::new();
        let (mut baseline_failed, mut candidate_failed, mut both_failed) = (0, 0, 0);
        for ((&pattern, x), y) in patterns.iter().zip(baseline).zip(candidate) {
            match (x, y) {
                (Some(x), Some(y)) => both.push((pattern, *x, *y)),
                (None, Some(_)) => baseline_failed += 1,
                (Some(_), None) => candidate_failed += 1,
                (None, None) => both_failed += 1,
            }
        }
        let improved = both.iter().filter(|(_, x, y)| y < x).count() as u64;
        let worsened = both.iter().filter(|(_, x, y)| y > x).count() as u64;
        let failed = baseline_failed + candidate_failed + both_failed;
        let good = both.len() as u64;
        let pairs = good + failed;
        let correlation = percentile_correlation(&both, percent);
        Self {
            pairs,
            baseline_failed,
            candidate_failed,
            both_failed,
            improved,
            worsened,
            equal: good - improved - worsened,
            improved_share: (good > 0).then(|| improved as f64 / good as f64),
            improved_share_bounds: (pairs > 0)
                .then(|| proportion_interval(improved, improved + failed, pairs)),
            sign_test_p_value: sign_test(improved, worsened, failed),
            percentile_correlation: correlation,
            effective_sample_size: correlation
                .filter(|correlation| *correlation < 1.0)
                .map(|correlation| good as f64 / (1.0 - correlation)),
            worst: worst(&both),
        }
    }
}

/// `P(|B - n/2| >= |k - n/2|)`, `B ~ Binomial(n, 1/2)`, with undecided pairs on the smaller side.
fn sign_test(improved: u64, worsened: u64, undecided: u64) -> Option<f64> {
    let larger = improved.max(worsened);
    let smaller = improved.min(worsened) + undecided;
    let n = larger + smaller;
    let one_sided = upper_tail(n, 0.5, larger.max(smaller));
    // Undecided pairs could have made the split even.
    let even = smaller >= larger;
    (n > 0).then(|| {
        if even {
            1.0
        } else {
            (2.0 * one_sided).min(1.0)
        }
    })
}

/// `(P11 - p^2) / (p (1 - p))`, `P11` the share of pairs in which both values are at most their
/// order statistic of rank `ceil(p n)`, and `p` the share of values that are.
fn percentile_correlation(pairs: &[(u32, f64, f64)], percent: f64) -> Option<f64> {
    let n = pairs.len();
    let rank = point_rank(n as u64, percent) as usize;
    if n == 0 || rank >= n {
        return None;
    }
    let at_rank = |value: fn(&(u32, f64, f64)) -> f64| {
        let mut values: Vec<f64> = pairs.iter().map(value).collect();
        *values.select_nth_unstable_by(rank - 1, f64::total_cmp).1
    };
    let (x_p, y_p) = (at_rank(|pair| pair.1), at_rank(|pair| pair.2));
    // In whole numbers, so that equal columns give exactly 1.
    let count = |below: &dyn Fn(f64, f64) -> bool| {
        pairs.iter().filter(|(_, x, y)| below(*x, *y)).count() as f64
    };
    let (of_x, of_y) = (count(&|x, _| x <= x_p), count(&|_, y| y <= y_p));
    let of_both = count(&|x, y| x <= x_p && y <= y_p);
    let n = n as f64;
    let variances = (of_x * (n - of_x)) * (of_y * (n - of_y));
    (variances > 0.0).then(|| (n * of_both - of_x * of_y) / variances.sqrt())
}

/// The largest growth; the first pattern among equal ones.
fn worst(pairs: &[(u32, f64, f64)]) -> Option<Deterioration> {
    let mut worst: Option<Deterioration> = None;
    for &(pattern, baseline, candidate) in pairs {
        let difference = candidate - baseline;
        if difference > worst.map_or(0.0, |worst| worst.difference) {
            worst = Some(Deterioration {
                pattern,
                baseline,
                candidate,
                difference,
                ratio: candidate / baseline,
            });
        }
    }
    worst
}
