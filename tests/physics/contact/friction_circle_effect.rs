//! What the friction circle changes: peaks and cost of `coulomb_3d` beside `simplified_3d`.

use std::path::Path;
use std::time::Instant;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::bundle;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use super::super::wheels::{Wheel, full, pattern, solve_row};

/// Deviations of pattern 1 of a reference wheel.
fn pattern_1(folder: &Path) -> Vec<f64> {
    let text = std::fs::read_to_string(folder.join("reference/patterns.csv")).unwrap();
    let rows = text.lines().skip(1).map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        (cells[0].to_owned(), cells[2].parse::<f64>().unwrap())
    });
    rows.filter(|(id, _)| id == "1").map(|row| row.1).collect()
}

/// Prints the table of docs/formulation.md, section 3:
/// `cargo test --release --test physics what_the_friction_circle -- --ignored --nocapture`.
#[test]
#[ignore = "minutes; prints the table of docs/formulation.md"]
fn what_the_friction_circle_changes_on_wheel24() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wheel24");
    let sector = bundle::read(&folder).unwrap();
    let deviations = pattern(&pattern_1(&folder));
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 2e8,
        tangential_stiffness_n_per_m: 1e8,
        friction_coefficient: 0.3,
    };
    let wheel = Wheel::of(
        &sector,
        ContactLaw::Simplified3d,
        contact,
        Damping::StructuralLossFactor(0.002),
        BasisChoice::StickAttachment { stick: 4 },
    );
    let options = SolverOptions {
        peak_tolerance: 1e-4,
        ..SolverOptions::default()
    };
    println!(
        "load N  harmonics  wheel      simplified_3d um  coulomb_3d um  change %  iterations  ms per iteration"
    );
    let cases: [(f64, &[u32]); 8] = [
        (80.0, &[0, 1, 2, 3]),
        (160.0, &[1]),
        (160.0, &[1, 3]),
        (320.0, &[1]),
        (320.0, &[1, 3]),
        (640.0, &[1, 3]),
        (1280.0, &[1]),
        (1280.0, &[1, 3]),
    ];
    for (load, harmonics) in cases {
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
        let line = |name: &str, one: Option<f64>, other: Option<f64>| {
            let (one, other) = (
                one.map_or(f64::NAN, |a| 1e6 * a),
                other.map_or(f64::NAN, |a| 1e6 * a),
            );
            let set = harmonics
                .iter()
                .map(u32::to_string)
                .collect::<Vec<_>>()
                .join("-");
            print!(
                "{load:6}  {set:>9}  {name:9}  {one:16.2}  {other:13.2}  {:8.2}",
                100.0 * (other / one - 1.0)
            );
        };
        line("tuned", tuned.amplitude_m, coupled_tuned.amplitude_m);
        println!();
        line(
            "pattern 1",
            row.peak_amplitude_m,
            coupled_row.peak_amplitude_m,
        );
        let (few, many) = (row.newton_iterations, coupled_row.newton_iterations);
        println!(
            "  {few} -> {many}  {:.2} -> {:.2}  {} {}",
            time / few as f64,
            coupled_time / many as f64,
            row.status.name(),
            coupled_row.status.name(),
        );
        assert!(load < 100.0 || (row.status, coupled_row.status) == (Status::Ok, Status::Ok));
    }
}
