//! The numerical error of a study whose settings were chosen by it, beside its statistical uncertainty.

use serde::Serialize;

use super::Warning;
use crate::population::statistics::Percentile;

/// Share of an interval beyond which numerical error is no longer small beside it.
const LARGE_SHARE: f64 = 0.1;
/// Share of an interval below which accuracy is paid for in vain.
const NEEDLESS_SHARE: f64 = 0.01;

/// Numerical error of the peak amplitudes of a study with `[accuracy]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NumericalError {
    /// Error accepted.
    pub accepted: f64,
    /// Upper bound of the error of 95 % of the rows, measured on a sample; none where it has no bound.
    pub p95_upper: Option<f64>,
    /// Whether that is accepted.
    pub met: bool,
}

impl NumericalError {
    /// What there is to say of it beside the intervals of the wanted percentile of the amplitude, one of
    /// each scenario.
    #[must_use]
    pub fn warnings(&self, percentiles: &[Percentile]) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if !self.met {
            warnings.push(Warning::AccuracyMissed {
                accepted: self.accepted,
                reached: self.p95_upper,
            });
        }
        let width = |found: &Percentile| Some((found.upper? - found.lower?) / found.value?);
        let widths = percentiles.iter().filter_map(width);
        let narrowest = widths.reduce(f64::min).filter(|&width| width > 0.0);
        let percent = percentiles.first().map_or(95.0, |found| found.percent);
        if let (Some(error), Some(width)) = (self.p95_upper, narrowest) {
            if error > LARGE_SHARE * width {
                warnings.push(Warning::NumericalErrorLarge {
                    error,
                    percent,
                    width,
                });
            } else if error < NEEDLESS_SHARE * width {
                warnings.push(Warning::NumericalErrorNeedless {
                    error,
                    percent,
                    width,
                });
            }
        }
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::NumericalError;
    use crate::population::statistics::percentile;
    use crate::report::Warning;

    #[test]
    fn an_error_is_large_or_needless_beside_the_interval() {
        let sorted: Vec<f64> = (0..200).map(|i| 1.0 + f64::from(i) / 2000.0).collect();
        let found = percentile(&sorted, 0, 95);
        let width = (found.upper.expect("estimable") - found.lower.expect("estimable"))
            / found.value.expect("estimable");
        let warned = |share: f64, met| {
            let error = NumericalError {
                accepted: 0.01,
                p95_upper: Some(share * width),
                met,
            };
            error.warnings(&[found])
        };
        assert!(matches!(
            warned(0.11, true)[..],
            [Warning::NumericalErrorLarge { .. }]
        ));
        assert!(warned(0.09, true).is_empty() && warned(0.011, true).is_empty());
        assert!(matches!(
            warned(0.009, true)[..],
            [Warning::NumericalErrorNeedless { .. }]
        ));
        assert!(matches!(
            warned(0.09, false)[..],
            [Warning::AccuracyMissed { .. }]
        ));
    }
}
