//! Tails of the binomial law, exact to rounding up to millions of trials.

use statrs::function::gamma::ln_gamma;

/// Two-sided confidence of the intervals; each tail has half of the rest.
pub const CONFIDENCE: f64 = 0.95;

/// `P(B <= k)` for `B ~ Binomial(n, p)`, `0 < p < 1`.
#[must_use]
pub fn lower_tail(n: u64, p: f64, k: u64) -> f64 {
    if k >= n {
        return 1.0;
    }
    // Sum the shorter side of the mode, from k outwards, by the ratio of neighbouring terms.
    if (k as f64) < p * (n as f64 + 1.0) {
        sum_downwards(n, p, k).min(1.0)
    } else {
        (1.0 - sum_downwards(n, 1.0 - p, n - k - 1)).clamp(0.0, 1.0)
    }
}

/// `P(B >= k)` for `B ~ Binomial(n, p)`, `0 < p < 1`.
#[must_use]
pub fn upper_tail(n: u64, p: f64, k: u64) -> f64 {
    if k == 0 {
        1.0
    } else if k > n {
        0.0
    } else {
        lower_tail(n, 1.0 - p, n - k)
    }
}

/// Upper bound on a proportion of which `k` of `n` trials show an instance, one-sided, exact (Clopper
/// & Pearson 1934): the largest p with `P(B <= k) >= 1 - CONFIDENCE`.
#[must_use]
pub fn proportion_upper_bound(k: u64, n: u64) -> f64 {
    upper_bound_at(k, n, CONFIDENCE)
}

/// Two-sided bounds on a proportion of which between `least` and `most` of `n` trials show an
/// instance, each exact with half of the rest (Clopper & Pearson 1934).
#[must_use]
pub fn proportion_interval(least: u64, most: u64, n: u64) -> [f64; 2] {
    let one_sided = 0.5 * (1.0 + CONFIDENCE);
    [
        1.0 - upper_bound_at(n.saturating_sub(least), n, one_sided),
        upper_bound_at(most, n, one_sided),
    ]
}

fn upper_bound_at(k: u64, n: u64, confidence: f64) -> f64 {
    if k >= n {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    // Halved until the bounds are neighbours in floating point.
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if lower_tail(n, middle, k) >= 1.0 - confidence {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// Sum of the terms `k, k - 1, ...` until they no longer count.
fn sum_downwards(n: u64, p: f64, k: u64) -> f64 {
    let mut term = probability(n, p, k);
    let mut sum = term;
    for j in (1..=k).rev() {
        term *= j as f64 * (1.0 - p) / ((n - j + 1) as f64 * p);
        sum += term;
        if term < 1e-18 * sum {
            break;
        }
    }
    sum
}

/// `P(B = k)`.
fn probability(n: u64, p: f64, k: u64) -> f64 {
    let (n, k) = (n as f64, k as f64);
    let ln_choose = ln_gamma(n + 1.0) - ln_gamma(k + 1.0) - ln_gamma(n - k + 1.0);
    (ln_choose + k * p.ln() + (n - k) * (-p).ln_1p()).exp()
}

#[cfg(test)]
mod tests {
    use super::{lower_tail, proportion_upper_bound, upper_tail};

    /// Pascal's rule in floating point, all terms.
    fn brute_force(n: usize, p: f64) -> Vec<f64> {
        let mut law = vec![1.0];
        for _ in 0..n {
            let mut next = vec![0.0; law.len() + 1];
            for (k, mass) in law.iter().enumerate() {
                next[k] += mass * (1.0 - p);
                next[k + 1] += mass * p;
            }
            law = next;
        }
        law
    }

    #[test]
    fn tails_agree_with_the_sum_of_all_terms() {
        for n in [1, 2, 7, 59, 72, 368] {
            for p in [0.05, 0.5, 0.95, 0.99] {
                let law = brute_force(n, p);
                for k in 0..=n {
                    let below: f64 = law[..=k].iter().sum();
                    let above: f64 = law[k..].iter().sum();
                    assert!((lower_tail(n as u64, p, k as u64) - below).abs() < 1e-11);
                    assert!((upper_tail(n as u64, p, k as u64) - above).abs() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn upper_bounds_on_a_proportion_are_those_of_clopper_and_pearson() {
        // Without an instance the bound is 1 - 0.05^(1/n).
        for n in [10, 200, 3000] {
            let expected = -(0.05_f64.ln() / n as f64).exp_m1();
            assert!((proportion_upper_bound(0, n) / expected - 1.0).abs() < 1e-9);
        }
        // 5 of 100: the beta quantile 0.95 of (6, 95).
        assert!((proportion_upper_bound(5, 100) - 0.102_253_377_643).abs() < 1e-11);
        assert!(proportion_upper_bound(7, 7).total_cmp(&1.0).is_eq());
    }

    #[test]
    fn tails_of_a_million_trials_add_up_to_one() {
        let n = 1_000_000;
        for k in [989_000, 990_000, 990_250] {
            let total = lower_tail(n, 0.99, k) + upper_tail(n, 0.99, k + 1);
            assert!((total - 1.0).abs() < 1e-7, "{total}");
        }
    }
}
