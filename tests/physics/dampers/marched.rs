//! Mistuned wheels of solid elements with every built-in damper: harmonic balance against time integration of the whole wheel.

use std::sync::Arc;

use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;
use blisk::response::mistuning::{ContactFactors, WheelBasis};
use blisk::verification::time_integration::{PointCase, Stability, TimeOptions, compare_point};

use super::built_in::{KINDS, SECTORS};
use crate::extremes::wheels::uneven;
use crate::wheels::{ENGINE_ORDER, Wheel, full, pattern, solve_row};

/// With it the periodic motions of these cases are stable.
const LOSS_FACTOR: f64 = 0.02;
/// Largest difference of the largest amplitude of a blade, relative.
const BAR: f64 = 5e-3;

/// What the contact of a case does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    /// Some pairs stick all the time.
    MicroSlip,
    /// Every pair slips, and none opens.
    GrossSlip,
    /// Pairs open.
    Separation,
}

use Regime::{GrossSlip, MicroSlip, Separation};

/// A kind of damper, its load, N for 1 N of excitation, the highest harmonic of harmonic balance, and what the contact does then.
type Case = (&'static str, f64, u32, Regime);

/// Harmonic balance at the peak with harmonic 1 is what the march ends in, and the contact does there what the case says.
fn hold((name, normal_load_n, highest, regime): Case) {
    let kind = { KINDS.iter().find(|kind| kind.name == name) }.expect("a kind");
    let wheel = Wheel {
        damping: Damping::StructuralLossFactor(LOSS_FACTOR),
        ..kind.wheel(ContactLaw::Simplified3d)
    };
    let deviations = uneven(SECTORS, 0.03);
    let solver = wheel.solver(&[1], SolverOptions::default());
    let (_, row) = solve_row(&solver, &pattern(&deviations), full(normal_load_n));
    let basis = WheelBasis::new(Arc::clone(&wheel.model));
    let change = basis.blade_stiffness_change(&deviations);
    let harmonics: Vec<u32> = (0..=highest).collect();
    let point = PointCase {
        basis: &basis,
        stiffness_change: Some(&change),
        damping: wheel.damping,
        engine_order: ENGINE_ORDER,
        amplitude_n: 1.0,
        law: wheel.law,
        sector: PairParameters {
            normal_load_n,
            ..wheel.sector
        },
        factors: &ContactFactors::default(),
        harmonics: &harmonics,
        solver: &SolverOptions {
            samples_per_period: 512,
            ..SolverOptions::default()
        },
        frequency_hz: row.peak_frequency_hz.expect("a peak"),
    };
    let found = compare_point(&point, &TimeOptions::default()).expect("a solution");
    let shares = found.settled.shares;
    println!(
        "{name}, {normal_load_n} N, harmonics 0 to {highest}, {:.2} Hz: largest {:+.1e}, any blade {:.1e}, {shares:?}",
        point.frequency_hz,
        found.largest_difference(),
        found.blade_difference(),
    );
    assert_eq!(found.stability(), Stability::Stable, "{name}");
    assert!(found.reached(BAR), "{name}, {normal_load_n} N");
    let does = match (shares.slipping, shares.separated) {
        (_, separated) if separated > 0.0 => Separation,
        (slipping, _) if slipping > 0.999 => GrossSlip,
        (slipping, _) => {
            assert!(slipping > 0.0, "{name}, {normal_load_n} N: all stuck");
            MicroSlip
        }
    };
    assert_eq!(does, regime, "{name}, {normal_load_n} N");
}

#[test]
fn rings_and_shrouds_do_in_time_what_harmonic_balance_says() {
    hold(("ring", 25.0, 7, MicroSlip));
    hold(("ring", 16.0, 7, Separation));
    hold(("shroud", 40.0, 7, Separation));
}

#[test]
fn so_do_blades_on_the_ground() {
    hold(("ground", 160.0, 7, MicroSlip));
    hold(("ground", 40.0, 7, GrossSlip));
    hold(("ground", 10.0, 7, Separation));
}

#[test]
#[ignore = "two minutes: marched periods of wheels with dampers between the blades"]
fn so_do_wedges_and_cylinders() {
    hold(("wedge", 160.0, 11, MicroSlip));
    hold(("wedge", 40.0, 7, GrossSlip));
    hold(("wedge", 10.0, 7, Separation));
    hold(("cylinder", 80.0, 7, MicroSlip));
}
