//! `distribution.parquet`: the distribution of every quantity with its simultaneous band.

use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::percentiles::{QUANTITY, scenario_keys};
use super::writer::TableWriter;
use super::{ScenarioRecord, TableError, TableHeader};
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::BandPoint;

use ColumnKind::Float64;

/// Columns of `distribution.parquet`.
pub const DISTRIBUTION_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    QUANTITY,
    ColumnSpec::new("value", Float64, "", "A value of the sample"),
    ColumnSpec::new(
        "cumulative",
        Float64,
        "1",
        "Share of the patterns with a result that are at most this value",
    ),
    ColumnSpec::new(
        "cumulative_lower",
        Float64,
        "1",
        "Lower edge of the 95 % band of Dvoretzky, Kiefer and Wolfowitz, failures at plus infinity",
    ),
    ColumnSpec::new(
        "cumulative_upper",
        Float64,
        "1",
        "Upper edge of the same band, failures at minus infinity",
    ),
];

/// Writes `distribution.parquet`, ordered by scenario, quantity, value.
///
/// # Errors
/// The file cannot be written.
pub fn write_distribution(
    path: &Path,
    records: &[ScenarioRecord],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut writer = TableWriter::create(path, DISTRIBUTION_COLUMNS, header)?;
    for record in records {
        let statistics = &record.statistics;
        let mut rows: Vec<(&Scenario, &'static str, &BandPoint)> = Vec::new();
        let quantities = [
            (
                "amplification_factor",
                &statistics.amplification_factor_band,
            ),
            ("peak_amplitude_m", &statistics.peak_amplitude_m_band),
        ];
        for (quantity, band) in quantities {
            rows.extend(band.points.iter().map(|p| (&record.scenario, quantity, p)));
        }
        if rows.is_empty() {
            continue;
        }
        let floats = |value: fn(&BandPoint) -> f64| {
            Values::Float64(rows.iter().map(|row| Some(value(row.2))).collect())
        };
        let mut values = scenario_keys(rows.iter().map(|row| row.0));
        values.push(Values::String(
            rows.iter().map(|row| Some(row.1.to_owned())).collect(),
        ));
        values.push(floats(|point| point.value));
        values.push(floats(|point| point.cumulative));
        values.push(floats(|point| point.lower));
        values.push(floats(|point| point.upper));
        writer.write(values)?;
    }
    writer.finish()
}
