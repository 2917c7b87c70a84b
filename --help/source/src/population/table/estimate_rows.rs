//! `sample.parquet` of an estimate: all patterns with their surrogate, and those that were solved.

use std::io::ErrorKind;
use std::path::Path;

use super::atomic::move_file;
use super::checked_json::{ESTIMATE, SAMPLE};
use super::column::{Cells, Column, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::places::{NEXT, digest_stored};
use super::publication::discard;
use super::{TableError, TableHeader, digest_file};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::population::statistics::Quantity;

const COLUMNS: &[Column<EstimateRow>] = &[
    key::scenario(),
    key::contact(),
    key::engine_order(),
    key::normal_load_n(),
    key::standard_deviation(),
    Column::shared(key::PATTERN, Cells::int32(|r| Some(r.pattern))),
    Column::new(
        "surrogate_amplitude_m",
        "m",
        "Peak amplitude of the surrogate; null where it has none",
        Cells::float64(|r| r.surrogate_amplitude_m),
    ),
    Column::new(
        "stratum",
        "",
        "Stratum, from the highest surrogate down",
        Cells::int32(|r| Some(r.stratum as u32)),
    ),
    Column::new(
        "inclusion_probability",
        "1",
        "Share of the patterns of its stratum that are solved",
        Cells::float64(|r| Some(r.inclusion_probability)),
    ),
    Column::new(
        "pilot",
        "",
        "Whether it is a row of the pilot",
        Cells::boolean(|r| Some(r.pilot)),
    ),
    Column::new(
        "status",
        "",
        "How the solution ended; null = not solved",
        Cells::string(|r| Some(r.row.as_ref()?.status.name().to_owned())),
    ),
    Column::new(
        "peak_amplitude_m",
        "m",
        "Peak amplitude of the row",
        Cells::float64(|r| Quantity::PeakAmplitudeM.of(r.row.as_ref()?)),
    ),
    Column::new(
        "amplification_factor",
        "1",
        "Amplification factor of the row",
        Cells::float64(|r| Quantity::AmplificationFactor.of(r.row.as_ref()?)),
    ),
];

/// Columns of `sample.parquet`.
pub const ESTIMATE_ROW_COLUMNS: &[ColumnSpec] = &specs::<_, _, { COLUMNS.len() }>(COLUMNS);

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

impl InScenario for EstimateRow {
    fn scenario(&self) -> &Scenario {
        &self.scenario
    }
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
    let mut writer = TableWriter::create(path, ESTIMATE_ROW_COLUMNS, header)?;
    writer.write(values_of(COLUMNS, rows))?;
    writer.finish()
}
