//! What the friction circle changes: peaks and cost of `coulomb_3d` beside `simplified_3d`.

use std::sync::Arc;
use std::time::Instant;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::bundle;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{
    Damping, HarmonicTransform, PairHarmonics, PairJacobian, Status,
};

use super::super::sector_sources::data;
use super::super::wheels::{Wheel, deviations_in, full, pattern, solve_row};
use super::random::Random;

/// Time of one evaluation of a slipping pair, law beside law. docs/formulation.md, section 3, has 2 to 2.7 periods
/// marched and 5 to 7 times the cost without derivative (3 to 5 with it), on an idle machine; a busy one may double that:
/// `cargo test --release --test physics what_an_evaluation_costs -- --ignored --nocapture`.
#[test]
#[ignore = "a timing of some seconds"]
fn what_an_evaluation_costs_under_either_law() {
    let parameters = PairParameters {
        normal_load_n: 1.0,
        normal_stiffness_n_per_m: 1.0,
        tangential_stiffness_n_per_m: 1.0,
        friction_coefficient: 0.3,
    };
    for harmonics in [&[1][..], &[1, 3], &[0, 1, 2, 3]] {
        let transform = Arc::new(HarmonicTransform::new(harmonics, 128).unwrap());
        let n = transform.n_coefficients();
        let mut random = Random(61);
        let motions: Vec<Vec<f64>> = (0..500).map(|_| random.vector(3 * n, 1.0)).collect();
        let mut correction = vec![0.0; 3 * n];
        let mut jacobian = PairJacobian::new(n);
        for with_jacobian in [false, true] {
            let mut microseconds = [f64::INFINITY; 2];
            let laws = [ContactLaw::Simplified3d, ContactLaw::Coulomb3d];
            let mut evaluators = laws.map(|law| PairHarmonics::new(law, Arc::clone(&transform)));
            let mut periods = 0;
            // Law after law, the smallest of many times: other work on the machine does not count.
            for _ in 0..30 {
                for (pairs, best) in evaluators.iter_mut().zip(&mut microseconds) {
                    let start = Instant::now();
                    periods = 0;
                    for motion in &motions {
                        let wanted = with_jacobian.then_some(&mut jacobian);
                        pairs.evaluate(&parameters, motion, &mut correction, wanted);
                        periods += pairs.history().coupled_slider().periods();
                    }
                    let time = 1e6 * start.elapsed().as_secs_f64() / motions.len() as f64;
                    *best = best.min(time);
                }
            }
            println!(
                "harmonics {harmonics:?}, Jacobian {with_jacobian}: {:.2} us, {:.2} us; {:.1} periods",
                microseconds[0],
                microseconds[1],
                periods as f64 / motions.len() as f64
            );
            let marched = periods as f64 / motions.len() as f64;
            assert!((2.0..=2.75).contains(&marched), "{harmonics:?}: {marched}");
            let ratio = microseconds[1] / microseconds[0];
            assert!(
                ratio < 16.0,
                "{harmonics:?}, Jacobian {with_jacobian}: {ratio}"
            );
        }
    }
}

/// A row of the table of docs/formulation.md.
struct Documented {
    load_n: f64,
    harmonics: Vec<u32>,
    /// Tuned and of pattern 1, each under `simplified_3d` and `coulomb_3d`.
    peaks_um: [Option<f64>; 4],
    iterations: [f64; 2],
}

fn documented() -> Vec<Documented> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formulation.md");
    let page = std::fs::read_to_string(path).unwrap();
    let rows = page
        .lines()
        .skip_while(|line| !line.starts_with("| load N | harmonics | tuned simplified |"));
    let rows: Vec<Documented> = rows
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let number = |cell: &str| cell.parse::<f64>().unwrap();
            let (few, many) = cells[8].split_once(" -> ").unwrap();
            Documented {
                load_n: number(cells[0]),
                harmonics: cells[1].split('-').map(|k| k.parse().unwrap()).collect(),
                // A dash stands for a row that ended without a peak.
                peaks_um: [2, 3, 5, 6].map(|place| cells[place].parse().ok()),
                iterations: [few, many].map(number),
            }
        })
        .collect();
    assert_eq!(rows.len(), 8);
    rows
}

fn wheel24() -> Wheel {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 2e8,
        tangential_stiffness_n_per_m: 1e8,
        friction_coefficient: 0.3,
    };
    Wheel::of(
        &bundle::read(&data("wheel24")).unwrap(),
        ContactLaw::Simplified3d,
        contact,
        Damping::StructuralLossFactor(0.002),
        BasisChoice::StickAttachment { stick: 4 },
    )
}

/// The table of docs/formulation.md, section 3: peaks to 0.02 um or 0.1 %, iterations to a tenth. Each row is printed
/// as the page has to have it.
/// `cargo test --release --test physics what_the_friction_circle -- --ignored --nocapture`.
#[test]
#[ignore = "about 5 minutes: a table of docs/formulation.md"]
fn what_the_friction_circle_changes_on_wheel24() {
    let deviations = pattern(&deviations_in("wheel24/reference/patterns.csv", 1));
    let wheel = wheel24();
    let options = SolverOptions {
        peak_tolerance: 1e-4,
        ..SolverOptions::default()
    };
    let mut wrong = Vec::new();
    for row_of_page in documented() {
        let (load, harmonics) = (row_of_page.load_n, &row_of_page.harmonics);
        let solved = [ContactLaw::Simplified3d, ContactLaw::Coulomb3d].map(|law| {
            let wheel = Wheel {
                law,
                ..wheel.clone()
            };
            let solver = wheel.solver(harmonics, options.clone());
            let start = Instant::now();
            let (tuned, row) = solve_row(&solver, &deviations, full(load));
            let time_ms = 1e3 * start.elapsed().as_secs_f64();
            (tuned, row, time_ms)
        });
        let [
            (tuned, row, time),
            (coupled_tuned, coupled_row, coupled_time),
        ] = &solved;
        let cells = |one: Option<f64>, other: Option<f64>| {
            let cell = |found: Option<f64>| {
                found.map_or("-".to_owned(), |amplitude_m| {
                    format!("{:.2}", 1e6 * amplitude_m)
                })
            };
            let change = one.zip(other).map(|(one, other)| other / one - 1.0);
            let change = change.map_or("-".to_owned(), |own| format!("{:.2} %", 100.0 * own));
            format!("{} | {} | {change}", cell(one), cell(other))
        };
        let set: Vec<String> = harmonics.iter().map(u32::to_string).collect();
        let (few, many) = (row.newton_iterations, coupled_row.newton_iterations);
        println!(
            "| {load} | {} | {} | {} | {few} -> {many} |",
            set.join("-"),
            cells(tuned.amplitude_m, coupled_tuned.amplitude_m),
            cells(row.peak_amplitude_m, coupled_row.peak_amplitude_m),
        );
        println!(
            "ms per iteration: {:.2}, {:.2}",
            time / few as f64,
            coupled_time / many as f64,
        );
        let statuses = [row.status, coupled_row.status];
        if load > 100.0 && statuses != [Status::Ok; 2] {
            wrong.push(format!("{load} N: {statuses:?}"));
        }
        let found = [
            tuned.amplitude_m,
            coupled_tuned.amplitude_m,
            row.peak_amplitude_m,
            coupled_row.peak_amplitude_m,
        ];
        for (found, written) in found.into_iter().zip(row_of_page.peaks_um) {
            let agrees = |(found, written): (f64, f64)| {
                (1e6 * found - written).abs() <= f64::max(0.02, 1e-3 * written)
            };
            if !found.zip(written).map_or(found == written, agrees) {
                wrong.push(format!("{load} N: {found:?}, the page: {written:?}"));
            }
        }
        for (found, written) in [few, many].into_iter().zip(row_of_page.iterations) {
            let error = (found as f64 / written - 1.0).abs();
            if error > 0.1 {
                wrong.push(format!("{load} N: {found} iterations, the page: {written}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
