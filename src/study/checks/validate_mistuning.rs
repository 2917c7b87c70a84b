//! Mistuning, patterns and standard deviation, which are tied together: from the file, and back.

use std::collections::BTreeSet;
use std::path::Path;

use super::check::Check;
use crate::population::table::read_pattern_parquet;
use crate::response::mistuning::{Distribution, PatternRecords, Projection, read_pattern_csv};
use crate::study::keys::mistuning::{
    DEVIATION, DistributionKind, DistributionTable, MistunedQuantity, MistuningTable, SweepTable,
};
use crate::study::{Mistuning, MistuningSource, Study, StudyError};

/// Cantilevered-blade modes of the classical projection unless the study says otherwise.
const DEFAULT_CANTILEVER_MODES: usize = 10;

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
    table: Option<MistuningTable>,
    sweep: &SweepTable,
    (patterns, given): (Option<u64>, Option<PatternRecords>),
) -> Result<Option<ResolvedMistuning>, StudyError> {
    let accepted = "distribution = { kind = \"normal\" }, or file = \"...\"";
    let Some(table) = table else {
        check.missing_for("mistuning.distribution", accepted);
        return Ok(None);
    };
    let projection = table.projection.unwrap_or(Projection::Exact);
    let cantilever_mode_count = cantilever_modes(check, projection, table.cantilever_mode_count);
    let resolved = match (table.file, table.distribution) {
        (None, None) => {
            check.missing_for("mistuning.distribution", accepted);
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
                check.refuse_for(
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
    let Some(patterns) = patterns else {
        check.missing("study.patterns");
        return 0;
    };
    check.judged("study.patterns", patterns as f64);
    patterns as u32
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
            check.judged(key, count as f64);
            Some(count)
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

fn law(check: &mut Check, table: &DistributionTable) -> Option<Distribution> {
    let key = "mistuning.distribution.truncation";
    let Some(kind) = table.kind else {
        check.missing("mistuning.distribution.kind");
        return None;
    };
    let law = match kind {
        DistributionKind::TruncatedNormal => {
            let truncation = table.truncation;
            if truncation.is_none() {
                check.missing(key);
            }
            let truncation = check.judged(key, truncation?);
            return Some(Distribution::TruncatedNormal { truncation });
        }
        DistributionKind::Normal => Distribution::Normal,
        DistributionKind::Uniform => Distribution::Uniform,
    };
    if table.truncation.is_some() {
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
    distribution: &DistributionTable,
    sweep: &SweepTable,
) -> Vec<Option<f64>> {
    let in_law = "mistuning.distribution.standard_deviation";
    let in_sweep = "sweep.standard_deviation";
    match (distribution.standard_deviation, &sweep.standard_deviation) {
        (Some(_), Some(_)) => {
            check.conflict(
                in_law,
                "sweep.standard_deviation gives it already; accepted: one of the two",
            );
            Vec::new()
        }
        (None, None) => {
            check.missing(in_sweep);
            Vec::new()
        }
        (Some(value), None) => vec![Some(check.judged(in_law, value))],
        (None, Some(values)) => {
            if values.is_empty() {
                check.refuse(in_sweep);
            }
            let mut seen = BTreeSet::new();
            for (place, &value) in values.iter().enumerate() {
                // The sum turns -0.0 into 0.0.
                if !DEVIATION.holds(value) || !seen.insert((value + 0.0).to_bits()) {
                    check.refuse(&format!("{in_sweep}[{place}]"));
                }
            }
            values.iter().map(|value| Some(value + 0.0)).collect()
        }
    }
}

/// `[mistuning]` as a study file has it; the standard deviations are those of the sweep.
pub(super) fn mistuning_table(mistuning: &Mistuning) -> MistuningTable {
    let (distribution, file) = match &mistuning.source {
        MistuningSource::Law(law) => {
            let (kind, truncation) = match *law {
                Distribution::Normal => (DistributionKind::Normal, None),
                Distribution::Uniform => (DistributionKind::Uniform, None),
                Distribution::TruncatedNormal { truncation } => {
                    (DistributionKind::TruncatedNormal, Some(truncation))
                }
            };
            let law = DistributionTable {
                kind: Some(kind),
                truncation,
                standard_deviation: None,
            };
            (Some(law), None)
        }
        MistuningSource::File { written, .. } => (None, Some(written.clone())),
    };
    MistuningTable {
        quantity: Some(MistunedQuantity::BladeStiffness),
        projection: Some(mistuning.projection),
        cantilever_mode_count: mistuning.cantilever_mode_count,
        distribution,
        file,
    }
}
