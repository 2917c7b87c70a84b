//! The peak search against dense sweeps of the same rows.

use blisk::population::monte_carlo::RowSolver;
use blisk::response::forced_response::{FrequencyBand, SolverOptions, dense_peak};
use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::Pattern;
use rayon::prelude::*;

use super::contact::random::Random;
use super::wheels::{ENGINE_ORDER, Wheel, full, pattern, solve_row};

/// A row with the band that holds its peak and the half-bandwidth of its linear resonances, Hz.
struct Row {
    case: usize,
    pattern: Pattern,
    load: f64,
    standard_deviation: f64,
}

/// A wheel with what its rows are drawn from.
struct Population {
    wheel: Wheel,
    loads: &'static [f64],
    band_hz: (f64, f64),
    half_bandwidth_hz: f64,
    rows: usize,
}

fn populations() -> [Population; 3] {
    [
        Population {
            wheel: Wheel {
                amplitude_n: 10.0,
                ..Wheel::lumped24()
            },
            loads: &[10.0, 30.0, 50.0, 150.0],
            band_hz: (330.0, 382.0),
            half_bandwidth_hz: 0.35,
            rows: 24,
        },
        Population {
            wheel: Wheel::wheel8(),
            loads: &[200.0, 400.0, 800.0, 1600.0],
            band_hz: (575.0, 655.0),
            half_bandwidth_hz: 0.61,
            rows: 24,
        },
        Population {
            wheel: Wheel {
                amplitude_n: 10.0,
                ..Wheel::wide_gap()
            },
            loads: &[50.0, 600.0],
            band_hz: (100.0, 290.0),
            half_bandwidth_hz: 0.1,
            rows: 12,
        },
    ]
}

const DEVIATIONS: [f64; 6] = [0.01, 0.02, 0.03, 0.05, 0.07, 0.1];

/// The highest value of a dense sweep, every frequency of which must converge.
fn swept_peak(population: &Population, solver: &RowSolver, row: &Row) -> f64 {
    let contact = full(row.load);
    let found = dense_peak(
        population.band_hz,
        population.half_bandwidth_hz,
        |frequencies| {
            let curve = solver.curve(ENGINE_ORDER, contact, Some(&row.pattern), frequencies);
            let largest = |all: Vec<f64>| all.into_iter().fold(0.0, f64::max);
            let points = curve.unwrap().into_iter();
            points.map(|(_, point)| point.ok().map(largest)).collect()
        },
    );
    assert!(found.inside, "case {}: the peak is at an end", row.case);
    assert_eq!(found.failed, 0, "case {}: points of the sweep", row.case);
    found.amplitude_m
}

#[test]
fn the_search_finds_what_a_dense_sweep_finds() {
    let options = SolverOptions::default();
    let mut worst = 0.0_f64;
    for population in populations() {
        let solver = population.wheel.solver(&[1], options.clone());
        let mut random = Random(41);
        let rows: Vec<Row> = (0..population.rows)
            .map(|case| {
                let standard_deviation = DEVIATIONS[case % DEVIATIONS.len()];
                Row {
                    case,
                    pattern: pattern(&population.wheel.deviations(&mut random, standard_deviation)),
                    load: population.loads[case / DEVIATIONS.len()],
                    standard_deviation,
                }
            })
            .collect();
        let under_reads: Vec<f64> = rows
            .par_iter()
            .map(|row| {
                let found = solve_row(&solver, &row.pattern, full(row.load)).1;
                assert_eq!(found.status, Status::Ok, "case {}", row.case);
                let dense = swept_peak(&population, &solver, row);
                1.0 - found.peak_amplitude_m.unwrap() / dense
            })
            .collect();
        for (row, under_read) in rows.iter().zip(&under_reads) {
            assert!(
                *under_read <= 2.0 * options.peak_tolerance,
                "{} case {}: {} N, {}: {under_read:.2e}",
                population.wheel.model.name,
                row.case,
                row.load,
                row.standard_deviation
            );
            worst = worst.max(*under_read);
        }
    }
    println!("60 rows, worst under-read {worst:.2e}");
}

#[test]
fn a_fixed_band_between_the_linear_resonances_holds_the_peak() {
    // The resonances of slide and stuck lie outside of the band, the nonlinear peak inside.
    let wheel = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    let anywhere = wheel.solver(&[1], SolverOptions::default());
    let free = anywhere.tuned_peak(ENGINE_ORDER, full(50.0));
    let peak = free.point.as_ref().unwrap().frequency_hz;
    for (start_hz, stop_hz) in [(peak - 1.0, peak + 1.0), (peak - 3.0, peak + 0.3)] {
        let options = SolverOptions {
            frequency_band: FrequencyBand::Fixed { start_hz, stop_hz },
            ..SolverOptions::default()
        };
        let found = wheel
            .solver(&[1], options)
            .tuned_peak(ENGINE_ORDER, full(50.0));
        assert_eq!(found.status, Status::Ok, "{start_hz} to {stop_hz} Hz");
        let ratio = found.amplitude_m().unwrap() / free.amplitude_m().unwrap();
        assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
    }
}
