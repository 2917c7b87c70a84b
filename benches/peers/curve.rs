//! Processor time of one curve and one row of lumped24, checked against the stored reference.
//!
//! `cargo bench --bench curve` prints them as `name = value`, in ms, the smallest of a few repetitions on one thread,
//! with the model reduced before; `benches/peers/run.py` reads that.

#![allow(clippy::print_stdout)] // The figures are the result of this program.

use std::path::Path;
use std::time::Instant;

use blisk::population::monte_carlo::Scenario;
use blisk::response::forced_response::ContactCondition;
use blisk::settings::{EngineSource, ReducedEngineSource};
use blisk::study::{Study, load_sector_model, pattern_source};

const REPETITIONS: usize = 8;
const LEAST_REPETITION_MS: f64 = 300.0;
const LOAD: ContactCondition = ContactCondition::Full {
    normal_load_n: 50.0,
};
/// Largest relative difference of any blade at any frequency: what the reference is good for.
const CURVE_TOLERANCE: f64 = 1e-6;
/// The peak that the others are measured by is the largest of the curve in steps of this, Hz.
const FINE_STEP_HZ: f64 = 0.002;

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let study = Study::read(&root.join("studies/lumped24.toml")).expect("a valid study");
    let sector = load_sector_model(&study).expect("a valid model");
    let patterns = pattern_source(&study, &sector).expect("patterns");
    let pattern = &patterns
        .pattern(0, study.standard_deviations[0])
        .expect("a pattern");
    let engine = ReducedEngineSource
        .build(&study, &sector, None)
        .expect("an engine");
    let solver = engine.solvers().expect("solvers").first().rows();
    let options = &study.solver;
    assert!(options.residual_tolerance <= 1e-8 && options.peak_tolerance <= 1e-3);

    let reference = reference();
    let frequencies: Vec<f64> = reference.iter().map(|row| row[0]).collect();
    let curve_at = |frequencies: &[f64]| -> Vec<(f64, Vec<f64>)> {
        let curve = solver.curve(3, LOAD, Some(pattern), frequencies);
        let points = curve.expect("a pattern that can be applied").into_iter();
        // A point is delivered only where its residual is within the tolerance.
        points
            .map(|(frequency, found)| (frequency, found.expect("a converged point")))
            .collect()
    };
    let (curve_ms, curve) = smallest(|| curve_at(&frequencies));
    let difference = curve
        .iter()
        .zip(&reference)
        .flat_map(|((_, found), expected)| found.iter().zip(&expected[1..]))
        .map(|(found, expected)| (found / expected - 1.0).abs())
        .fold(0.0, f64::max);
    assert!(difference <= CURVE_TOLERANCE, "{difference:e}");

    let scenario = Scenario {
        index: 0,
        load_case: None,
        engine_order: 3,
        standard_deviation: None,
        contact: LOAD,
    };
    let tuned = solver.tuned(&scenario);
    let (row_ms, mut rows) = smallest(|| solver.rows(pattern, &[(&scenario, &tuned)]));
    let row = rows.pop().expect("a row");
    let amplitude = row.peak_amplitude_m.expect("a peak");
    let frequency_hz = row.peak_frequency_hz.expect("a peak");
    let around: Vec<f64> = (-500..=500)
        .map(|step| frequency_hz + FINE_STEP_HZ * f64::from(step))
        .collect();
    let highest = curve_at(&around)
        .iter()
        .chain(&curve)
        .flat_map(|(_, amplitudes)| amplitudes.clone())
        .fold(0.0, f64::max);
    let peak_difference = (amplitude / highest - 1.0).abs();
    assert!(
        peak_difference <= options.peak_tolerance,
        "{amplitude:e} {highest:e}"
    );

    println!("curve_points = {}", curve.len());
    println!("curve_ms = {curve_ms:.2}");
    println!("curve_difference = {difference:e}");
    println!("peak_hz = {frequency_hz}");
    println!("peak_m = {amplitude:e}");
    println!("peak_difference = {peak_difference:e}");
    println!("peak_solves = {}", row.nonlinear_solves);
    println!("peak_iterations = {}", row.newton_iterations);
    println!("peak_factorisations = {}", row.factorisations);
    println!("row_ms = {row_ms:.2}");
}

/// Frequency, Hz, and the amplitude of every blade, m.
fn reference() -> Vec<Vec<f64>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("tests/data/lumped24/ref_p0_h3.csv");
    let text = std::fs::read_to_string(path).expect("the stored reference");
    let numbers = |line: &str| -> Vec<f64> {
        let cells = line.split(',');
        cells.map(|cell| cell.parse().expect("a number")).collect()
    };
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(numbers)
        .collect()
}

/// The smallest processor time, ms, over some repetitions, and the last result. A repetition is as many turns as take
/// long beside the grain of the time that the system tells, 4 ms.
fn smallest<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let clock = Instant::now();
    let mut result = work();
    let once = 1e3 * clock.elapsed().as_secs_f64();
    let turns = (LEAST_REPETITION_MS / once).ceil().max(1.0) as usize;
    let mut least = f64::INFINITY;
    for _ in 0..REPETITIONS {
        let clock = Instant::now();
        let before = processor_ms();
        for _ in 0..turns {
            result = work();
        }
        let elapsed = 1e3 * clock.elapsed().as_secs_f64();
        let used = processor_ms()
            .zip(before)
            .map(|(after, before)| after - before);
        least = least.min(used.unwrap_or(elapsed) / turns as f64);
    }
    (least, result)
}

/// Time that this thread has spent on a processor, ms, where the system tells it (Linux); else the clock must do.
fn processor_ms() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-6 * nanoseconds)
}
