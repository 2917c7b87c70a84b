//! `peak_audit.parquet`: delivered peaks beside the highest value of a dense sweep.

use std::path::Path;

use super::column::{Cells, Column, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::forced_response::DensePeak;

/// One delivered row with what a dense sweep saw.
#[derive(Debug, Clone, PartialEq)]
pub struct PeakAuditRecord {
    /// Keys.
    pub scenario: Scenario,
    /// The row as delivered.
    pub delivered: ResponseRow,
    /// The sweep; none where the row was delivered without a value.
    pub swept: Option<DensePeak>,
}

impl PeakAuditRecord {
    /// Share by which the delivered peak is lower than the sweep's, `1 - delivered / swept`;
    /// negative where the search found more than the sweep.
    #[must_use]
    pub fn under_read(&self) -> Option<f64> {
        Some(1.0 - self.delivered.peak_amplitude_m? / self.swept?.amplitude_m)
    }
}

impl InScenario for PeakAuditRecord {
    fn scenario(&self) -> &Scenario {
        &self.scenario
    }
}

const COLUMNS: &[Column<PeakAuditRecord>] = &[
    key::scenario(),
    key::contact(),
    key::engine_order(),
    key::normal_load_n(),
    key::standard_deviation(),
    Column::shared(key::PATTERN, Cells::int32(|r| Some(r.delivered.pattern))),
    Column::new(
        "status",
        "",
        "How the delivered solution ended",
        Cells::string(|r| Some(r.delivered.status.name().to_owned())),
    ),
    Column::new(
        "peak_amplitude_m",
        "m",
        "Largest amplitude over blades and frequency, as delivered",
        Cells::float64(|r| r.delivered.peak_amplitude_m),
    ),
    Column::new(
        "peak_frequency_hz",
        "Hz",
        "Excitation frequency of the peak, as delivered",
        Cells::float64(|r| r.delivered.peak_frequency_hz),
    ),
    Column::new(
        "swept_amplitude_m",
        "m",
        "Largest amplitude over blades and frequency of the sweep",
        Cells::float64(|r| Some(r.swept?.amplitude_m)),
    ),
    Column::new(
        "swept_frequency_hz",
        "Hz",
        "Its frequency",
        Cells::float64(|r| Some(r.swept?.frequency_hz)),
    ),
    Column::new(
        "under_read",
        "1",
        "1 - peak_amplitude_m / swept_amplitude_m",
        Cells::float64(PeakAuditRecord::under_read),
    ),
    Column::new(
        "swept_points",
        "1",
        "Frequencies of the sweep, failed ones included",
        Cells::int64(|r| Some(r.swept?.points as u64)),
    ),
    Column::new(
        "swept_failed",
        "1",
        "Frequencies of the sweep without a solution",
        Cells::int64(|r| Some(r.swept?.failed as u64)),
    ),
    Column::new(
        "swept_with_fewer_harmonics",
        "1",
        "Frequencies of the sweep solved with fewer harmonics than the load has",
        Cells::int64(|r| Some(r.swept?.with_fewer_harmonics as u64)),
    ),
    Column::new(
        "swept_inside",
        "",
        "The highest value of the sweep lies inside of its band",
        Cells::boolean(|r| Some(r.swept?.inside)),
    ),
];

/// Columns of `peak_audit.parquet`.
pub const PEAK_AUDIT_COLUMNS: &[ColumnSpec] = &specs::<_, _, { COLUMNS.len() }>(COLUMNS);

/// Writes `peak_audit.parquet`; `seed` is that of the sample, kept in the file's metadata.
///
/// # Errors
/// The file cannot be written.
pub fn write_peak_audit(
    path: &Path,
    records: &[PeakAuditRecord],
    header: &TableHeader,
    seed: u64,
) -> Result<(), TableError> {
    let sample = [
        ("blisk.sample_seed", seed.to_string()),
        ("blisk.sample_rows", records.len().to_string()),
    ];
    let mut writer = TableWriter::create_with(path, PEAK_AUDIT_COLUMNS, header, &sample)?;
    writer.write(values_of(COLUMNS, records))?;
    writer.finish()
}
