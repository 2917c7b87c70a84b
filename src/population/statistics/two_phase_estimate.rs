//! Mean and percentiles from a two-phase sample, with intervals.
//!
//! With `W_h` the share of stratum h in the N patterns and `p_h` the share of its `n_h` solved rows that
//! exceed x, `E(x) = sum_h W_h p_h` estimates the exceedance of x without bias, whatever the
//! surrogate is worth. Its variance has a part of each phase (Cochran 1977, equation 12.3 ff.):
//!
//! ```text
//! V = E (1 - E) / N + sum_h W_h^2 (1 - n_h / N_h) p_h (1 - p_h) / (n_h - 1)
//! ```
//!
//! Bounds of a percentile are those x at which a one-sided test of `E(x) = 1 - p` turns (Woodruff 1952).
//! As in the exact bounds of Clopper & Pearson (1934) the upper limit of E counts one row more than seen,
//! in the stratum where it weighs most (Fay & Feuer 1997 for weighted sums of counts), among those from the
//! highest surrogate down to the first without such a row; the lower limit one row less, likewise. E is
//! then as the beta law of that mean and variance.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::beta_law::matched_beta_below;
use super::{CONFIDENCE, PointStatus, failure_gate, smallest_sample};

/// A stratum with its solved rows.
#[derive(Debug, Clone, PartialEq)]
pub struct StratumSample {
    /// Patterns of the stratum, solved or not.
    pub size: u64,
    /// Surrogate and value of each solved row; no value where it failed.
    pub rows: Vec<(Option<f64>, Option<f64>)>,
}

/// The solved rows of a population; strata from the highest surrogate down, none without rows.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoPhaseSample {
    strata: Vec<StratumSample>,
    /// Values of each stratum, ascending.
    sorted: Vec<Vec<f64>>,
    surrogate_mean: Option<f64>,
    population: f64,
}

/// A percentile from a two-phase sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TwoPhasePercentile {
    /// The percentile in percent.
    pub percent: f64,
    /// Smallest value with an estimated share of the good rows of at least `percent` below or at it.
    pub value: Option<f64>,
    /// Lower 95 % bound, failed rows at minus infinity.
    pub lower: Option<f64>,
    /// Upper 95 % bound, failed rows at plus infinity.
    pub upper: Option<f64>,
    /// Why `value` is there or not.
    pub status: PointStatus,
    /// Patterns of a simple random sample whose distribution function is as sharp at the value.
    pub equivalent_patterns: Option<f64>,
}

/// The mean of the rows with a value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeanEstimate {
    /// Mean, the surrogate as control variate.
    pub value: f64,
    /// Lower 95 % bound.
    pub lower: f64,
    /// Upper 95 % bound.
    pub upper: f64,
    /// Coefficient of the surrogate, estimated from the same rows.
    pub coefficient: f64,
    /// Correlation of value and surrogate over the population.
    pub correlation: Option<f64>,
    /// Patterns of a simple random sample with the same standard error.
    pub equivalent_patterns: Option<f64>,
}

impl TwoPhaseSample {
    /// The sample of a population whose surrogates have the mean `surrogate_mean`.
    #[must_use]
    pub fn new(mut strata: Vec<StratumSample>, surrogate_mean: Option<f64>) -> Self {
        strata.retain(|stratum| !stratum.rows.is_empty());
        let sorted = strata.iter().map(|stratum| {
            let mut values: Vec<f64> = stratum.rows.iter().filter_map(|row| row.1).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        });
        Self {
            sorted: sorted.collect(),
            population: strata.iter().map(|stratum| stratum.size as f64).sum(),
            strata,
            surrogate_mean,
        }
    }

    /// Estimated share of the population whose rows fail.
    #[must_use]
    pub fn failed_share(&self) -> f64 {
        let shares = self
            .strata
            .iter()
            .zip(&self.sorted)
            .map(|(stratum, values)| {
                let failed = stratum.rows.len() - values.len();
                self.weight(stratum) * failed as f64 / stratum.rows.len() as f64
            });
        shares.sum()
    }

    /// Share of the population that one solved row stands for, at most.
    #[must_use]
    pub fn largest_weight(&self) -> f64 {
        self.strata
            .iter()
            .map(|stratum| self.weight(stratum) / stratum.rows.len() as f64)
            .fold(0.0, f64::max)
    }

    /// The percentile `percent`, at least 50.
    #[must_use]
    pub fn percentile(&self, percent: f64) -> TwoPhasePercentile {
        let exceeding = 1.0 - percent / 100.0;
        let mut values: Vec<f64> = self.sorted.iter().flatten().copied().collect();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup_by(|a, b| a.total_cmp(b).is_eq());
        let below = values.partition_point(|&x| self.surely_reached(x, exceeding));
        let above = values.partition_point(|&x| !self.surely_held(x, exceeding));
        let lower = below.checked_sub(1).map(|place| values[place]);
        let upper = values.get(above).copied();
        let failed = self.failed_share();
        let status = if lower.is_none() || upper.is_none() {
            PointStatus::TooFewPatterns {
                needed: smallest_sample(percent / 100.0, CONFIDENCE),
            }
        } else if failed > failure_gate(percent / 100.0) * (1.0 + 1e-12) {
            PointStatus::TooManyFailures
        } else {
            PointStatus::Estimated
        };
        let good = 1.0 - failed;
        let over = |x: f64| self.moments(&self.exceedances(x, false, false)).0;
        let place = values.partition_point(|&x| over(x) > exceeding * good * (1.0 + 1e-9));
        let value = values
            .get(place)
            .copied()
            .filter(|_| status == PointStatus::Estimated);
        let variance = value.map(|x| self.moments(&self.exceedances(x, true, false)).1);
        TwoPhasePercentile {
            percent,
            value,
            lower,
            upper,
            status,
            equivalent_patterns: variance
                .map(|variance| exceeding * (1.0 - exceeding) / variance)
                .filter(|patterns| patterns.is_finite()),
        }
    }

    /// The mean of the rows with a value: the weighted mean, moved by how much the surrogates of the solved
    /// rows differ from those of all patterns; none with fewer than three values.
    #[must_use]
    pub fn mean(&self) -> Option<MeanEstimate> {
        let control = self.surrogate_mean.unwrap_or(0.0);
        // (weight, surrogate, value) of every good row.
        let mut rows: Vec<Vec<(f64, f64, f64)>> = Vec::new();
        let (mut all_weight, mut all_surrogate) = (0.0, 0.0);
        for stratum in &self.strata {
            let weight = self.weight(stratum) / stratum.rows.len() as f64;
            let mut good = Vec::new();
            for &(surrogate, value) in &stratum.rows {
                let surrogate = surrogate.unwrap_or(control);
                all_weight += weight;
                all_surrogate += weight * surrogate;
                good.extend(value.map(|value| (weight, surrogate, value)));
            }
            rows.push(good);
        }
        let flat = || rows.iter().flatten();
        let count = flat().count();
        if count < 3 {
            return None;
        }
        let total: f64 = flat().map(|row| row.0).sum();
        let weighted = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            flat().map(|&(w, s, y)| w * of(s, y)).sum::<f64>() / total
        };
        let (s, y) = (weighted(&|s, _| s), weighted(&|_, y| y));
        let ss = weighted(&|surrogate, _| (surrogate - s).powi(2));
        let sy = weighted(&|surrogate, value| (surrogate - s) * (value - y));
        let yy = weighted(&|_, value| (value - y).powi(2));
        let coefficient = if ss > 0.0 { sy / ss } else { 0.0 };
        let value = y + coefficient * (control - all_surrogate / all_weight);
        let mut variance = yy / self.population;
        for (stratum, good) in self.strata.iter().zip(&rows) {
            let n = good.len() as f64;
            if good.len() < 2 {
                continue;
            }
            let rest = |row: &(f64, f64, f64)| row.2 - y - coefficient * (row.1 - s);
            let mean = good.iter().map(rest).sum::<f64>() / n;
            let spread = good
                .iter()
                .map(|row| (rest(row) - mean).powi(2))
                .sum::<f64>()
                / (n - 1.0);
            let open = 1.0 - stratum.rows.len() as f64 / stratum.size as f64;
            variance += self.weight(stratum).powi(2) * open * spread / n;
        }
        let freedom = (count as f64 - self.strata.len() as f64 - 1.0).max(1.0);
        variance *= 1.0 + 1.0 / freedom;
        let half = StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |law| {
            law.inverse_cdf(0.5 * (1.0 + CONFIDENCE))
        }) * variance.sqrt();
        Some(MeanEstimate {
            value,
            lower: value - half,
            upper: value + half,
            coefficient,
            correlation: Some(sy / (ss * yy).sqrt()).filter(|rho| rho.is_finite()),
            equivalent_patterns: Some(yy / variance).filter(|patterns| patterns.is_finite()),
        })
    }

    fn weight(&self, stratum: &StratumSample) -> f64 {
        stratum.size as f64 / self.population
    }

    /// Share of the rows of each stratum above x, or at it as well if `reaching`; failed rows are
    /// above if `failed_above`.
    fn exceedances(&self, x: f64, reaching: bool, failed_above: bool) -> Vec<f64> {
        let shares = self
            .strata
            .iter()
            .zip(&self.sorted)
            .map(|(stratum, values)| {
                let below = values.partition_point(|&value| value < x || (!reaching && value <= x));
                let failed = stratum.rows.len() - values.len();
                let above = values.len() - below + if failed_above { failed } else { 0 };
                above as f64 / stratum.rows.len() as f64
            });
        shares.collect()
    }

    /// Estimated exceedance and its variance.
    fn moments(&self, shares: &[f64]) -> (f64, f64) {
        let (mut exceedance, mut within) = (0.0, 0.0);
        for (stratum, &p) in self.strata.iter().zip(shares) {
            let (weight, n) = (self.weight(stratum), stratum.rows.len() as f64);
            exceedance += weight * p;
            within += weight.powi(2) * open_share(stratum) * p * (1.0 - p) / (n - 1.0).max(1.0);
        }
        let between = exceedance * (1.0 - exceedance) / self.population;
        (exceedance, between.max(0.0) + within)
    }

    /// Whether the percentile is at most x: the upper limit of the exceedance of x is at most
    /// `exceeding`.
    fn surely_held(&self, x: f64, exceeding: f64) -> bool {
        let shares = self.exceedances(x, false, true);
        let (exceedance, variance) = self.moments(&shares);
        let last = shares.iter().rposition(|&p| p > 0.0);
        let reach = last.map_or(1, |last| last + 2).min(shares.len());
        let more = self.largest_change(&shares[..reach], 0, |p| 1.0 - p);
        let unseen = 1.0 / self.population;
        let (mean, variance) = (
            exceedance + more.max(unseen),
            variance + more.powi(2) + unseen.powi(2),
        );
        matched_beta_below(mean, variance, exceeding) >= 0.5 * (1.0 + CONFIDENCE)
    }

    /// Whether the percentile is at least x: the lower limit of the share of x and above is above
    /// `exceeding`.
    fn surely_reached(&self, x: f64, exceeding: f64) -> bool {
        let shares = self.exceedances(x, true, false);
        let (exceedance, variance) = self.moments(&shares);
        let first = shares.iter().position(|&p| p < 1.0).unwrap_or(shares.len());
        let from = first.saturating_sub(1);
        // Where exceeding is the rule, a row that does not is the one that may have been missed.
        let less = self.largest_change(&shares[from..], from, |p| if p > 0.5 { p } else { 0.0 });
        matched_beta_below(exceedance - less, variance + less.powi(2), exceeding)
            <= 0.5 * (1.0 - CONFIDENCE)
    }

    /// Largest change of the exceedance by one more row, among the strata from `first` on that have
    /// these shares.
    fn largest_change(&self, shares: &[f64], first: usize, room: impl Fn(f64) -> f64) -> f64 {
        self.strata[first..]
            .iter()
            .zip(shares)
            .map(|(stratum, &p)| {
                self.weight(stratum) / stratum.rows.len() as f64 * room(p) * open_share(stratum)
            })
            .fold(0.0, f64::max)
    }
}

/// Share of a stratum that is not solved.
fn open_share(stratum: &StratumSample) -> f64 {
    1.0 - stratum.rows.len() as f64 / stratum.size as f64
}
