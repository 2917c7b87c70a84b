//! The checks that tie mistuning, patterns and standard deviation together.

use std::collections::BTreeSet;
use std::path::Path;

use super::check::Check;
use crate::population::table::read_pattern_parquet;
use crate::response::mistuning::{
    Distribution, PatternRecords, Projection, TRUNCATION_RANGE, read_pattern_csv,
};
use crate::study::raw::{RawDistribution, RawDistributionKind, RawMistuning, RawSweep};
use crate::study::{Mistuning, MistuningSource, Study, StudyError};

/// Cantilevered-blade modes of the classical projection unless the study says otherwise.
const DEFAULT_CANTILEVER_MODES: usize = 10;

/// Largest number of patterns: ids are Int32 in the tables.
const MAX_PATTERNS: u64 = i32::MAX as u64;

/// What the tables `[mistuning]`, `[sweep]` and `[study]` say about the patterns.
pub(super) struct ResolvedMistuning {
    pub(super) mistuning: Mistuning,
    pub(super) patterns: u32,
    pub(super) standard_deviations: Vec<Option<f64>>,
}

/// None where there is no usable source of patterns; the findings then say why. `patterns` are their number, and their records where
/// these are in memory and not in the file.
///
/// # Errors
/// The file of patterns is not accepted.
pub(super) fn mistuning(
    check: &mut Check,
    study_file: &Path,
    raw: Option<RawMistuning>,
    sweep: &RawSweep,
    (patterns, given): (Option<u64>, Option<PatternRecords>),
) -> Result<Option<ResolvedMistuning>, StudyError> {
    let accepted = "distribution = { kind = \"normal\" }, or file = \"...\"";
    let Some(raw) = raw else {
        check.missing("mistuning.distribution", accepted);
        return Ok(None);
    };
    let projection = raw.projection.unwrap_or(Projection::Exact);
    let cantilever_mode_count = cantilever_modes(check, projection, raw.cantilever_mode_count);
    let resolved = match (raw.file, raw.distribution) {
        (None, None) => {
            check.missing("mistuning.distribution", accepted);
            None
        }
        (Some(_), Some(_)) => {
            check.conflict(
                "mistuning.distribution",
                "mistuning.file gives the patterns already; accepted: one of the two",
            );
            None
        }
        (None, Some(distribution)) => {
            let standard_deviations = standard_deviations(check, &distribution, sweep);
            law(check, &distribution).map(|law| ResolvedMistuning {
                mistuning: Mistuning {
                    projection,
                    cantilever_mode_count,
                    source: MistuningSource::Law(law),
                },
                patterns: pattern_count(check, patterns),
                standard_deviations,
            })
        }
        (Some(written), None) => {
            if sweep.standard_deviation.is_some() {
                check.conflict(
                    "sweep.standard_deviation",
                    "mistuning.file gives the deviations as they are; accepted: no standard deviation",
                );
            }
            let path = Study::beside(study_file, &written);
            let records = given.map_or_else(|| read_patterns(&path), Ok)?;
            if records.has_modes() && projection == Projection::Exact {
                check.conflict(
                    "mistuning.projection",
                    "the file gives deviations per mode; accepted: projection = \"cantilever_modes\"",
                );
            }
            let in_file = records.ids().len();
            if patterns.is_some_and(|patterns| patterns != in_file as u64) {
                check.refuse(
                    "study.patterns",
                    &format!("absent, or {in_file}, the number of patterns in {written}"),
                );
            }
            Some(ResolvedMistuning {
                mistuning: Mistuning {
                    projection,
                    cantilever_mode_count,
                    source: MistuningSource::File {
                        written,
                        path,
                        records,
                    },
                },
                patterns: in_file as u32,
                standard_deviations: vec![None],
            })
        }
    };
    Ok(resolved)
}

fn read_patterns(path: &Path) -> Result<PatternRecords, StudyError> {
    if path
        .extension()
        .is_some_and(|extension| extension == "parquet")
    {
        Ok(read_pattern_parquet(path)?)
    } else {
        Ok(read_pattern_csv(path)?)
    }
}

fn pattern_count(check: &mut Check, patterns: Option<u64>) -> u32 {
    let accepted = "a whole number from 1 to 2147483647";
    if let Some(patterns) = patterns {
        let fits = (1..=MAX_PATTERNS).contains(&patterns);
        check.within("study.patterns", patterns, fits, accepted) as u32
    } else {
        check.missing("study.patterns", accepted);
        0
    }
}

fn cantilever_modes(
    check: &mut Check,
    projection: Projection,
    count: Option<usize>,
) -> Option<usize> {
    let key = "mistuning.cantilever_mode_count";
    match projection {
        Projection::CantileverModes => {
            let count = count.unwrap_or(DEFAULT_CANTILEVER_MODES);
            let fits = (1..=1000).contains(&count);
            Some(check.within(key, count, fits, "a whole number from 1 to 1000"))
        }
        Projection::Exact => {
            if count.is_some() {
                check.conflict(
                    key,
                    "projection = \"exact\" has none; accepted: projection = \"cantilever_modes\"",
                );
            }
            None
        }
    }
}

fn law(check: &mut Check, raw: &RawDistribution) -> Option<Distribution> {
    let key = "mistuning.distribution.truncation";
    let accepted = format!(
        "a number from {} to {}, in standard deviations of the normal law",
        TRUNCATION_RANGE[0], TRUNCATION_RANGE[1]
    );
    let Some(kind) = raw.kind else {
        check.missing(
            "mistuning.distribution.kind",
            "\"normal\", \"uniform\" or \"truncated_normal\"",
        );
        return None;
    };
    let law = match (kind, raw.truncation) {
        (RawDistributionKind::TruncatedNormal, Some(truncation)) => {
            let law = Distribution::TruncatedNormal { truncation };
            if law.validate().is_err() {
                check.refuse(key, &accepted);
            }
            return Some(law);
        }
        (RawDistributionKind::TruncatedNormal, None) => {
            check.missing(key, &accepted);
            return None;
        }
        (RawDistributionKind::Normal, _) => Distribution::Normal,
        (RawDistributionKind::Uniform, _) => Distribution::Uniform,
    };
    if raw.truncation.is_some() {
        check.conflict(
            key,
            "this law is not cut off; accepted: kind = \"truncated_normal\"",
        );
    }
    Some(law)
}

/// The standard deviation stands once: in `[sweep]` as a list, or in the distribution as a number.
fn standard_deviations(
    check: &mut Check,
    distribution: &RawDistribution,
    sweep: &RawSweep,
) -> Vec<Option<f64>> {
    let in_law = "mistuning.distribution.standard_deviation";
    let in_sweep = "sweep.standard_deviation";
    let fits = |value: f64| (0.0..=0.5).contains(&value);
    match (distribution.standard_deviation, &sweep.standard_deviation) {
        (Some(_), Some(_)) => {
            check.conflict(
                in_law,
                "sweep.standard_deviation gives it already; accepted: one of the two",
            );
            Vec::new()
        }
        (None, None) => {
            check.missing(
                in_sweep,
                "a list of different numbers from 0 to 0.5, at least one",
            );
            Vec::new()
        }
        (Some(value), None) => {
            vec![Some(check.within(
                in_law,
                value,
                fits(value),
                "a number from 0 to 0.5",
            ))]
        }
        (None, Some(values)) => {
            let accepted = "a list of different numbers from 0 to 0.5, at least one";
            if values.is_empty() {
                check.refuse(in_sweep, accepted);
            }
            let mut seen = BTreeSet::new();
            for (place, &value) in values.iter().enumerate() {
                // The sum turns -0.0 into 0.0.
                if !fits(value) || !seen.insert((value + 0.0).to_bits()) {
                    check.refuse(&format!("{in_sweep}[{place}]"), accepted);
                }
            }
            values.iter().map(|value| Some(value + 0.0)).collect()
        }
    }
}
