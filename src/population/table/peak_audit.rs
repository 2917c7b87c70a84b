//! `peak_audit.parquet`: delivered peaks beside the highest value of a dense sweep.

use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::writer::TableWriter;
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::forced_response::DensePeak;

use ColumnKind::{Boolean, Float64, Int64, String as Text};

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

/// Columns of `peak_audit.parquet`.
pub const PEAK_AUDIT_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    key::PATTERN,
    ColumnSpec::new("status", Text, "", "How the delivered solution ended"),
    ColumnSpec::new(
        "peak_amplitude_m",
        Float64,
        "m",
        "Largest amplitude over blades and frequency, as delivered",
    ),
    ColumnSpec::new(
        "peak_frequency_hz",
        Float64,
        "Hz",
        "Excitation frequency of the peak, as delivered",
    ),
    ColumnSpec::new(
        "swept_amplitude_m",
        Float64,
        "m",
        "Largest amplitude over blades and frequency of the sweep",
    ),
    ColumnSpec::new("swept_frequency_hz", Float64, "Hz", "Its frequency"),
    ColumnSpec::new(
        "under_read",
        Float64,
        "1",
        "1 - peak_amplitude_m / swept_amplitude_m",
    ),
    ColumnSpec::new(
        "swept_points",
        Int64,
        "1",
        "Frequencies of the sweep, failed ones included",
    ),
    ColumnSpec::new(
        "swept_failed",
        Int64,
        "1",
        "Frequencies of the sweep without a solution",
    ),
    ColumnSpec::new(
        "swept_inside",
        Boolean,
        "",
        "The highest value of the sweep lies inside of its band",
    ),
];

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
    type Record = PeakAuditRecord;
    let ids = |value: &dyn Fn(&Record) -> u32| {
        Values::Int32(records.iter().map(|r| Some(value(r) as i32)).collect())
    };
    let floats = |value: &dyn Fn(&Record) -> Option<f64>| {
        Values::Float64(records.iter().map(value).collect())
    };
    let names = |value: &dyn Fn(&Record) -> &str| {
        Values::String(records.iter().map(|r| Some(value(r).to_owned())).collect())
    };
    let counts = |value: &dyn Fn(&DensePeak) -> usize| {
        let counts = records.iter().map(|r| r.swept.as_ref().map(value));
        Values::Int64(counts.map(|count| count.map(|n| n as i64)).collect())
    };
    let values = vec![
        ids(&|r| r.scenario.index as u32),
        names(&|r| r.scenario.contact.name()),
        ids(&|r| r.scenario.engine_order),
        floats(&|r| r.scenario.contact.normal_load_n()),
        floats(&|r| r.scenario.standard_deviation),
        ids(&|r| r.delivered.pattern),
        names(&|r| r.delivered.status.name()),
        floats(&|r| r.delivered.peak_amplitude_m),
        floats(&|r| r.delivered.peak_frequency_hz),
        floats(&|r| r.swept.map(|swept| swept.amplitude_m)),
        floats(&|r| r.swept.map(|swept| swept.frequency_hz)),
        floats(&Record::under_read),
        counts(&|swept| swept.points),
        counts(&|swept| swept.failed),
        Values::Boolean(
            records
                .iter()
                .map(|r| r.swept.map(|swept| swept.inside))
                .collect(),
        ),
    ];
    let sample = [
        ("blisk.sample_seed", seed.to_string()),
        ("blisk.sample_rows", records.len().to_string()),
    ];
    let mut writer = TableWriter::create_with(path, PEAK_AUDIT_COLUMNS, header, &sample)?;
    writer.write(values)?;
    writer.finish()
}
