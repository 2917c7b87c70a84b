//! `distribution.parquet`: the distribution of every quantity with its simultaneous band.

use std::path::Path;

use super::column::{Cells, Column, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::percentiles::QUANTITY;
use super::{ScenarioRecord, TableError, TableHeader};
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::BandPoint;

/// A point of the distribution of a quantity of a scenario.
struct DistributionRow<'a> {
    scenario: &'a Scenario,
    quantity: &'static str,
    point: &'a BandPoint,
}

impl InScenario for DistributionRow<'_> {
    fn scenario(&self) -> &Scenario {
        self.scenario
    }
}

impl<'a> DistributionRow<'a> {
    const COLUMNS: &'a [Column<Self>] = &[
        key::scenario(),
        key::contact(),
        key::engine_order(),
        key::normal_load_n(),
        key::standard_deviation(),
        Column::shared(QUANTITY, Cells::string(|r| Some(r.quantity.to_owned()))),
        Column::new(
            "value",
            "",
            "A value of the sample",
            Cells::float64(|r| Some(r.point.value)),
        ),
        Column::new(
            "cumulative",
            "1",
            "Share of the patterns with a result that are at most this value",
            Cells::float64(|r| Some(r.point.cumulative)),
        ),
        Column::new(
            "cumulative_lower",
            "1",
            "Lower edge of the 95 % band of Dvoretzky, Kiefer and Wolfowitz, failures at plus infinity",
            Cells::float64(|r| Some(r.point.lower)),
        ),
        Column::new(
            "cumulative_upper",
            "1",
            "Upper edge of the same band, failures at minus infinity",
            Cells::float64(|r| Some(r.point.upper)),
        ),
    ];
}

/// Columns of `distribution.parquet`.
pub const DISTRIBUTION_COLUMNS: &[ColumnSpec] =
    &specs::<_, _, { DistributionRow::COLUMNS.len() }>(DistributionRow::COLUMNS);

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
        let mut rows = Vec::new();
        let quantities = [
            (
                "amplification_factor",
                &statistics.amplification_factor_band,
            ),
            ("peak_amplitude_m", &statistics.peak_amplitude_m_band),
        ];
        for (quantity, band) in quantities {
            rows.extend(band.points.iter().map(|point| DistributionRow {
                scenario: &record.scenario,
                quantity,
                point,
            }));
        }
        if rows.is_empty() {
            continue;
        }
        writer.write(values_of(DistributionRow::COLUMNS, &rows))?;
    }
    writer.finish()
}
