//! The numerical error of a study whose settings were chosen by it, beside its statistical uncertainty, and what its rows are
//! held to.

use std::fmt;

use serde::Serialize;

use crate::population::statistics::Percentile;

/// Share of an interval beyond which numerical error is no longer small beside it.
const LARGE_SHARE: f64 = 0.1;
/// Share of an interval below which accuracy is paid for in vain.
const NEEDLESS_SHARE: f64 = 0.01;

/// What makes a percentile surer: the one verdict of a report on its statistical and its numerical error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Remedy {
    /// More patterns.
    Patterns,
    /// More patterns first; the numerical error is not small beside the interval.
    PatternsThenFiner,
    /// Finer solutions.
    Finer,
}

impl Remedy {
    /// By both widths of the percentile, and by what was found of the error that was measured: it weighs more than what
    /// the rows state at worst.
    pub(super) fn of<'a>(
        statistical: f64,
        numerical: f64,
        findings: impl IntoIterator<Item = &'a NumericalFinding>,
    ) -> Self {
        match findings.into_iter().next() {
            Some(NumericalFinding::Needless { .. }) => Self::Patterns,
            _ if numerical > statistical => Self::Finer,
            Some(_) => Self::PatternsThenFiner,
            None => Self::Patterns,
        }
    }

    /// What the statistical interval is beside the numerical bounds, and what follows; `wider`: the bounds are wider.
    pub(super) fn beside_bounds(self, wider: bool) -> &'static str {
        match self {
            Self::Finer => {
                ": less than the numerical bounds, so more accurate solutions (accuracy.amplitude_error) before more \
                 patterns"
            }
            _ if wider => {
                ": less than the numerical bounds, but far more than the error that was measured, so more patterns \
                 before more accurate solutions"
            }
            _ => {
                ": more than the numerical bounds, so more patterns before more accurate solutions"
            }
        }
    }

    /// Which of the two errors matters more, with the `interval` of the percentile in words.
    pub(super) fn beside_statistics(self, interval: &str) -> String {
        let which = match self {
            Self::Finer => "larger",
            Self::Patterns | Self::PatternsThenFiner => "smaller",
        };
        format!("{which} than statistics ({interval})")
    }

    /// In a few words.
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Patterns => "to be surer: more patterns first",
            Self::PatternsThenFiner => "to be surer: more patterns and accuracy",
            Self::Finer => "to be surer: more accuracy first",
        }
    }
}

/// The tolerances of the errors that a row is marked by; none where the results do not say it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct RowTolerance {
    /// Of the change by finer sampling.
    pub sampling_tolerance: Option<f64>,
    /// Of the change by more harmonics, `solver.harmonic_tolerance`.
    pub harmonic_tolerance: Option<f64>,
}

impl RowTolerance {
    fn known(self) -> Vec<String> {
        let named = [
            ("samples per period", self.sampling_tolerance),
            ("harmonics", self.harmonic_tolerance),
        ];
        { named.into_iter() }
            .filter_map(|(name, own)| Some(format!("{} % by {name}", percent(own?))))
            .collect()
    }

    /// Both that are known, in brackets; empty without any.
    pub(super) fn in_brackets(self) -> String {
        let known = self.known();
        if known.is_empty() {
            String::new()
        } else {
            format!(" ({})", known.join(", "))
        }
    }

    /// What each row is held to, and which keys say it; with the error that `[accuracy]` chose them by. Empty where nothing is
    /// known.
    #[must_use]
    pub fn in_words(self, accepted: Option<f64>) -> String {
        let known = self.known();
        if known.is_empty() {
            return String::new();
        }
        let by = accepted.map_or_else(
            || {
                "solver.peak_tolerance, solver.harmonic_tolerance; accuracy.amplitude_error sets both"
                    .to_owned()
            },
            |accepted| {
                format!(
                    "chosen by accuracy.amplitude_error, {} % for 95 % of the rows",
                    percent(accepted)
                )
            },
        );
        format!(
            "the amplitude of each row is held to {} ({by})",
            known.join(" and ")
        )
    }
}

/// In percent, with six decimals at most.
fn percent(ratio: f64) -> f64 {
    (1e8 * ratio).round() / 1e6
}

/// Numerical error of the peak amplitudes of a study with `[accuracy]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NumericalError {
    /// Error accepted.
    pub accepted: f64,
    /// Upper bound of the error of 95 % of the rows, measured on a sample; none where it has no bound.
    pub p95_upper: Option<f64>,
    /// What the worst is claimed to be at most.
    pub worst_upper: Option<f64>,
    /// Whether that is accepted.
    pub met: bool,
}

/// What there is to say of a numerical error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "finding", rename_all = "snake_case")]
pub enum NumericalFinding {
    /// The accepted error is not kept.
    Missed {
        /// Error accepted.
        accepted: f64,
        /// Upper bound of the error of 95 % of the rows at the settings taken; none without a bound.
        reached: Option<f64>,
    },
    /// The error is not small beside the statistical uncertainty.
    Large {
        /// Upper bound of the error of 95 % of the rows.
        error: f64,
        /// The percentile whose interval is meant.
        percent: f64,
        /// Relative width of the narrowest interval of the percentile over the scenarios.
        width: f64,
    },
    /// The error is so small beside the statistical uncertainty that it is paid for in vain.
    Needless {
        /// Upper bound of the error of 95 % of the rows.
        error: f64,
        /// The percentile whose interval is meant.
        percent: f64,
        /// Relative width of the narrowest interval of the percentile over the scenarios.
        width: f64,
    },
}

impl NumericalError {
    /// What there is to say of the error beside the intervals of the percentile of the amplitude asked for,
    /// one of each scenario.
    #[must_use]
    pub fn findings(&self, percentiles: &[Percentile]) -> Vec<NumericalFinding> {
        let mut found = Vec::new();
        if !self.met {
            found.push(NumericalFinding::Missed {
                accepted: self.accepted,
                reached: self.p95_upper,
            });
        }
        let width = |own: &Percentile| Some((own.upper? - own.lower?) / own.value?);
        let widths = percentiles.iter().filter_map(width);
        let narrowest = widths.reduce(f64::min).filter(|&width| width > 0.0);
        let percent = percentiles.first().map_or(95.0, |own| own.percent);
        if let (Some(error), Some(width)) = (self.p95_upper, narrowest) {
            if error > LARGE_SHARE * width {
                found.push(NumericalFinding::Large {
                    error,
                    percent,
                    width,
                });
            } else if error < NEEDLESS_SHARE * width {
                found.push(NumericalFinding::Needless {
                    error,
                    percent,
                    width,
                });
            }
        }
        found
    }
}

/// An error as a share of the width of an interval, in percent.
pub(super) fn share_of_interval(error: f64, width: f64) -> String {
    let share = error / width;
    let decimals = if share < LARGE_SHARE { 2 } else { 0 };
    format!("{:.decimals$} %", 100.0 * share)
}

impl fmt::Display for NumericalFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missed { accepted, reached } => write!(
                f,
                "no settings that were tried keep accuracy.amplitude_error = {accepted}; the most accurate \
                 were taken ({}); accept a larger error, or see `blisk tradeoff`",
                reached.map_or("without a bound".to_owned(), |reached| format!(
                    "95 % of the amplitudes within {:.2} %",
                    100.0 * reached
                ))
            ),
            Self::Large {
                error,
                percent,
                width,
            } => write!(
                f,
                "the numerical error (95 % of the amplitudes within {:.2} %) is {} of the width of the \
                 interval of P{percent} ({:.2} %), more than a tenth: differences as small as that are no \
                 statistics; take a smaller accuracy.amplitude_error",
                100.0 * error,
                share_of_interval(*error, *width),
                100.0 * width
            ),
            Self::Needless {
                error,
                percent,
                width,
            } => write!(
                f,
                "the numerical error (95 % of the amplitudes within {:.3} %) is {} of the width of the \
                 interval of P{percent} ({:.1} %), less than a hundredth: a larger accuracy.amplitude_error \
                 is faster and would hardly show",
                100.0 * error,
                share_of_interval(*error, *width),
                100.0 * width
            ),
        }
    }
}

/// What helps so many rows whose sampling error is beyond its tolerance, and so many whose harmonic error is, with harmonics
/// that the program chose or not, on a basis or not.
pub(super) fn advice_beyond(
    by_sampling: u64,
    by_harmonics: u64,
    (automatic, on_basis): (bool, bool),
) -> String {
    let samples = format!(
        "the sampling error is the larger one of {by_sampling}: raise solver.samples_per_period"
    );
    let more = match (automatic, on_basis) {
        (true, true) => {
            "\"auto\" took no more of them: raise the normal load, name more in solver.harmonics"
        }
        (true, false) => {
            "\"auto\" took all that have a peak: raise the normal load, or keep this one, since the stated errors are valid"
        }
        (false, _) => {
            "take solver.harmonics = \"auto\" or a larger set (another study with another --out)"
        }
    };
    let harmonics = format!(
        "the harmonic error is the larger one of {by_harmonics}: {more}, or accept it by a larger \
         solver.harmonic_tolerance"
    );
    let parts = [(by_sampling, samples), (by_harmonics, harmonics)];
    let parts = parts.into_iter().filter(|(rows, _)| *rows > 0);
    parts.map(|(_, part)| part).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::{NumericalError, NumericalFinding, Remedy};
    use crate::population::statistics::percentile;

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
                worst_upper: None,
                met,
            };
            error.findings(&[found])
        };
        assert!(matches!(
            warned(0.11, true)[..],
            [NumericalFinding::Large { .. }]
        ));
        assert!(warned(0.09, true).is_empty() && warned(0.011, true).is_empty());
        assert!(matches!(
            warned(0.009, true)[..],
            [NumericalFinding::Needless { .. }]
        ));
        assert!(matches!(
            warned(0.09, false)[..],
            [NumericalFinding::Missed { .. }]
        ));
    }

    #[test]
    fn one_verdict_weighs_both_errors_and_what_was_measured() {
        let (error, percent, width) = (0.01, 95.0, 0.05);
        let large = NumericalFinding::Large {
            error,
            percent,
            width,
        };
        let needless = NumericalFinding::Needless {
            error,
            percent,
            width,
        };
        for (widths, finding, remedy) in [
            ((0.05, 0.01), None, Remedy::Patterns),
            ((0.05, 0.06), None, Remedy::Finer),
            ((0.05, 0.01), Some(large), Remedy::PatternsThenFiner),
            ((0.05, 0.06), Some(large), Remedy::Finer),
            // Bounds that rows state may be wide where the error that was measured is small.
            ((0.05, 0.06), Some(needless), Remedy::Patterns),
        ] {
            assert_eq!(Remedy::of(widths.0, widths.1, &finding), remedy);
        }
    }
}
