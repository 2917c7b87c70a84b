//! The summary of a results folder, from its tables or from what is stored so far.

use std::path::Path;

use super::results_folder::{finished_rows, verify_tables};
use crate::population::monte_carlo::{
    Scenario, TUNED_RECEPTANCES, TunedReference, sampling_tolerance,
};
use crate::population::statistics::{CONFIDENCE, ScenarioAccumulator, ScenarioStability};
use crate::population::table::{
    Compression, Manifest, RowSchema, RowStore, RunState, ScenarioEntry, ScenarioRecord,
    TableHeader,
};
use crate::report::{BasisSummary, NumericalError, RowTolerance, StudySummary, SummaryContext};
use crate::response::forced_response::Harmonics;
use crate::settings::SHAPES_BETWEEN;
use crate::study::PipelineError;

/// The summary of what is stored of a study that is not finished.
#[derive(Debug, Clone, PartialEq)]
pub struct PartialSummary {
    /// The summary of these rows.
    pub summary: StudySummary,
    /// Rows stored.
    pub stored: u64,
    /// Rows of the study, or of the shard of it.
    pub planned: u64,
}

/// The summary of the finished study in the folder `results`, from its tables.
///
/// # Errors
/// The folder holds no finished study, or a file of it is damaged.
pub fn summarise(results: &Path) -> Result<StudySummary, PipelineError> {
    let manifest = manifest_of(results)?;
    if manifest.state != RunState::Finished {
        return Err(PipelineError::Unfinished {
            folder: results.to_owned(),
        });
    }
    verify_tables(results, &manifest)?;
    summary_of_rows(results, &manifest)
}

/// The summary of the rows that are stored of an unfinished study in the folder `results`; none if
/// it is finished.
///
/// # Errors
/// The folder holds no study, or a file of it is damaged.
pub fn summarise_partly(results: &Path) -> Result<Option<PartialSummary>, PipelineError> {
    let manifest = manifest_of(results)?;
    if manifest.state == RunState::Finished {
        return Ok(None);
    }
    let summary = summary_of_rows(results, &manifest)?;
    Ok(Some(PartialSummary {
        stored: summary.rows.planned(),
        planned: planned_rows(&manifest),
        summary,
    }))
}

/// Rows that the study, or the shard of it, has when it is finished.
pub(super) fn planned_rows(manifest: &Manifest) -> u64 {
    let patterns = manifest.shard.map_or(manifest.patterns, |shard| {
        shard.size(manifest.patterns as usize) as u64
    });
    patterns * manifest.scenarios.len() as u64
}

fn manifest_of(results: &Path) -> Result<Manifest, PipelineError> {
    Manifest::read(results)?.ok_or_else(|| PipelineError::NoResults {
        folder: results.to_owned(),
    })
}

/// The summary of the rows stored, whose files are checked as they are read.
pub(in crate::campaign) fn summary_of_rows(
    results: &Path,
    manifest: &Manifest,
) -> Result<StudySummary, PipelineError> {
    let entries = &manifest.scenarios;
    let keys: Vec<Scenario> = entries.iter().map(ScenarioEntry::keys).collect();
    let tuned: Vec<TunedReference> = entries.iter().map(ScenarioEntry::tuned).collect();
    let mut accumulators = vec![ScenarioAccumulator::default(); keys.len()];
    row_store(results, manifest)?.visit(|row| {
        accumulators[row.scenario].add(&row);
        Ok(())
    })?;
    let stop = manifest.stop.as_ref();
    let confidence = stop.map_or(CONFIDENCE, |stop| stop.confidence);
    let stability: Vec<_> = entries.iter().map(|entry| entry.stability).collect();
    let records = records_of(&keys, (&tuned, &stability), accumulators, confidence);
    Ok(StudySummary::new(&context_of(manifest), &records))
}

/// The stored rows that a manifest is about.
pub(super) fn row_store(results: &Path, manifest: &Manifest) -> Result<RowStore, PipelineError> {
    let entries = &manifest.scenarios;
    let keys: Vec<Scenario> = entries.iter().map(ScenarioEntry::keys).collect();
    let schema = RowSchema {
        scenarios: keys.clone(),
        row_digests: entries
            .iter()
            .map(|entry| entry.row_digest.clone())
            .collect(),
        header: TableHeader {
            study_digest: manifest.study_digest.clone(),
            compression: Compression::default(),
            load_cases: TableHeader::load_cases_of(&keys),
        },
    };
    let rows = finished_rows(results, manifest);
    Ok(match manifest.state {
        // The parts of a finished folder are those of a run that goes on from there.
        RunState::Finished => RowStore::of_files(schema, rows),
        RunState::Running => RowStore::open(results, schema, rows)?,
    })
}

/// The scenarios with their statistics, bounds at `confidence`.
pub(in crate::campaign) fn records_of(
    scenarios: &[Scenario],
    (tuned, stability): (&[TunedReference], &[Option<ScenarioStability>]),
    accumulators: Vec<ScenarioAccumulator>,
    confidence: f64,
) -> Vec<ScenarioRecord> {
    scenarios
        .iter()
        .zip(tuned.iter().zip(stability))
        .zip(accumulators)
        .map(
            |((scenario, (tuned, stability)), accumulator)| ScenarioRecord {
                scenario: *scenario,
                tuned: tuned.clone(),
                statistics: accumulator.finish_at(confidence),
                stability: *stability,
            },
        )
        .collect()
}

pub(in crate::campaign) fn context_of(manifest: &Manifest) -> SummaryContext {
    let harmonics = manifest.study["solver"]["harmonics"].as_array().map(|set| {
        let numbers = set.iter().filter_map(serde_json::Value::as_u64);
        Harmonics::Set(numbers.map(|number| number as u32).collect())
    });
    SummaryContext {
        name: manifest.name.clone(),
        study_digest: manifest.study_digest.clone(),
        seed: manifest.seed,
        patterns: manifest.patterns,
        stop: manifest.stop.clone(),
        harmonics: harmonics.unwrap_or(Harmonics::Auto),
        tolerance: tolerance_of(manifest),
        basis: basis_of(manifest),
        numerical_error: numerical_error_of(manifest),
        rotation: serde_json::from_value(manifest.reduction["rotation"].clone()).ok(),
        stress_pa_per_m: manifest.study["output"]["stress_pa_per_m"].as_f64(),
        version: manifest.version.clone(),
    }
}

/// The tolerances that the study says, or those of the settings that `[accuracy]` chose.
fn tolerance_of(manifest: &Manifest) -> RowTolerance {
    let said = &manifest.study["solver"];
    let chosen = &manifest.chosen["accuracy"]["setting"];
    let number = |words: &str| words.parse().ok();
    let peak = chosen["peak_tolerance"].as_str().and_then(number);
    // A set of numbers, which may be chosen too, has no tolerance in the manifest.
    let harmonics = chosen["harmonics"].as_str();
    let harmonics = harmonics.and_then(|words| number(words.strip_prefix("auto ")?));
    RowTolerance {
        sampling_tolerance: peak
            .or_else(|| said["peak_tolerance"].as_f64())
            .map(sampling_tolerance),
        harmonic_tolerance: harmonics.or_else(|| said["harmonic_tolerance"].as_f64()),
    }
}

/// The basis and its measured error, from the facts that the engine gave.
fn basis_of(manifest: &Manifest) -> BasisSummary {
    let facts = &manifest.reduction;
    let taken = facts["tuned_peak_errors"]
        .as_array()
        .and_then(|tried| tried.last());
    let asked = &manifest.study["reduction"];
    let number = |key: &str| facts[key].as_f64();
    let truncation = number("craig_bampton_error");
    let wanted = asked["error"].as_f64().unwrap_or(f64::INFINITY);
    let on_receptances = facts["basis"] == TUNED_RECEPTANCES;
    let of_peaks = if on_receptances { SHAPES_BETWEEN } else { 1.0 };
    BasisSummary {
        name: facts["basis"].as_str().unwrap_or_default().to_owned(),
        tuned_peak_error: taken.and_then(|taken| taken["error"].as_f64()),
        craig_bampton_reach: number("craig_bampton_reach"),
        craig_bampton_error: truncation.filter(|_| asked["craig_bampton_modes"].is_u64()),
        wanted_error: wanted,
        wanted_peak_error: of_peaks * wanted,
        is_replaced: asked["basis"] == "stick_attachment" && facts["basis"] == TUNED_RECEPTANCES,
    }
}

/// What the choice of the settings says of the numerical error, where they were chosen by it.
fn numerical_error_of(manifest: &Manifest) -> Option<NumericalError> {
    let choice = &manifest.chosen["accuracy"];
    Some(NumericalError {
        accepted: choice["accepted_error"].as_f64()?,
        p95_upper: choice["evidence"]["amplitude"]["p95_upper"].as_f64(),
        worst_upper: choice["evidence"]["amplitude_worst_upper"].as_f64(),
        met: choice["met"].as_bool()?,
    })
}
