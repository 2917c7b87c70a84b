//! Finite elements, eight blades: harmonic balance with converged harmonics against time integration
//! on the same reduced model.

use std::sync::Arc;

use blisk::linalg::Matrix;
use blisk::model::reduction::BasisChoice;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::WheelBasis;
use blisk::response::time_integration::{PointCase, PointComparison, TimeOptions, compare_point};

use super::super::wheels::{ENGINE_ORDER, Wheel, wheel8_contact, wheel8_sector};
use super::deviations;

fn wheel() -> Wheel {
    Wheel::of(
        &wheel8_sector(),
        ContactLaw::Simplified3d,
        wheel8_contact(),
        Damping::StructuralLossFactor(0.002),
        BasisChoice::StickAttachment { stick: 4 },
    )
}

fn compare(
    load: f64,
    mistuned: bool,
    frequency_hz: f64,
    harmonics: &[u32],
    options: &TimeOptions,
) -> Result<PointComparison, Status> {
    let wheel = wheel();
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let change: Option<Matrix<f64>> = mistuned.then(|| {
        basis.blade_stiffness_change(&deviations("wheel8/reference", "patterns.csv", 1, 8))
    });
    let solver = SolverOptions {
        samples_per_period: 512,
        ..SolverOptions::default()
    };
    let case = PointCase {
        basis: &basis,
        stiffness_change: change.as_ref(),
        damping: wheel.damping,
        engine_order: ENGINE_ORDER,
        amplitude_n: 1.0,
        law: wheel.law,
        sector: PairParameters {
            normal_load_n: load,
            ..wheel.sector
        },
        harmonics,
        solver: &solver,
        frequency_hz,
    };
    compare_point(&case, options)
}

#[test]
fn scratch() {
    let load: f64 = std::env::var("LOAD").unwrap().parse().unwrap();
    let f: f64 = std::env::var("FREQ").unwrap().parse().unwrap();
    let top: u32 = std::env::var("TOP").unwrap().parse().unwrap();
    let first: u32 = std::env::var("FIRST").unwrap().parse().unwrap();
    let mistuned = std::env::var("MIST").is_ok();
    let harmonics: Vec<u32> = (first..=top).collect();
    let found = compare(load, mistuned, f, &harmonics, &TimeOptions { steps_per_period: 512, ..TimeOptions::default()});
    match found {
        Err(status) => println!("HB: {status:?}"),
        Ok(found) => println!("{load} {f} {first}..{top} {mistuned}: HB {:?}\n time {:?}\n {:.2e} {:.2e} {:?} {:?} blade {:.1e} force {:.1e} drift {:.1e} creep {:e} {:?} it {}",
            found.harmonic_balance_m, found.time_m, found.largest_difference(), found.blade_difference(), found.status, found.steps,
            found.settled.blade_change, found.settled.force_change, found.settled.drift, found.settled.creep_m, found.settled.shares, found.settled.contact_iterations),
    }
}
