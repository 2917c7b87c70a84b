//! Warnings: what a reader of the numbers must know, and what can be done about it.

use std::fmt;

use serde::Serialize;

use super::numerical_error::{advice_beyond, share_of_interval};
use super::{NumericalFinding, RowTolerance};

/// Largest number of wheels of a file that a report names one by one.
pub const MOST_WHEELS_NAMED: u64 = 12;

/// Says scenarios, of which it gets the indices, in the words of a reader.
pub(super) type Named<'a> = &'a dyn Fn(&[usize]) -> String;

/// A warning about the results of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "warning", rename_all = "snake_case")]
pub enum Warning {
    /// Contacts separate, which the harmonics of the solution cannot represent.
    SeparationWithFewHarmonics {
        /// Scenarios concerned.
        scenarios: Vec<usize>,
        /// Largest share of separated pairs of a row, the tuned wheel included.
        largest_fraction: f64,
    },
    /// Rows whose sampling or harmonic error exceeds its tolerance.
    BeyondTolerance {
        /// Rows concerned.
        rows: u64,
        /// Those of them whose sampling error is the larger one; of the others the harmonic error is.
        by_sampling: u64,
        /// Whether the program chose the harmonics.
        automatic: bool,
        /// Whether rows are on a reduction basis, on which more harmonics can be named.
        on_basis: bool,
        /// All rows of the scenarios concerned.
        planned: u64,
        /// Scenarios concerned.
        scenarios: Vec<usize>,
        /// The tolerances.
        #[serde(flatten)]
        tolerance: RowTolerance,
        /// Largest stated error of a row.
        largest_stated_error: f64,
    },
    /// The basis that the study names is replaced.
    ReplacedBasis {
        /// What rows are solved on.
        taken: String,
    },
    /// Motions at peaks that the wheel does not stay on.
    Unstable {
        /// Rows that were looked at.
        looked_at: u64,
        /// Rows, among those looked at, whose motion is unstable.
        rows: u64,
        /// Scenarios whose tuned wheel does not stay on its motion.
        tuned: Vec<usize>,
    },
    /// The basis is less accurate than the study asks for.
    BasisError {
        /// The basis.
        basis: String,
        /// Measured relative error of the tuned peak.
        error: f64,
        /// Error asked for.
        wanted: f64,
    },
    /// The Craig-Bampton model itself has too few modes.
    CraigBamptonModes {
        /// Highest fixed-interface frequency over what it should be.
        reach: f64,
    },
    /// More fixed-interface modes change the tuned peak.
    CraigBamptonError {
        /// Measured relative change.
        error: f64,
        /// Error asked for.
        wanted: f64,
    },
    /// The numerical error by which the settings were chosen.
    NumericalError(NumericalFinding),
    /// Rows without result.
    Failures {
        /// Rows that failed.
        failed: u64,
        /// All rows.
        planned: u64,
    },
    /// Tuned wheels without result, so that there are no amplification factors.
    TunedFailures {
        /// Scenarios concerned.
        scenarios: Vec<usize>,
    },
    /// A percentile has no value because there are too few patterns.
    TooFewPatterns {
        /// The percentile.
        percent: u32,
        /// Smallest number of patterns that gives a two-sided interval.
        needed: u64,
        /// Wheels in `mistuning.file`; absent: patterns are drawn.
        #[serde(skip_serializing_if = "Option::is_none")]
        wheels_in_file: Option<u64>,
    },
    /// A percentile has no value because too many rows failed.
    TooManyFailures {
        /// The percentile.
        percent: u32,
        /// Scenarios concerned.
        scenarios: Vec<usize>,
    },
}

impl Warning {
    /// Whether failures leave a percentile or a tuned reference without value.
    #[must_use]
    pub fn costs_a_statistic(&self) -> bool {
        matches!(
            self,
            Self::TooManyFailures { .. } | Self::TunedFailures { .. }
        )
    }

    /// What is wrong in a few words, a line each; [`Warning::in_words`] adds what to do about it. Neighbouring
    /// percentiles that have no value for one reason share a line. `patterns` is what these are called.
    pub(super) fn headlines(warnings: &[&Self], named: Named<'_>, patterns: &str) -> Vec<String> {
        let alike = |a: &&Self, b: &&Self| match (a, b) {
            (
                Self::TooManyFailures { scenarios: a, .. },
                Self::TooManyFailures { scenarios: b, .. },
            ) => a == b,
            (Self::TooFewPatterns { .. }, Self::TooFewPatterns { .. }) => true,
            _ => false,
        };
        let lines = warnings.chunk_by(alike);
        lines
            .map(|line| {
                let needing = { line.iter() }.filter_map(|own| own.needing());
                let needing: Vec<(String, u64)> = needing.collect();
                if needing.len() > 1 {
                    return too_few_patterns(needing, patterns);
                }
                let percentiles = line.iter().filter_map(|own| own.percentile());
                let percentiles: Vec<String> =
                    percentiles.map(|percent| format!("P{percent}")).collect();
                line[0].headline(&percentiles, named)
            })
            .collect()
    }

    /// What there is to say of the numerical error by which the settings were chosen.
    pub(super) fn numerical_finding(&self) -> Option<&NumericalFinding> {
        match self {
            Self::NumericalError(finding) => Some(finding),
            _ => None,
        }
    }

    /// What follows for a reader who has the load by the percentile `chosen`, after its rank: what weighs most has the
    /// lowest.
    pub(super) fn consequence(&self, chosen: Option<f64>) -> (u8, String) {
        let (rank, words) = match self {
            Self::TooManyFailures { .. } | Self::TunedFailures { .. } => {
                (0, "Results are missing: too many rows failed.")
            }
            Self::NumericalError(NumericalFinding::Missed { .. }) => {
                (1, "The numerical error is larger than accepted.")
            }
            Self::Unstable { .. } => (2, "Some motions at peaks are unstable."),
            Self::SeparationWithFewHarmonics { .. } => {
                (3, "Contacts separate, which the harmonics miss.")
            }
            Self::BasisError { .. }
            | Self::CraigBamptonModes { .. }
            | Self::CraigBamptonError { .. } => (4, "The reduced model is coarser than asked for."),
            Self::Failures { .. } => (5, "Some rows have no result: bounds are wider."),
            Self::BeyondTolerance { .. } => (6, "Some rows are less accurate than asked for."),
            Self::NumericalError(NumericalFinding::Large { .. }) => {
                (7, "The numerical error is not negligible.")
            }
            Self::TooFewPatterns { percent, .. } => {
                let words = match chosen {
                    Some(chosen) if f64::from(*percent) > chosen => {
                        format!("No P{percent}: the load is chosen by P{chosen}.")
                    }
                    _ => format!("P{percent} has no value: too few patterns."),
                };
                return (8, words);
            }
            Self::ReplacedBasis { .. } => (9, "The basis of the study is replaced."),
            Self::NumericalError(NumericalFinding::Needless { .. }) => {
                (10, "Solutions are more accurate than needed.")
            }
        };
        (rank, words.to_owned())
    }

    /// Scenarios of which failures leave a percentile or a tuned reference without value.
    #[must_use]
    pub(super) fn costly_scenarios(&self) -> &[usize] {
        match self {
            Self::TooManyFailures { scenarios, .. } | Self::TunedFailures { scenarios } => {
                scenarios
            }
            _ => &[],
        }
    }

    /// The percentile that has too few patterns, and how many it needs.
    fn needing(&self) -> Option<(String, u64)> {
        match self {
            Self::TooFewPatterns {
                percent, needed, ..
            } => Some((format!("P{percent}"), *needed)),
            _ => None,
        }
    }

    /// The percentile that has no value.
    fn percentile(&self) -> Option<u32> {
        match self {
            Self::TooFewPatterns { percent, .. } | Self::TooManyFailures { percent, .. } => {
                Some(*percent)
            }
            _ => None,
        }
    }

    /// What is wrong in a few words; of warnings about a percentile, those of all `percentiles`.
    fn headline(&self, percentiles: &[String], named: Named<'_>) -> String {
        let (have, need) = match percentiles.len() {
            1 => ("has", "it needs"),
            _ => ("have", "they need"),
        };
        let percentiles = percentiles.join(", ");
        let share = |ratio: f64| format!("{:.2} %", 100.0 * ratio);
        match self {
            Self::SeparationWithFewHarmonics { scenarios, .. } => format!(
                "contacts separate at {}, which the harmonics cannot show",
                named(scenarios)
            ),
            Self::BeyondTolerance {
                rows,
                planned,
                scenarios,
                ..
            } => format!(
                "{rows} of {planned} solutions at {} miss the accuracy asked for",
                named(scenarios)
            ),
            Self::ReplacedBasis { .. } => "the basis of the study is replaced".to_owned(),
            Self::Unstable { rows, tuned, .. } => {
                let tuned = tuned.len();
                format!("unstable motions: {rows} rows, {tuned} tuned wheels")
            }
            Self::BasisError { error, wanted, .. } => format!(
                "the basis misses the tuned peak by {} instead of {}",
                share(*error),
                share(*wanted)
            ),
            Self::CraigBamptonModes { .. } => "too few fixed-interface modes".to_owned(),
            Self::CraigBamptonError { error, wanted } => format!(
                "more fixed-interface modes change the tuned peak by {} instead of {}",
                share(*error),
                share(*wanted)
            ),
            Self::NumericalError(NumericalFinding::Missed { accepted, .. }) => {
                format!("the accepted error of {} is not kept", share(*accepted))
            }
            Self::NumericalError(NumericalFinding::Large {
                error,
                percent,
                width,
            }) => format!(
                "numerical error {} of the P{percent} interval: more accuracy helps too",
                share_of_interval(*error, *width)
            ),
            Self::NumericalError(NumericalFinding::Needless {
                error,
                percent,
                width,
            }) => format!(
                "numerical error {} of the P{percent} interval: more accurate than needed",
                share_of_interval(*error, *width)
            ),
            Self::Failures { failed, planned } => {
                format!("{failed} of {planned} rows have no result")
            }
            Self::TunedFailures { scenarios } => {
                format!("no tuned peak at {}", named(scenarios))
            }
            Self::TooFewPatterns { needed, .. } => {
                format!("{percentiles} {have} no value: {need} {needed} patterns")
            }
            Self::TooManyFailures { scenarios, .. } => format!(
                "{percentiles} {have} no value at {}: too many rows failed",
                named(scenarios)
            ),
        }
    }

    /// What is wrong and what to do about it, with the scenarios of the study by load and setting.
    pub(super) fn in_words(&self, named: Named<'_>) -> String {
        let at = |scenarios: &[usize]| format!("at {}", named(scenarios));
        match self {
            Self::SeparationWithFewHarmonics {
                scenarios,
                largest_fraction,
            } => format!(
                "contacts separate {} (up to {:.0} % of the pairs of a wheel): \
                 harmonic 1 or odd harmonics alone cannot represent that; raise the normal load, or \
                 take solver.harmonics = \"auto\" or a list with 0 and even ones, which is another study with another --out",
                at(scenarios),
                100.0 * largest_fraction
            ),
            Self::BeyondTolerance {
                rows,
                by_sampling,
                automatic,
                on_basis,
                planned,
                scenarios,
                tolerance,
                largest_stated_error,
            } => format!(
                "{rows} of {planned} rows state a sampling or harmonic error beyond its tolerance{} {} \
                 (stated errors up to {:.1} %); {}",
                tolerance.in_brackets(),
                at(scenarios),
                100.0 * largest_stated_error,
                advice_beyond(*by_sampling, rows - by_sampling, (*automatic, *on_basis)),
            ),
            Self::ReplacedBasis { taken } => format!(
                "basis = \"stick_attachment\" is replaced: rows are on {taken}, which has no modes to choose; take \
                 basis = \"auto\", or leave it out"
            ),
            Self::Unstable {
                looked_at,
                rows,
                tuned,
            } => unstable_motions(*looked_at, *rows, tuned, &at),
            Self::BasisError {
                basis,
                error,
                wanted,
            } => format!(
                "basis {basis} misses the tuned peak by {:.2} %, more than reduction.error = {wanted}; \
                 take more modes or basis = \"auto\", or accept it by a larger reduction.error",
                100.0 * error
            ),
            Self::CraigBamptonModes { reach } => format!(
                "the fixed-interface modes reach only {reach:.2} times the frequency that they should \
                 (6 times that of the tuned peak, 1.5 times that of its harmonics); raise \
                 reduction.craig_bampton_modes"
            ),
            Self::CraigBamptonError { error, wanted } => format!(
                "more fixed-interface modes change the tuned peak by {:.2} %, more than \
                 reduction.error = {wanted}; leave reduction.craig_bampton_modes out or raise it, or \
                 accept it by a larger reduction.error",
                100.0 * error
            ),
            Self::NumericalError(finding) => finding.to_string(),
            Self::Failures { failed, planned } => format!(
                "{failed} of {planned} rows have no result; the bounds take them as infinitely low \
                 and infinitely high; manifest.json counts them by status"
            ),
            Self::TunedFailures { scenarios } => format!(
                "the tuned wheel {} has no peak, so these have no amplification factor; \
                 widen solver.frequency_band_hz or raise solver.samples_per_period",
                at(scenarios)
            ),
            Self::TooFewPatterns {
                percent,
                needed,
                wheels_in_file: None,
            } => format!(
                "P{percent} is not estimable: a 95 % interval needs at least {needed} patterns; raise \
                 study.patterns and run again, only the new ones are solved"
            ),
            Self::TooFewPatterns {
                percent,
                needed,
                wheels_in_file: Some(wheels),
            } => format!(
                "P{percent} is not estimable: a 95 % interval needs at least {needed} wheels, mistuning.file holds \
                 {wheels}; {}, or put more wheels into the file",
                read_each_wheel(*wheels)
            ),
            Self::TooManyFailures { percent, scenarios } => format!(
                "P{percent} {} has no value: too many rows failed; see their status in \
                 responses.parquet",
                at(scenarios)
            ),
        }
    }
}

/// With the scenarios by their numbers, as tables have them.
impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers = |own: &usize| own.to_string();
        let named = |own: &[usize]| {
            let numbers: Vec<String> = own.iter().map(numbers).collect();
            format!("scenarios {}", numbers.join(", "))
        };
        f.write_str(&self.in_words(&named))
    }
}

/// Percentiles without value and how many patterns each needs; of several that need as many, the last one.
fn too_few_patterns(mut needing: Vec<(String, u64)>, patterns: &str) -> String {
    needing.sort_by_key(|own| own.1);
    let each: Vec<&(String, u64)> = { needing.chunk_by(|a, b| a.1 == b.1) }
        .filter_map(|alike| alike.last())
        .collect();
    let names: Vec<&str> = each.iter().map(|own| own.0.as_str()).collect();
    let needs: Vec<String> = each.iter().map(|own| own.1.to_string()).collect();
    format!(
        "no {}: {} {patterns} needed",
        names.join(", "),
        needs.join(", ")
    )
}

/// Which motions are unstable, and what follows from it.
fn unstable_motions(
    looked_at: u64,
    rows: u64,
    tuned: &[usize],
    at: &dyn Fn(&[usize]) -> String,
) -> String {
    let mut motions = Vec::new();
    if rows > 0 {
        motions.push(format!("of {rows} of the {looked_at} rows looked at"));
    }
    if !tuned.is_empty() {
        motions.push(format!("of the tuned wheel {}", at(tuned)));
    }
    format!(
        "the motions {} are unstable: the wheel does not stay on them, and its amplitude in time differs, by a few per cent \
         where that was marched; see the columns stable and tuned_stable",
        motions.join(" and ")
    )
}

/// Where the peak of each wheel of a file is read.
pub(super) fn read_each_wheel(wheels: u64) -> &'static str {
    if wheels <= MOST_WHEELS_NAMED {
        "read the peak of each wheel, which blisk report DIR prints"
    } else {
        "read the peak of each wheel in responses.parquet"
    }
}
