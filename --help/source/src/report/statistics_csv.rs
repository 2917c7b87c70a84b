//! The summary of a study as one table of comma-separated values, a row per scenario, for spreadsheets.

use std::fmt::Write;

use super::{ScenarioSummary, StudySummary};
use crate::population::monte_carlo::LoadCaseName;
use crate::population::statistics::{PERCENTILES, SampleStatistics};

/// A row per scenario of `summary` under a header with units in its names.
///
/// Decimal points, no separators of thousands, no quotes, ASCII alone: names of load cases have neither commas nor
/// spaces. A number that does not exist is an empty cell, as it is a null in the Parquet tables, so that a spreadsheet
/// takes the column as numbers.
#[must_use]
pub fn statistics_csv(summary: &StudySummary) -> String {
    let mut csv = String::new();
    for (place, scenario) in summary.scenarios.iter().enumerate() {
        let cells = cells(scenario);
        if place == 0 {
            let names: Vec<&str> = cells.iter().map(|(name, _)| name.as_str()).collect();
            // Writing to a String cannot fail.
            let _ = writeln!(csv, "{}", names.join(","));
        }
        let values: Vec<&str> = cells.iter().map(|(_, value)| value.as_str()).collect();
        let _ = writeln!(csv, "{}", values.join(","));
    }
    csv
}

/// Columns with the values of one scenario.
fn cells(scenario: &ScenarioSummary) -> Vec<(String, String)> {
    let mut cells: Vec<(String, String)> = Vec::new();
    let mut cell = |name: &str, value: String| cells.push((name.to_owned(), value));
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let case = scenario.load_case.as_ref().map(LoadCaseName::as_str);
    cell("scenario", scenario.scenario.to_string());
    cell("load_case", case.unwrap_or_default().to_owned());
    cell("engine_order", scenario.engine_order.to_string());
    cell("standard_deviation", number(scenario.standard_deviation));
    cell("contact", scenario.contact.to_owned());
    cell("normal_load_n", number(scenario.normal_load_n));
    cell("speed_rpm", number(scenario.speed_rpm));
    cell("rows_planned", scenario.rows.planned().to_string());
    cell("rows_ok", scenario.rows.ok().to_string());
    cell("rows_failed", scenario.rows.failed().to_string());
    cell("tuned_status", scenario.tuned_status.to_owned());
    cell("tuned_amplitude_m", number(scenario.tuned_amplitude_m));
    cell("tuned_frequency_hz", number(scenario.tuned_frequency_hz));
    cell("crossing_rpm", number(scenario.crossing_rpm()));
    let samples: [(&str, &SampleStatistics); 2] = [
        ("peak_amplitude_m", &scenario.peak_amplitude_m),
        ("amplification_factor", &scenario.amplification_factor),
    ];
    for (quantity, sample) in samples {
        cell(&format!("{quantity}_mean"), number(sample.mean));
        for percent in PERCENTILES {
            let found = sample.percentile(percent);
            let name = format!("{quantity}_p{percent}");
            cell(&name, number(found.and_then(|own| own.value)));
            cell(
                &format!("{name}_lower"),
                number(found.and_then(|own| own.lower)),
            );
            cell(
                &format!("{name}_upper"),
                number(found.and_then(|own| own.upper)),
            );
        }
    }
    cell(
        "mean_slipping_fraction",
        number(scenario.mean_slipping_fraction),
    );
    cell("separated_rows_fraction", number(scenario.separated_rows));
    cells
}
