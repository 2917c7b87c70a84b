//! Errors that the rows of a scenario state, and what they come to in a percentile.

use serde::Serialize;

use super::words::{listed, share_words};
use super::{BasisSummary, NumericalError};
use crate::population::monte_carlo::{
    HARMONIC_SAFETY, HARMONIC_SAFETY_ON_RECEPTANCES, ResponseRow, TUNED_RECEPTANCES,
};
use crate::population::statistics::{Percentile, percentile_at};
use crate::response::harmonic_balance::Status;

/// Median, 95th percentile and largest of the magnitudes of an error.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ErrorSpread {
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Largest.
    pub largest: f64,
}

impl ErrorSpread {
    /// The spread of the magnitudes of `errors`; none without any.
    #[must_use]
    pub fn of(errors: impl Iterator<Item = f64>) -> Option<Self> {
        let mut sizes: Vec<f64> = errors.map(f64::abs).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let at = |p: f64| sizes[((p * sizes.len() as f64).ceil() as usize).max(1) - 1];
        (!sizes.is_empty()).then(|| Self {
            median: at(0.5),
            p95: at(0.95),
            largest: at(1.0),
        })
    }
}

/// Statistical and numerical error of one percentile, side by side.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PercentileError {
    /// The percentile of the delivered rows with its statistical interval.
    pub percentile: Percentile,
    /// The percentile, m, if every row is as much too high as it states; none where rows state no
    /// bound that matters to it.
    pub lowest: Option<f64>,
    /// The percentile, m, if every row is as much too low as it states; none where rows state no
    /// bound that matters to it.
    pub highest: Option<f64>,
    /// The percentile, m, with every row corrected by its sampling and harmonic error.
    pub corrected: Option<f64>,
}

impl PercentileError {
    /// About from where to where the statistical interval goes, m, with the numerical error of the percentile at its ends.
    pub(super) fn interval_with_error(&self) -> Option<(f64, f64)> {
        let found = self.percentile;
        let (low, high) = (self.lowest? / found.value?, self.highest? / found.value?);
        Some((low * found.lower?, high * found.upper?))
    }

    /// Width of the statistical interval over the value.
    #[must_use]
    pub fn statistical_width(&self) -> Option<f64> {
        let found = &self.percentile;
        Some((found.upper? - found.lower?) / found.value?)
    }

    /// Width of the numerical bounds over the value.
    #[must_use]
    pub fn numerical_width(&self) -> Option<f64> {
        Some((self.highest? - self.lowest?) / self.percentile.value?)
    }
}

/// Relative errors of the peak amplitude that the rows of a scenario state.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct StatedErrors {
    /// Rows with a result.
    pub rows: u64,
    /// Rows with a result that state no bound.
    pub without_bound: u64,
    /// Change by finer sampling.
    pub sampling: Option<ErrorSpread>,
    /// Change by more harmonics.
    pub harmonics: Option<ErrorSpread>,
    /// Bound on the error from all sources.
    pub stated: Option<ErrorSpread>,
}

impl StatedErrors {
    /// Why a percentile of these rows has no numerical bound.
    pub(super) fn why_no_bound(&self) -> String {
        let Self {
            rows,
            without_bound,
            ..
        } = self;
        if *without_bound > 0 {
            format!("{without_bound} of {rows} rows state none")
        } else {
            "rows state errors as large as the amplitude, or failed".to_owned()
        }
    }
}

/// Errors that every row of a scenario states besides its own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CommonErrors {
    /// What the harmonics left out change in the tuned peak of the full contact model; none for linear limits.
    pub harmonics: Option<f64>,
    /// What the reduced model leaves out under its load or limit; none where that of the basis counts for all.
    pub reduced_model: Option<f64>,
    /// Tolerance of the peak search.
    pub peak: Option<f64>,
}

/// Amplitude and errors of one row with a result.
#[derive(Debug, Clone, Copy)]
struct Judged {
    amplitude_m: f64,
    sampling: Option<f64>,
    harmonics: Option<f64>,
    stated: Option<f64>,
}

/// The rows of one scenario as they are read.
#[derive(Debug, Clone, Default)]
pub struct ErrorRows {
    good: Vec<Judged>,
    failed: u64,
}

impl ErrorRows {
    /// Adds a row.
    pub fn add(&mut self, row: &ResponseRow) {
        match row.peak_amplitude_m.filter(|_| row.status == Status::Ok) {
            Some(amplitude_m) => self.good.push(Judged {
                amplitude_m,
                sampling: row.sampling_error,
                harmonics: row.harmonic_error,
                stated: row.stated_error,
            }),
            None => self.failed += 1,
        }
    }

    /// What the rows state.
    #[must_use]
    pub fn spread(&self) -> StatedErrors {
        let of =
            |error: fn(&Judged) -> Option<f64>| ErrorSpread::of(self.good.iter().filter_map(error));
        StatedErrors {
            rows: self.good.len() as u64,
            without_bound: self.good.iter().filter(|row| row.stated.is_none()).count() as u64,
            sampling: of(|row| row.sampling),
            harmonics: of(|row| row.harmonics),
            stated: of(|row| row.stated),
        }
    }

    /// The percentile `percent`, bounds at `confidence`, with what the errors make of it.
    ///
    /// An order statistic does not fall if no value does, so that the percentile of the lowest values
    /// that the rows allow is the lowest that it can be. With `|x - t| <= s t`, the true value t
    /// lies between `x / (1 + s)` and `x / (1 - s)`; a row without bound can be anything.
    #[must_use]
    pub fn percentile(&self, percent: f64, confidence: f64) -> PercentileError {
        let of = |value: &dyn Fn(&Judged) -> f64| {
            let mut values: Vec<f64> = self.good.iter().map(value).collect();
            values.sort_unstable_by(f64::total_cmp);
            percentile_at(&values, self.failed, percent, confidence)
        };
        let finite = |found: Option<f64>| found.filter(|value| value.is_finite());
        let lowest = of(&|row| match row.stated {
            Some(stated) => row.amplitude_m / (1.0 + stated),
            None => f64::NEG_INFINITY,
        });
        let highest = of(&|row| match row.stated {
            Some(stated) if stated < 1.0 => row.amplitude_m / (1.0 - stated),
            _ => f64::INFINITY,
        });
        let corrected = of(&|row| {
            let change = row.sampling.unwrap_or(0.0) + row.harmonics.unwrap_or(0.0);
            row.amplitude_m * (1.0 + change)
        });
        PercentileError {
            percentile: of(&|row| row.amplitude_m),
            lowest: finite(lowest.value),
            highest: finite(highest.value),
            corrected: corrected.value,
        }
    }
}

/// Errors that every row of a load states, whatever its own.
pub(super) fn common_words(basis: &BasisSummary, common: &CommonErrors) -> Option<String> {
    let (safety, judged_by, measured_on) = if basis.name == TUNED_RECEPTANCES {
        // The tuned wheel judges harmonics too, mistuned ones alone the modes.
        (
            HARMONIC_SAFETY_ON_RECEPTANCES,
            "the worst of some tuned and mistuned wheels",
            "mistuned wheels",
        )
    } else {
        (HARMONIC_SAFETY, "the tuned wheel", "the tuned wheel")
    };
    let parts = [
        (
            common.harmonics.map(|change| safety * change),
            format!(
                "harmonics left out, whatever its own change ({safety} times their change on {judged_by})"
            ),
        ),
        (common.peak, "the peak search".to_owned()),
        (
            common.reduced_model.or(basis.tuned_peak_error),
            format!(
                "the reduced model ({}, measured on {measured_on})",
                basis.name.replace(TUNED_RECEPTANCES, "tuned receptances")
            ),
        ),
    ];
    let parts: Vec<String> = parts
        .into_iter()
        .filter_map(|(error, of)| Some(format!("{} for {of}", share_words(error?))))
        .collect();
    (!parts.is_empty()).then(|| format!("Every solution here states at least {}.", listed(&parts)))
}

/// What was measured of the error before the settings were chosen by it.
pub(super) fn measured(error: NumericalError) -> String {
    let accepted = share_words(error.accepted);
    let kept = match (error.p95_upper, error.met) {
        (Some(bound), true) => format!(
            "with 95 % confidence 95 % of the amplitudes are within {} of a finer solution",
            share_words(bound)
        ),
        (Some(bound), false) => format!(
            "not kept, 95 % of the amplitudes are within {} of a finer solution",
            share_words(bound)
        ),
        (None, _) => "without a bound".to_owned(),
    };
    let worst = error.worst_upper.map_or(String::new(), |worst| {
        format!(
            ", and the worst is claimed to be within {}",
            share_words(worst)
        )
    });
    format!(
        "The settings were chosen on a sample of rows for an error of {accepted} (accuracy.amplitude_error): {kept}{worst}."
    )
}

/// What single solutions state, each by its name.
fn sources(rows: &StatedErrors) -> impl Iterator<Item = (&'static str, ErrorSpread)> {
    let sources = [
        ("full error bound", rows.stated),
        ("change by finer sampling", rows.sampling),
        ("change by the next harmonics", rows.harmonics),
    ];
    { sources.into_iter() }.filter_map(|(name, spread)| Some((name, spread?)))
}

/// The largest errors that the few rows of a load state; none where they state none.
pub(super) fn largest_stated(rows: &StatedErrors) -> Option<String> {
    let parts: Vec<String> = sources(rows)
        .map(|(name, spread)| format!("{name} {}", share_words(spread.largest)))
        .collect();
    let of = if rows.rows > 1 {
        "The largest that a solution here states"
    } else {
        "The solution states"
    };
    (!parts.is_empty()).then(|| format!("{of}: {}.", parts.join(", ")))
}

/// What the rows of the chosen load state.
pub(super) fn stated(rows: &StatedErrors) -> String {
    let parts: Vec<String> = sources(rows)
        .map(|(name, spread)| {
            format!(
                "{name} {} (largest {})",
                share_words(spread.median),
                share_words(spread.largest)
            )
        })
        .collect();
    if parts.is_empty() {
        "These solutions state no errors.".to_owned()
    } else {
        format!(
            "Median of the single solutions: {}. A solution may be further off than the percentile, which depends on few of them.",
            parts.join(", ")
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::statistics::CONFIDENCE;

    /// Uniform on the unit interval.
    struct Uniform(u64);

    impl Uniform {
        fn draw(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    fn rows(count: usize, draw: &mut Uniform) -> ErrorRows {
        let mut row = || Judged {
            amplitude_m: 1.0 + draw.draw(),
            sampling: Some(1e-3 * (draw.draw() - 0.5)),
            harmonics: Some(1e-2 * (draw.draw() - 0.5)),
            stated: Some(0.2 * draw.draw()),
        };
        ErrorRows {
            good: (0..count).map(|_| row()).collect(),
            failed: 0,
        }
    }

    fn value(values: &[f64], percent: f64) -> f64 {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let found = percentile_at(&sorted, 0, percent, CONFIDENCE);
        found.value.expect("enough values")
    }

    #[test]
    fn no_true_amplitudes_within_the_stated_errors_leave_the_bounds_and_some_reach_them() {
        let mut draw = Uniform(7);
        let rows = rows(400, &mut draw);
        for percent in [50.0, 95.0, 99.0] {
            let found = rows.percentile(percent, CONFIDENCE);
            let (lowest, highest) = (
                found.lowest.expect("a bound"),
                found.highest.expect("a bound"),
            );
            let of_truth = |share: &mut dyn FnMut() -> f64| {
                let truths: Vec<f64> = rows
                    .good
                    .iter()
                    .map(|row| {
                        let stated = row.stated.unwrap_or_default();
                        let (low, high) = (
                            row.amplitude_m / (1.0 + stated),
                            row.amplitude_m / (1.0 - stated),
                        );
                        let truth = low + share() * (high - low);
                        // The error is relative to the truth, as rows state it.
                        assert!((row.amplitude_m - truth).abs() <= stated * truth * (1.0 + 1e-12));
                        truth
                    })
                    .collect();
                value(&truths, percent)
            };
            for _ in 0..200 {
                let truth = of_truth(&mut || draw.draw());
                assert!(lowest <= truth && truth <= highest, "{percent}");
            }
            assert!((of_truth(&mut || 0.0) / lowest - 1.0).abs() < 1e-12);
            assert!((of_truth(&mut || 1.0) / highest - 1.0).abs() < 1e-12);
            assert!(found.numerical_width().expect("a width") > 0.0);
        }
    }

    #[test]
    fn rows_without_a_bound_cost_the_bounds_where_they_reach_the_percentile() {
        let mut draw = Uniform(3);
        let mut rows = rows(400, &mut draw);
        let before = rows.percentile(95.0, CONFIDENCE);
        for row in rows.good.iter_mut().take(3) {
            row.stated = None;
        }
        let few = rows.percentile(95.0, CONFIDENCE);
        assert!(few.lowest <= before.lowest && few.highest >= before.highest);
        assert!(few.highest.is_some());
        for row in rows.good.iter_mut().take(30) {
            row.stated = None;
        }
        assert_eq!(rows.percentile(95.0, CONFIDENCE).highest, None);
        assert_eq!(rows.spread().without_bound, 30);
        rows.failed = 40;
        assert_eq!(rows.percentile(95.0, CONFIDENCE).percentile.value, None);
        assert_eq!(
            ErrorRows::default().percentile(95.0, CONFIDENCE).lowest,
            None
        );
        assert_eq!(ErrorRows::default().spread().stated, None);
    }

    #[test]
    fn the_spread_is_by_rank_and_of_magnitudes() {
        let spread = ErrorSpread::of((1..=100).map(|i| f64::from(if i % 2 == 0 { i } else { -i })));
        let expected = ErrorSpread {
            median: 50.0,
            p95: 95.0,
            largest: 100.0,
        };
        assert_eq!(spread, Some(expected));
        assert_eq!(ErrorSpread::of([].into_iter()), None);
    }
}
