//! Weights of a smoothed percentile against sums with fifty digits.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use blisk::population::statistics::{PercentileEstimator, resample_percentile};

/// `tests/data/statistics/percentile_windows.csv`, made by the program beside it: patterns, percent, rank, and the sum of
/// the weights up to that rank.
fn reference() -> Vec<(usize, f64, usize, f64)> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/statistics/percentile_windows.csv");
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (
                cells[0].parse().unwrap(),
                cells[1].parse().unwrap(),
                cells[2].parse().unwrap(),
                cells[3].parse().unwrap(),
            )
        })
        .collect()
}

/// Of a column that is 0 up to a rank and 1 above it the smoothed percentile is the sum of the weights above.
#[test]
fn weights_of_a_smoothed_percentile_are_those_of_the_beta_law_up_to_a_million_patterns() {
    let rows = reference();
    assert_eq!(rows.len(), 45);
    for (patterns, percent, rank, expected) in rows {
        let column: Vec<Option<f64>> = (1..=patterns)
            .map(|own| Some(f64::from(u8::from(own > rank))))
            .collect();
        let found = resample_percentile(
            &[&column],
            percent,
            PercentileEstimator::SmoothedOrderStatistics,
            0,
            (1, 1),
        );
        let error = (1.0 - found[0].low - expected).abs();
        assert!(
            error < 1e-9,
            "P{percent} of {patterns}, rank {rank}: {error:e}"
        );
    }
}
