//! The normal load that keeps the response lowest, of the tuned wheel and of a population.

use std::fmt::Write;

use blisk::population::monte_carlo::ResponseRow;
use blisk::population::statistics::SampleStatistics;
use blisk::response::forced_response::ContactCondition;
use blisk::study::Study;
use rayon::prelude::*;

use super::super::support::{Case, package};
use super::{Section, table};

const LOADS_N: [f64; 10] = [
    240.0, 320.0, 400.0, 480.0, 560.0, 640.0, 800.0, 1200.0, 1600.0, 4000.0,
];
const PATTERNS: u32 = 100;
const STANDARD_DEVIATIONS: [f64; 3] = [0.005, 0.01, 0.03];

pub(super) fn section() -> Section {
    let case = Case::new(Study::read(&package("studies/quickstart.toml")).unwrap());
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let tuned: Vec<_> = LOADS_N
        .map(|normal_load_n| case.tuned(ContactCondition::Full { normal_load_n }))
        .into_iter()
        .collect();
    columns.push(
        tuned
            .iter()
            .map(|tuned| tuned.amplitude_m.unwrap())
            .collect(),
    );
    let mut failed = 0;
    for deviation in STANDARD_DEVIATIONS {
        let of_load = LOADS_N.iter().zip(&tuned).map(|(&normal_load_n, tuned)| {
            let contact = ContactCondition::Full { normal_load_n };
            let rows: Vec<ResponseRow> = (0..PATTERNS)
                .into_par_iter()
                .map(|id| case.row(&case.pattern(id, Some(deviation)), contact, tuned))
                .collect();
            let peaks: Vec<f64> = rows.iter().filter_map(|row| row.peak_amplitude_m).collect();
            let missing = rows.len() - peaks.len();
            failed += missing;
            let statistics = SampleStatistics::new(peaks, missing as u64);
            statistics.percentile(95).unwrap().value.unwrap()
        });
        columns.push(of_load.collect());
    }
    let rows: Vec<Vec<String>> = LOADS_N
        .iter()
        .enumerate()
        .map(|(at, load)| {
            let mut row = vec![format!("{load}")];
            row.extend(
                columns
                    .iter()
                    .map(|column| format!("{:.2}", 1e6 * column[at])),
            );
            row
        })
        .collect();
    let header = [
        "normal load per sector, N",
        "tuned, um",
        "P95 at 0.5 %, um",
        "P95 at 1 %, um",
        "P95 at 3 %, um",
    ];
    let mut text = format!(
        "Built-in wheel of studies/quickstart.toml with its basis and harmonics, {PATTERNS} patterns for each standard deviation of the blade \
         stiffness, {failed} rows failed.\n\n{}\n",
        table(&header, &rows)
    );
    for (name, column) in header[1..].iter().zip(&columns) {
        let lowest = (0..LOADS_N.len()).min_by(|&a, &b| column[a].total_cmp(&column[b]));
        let load = LOADS_N[lowest.unwrap()];
        writeln!(text, "- {name}: lowest at {load} N").unwrap();
    }
    Section {
        title: "Optimal normal load, tuned and mistuned",
        text,
    }
}
