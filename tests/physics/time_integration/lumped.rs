//! The lumped wheel: harmonic balance with eight odd harmonics against time integration.

use std::sync::Arc;

use blisk::linalg::Matrix;
use blisk::response::forced_response::{AmplitudeMeasure, SolverOptions};
use blisk::response::friction::PairParameters;
use blisk::response::harmonic_balance::Status;
use blisk::response::mistuning::WheelBasis;
use blisk::response::time_integration::{PointCase, PointComparison, TimeOptions, compare_point};

use super::super::wheels::{ENGINE_ORDER, Wheel};
use super::deviations;

const FREQUENCIES_HZ: [f64; 3] = [347.5, 350.5, 354.5];
const ODD: [u32; 8] = [1, 3, 5, 7, 9, 11, 13, 15];

fn compare(mistuned: bool, frequency_hz: f64, options: &TimeOptions) -> PointComparison {
    let wheel = Wheel::lumped24();
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let change: Option<Matrix<f64>> = mistuned
        .then(|| basis.blade_stiffness_change(&deviations("lumped24", "mistuning.csv", 0, 24)));
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
        harmonics: &ODD,
        solver: &solver,
        frequency_hz,
    };
    compare_point(&case, options).unwrap()
}

#[test]
fn eight_odd_harmonics_are_what_the_dynamics_do() {
    for mistuned in [false, true] {
        let found = compare(mistuned, 350.5, &TimeOptions::default());
        println!(
            "mistuned {mistuned}: largest {:.1e}, blade {:.1e}, {:?} {:?}",
            found.largest_difference(),
            found.blade_difference(),
            found.status,
            found.steps
        );
        assert_eq!(found.status, Status::Ok);
        assert!(found.largest_difference().abs() <= 1e-4);
        assert!(found.blade_difference() <= 2e-4);
    }
}
