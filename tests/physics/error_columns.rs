//! Estimated errors against solutions with more harmonics and samples.

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::bundle;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;

use super::wheels::{Wheel, full, pattern, solve_row};

fn bundle_wheel(name: &str, kt: f64, basis: BasisChoice) -> Wheel {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name);
    Wheel::of(
        &bundle::read(&folder).unwrap(),
        ContactLaw::Simplified3d,
        PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: 2.0 * kt,
            tangential_stiffness_n_per_m: kt,
            friction_coefficient: 0.3,
        },
        Damping::StructuralLossFactor(0.002),
        basis,
    )
}

fn deviations(name: &str) -> Vec<f64> {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
        .join("reference/patterns.csv");
    std::fs::read_to_string(file)
        .unwrap()
        .lines()
        .skip(1)
        .filter_map(|l| {
            let c: Vec<&str> = l.split(',').collect();
            (c[0] == "1").then(|| c[2].parse().unwrap())
        })
        .collect()
}

#[test]
#[ignore = "experiment"]
fn experiment() {
    let name = std::env::var("W").unwrap();
    let kt = if name == "wheel8" { 4e8 } else { 1e8 };
    let modes: usize = std::env::var("M").unwrap().parse().unwrap();
    let basis = if modes == 0 {
        BasisChoice::StickAttachment { stick: 4 }
    } else {
        BasisChoice::StickSlide {
            stick: modes,
            slide: modes,
        }
    };
    let wheel = bundle_wheel(&name, kt, basis);
    let mistuned = std::env::var("P").is_ok();
    let loads: Vec<f64> = std::env::var("L")
        .unwrap()
        .split(',')
        .map(|x| x.parse().unwrap())
        .collect();
    let d = deviations(&name);
    assert_eq!(d.len(), wheel.model.sectors);
    let sets: [&[u32]; 5] = [
        &[1],
        &[1, 3],
        &[0, 1, 2, 3],
        &[1, 3, 5, 7],
        &[0, 1, 2, 3, 4, 5, 6, 7],
    ];
    for load in loads {
        let all: Vec<u32> = (0..=15).collect();
        let mut truth = None;
        for (set, samples) in std::iter::once((&all[..], 512)).chain(sets.iter().map(|s| (*s, 128)))
        {
            let solver = wheel.solver(
                set,
                SolverOptions {
                    samples_per_period: samples,
                    peak_tolerance: 1e-5,
                    ..SolverOptions::default()
                },
            );
            let begin = std::time::Instant::now();
            let (amplitude, s, h, sep, un) = if mistuned {
                let (_, row) = solve_row(&solver, &pattern(&d), full(load));
                print!(
                    "[nonlinear {} iter {}] ",
                    row.nonlinear_solves, row.newton_iterations
                );
                (
                    row.peak_amplitude_m,
                    row.sampling_error,
                    row.harmonic_error,
                    row.separated_fraction,
                    row.stated_error,
                )
            } else {
                let t = solver.tuned(&super::wheels::scenario(full(load)));
                (
                    t.amplitude_m,
                    t.errors.map(|e| e.sampling),
                    t.errors.map(|e| e.harmonics),
                    t.separated_fraction,
                    t.errors.map(|e| e.unsettled),
                )
            };
            let time = begin.elapsed().as_secs_f64();
            if truth.is_none() {
                truth = amplitude;
            }
            let real = truth.unwrap_or(f64::NAN) / amplitude.unwrap_or(f64::NAN) - 1.0;
            println!(
                "{name} {modes} {load} {set:?}: {:.4e} true {:+.4} % sampling {:+.4} harmonics {:+.4} sep {sep:?} {un:?} {time:.2} s",
                amplitude.unwrap_or(f64::NAN),
                100.0 * real,
                100.0 * s.unwrap_or(f64::NAN),
                100.0 * h.unwrap_or(f64::NAN)
            );
        }
    }
}
