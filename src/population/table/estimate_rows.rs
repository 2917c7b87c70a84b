//! `sample.parquet` of an estimate: all patterns with their surrogate, and those that were solved.

use std::io::ErrorKind;
use std::path::Path;

use super::atomic::move_file;
use super::checked_json::{ESTIMATE, SAMPLE};
use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::percentiles::scenario_keys;
use super::places::{NEXT, digest_stored};
use super::publication::discard;
use super::writer::TableWriter;
use super::{TableError, TableHeader, digest_file};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::population::statistics::Quantity;

use ColumnKind::{Boolean, Float64, Int32, String as Text};

/// Columns of `sample.parquet`.
pub const ESTIMATE_ROW_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    key::PATTERN,
    ColumnSpec::new(
        "surrogate_amplitude_m",
        Float64,
        "m",
        "Peak amplitude of the surrogate; null where it has none",
    ),
    ColumnSpec::new(
        "stratum",
        Int32,
        "",
        "Stratum, from the highest surrogate down",
    ),
    ColumnSpec::new(
        "inclusion_probability",
        Float64,
        "1",
        "Share of the patterns of its stratum that are solved",
    ),
    ColumnSpec::new("pilot", Boolean, "", "Whether it is a row of the pilot"),
    ColumnSpec::new(
        "status",
        Text,
        "",
        "How the solution ended; null = not solved",
    ),
    ColumnSpec::new(
        "peak_amplitude_m",
        Float64,
        "m",
        "Peak amplitude of the row",
    ),
    ColumnSpec::new(
        "amplification_factor",
        Float64,
        "1",
        "Amplification factor of the row",
    ),
];

/// A pattern of an estimate.
#[derive(Debug, Clone)]
pub struct EstimateRow {
    /// Scenario, with its index in the study.
    pub scenario: Scenario,
    /// Pattern id.
    pub pattern: u32,
    /// Peak amplitude of the surrogate, m.
    pub surrogate_amplitude_m: Option<f64>,
    /// Stratum.
    pub stratum: usize,
    /// Share of the patterns of its stratum that are solved.
    pub inclusion_probability: f64,
    /// Whether it is a row of the pilot.
    pub pilot: bool,
    /// Its row; none if it was not solved.
    pub row: Option<ResponseRow>,
}

/// Puts `sample.parquet` into the folder `results`, in the order of `rows`; its digest. An estimate that is about
/// another sample is removed before, so that a process that is killed leaves none beside a sample that it is not about.
///
/// # Errors
/// A file cannot be written or removed.
pub fn write_sample(
    results: &Path,
    rows: &[EstimateRow],
    header: &TableHeader,
) -> Result<String, TableError> {
    let (path, staged) = (results.join(SAMPLE), results.join(NEXT).join(SAMPLE));
    write_estimate_rows(&staged, rows, header)?;
    let digest = digest_file(&staged).map_err(TableError::io("read", &staged))?;
    if !digest_stored(&path).is_ok_and(|found| found.as_ref() == Some(&digest)) {
        let estimate = results.join(ESTIMATE);
        match std::fs::remove_file(&estimate) {
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            removed => removed.map_err(TableError::io("remove", &estimate))?,
        }
    }
    move_file(&staged, &path)?;
    discard(results)?;
    Ok(digest)
}

/// Writes `sample.parquet` in the order of `rows`.
///
/// # Errors
/// The file cannot be written.
pub fn write_estimate_rows(
    path: &Path,
    rows: &[EstimateRow],
    header: &TableHeader,
) -> Result<(), TableError> {
    let floats = |value: &dyn Fn(&EstimateRow) -> Option<f64>| {
        Values::Float64(rows.iter().map(value).collect())
    };
    let integers = |value: &dyn Fn(&EstimateRow) -> i32| {
        Values::Int32(rows.iter().map(|row| Some(value(row))).collect())
    };
    let mut values = scenario_keys(rows.iter().map(|row| &row.scenario));
    values.push(integers(&|row| row.pattern as i32));
    values.push(floats(&|row| row.surrogate_amplitude_m));
    values.push(integers(&|row| row.stratum as i32));
    values.push(floats(&|row| Some(row.inclusion_probability)));
    values.push(Values::Boolean(
        rows.iter().map(|row| Some(row.pilot)).collect(),
    ));
    values.push(Values::String(
        rows.iter()
            .map(|row| Some(row.row.as_ref()?.status.name().to_owned()))
            .collect(),
    ));
    values.push(floats(&|row| {
        Quantity::PeakAmplitudeM.of(row.row.as_ref()?)
    }));
    values.push(floats(&|row| {
        Quantity::AmplificationFactor.of(row.row.as_ref()?)
    }));
    let mut writer = TableWriter::create(path, ESTIMATE_ROW_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}
