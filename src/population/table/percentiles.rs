//! `percentiles.parquet`: every percentile of every quantity with ranks and achieved coverage.

use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::writer::TableWriter;
use super::{ScenarioRecord, TableError, TableHeader};
use crate::population::monte_carlo::Scenario;
use crate::population::statistics::Percentile;

use ColumnKind::{Boolean, Float64, Int32, String as Text};

/// The column that names the quantity of a row.
pub(super) const QUANTITY: ColumnSpec = ColumnSpec::new(
    "quantity",
    Text,
    "",
    "amplification_factor (ratio) or peak_amplitude_m (m)",
);

/// Columns of `percentiles.parquet`.
pub const PERCENTILE_COLUMNS: &[ColumnSpec] = &[
    key::SCENARIO,
    key::CONTACT,
    key::ENGINE_ORDER,
    key::NORMAL_LOAD,
    key::STANDARD_DEVIATION,
    QUANTITY,
    ColumnSpec::new("percent", Float64, "%", "The percentile"),
    ColumnSpec::new(
        "value",
        Float64,
        "",
        "Order statistic of the patterns with a result; null = not estimable",
    ),
    ColumnSpec::new(
        "lower",
        Float64,
        "",
        "Lower 95 % bound, distribution-free, failures at minus infinity",
    ),
    ColumnSpec::new(
        "upper",
        Float64,
        "",
        "Upper 95 % bound, distribution-free, failures at plus infinity",
    ),
    ColumnSpec::new(
        "rank_lower",
        Int32,
        "",
        "Rank of the lower bound among the planned patterns, from 1",
    ),
    ColumnSpec::new(
        "rank_upper",
        Int32,
        "",
        "Rank of the upper bound among the planned patterns, from 1",
    ),
    ColumnSpec::new(
        "achieved_coverage",
        Float64,
        "1",
        "Probability that the interval of these ranks holds the percentile",
    ),
    ColumnSpec::new("estimable", Boolean, "", "Whether there is a value"),
    ColumnSpec::new(
        "status",
        Text,
        "",
        "estimated, too_few_patterns or too_many_failures",
    ),
];

/// Writes `percentiles.parquet`, ordered by scenario, quantity, percentile.
///
/// # Errors
/// The file cannot be written.
pub fn write_percentiles(
    path: &Path,
    records: &[ScenarioRecord],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut rows: Vec<(&Scenario, &'static str, &Percentile)> = Vec::new();
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
            rows.extend(percentiles.map(|percentile| (&record.scenario, quantity, percentile)));
        }
    }
    let floats = |value: &dyn Fn(&Percentile) -> Option<f64>| {
        Values::Float64(rows.iter().map(|(_, _, found)| value(found)).collect())
    };
    let ranks = |value: &dyn Fn(&Percentile) -> Option<u64>| {
        let rank = |found: &Percentile| value(found).map(|rank| rank as i32);
        Values::Int32(rows.iter().map(|(_, _, found)| rank(found)).collect())
    };
    let mut values = scenario_keys(rows.iter().map(|(scenario, _, _)| *scenario));
    values.push(Values::String(
        rows.iter().map(|row| Some(row.1.to_owned())).collect(),
    ));
    values.push(floats(&|found| Some(found.percent)));
    values.push(floats(&|found| found.value));
    values.push(floats(&|found| found.lower));
    values.push(floats(&|found| found.upper));
    values.push(ranks(&|found| found.rank_lower));
    values.push(ranks(&|found| found.rank_upper));
    values.push(floats(&|found| found.achieved_coverage));
    values.push(Values::Boolean(
        rows.iter().map(|row| Some(row.2.value.is_some())).collect(),
    ));
    values.push(Values::String(
        rows.iter()
            .map(|row| Some(row.2.status.name().to_owned()))
            .collect(),
    ));
    let mut writer = TableWriter::create(path, PERCENTILE_COLUMNS, header)?;
    writer.write(values)?;
    writer.finish()
}

/// Values of the five key columns of a scenario, one per item.
pub(super) fn scenario_keys<'a>(scenarios: impl Iterator<Item = &'a Scenario>) -> Vec<Values> {
    let scenarios: Vec<&Scenario> = scenarios.collect();
    vec![
        Values::Int32(scenarios.iter().map(|s| Some(s.index as i32)).collect()),
        Values::String(
            scenarios
                .iter()
                .map(|s| Some(s.contact.name().to_owned()))
                .collect(),
        ),
        Values::Int32(
            scenarios
                .iter()
                .map(|s| Some(s.engine_order as i32))
                .collect(),
        ),
        Values::Float64(
            scenarios
                .iter()
                .map(|s| s.contact.normal_load_n())
                .collect(),
        ),
        Values::Float64(scenarios.iter().map(|s| s.standard_deviation).collect()),
    ]
}
