//! Distribution function of the beta law, and of the one that has a given mean and variance.

use statrs::function::gamma::ln_gamma;

/// Terms of the continued fraction at most; it takes about the square root of the larger parameter.
const TERMS: u32 = 100_000;

/// `P(B <= x)` of the beta law with this mean and variance; a step where no such law exists.
#[must_use]
pub fn matched_beta_below(mean: f64, variance: f64, x: f64) -> f64 {
    let size = mean * (1.0 - mean) / variance - 1.0;
    if mean > 0.0 && mean < 1.0 && size > 0.0 && size.is_finite() {
        beta_below(mean * size, (1.0 - mean) * size, x)
    } else {
        f64::from(u8::from(mean <= x))
    }
}

/// `P(B <= x)` for `B ~ Beta(a, b)`: the regularised incomplete beta function by its continued
/// fraction (Abramowitz & Stegun 1964, 26.5.8), after Lentz.
#[must_use]
pub fn beta_below(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    let ln_front = ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) + a * x.ln() + b * (-x).ln_1p();
    if x < (a + 1.0) / (a + b + 2.0) {
        (ln_front.exp() * continued_fraction(a, b, x) / a).min(1.0)
    } else {
        (1.0 - ln_front.exp() * continued_fraction(b, a, 1.0 - x) / b).max(0.0)
    }
}

fn continued_fraction(a: f64, b: f64, x: f64) -> f64 {
    let away_from_zero = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for term in 1..TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for coefficient in [even, odd] {
            d = 1.0 / away_from_zero(1.0 + coefficient * d);
            c = away_from_zero(1.0 + coefficient / c);
            change = c * d;
            fraction *= change;
        }
        if (change - 1.0).abs() < 1e-13 {
            break;
        }
    }
    fraction
}

#[cfg(test)]
mod tests {
    use super::super::binomial::upper_tail;
    use super::{beta_below, matched_beta_below};

    #[test]
    fn integer_parameters_give_tails_of_the_binomial_law() {
        // P(Beta(k, n - k + 1) <= p) = P(B >= k), B ~ Binomial(n, p).
        for n in [1_u64, 7, 100, 40_000] {
            for p in [0.01, 0.3, 0.95] {
                for k in [1, n / 100 + 1, n / 2 + 1, n] {
                    let found = beta_below(k as f64, (n - k + 1) as f64, p);
                    let expected = upper_tail(n, p, k);
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "{n} {p} {k}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_matched_law_has_the_mean_and_variance() {
        // Beta(2, 6): mean 1/4, variance 12 / (64 * 9).
        for x in [0.05, 0.25, 0.6] {
            let matched = matched_beta_below(0.25, 12.0 / 576.0, x);
            assert!((matched - beta_below(2.0, 6.0, x)).abs() < 1e-12);
        }
        assert!(matched_beta_below(0.2, 0.0, 0.3).total_cmp(&1.0).is_eq());
        assert!(matched_beta_below(-0.1, 1e-6, 0.3).total_cmp(&1.0).is_eq());
        assert!(matched_beta_below(0.5, 1e-9, 0.3) < 1e-9);
    }
}
