//! `percentiles.parquet`: every percentile of every quantity with ranks and achieved coverage.

use std::path::Path;

use super::column::{Cells, Column, ColumnKind, ColumnSpec, InScenario, key, specs, values_of};
use super::parquet::TableWriter;
use super::{ScenarioRecord, TableError, TableHeader};
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::Percentile;

/// The column that names the quantity of a row.
pub(super) const QUANTITY: ColumnSpec = ColumnSpec::new(
    "quantity",
    ColumnKind::String,
    "",
    "amplification_factor (ratio) or peak_amplitude_m (m)",
);

/// A percentile of a quantity of a scenario.
struct PercentileRow<'a> {
    scenario: &'a Scenario,
    quantity: &'static str,
    found: &'a Percentile,
}

impl InScenario for PercentileRow<'_> {
    fn scenario(&self) -> &Scenario {
        self.scenario
    }
}

impl<'a> PercentileRow<'a> {
    const COLUMNS: &'a [Column<Self>] = &[
        key::scenario(),
        key::contact(),
        key::engine_order(),
        key::normal_load_n(),
        key::standard_deviation(),
        Column::shared(QUANTITY, Cells::string(|r| Some(r.quantity.to_owned()))),
        Column::new(
            "percent",
            "%",
            "The percentile",
            Cells::float64(|r| Some(r.found.percent)),
        ),
        Column::new(
            "value",
            "",
            "Order statistic of the patterns with a result; null = not estimable",
            Cells::float64(|r| r.found.value),
        ),
        Column::new(
            "lower",
            "",
            "Lower 95 % bound, distribution-free, failures at minus infinity",
            Cells::float64(|r| r.found.lower),
        ),
        Column::new(
            "upper",
            "",
            "Upper 95 % bound, distribution-free, failures at plus infinity",
            Cells::float64(|r| r.found.upper),
        ),
        Column::new(
            "rank_lower",
            "",
            "Rank of the lower bound among the planned patterns, from 1",
            Cells::int32(|r| r.found.rank_lower.map(|rank| rank as u32)),
        ),
        Column::new(
            "rank_upper",
            "",
            "Rank of the upper bound among the planned patterns, from 1",
            Cells::int32(|r| r.found.rank_upper.map(|rank| rank as u32)),
        ),
        Column::new(
            "achieved_coverage",
            "1",
            "Probability that the interval of these ranks holds the percentile",
            Cells::float64(|r| r.found.achieved_coverage),
        ),
        Column::new(
            "estimable",
            "",
            "Whether there is a value",
            Cells::boolean(|r| Some(r.found.value.is_some())),
        ),
        Column::new(
            "status",
            "",
            "estimated, too_few_patterns or too_many_failures",
            Cells::string(|r| Some(r.found.status.name().to_owned())),
        ),
    ];
}

/// Columns of `percentiles.parquet`.
pub const PERCENTILE_COLUMNS: &[ColumnSpec] =
    &specs::<_, _, { PercentileRow::COLUMNS.len() }>(PercentileRow::COLUMNS);

/// Writes `percentiles.parquet`, ordered by scenario, quantity, percentile.
///
/// # Errors
/// The file cannot be written.
pub fn write_percentiles(
    path: &Path,
    records: &[ScenarioRecord],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut rows = Vec::new();
    for record in records {
        let quantities = [
            (
                "amplification_factor",
                &record.statistics.amplification_factor,
            ),
            ("peak_amplitude_m", &record.statistics.peak_amplitude_m),
        ];
        for (quantity, sample) in quantities {
            let percentiles = sample.percentiles.iter();
            rows.extend(percentiles.map(|found| PercentileRow {
                scenario: &record.scenario,
                quantity,
                found,
            }));
        }
    }
    let mut writer = TableWriter::create(path, PERCENTILE_COLUMNS, header)?;
    writer.write(values_of(PercentileRow::COLUMNS, &rows))?;
    writer.finish()
}
