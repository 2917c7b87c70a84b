//! The truth that the program is held against: mistuned wheels with every contact degree of freedom, factored whole.
//!
//! Nothing of the program is used but sector models as data: no reduced model, no contact law, no solver.

mod cases;
mod contact;
mod hints;
mod iteration;
mod peak;
mod rows;
mod sector;
mod wheel;

use std::path::{Path, PathBuf};

use blisk::model::sector::bundle;

use cases::{Condition, PATTERNS, WHEELS, Wheel, draw};
use contact::{Law, Period};
use hints::Hints;
use iteration::{Case, Contact, solve};
use peak::peak;
use rayon::prelude::*;
use rows::{Sectors, solve_row, sort, store, stored};
use sector::Sector;
use wheel::FactoredWheel;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

fn reference_case(deviations: Vec<f64>, contact: Contact) -> Case {
    Case {
        loss_factor: 0.002,
        engine_order: 3,
        deviations,
        contact,
    }
}

/// Deviations of pattern 1 of a reference wheel.
fn pattern_1(wheel: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(data(wheel).join("reference/patterns.csv")).unwrap();
    let rows = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>());
    let of_pattern = rows.filter(|cells| cells[0] == "1");
    of_pattern.map(|cells| cells[2].parse().unwrap()).collect()
}

/// Peaks and their frequencies known for wheel8 from another implementation, at a fixed frequency.
#[test]
fn the_peaks_known_for_wheel8_are_met() {
    faer::set_global_parallelism(faer::Par::Seq);
    let model = bundle::read(&data("wheel8")).unwrap();
    let sector = Sector::new(&model, 80);
    let friction = |normal_load_n| {
        Contact::Friction(Law {
            normal_load_n,
            normal_stiffness_n_per_m: 8e8,
            tangential_stiffness_n_per_m: 4e8,
            friction_coefficient: 0.3,
        })
    };
    let tuned = vec![0.0; 8];
    let cases: [(Vec<f64>, Contact, &[u32], f64, f64); 9] = [
        (
            tuned.clone(),
            Contact::Springs(0.0, 0.0),
            &[1],
            611.76888,
            4.18716429e-4,
        ),
        (
            tuned.clone(),
            Contact::Springs(8e8, 4e8),
            &[1],
            617.77559,
            4.21449279e-4,
        ),
        (
            pattern_1("wheel8"),
            Contact::Springs(8e8, 0.0),
            &[1],
            611.27237,
            4.77504552e-4,
        ),
        (
            pattern_1("wheel8"),
            Contact::Springs(8e8, 4e8),
            &[1],
            616.40759,
            4.94962016e-4,
        ),
        (
            tuned.clone(),
            friction(400.0),
            &[1],
            615.06367,
            1.35559717e-4,
        ),
        (
            pattern_1("wheel8"),
            friction(200.0),
            &[1],
            612.86433,
            1.99764944e-4,
        ),
        (
            pattern_1("wheel8"),
            friction(400.0),
            &[1, 3],
            614.22580,
            1.79591708e-4,
        ),
        (
            pattern_1("wheel8"),
            friction(1600.0),
            &[1, 3],
            616.03967,
            2.80179361e-4,
        ),
        (
            pattern_1("wheel8"),
            friction(100.0),
            &[0, 1, 2, 3],
            611.80039,
            3.05571267e-4,
        ),
    ];
    for (deviations, contact, harmonics, frequency_hz, amplitude_m) in cases {
        let case = reference_case(deviations, contact);
        let began = std::time::Instant::now();
        let period = Period::new(harmonics, 512);
        let point = solve(&sector, &case, &period, frequency_hz, None).unwrap();
        let error = point.amplitude_m() / amplitude_m - 1.0;
        println!(
            "{harmonics:?} {frequency_hz} Hz: {error:.2e}, {} products, {} open, {} slip, {:.1} s",
            point.products,
            point.opening_pairs,
            point.slipping_pairs,
            began.elapsed().as_secs_f64()
        );
        assert!(error.abs() < 5e-4, "{harmonics:?} {frequency_hz}: {error}");
    }
}

/// The load under which every pair of the tuned wheel sticks at its stuck peak, N per sector.
fn sticking_n(wheel: &Wheel) -> f64 {
    let sector = Sector::new(&wheel.model, 80);
    let hint_hz = Hints::new(wheel).frequency_hz(None, Condition::Stuck);
    let case = wheel.case(None, Condition::Stuck);
    let period = Period::new(&[1], 64);
    let frequency_hz = peak(&sector, &case, &period, hint_hz.unwrap(), None)
        .unwrap()
        .top
        .frequency_hz;
    let law = wheel.law();
    let (kn, kt) = (
        law.normal_stiffness_n_per_m,
        law.tangential_stiffness_n_per_m,
    );
    let omega = std::f64::consts::TAU * frequency_hz;
    let stuck = FactoredWheel::new(
        &sector,
        omega,
        case.loss_factor,
        &case.deviations,
        [kn, kt, kt],
    );
    let motion = stuck.receptance(case.engine_order).contact_excited;
    let tangential = |motion: &[faer::c64]| f64::max(motion[1].norm(), motion[2].norm());
    let largest = motion.chunks(3).map(tangential).fold(0.0, f64::max);
    largest * law.tangential_stiffness_n_per_m / law.friction_coefficient
}

/// `cargo test --release --test truth make_the_cases -- --ignored`
#[test]
#[ignore = "writes the cases"]
fn make_the_cases() {
    for wheel in WHEELS {
        draw(wheel, sticking_n);
        println!("{wheel}: {:?}", Wheel::read(wheel).loads_n);
    }
}

/// Solves the rows that `truth.csv` does not have; `TRUTH_WHEEL` and `TRUTH_ROWS` leave others out.
/// `cargo test --release --test truth make_the_truth -- --ignored --nocapture`
#[test]
#[ignore = "hours: writes what is missing of the truth"]
fn make_the_truth() {
    faer::set_global_parallelism(faer::Par::Seq);
    let wanted = std::env::var("TRUTH_WHEEL").ok();
    let most = std::env::var("TRUTH_ROWS").map_or(usize::MAX, |own| own.parse().unwrap());
    for name in WHEELS {
        if wanted.as_ref().is_some_and(|own| own != name) {
            continue;
        }
        let wheel = Wheel::read(name);
        let sectors = Sectors::new(&wheel);
        let hints = Hints::new(&wheel);
        let known = stored(name);
        let jobs: Vec<(usize, Condition)> = [true, false]
            .into_iter()
            .flat_map(|friction| (0..PATTERNS).map(move |pattern| (pattern, friction)))
            .map(|(pattern, friction)| (pattern, wheel.condition(pattern, friction)))
            .filter(|(pattern, condition)| {
                let condition = condition.to_string();
                !known
                    .iter()
                    .any(|row| row.pattern == *pattern && row.condition == condition)
            })
            .take(most)
            .collect();
        jobs.par_iter().for_each(|&(pattern, condition)| {
            let Some(hint_hz) = hints.frequency_hz(Some(pattern), condition) else {
                println!("{name}, pattern {pattern}, {condition}: no hint");
                return;
            };
            let row = solve_row(&sectors, &wheel, pattern, condition, hint_hz);
            println!("{name} {row:?}");
            store(name, &row);
        });
        sort(name);
    }
}
