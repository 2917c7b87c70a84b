//! Time per Newton step, per peak and per pattern, beside the machine's dense LU and matrix product.
//!
//! `cargo bench` times the parts of a Newton step with criterion and the rest by the smallest of a
//! few repetitions, all of it but the last table on one thread.

#![allow(clippy::print_stdout)] // The tables are the result of this program.

#[path = "../common/mod.rs"]
mod common;

use std::f64::consts::TAU;
use std::num::NonZero;
use std::time::{Duration, Instant};

use blisk::campaign::{RunRequest, run};
use blisk::linalg::LuWorkspace;
use blisk::population::monte_carlo::Scenario;
use blisk::response::forced_response::{ContactCondition, Work};
use blisk::settings::{Progress, ReducedEngineSource};
use criterion::{Criterion, criterion_group, criterion_main};

use common::case::{Case, study};
use common::machine::{Floor, diagonally_dominant, smallest};

struct Silent;

impl Progress for Silent {}

/// Name of a case and the number of patterns over which peaks are averaged.
const CASES: [(&str, u32); 2] = [("lumped24", 1), ("quickstart", 2)];

fn newton_steps(criterion: &mut Criterion) {
    for (name, _) in CASES {
        let case = Case::with_whole_jacobian(name, 1);
        let loads = case.loads();
        let load = loads[loads.len() / 2];
        let excited = case.excited(&case.patterns[0], case.harmonics());
        let condition = ContactCondition::Full {
            normal_load_n: load,
        };
        let found = case.peak(&case.patterns[0], &excited, condition);
        let point = found.point.expect("a peak");
        let omega = TAU * point.frequency_hz;
        let system = case.system(&excited, load);
        let mut workspace = system.workspace();
        let n = system.unknowns();
        println!(
            "\n{name}: pattern 0 at {load} N, {n} unknowns, {:.0} % of the pairs slip",
            100.0 * point.shares.slipping
        );
        let mut residual = vec![0.0; n];
        let mut jacobian = vec![0.0; n * n];
        let mut lu = LuWorkspace::<f64>::new(n);
        let mut group = criterion.benchmark_group(name);
        group.sample_size(10);
        group.warm_up_time(Duration::from_millis(300));
        group.measurement_time(Duration::from_secs(2));
        group.bench_function("residual and pair derivatives", |bencher| {
            bencher.iter(|| {
                system.residual(omega, &point.solution, &mut residual, true, &mut workspace)
            });
        });
        group.bench_function("jacobian", |bencher| {
            bencher.iter(|| system.jacobian(omega, &mut workspace, &mut jacobian));
        });
        group.bench_function("factor", |bencher| {
            bencher.iter(|| {
                lu.matrix_mut().copy_from_slice(&jacobian);
                lu.factor()
            });
        });
        group.bench_function("solve", |bencher| bencher.iter(|| lu.solve(&mut residual)));
        group.finish();
        machine(criterion, n);
        let (step, ()) = smallest(20, || {
            system.residual(omega, &point.solution, &mut residual, true, &mut workspace);
            system.jacobian(omega, &mut workspace, lu.matrix_mut());
            lu.factor();
            lu.solve(&mut residual);
        });
        over_floor(step, n, case.solver.basis().contact().rows());
    }
}

/// A whole Newton step beside what dense algebra of its size takes.
fn over_floor(step: Duration, n: usize, contact_rows: usize) {
    let floor = Floor::measured(n, contact_rows, 20);
    println!(
        "{n} unknowns, {contact_rows} contact rows: a Newton step {:.2} ms; floor: LU {:.2} ms + product {:.2} ms; step / floor {:.2}",
        1e3 * step.as_secs_f64(),
        1e3 * floor.factor.as_secs_f64(),
        1e3 * floor.product.as_secs_f64(),
        step.as_secs_f64() / floor.step().as_secs_f64()
    );
}

/// What the machine does with dense matrices of the same size.
fn machine(criterion: &mut Criterion, n: usize) {
    let matrix = diagonally_dominant(n);
    let mut lu = LuWorkspace::<f64>::new(n);
    let mut group = criterion.benchmark_group(format!("dense {n}"));
    group.sample_size(10);
    group.warm_up_time(Duration::from_millis(300));
    group.measurement_time(Duration::from_secs(2));
    let size = n as u64;
    group.throughput(criterion::Throughput::Elements(2 * size.pow(3) / 3));
    group.bench_function("LU (elements are flops)", |bencher| {
        bencher.iter(|| {
            lu.matrix_mut().copy_from_slice(matrix.as_slice());
            lu.factor()
        });
    });
    group.throughput(criterion::Throughput::Elements(2 * size.pow(3)));
    group.bench_function("matrix product (elements are flops)", |bencher| {
        bencher.iter(|| matrix.times(&matrix));
    });
    group.finish();
}

fn peaks(_: &mut Criterion) {
    for (name, patterns) in CASES {
        let case = Case::new(name, patterns);
        println!("\n{name}: one peak on one thread, mean over {patterns} pattern(s)");
        peaks_of(&case);
        rows_of_a_pattern(&case);
    }
}

/// Time and counts of the peaks of a case under every load.
fn peaks_of(case: &Case) {
    println!("load N   time ms   solves   iterations   factorisations   retries   status");
    let excited: Vec<_> = case
        .patterns
        .iter()
        .map(|p| case.excited(p, case.harmonics()))
        .collect();
    for load in case.loads() {
        let condition = ContactCondition::Full {
            normal_load_n: load,
        };
        let (time, found) = smallest(2, || {
            let each = case.patterns.iter().zip(&excited);
            each.map(|(pattern, excited)| case.peak(pattern, excited, condition))
                .collect::<Vec<_>>()
        });
        let mean = |count: fn(&Work) -> u64| {
            let sum: u64 = found.iter().map(|peak| count(&peak.work)).sum();
            sum as f64 / found.len() as f64
        };
        let statuses: Vec<&str> = found.iter().map(|peak| peak.status.name()).collect();
        println!(
            "{load:6} {:9.1} {:8.1} {:12.1} {:16.1} {:9.1}   {}",
            1e3 * time.as_secs_f64() / found.len() as f64,
            mean(|work| work.nonlinear_solves),
            mean(|work| work.newton_iterations),
            mean(|work| work.factorisations),
            mean(|work| work.retries),
            statuses.join(" ")
        );
    }
}

/// One pattern as a run solves it, error columns included: its linear limits alone, and with each load by itself.
fn rows_of_a_pattern(case: &Case) {
    let time = |contact: ContactCondition| {
        let scenario = Scenario {
            contact,
            ..case.study.scenarios()[0]
        };
        let tuned = case.solver.tuned(&scenario);
        let patterns = &case.patterns;
        let (time, ()) = smallest(2, || {
            for pattern in patterns {
                std::hint::black_box(case.solver.rows(pattern, &[(&scenario, &tuned)]));
            }
        });
        1e3 * time.as_secs_f64() / patterns.len() as f64
    };
    let linear = time(ContactCondition::Stuck);
    println!("{}: a linear pattern (stuck) {linear:.2} ms", case.name);
    for load in case.loads() {
        let full = time(ContactCondition::Full {
            normal_load_n: load,
        });
        println!(
            "{}: a pattern at {load} N {full:.1} ms, {:.1} linear ones",
            case.name,
            full / linear
        );
    }
}

/// The same population on one thread and on all.
fn threads(_: &mut Criterion) {
    let mut study = study("quickstart");
    study.patterns = 96;
    let all = std::thread::available_parallelism().map_or(1, NonZero::get);
    let [alone, together] = [1, all].map(|threads| {
        let (time, _) = smallest(2, || {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let results = folder.path().join("quickstart");
            let request = RunRequest {
                study: &study,
                results: &results,
                threads,
            };
            run(request, &ReducedEngineSource, &Silent).expect("a run")
        });
        time.as_secs_f64()
    });
    println!(
        "\nquickstart, 96 patterns, model cached: {alone:.1} s on 1 thread, {together:.1} s on {all}: {:.2} and {:.2} patterns a \
         second under 6 loads and 2 limits, {:.2} times",
        96.0 / alone,
        96.0 / together,
        alone / together
    );
}

/// A whole run of the chain of blades at one standard deviation, tables included.
fn linear_population(_: &mut Criterion) {
    let mut study = study("one-dof");
    study.standard_deviations = vec![Some(0.03)];
    let folder = tempfile::tempdir().expect("a temporary folder");
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get);
    let request = RunRequest {
        study: &study,
        results: &folder.path().join("one-dof"),
        threads,
    };
    let start = Instant::now();
    let outcome = run(request, &ReducedEngineSource, &Silent).expect("a run");
    println!(
        "\none-dof: {} linear rows on {threads} threads, tables included: {:.1} s",
        outcome.rows_solved,
        start.elapsed().as_secs_f64()
    );
}

criterion_group!(benches, newton_steps, peaks, threads, linear_population);
criterion_main!(benches);
