//! The lumped wheel: harmonic balance with eight odd harmonics against time integration.

use std::sync::Arc;

use blisk::linalg::Matrix;
use blisk::response::forced_response::{AmplitudeMeasure, SolverOptions, wheel_force};
use blisk::response::friction::PairParameters;
use blisk::response::harmonic_balance::{ContactInterface, Status, Structure};
use blisk::response::mistuning::{StructuralModes, WheelBasis};
use blisk::verification::time_integration::{
    MarchedWheel, PointCase, PointComparison, TimeOptions, WheelState, compare_point, settle,
};

use super::super::wheels::{ENGINE_ORDER, Wheel, deviations_in};

/// Those of the reference tables `time_check_*.csv`.
const FREQUENCIES_HZ: [f64; 3] = [347.5, 350.5, 354.5];
const ODD: [u32; 8] = [1, 3, 5, 7, 9, 11, 13, 15];

fn compare(mistuned: bool, frequency_hz: f64, options: &TimeOptions) -> PointComparison {
    let wheel = Wheel::lumped24();
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let change: Option<Matrix<f64>> =
        mistuned.then(|| basis.blade_stiffness_change(&deviations_in("lumped24/mistuning.csv", 0)));
    let solver = SolverOptions {
        samples_per_period: 1024,
        amplitude: AmplitudeMeasure::TimeMaximum,
        ..SolverOptions::default()
    };
    let case = PointCase {
        basis: &basis,
        stiffness_change: change.as_ref(),
        damping: wheel.damping,
        engine_order: ENGINE_ORDER,
        amplitude_n: 10.0,
        law: wheel.law,
        sector: PairParameters {
            normal_load_n: 50.0,
            ..wheel.sector
        },
        factors: &blisk::response::mistuning::ContactFactors::default(),
        harmonics: &ODD,
        solver: &solver,
        frequency_hz,
    };
    compare_point(&case, options).unwrap()
}

fn hold_together(mistuned: bool, frequency_hz: f64, found: &PointComparison) {
    println!(
        "mistuned {mistuned}, {frequency_hz} Hz: largest {:.1e}, any blade {:.1e}, {:?}",
        found.largest_difference(),
        found.blade_difference(),
        found.steps
    );
    assert_eq!(found.status, Status::Ok);
    assert!(found.reached(1e-4));
    assert!(found.blade_difference() <= 2e-4);
}

#[test]
fn eight_odd_harmonics_are_what_the_dynamics_do() {
    for mistuned in [false, true] {
        let options = TimeOptions {
            steps_per_period: 512,
            minimum_periods: 60,
            ..TimeOptions::default()
        };
        let found = compare(mistuned, 350.5, &options);
        hold_together(mistuned, 350.5, &found);
    }
}

#[test]
#[ignore = "minutes: all frequencies of the reference tables"]
fn so_they_are_at_every_frequency_of_the_reference() {
    for mistuned in [false, true] {
        for frequency_hz in FREQUENCIES_HZ {
            let options = TimeOptions {
                minimum_periods: 500,
                ..TimeOptions::default()
            };
            hold_together(
                mistuned,
                frequency_hz,
                &compare(mistuned, frequency_hz, &options),
            );
        }
    }
}

/// Columns `freq_hz, blade, time_amp_m` of a reference table at one frequency, blade after blade.
fn reference(table: &str, frequency_hz: f64) -> Vec<f64> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/lumped24");
    let text = std::fs::read_to_string(folder.join(table)).unwrap();
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .filter(|row: &Vec<f64>| (row[0] - frequency_hz).abs() < 1e-9)
        .map(|row| row[2])
        .collect()
}

#[test]
#[ignore = "minutes: 6000 periods from rest"]
fn from_rest_the_mistuned_wheel_ends_in_the_harmonic_balance_solution() {
    let frequency_hz = 350.5;
    let near = compare(true, frequency_hz, &TimeOptions::default());
    let wheel = Wheel::lumped24();
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let change = basis.blade_stiffness_change(&deviations_in("lumped24/mistuning.csv", 0));
    let modes = StructuralModes::of_wheel(&basis, &change).unwrap();
    let force = wheel_force(&basis, &modes, ENGINE_ORDER, 10.0);
    let structure = Structure::new(modes, wheel.damping);
    let geometry = wheel.model.contact.clone();
    let sector = PairParameters {
        normal_load_n: 50.0,
        ..wheel.sector
    };
    let interface = ContactInterface {
        law: wheel.law,
        pairs: geometry.weights.iter().map(|&w| sector.share(w)).collect(),
        geometry,
    };
    let marched = MarchedWheel {
        structure: &structure,
        interface: &interface,
        force: &force,
        omega: std::f64::consts::TAU * frequency_hz,
    };
    let options = TimeOptions {
        steps_per_period: 800,
        minimum_periods: 6000,
        maximum_periods: 6000,
        ..TimeOptions::default()
    };
    let settled = settle(&marched, &WheelState::at_rest(&marched), &options);
    assert_eq!(settled.status, Status::Ok);
    let peak = near.harmonic_balance_m.iter().copied().fold(0.0, f64::max);
    let against = |others: &[f64]| {
        let blades = settled.time_maximum_m.iter().zip(others);
        blades.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / peak
    };
    let largest = settled.time_maximum_m.iter().copied().fold(0.0, f64::max);
    let table = reference("time_check_p0.csv", frequency_hz);
    println!(
        "from rest, 6000 periods: largest {:.1e}, any blade {:.1e}; another code from rest {:.1e}",
        largest / peak - 1.0,
        against(&near.harmonic_balance_m),
        against(&table)
    );
    assert!((largest / peak - 1.0).abs() <= 1e-4);
    assert!(against(&near.harmonic_balance_m) <= 2e-4);
    assert!(against(&table) <= 2e-4);
}
