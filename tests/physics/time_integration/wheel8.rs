//! Finite elements, eight blades: harmonic balance with converged harmonics against time integration
//! on the same reduced model.

use std::ops::RangeInclusive;
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

/// A point of the wheel; pattern 1 of the reference where mistuned.
struct Point {
    normal_load_n: f64,
    mistuned: bool,
    frequency_hz: f64,
    harmonics: RangeInclusive<u32>,
}

impl Point {
    fn compare(&self, options: &TimeOptions) -> PointComparison {
        let wheel = wheel();
        let basis = WheelBasis::new(Arc::clone(&wheel.model));
        let change: Option<Matrix<f64>> = self.mistuned.then(|| {
            let pattern = deviations("wheel8/reference", "patterns.csv", 1, 8);
            basis.blade_stiffness_change(&pattern)
        });
        let solver = SolverOptions {
            samples_per_period: 512,
            ..SolverOptions::default()
        };
        let harmonics: Vec<u32> = self.harmonics.clone().collect();
        let case = PointCase {
            basis: &basis,
            stiffness_change: change.as_ref(),
            damping: wheel.damping,
            engine_order: ENGINE_ORDER,
            amplitude_n: 1.0,
            law: wheel.law,
            sector: PairParameters {
                normal_load_n: self.normal_load_n,
                ..wheel.sector
            },
            factors: &blisk::response::mistuning::ContactFactors::default(),
            harmonics: &harmonics,
            solver: &solver,
            frequency_hz: self.frequency_hz,
        };
        let found = compare_point(&case, options).unwrap();
        let settled = &found.settled;
        println!(
            "{} N, mistuned {}, {} Hz, harmonics {:?}: {:?}, largest {:+.2e}, any blade {:.2e}, \
             change of blades {:.1e}, of forces {:.1e}, drift {:.1e}, {:?} {:?}",
            self.normal_load_n,
            self.mistuned,
            self.frequency_hz,
            self.harmonics,
            found.status,
            found.largest_difference(),
            found.blade_difference(),
            settled.blade_change,
            settled.force_change,
            settled.drift,
            settled.shares,
            found.steps
        );
        found
    }
}

#[test]
fn in_micro_slip_the_dynamics_reach_the_harmonic_balance_solution() {
    let point = Point {
        normal_load_n: 1600.0,
        mistuned: false,
        frequency_hz: 617.28,
        harmonics: 1..=31,
    };
    let options = TimeOptions {
        minimum_periods: 50,
        drift_periods: 40,
        ..TimeOptions::default()
    };
    let found = point.compare(&options);
    assert!(found.settled.shares.slipping > 0.0);
    assert!(found.reached(5e-3));
}

#[test]
#[ignore = "minutes: points whose periodic motion is stable"]
fn where_the_motion_repeats_itself_harmonic_balance_has_found_it() {
    for (normal_load_n, mistuned, frequency_hz, harmonics) in [
        (1600.0, false, 617.28, 1..=31),
        (1600.0, true, 616.04, 1..=7),
        (800.0, false, 616.5, 1..=31),
        (400.0, true, 614.25, 1..=15),
    ] {
        let point = Point {
            normal_load_n,
            mistuned,
            frequency_hz,
            harmonics,
        };
        let found = point.compare(&TimeOptions::default());
        assert!(
            found.reached(5e-3),
            "{normal_load_n} N, mistuned {mistuned}"
        );
    }
}

/// Where every pair slips with a load that varies much, the periodic solution of the tuned wheel is
/// unstable: waves of other nodal diameters at frequencies between the harmonics grow from nothing
/// within some ten periods and stay, with a ring that creeps as with one that is pinned. At 400 N
/// the Floquet multipliers say so (section 10 of docs/formulation.md). Harmonic balance cannot know;
/// the march says so.
#[test]
#[ignore = "minutes: points whose periodic motion is unstable"]
fn where_the_periodic_motion_is_unstable_the_march_reports_it() {
    for (normal_load_n, mistuned, frequency_hz, harmonics) in [
        (400.0, false, 615.08, 1..=15),
        (200.0, false, 613.6, 0..=15),
        (100.0, false, 612.88, 0..=15),
        (100.0, true, 612.0, 0..=5),
    ] {
        let point = Point {
            normal_load_n,
            mistuned,
            frequency_hz,
            harmonics,
        };
        let options = TimeOptions {
            maximum_periods: 500,
            ..TimeOptions::default()
        };
        let found = point.compare(&options);
        assert_eq!(found.status, Status::WorkBudget);
        assert!(found.settled.force_change > 1e-3);
        // What the excitation sees of it all the same, on average over the beat.
        let mean = found.settled.mean_fundamental_m.iter().copied();
        let harmonic_balance = found.harmonic_balance_m.iter().copied();
        let ratio = mean.fold(0.0, f64::max) / harmonic_balance.fold(0.0, f64::max);
        println!("mean fundamental over harmonic balance {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.05);
    }
}
