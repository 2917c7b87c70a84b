//! Damping from 1e-7 to 0.3.

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{LumpedOptions, lumped};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use super::wheels::{
    CHAIN_LOADS, ORDER, SECTORS, amplitude, chain, decades, one_dimensional, solved, tight, uneven,
};
use crate::sector_sources::lumped::one_dof;
use crate::wheels::{Wheel, full, relative};

const NO_CONTACT: PairParameters = PairParameters {
    normal_load_n: 0.0,
    normal_stiffness_n_per_m: 0.0,
    tangential_stiffness_n_per_m: 0.0,
    friction_coefficient: 0.0,
};

fn factors() -> Vec<f64> {
    decades(-7, -1, 1).into_iter().chain([0.3]).collect()
}

fn single_mass(options: &LumpedOptions, damping: Damping) -> Wheel {
    Wheel::of(
        &lumped::build(options).unwrap(),
        ContactLaw::MacroSlip1d,
        NO_CONTACT,
        damping,
        BasisChoice::CraigBampton,
    )
}

/// One mass per sector: the peak is `F / (eta k)` with a loss factor and, with a damping ratio or a
/// dashpot, `F / (2 zeta k sqrt(1 - zeta^2))`.
#[test]
fn a_tuned_peak_has_its_closed_form_at_any_damping() {
    let options = one_dof(SECTORS);
    let angle = std::f64::consts::TAU * f64::from(ORDER) / SECTORS as f64;
    let k = options.blade_stiffness_n_per_m
        + 2.0 * options.blade_coupling_stiffness_n_per_m * (1.0 - angle.cos());
    let omega = (k / options.blade_mass_kg).sqrt();
    for factor in factors() {
        let viscous = 1.0 / (2.0 * factor * k * (1.0 - factor * factor).sqrt());
        let dashpot = Damping::Rayleigh {
            mass_per_s: 2.0 * factor * omega,
            stiffness_s: 0.0,
        };
        for (damping, exact) in [
            (Damping::StructuralLossFactor(factor), 1.0 / (factor * k)),
            (Damping::ModalRatio(factor), viscous),
            (dashpot, viscous),
        ] {
            let solver = single_mass(&options, damping).solver(&[1], tight());
            let none = vec![0.0; SECTORS];
            let (tuned, row) = solved(&solver, ORDER, &none, ContactCondition::Free);
            let found = tuned.amplitude_m.unwrap();
            assert!(
                relative(found, exact) < 1e-9,
                "{damping:?}: {found} {exact}"
            );
            assert!(relative(amplitude(&row), exact) < 1e-7, "{damping:?}");
        }
    }
}

/// A grid a quarter of a half-bandwidth apart reads a resonance at least at 0.992 of its height.
#[test]
fn a_grid_of_a_quarter_half_bandwidth_reads_at_least_0_992_of_a_peak() {
    for factor in [1e-7, 1e-5, 1e-3] {
        let solver =
            single_mass(&one_dof(SECTORS), Damping::ModalRatio(factor)).solver(&[1], tight());
        let tuned = solver.tuned_peak(ORDER, ContactCondition::Free);
        let (height, at) = (
            tuned.amplitude_m().unwrap(),
            tuned.point.unwrap().frequency_hz,
        );
        let half_bandwidth = factor * at;
        let read = |offset: f64| {
            let frequency = at + offset * half_bandwidth;
            let curve = solver.curve(ORDER, ContactCondition::Free, None, &[frequency]);
            curve.unwrap().remove(0).1.unwrap()[0] / height
        };
        let worst = read(0.125).min(read(-0.125));
        assert!((0.992..0.9925).contains(&worst), "{factor:e}: {worst}");
    }
}

/// Damping below which a search may end without knowing that nothing hides: where friction holds the
/// peak, it is thousands of times broader than a linear resonance, and looking for one that narrow uses
/// up the budget of points.
const UNSEARCHABLE: f64 = 3e-5;

/// More damping lowers every peak; a row without number ends with `work_budget`, at hardly any damping.
fn settles(factors: &[f64]) {
    for load in CHAIN_LOADS {
        let peaks: Vec<(f64, Option<f64>)> = factors
            .iter()
            .map(|&factor| {
                let wheel = Wheel {
                    damping: Damping::StructuralLossFactor(factor),
                    ..one_dimensional(&chain())
                };
                let solver = wheel.solver(&[1], SolverOptions::default());
                let row = solved(&solver, ORDER, &uneven(SECTORS, 0.04), full(load)).1;
                println!(
                    "{load} N, {factor:.0e}: {} {:?} m, {} solves, {} iterations",
                    row.status.name(),
                    row.peak_amplitude_m,
                    row.nonlinear_solves,
                    row.newton_iterations
                );
                assert!(
                    [Status::Ok, Status::WorkBudget].contains(&row.status),
                    "{row:?}"
                );
                (factor, row.peak_amplitude_m)
            })
            .collect();
        for (factor, peak) in &peaks {
            assert!(
                peak.is_some() || *factor < UNSEARCHABLE,
                "{load} N, {factor:e}"
            );
        }
        // To the tolerance of the search.
        let found: Vec<f64> = peaks.iter().filter_map(|(_, peak)| *peak).collect();
        assert!(
            found.windows(2).all(|pair| pair[1] < pair[0] * 1.002),
            "{load} N: {peaks:?}"
        );
    }
}

#[test]
fn friction_bounds_the_peak_of_a_hardly_damped_wheel() {
    settles(&factors());
}

#[test]
#[ignore = "about 1 minute: `cargo test --release --test physics extremes -- --ignored`"]
fn friction_bounds_the_peak_of_a_hardly_damped_wheel_long() {
    settles(&decades(-7, -1, 4));
}

/// Peak of one mass under a slider of limit `mu N0` on a spring kt, by the balance of energy of one
/// harmonic: `F pi A = pi eta k A^2 + 4 mu N0 (A - mu N0 / kt)` at phase resonance.
fn by_energy(force: f64, eta: f64, k: f64, limit: f64, kt: f64) -> f64 {
    let pi = std::f64::consts::PI;
    let (a, b, c) = (
        pi * eta * k,
        4.0 * limit - pi * force,
        -4.0 * limit * limit / kt,
    );
    // The positive root, without cancellation for either sign of b.
    let root = (b * b - 4.0 * a * c).sqrt();
    if b > 0.0 {
        -2.0 * c / (b + root)
    } else {
        (root - b) / (2.0 * a)
    }
}

/// Oracle 3.4: without other damping the resonance is bounded if and only if `F < 4 mu N0 / pi`.
///
/// A heavy disk under a stiff, light blade slides on a ring that is held: one mass, one slider. The
/// peak follows the balance of energy from far below the bound to far above, where it grows as
/// `(F - 4 mu N0 / pi) / (eta k)`.
#[test]
fn a_slider_bounds_the_resonance_up_to_four_over_pi_of_its_limit() {
    let (limit, kt, ground) = (3.0, 4.0e5, 1.0e6);
    let options = LumpedOptions {
        sectors: 1,
        blade_mass_kg: 1e-9,
        blade_stiffness_n_per_m: 1e12,
        disk_mass_kg: 1.0,
        disk_ground_stiffness_n_per_m: ground,
        ring_mass_kg: 1e-3,
        ring_ground_stiffness_n_per_m: 1e14,
        ..LumpedOptions::default()
    };
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: 0.3,
    };
    let bound = 4.0 * limit / std::f64::consts::PI;
    for eta in [1e-2, 1e-4, 1e-6] {
        for share in [0.9, 0.99, 1.01, 1.1, 3.0] {
            let wheel = Wheel {
                amplitude_n: share * bound,
                ..Wheel::of(
                    &lumped::build(&options).unwrap(),
                    ContactLaw::MacroSlip1d,
                    contact,
                    Damping::StructuralLossFactor(eta),
                    BasisChoice::CraigBampton,
                )
            };
            let settings = SolverOptions {
                samples_per_period: 2048,
                ..SolverOptions::default()
            };
            let found = wheel
                .solver(&[1], settings)
                .tuned_peak(0, full(limit / 0.3));
            let exact = by_energy(share * bound, eta, ground, limit, kt);
            println!(
                "eta {eta:.0e}, F {share} of the bound: {} {:?}, exact {exact:.6e}, {:?}",
                found.status.name(),
                found.amplitude_m(),
                found.work
            );
            if eta < UNSEARCHABLE && share < 1.0 {
                let accepted = [Status::Ok, Status::WorkBudget];
                assert!(
                    accepted.contains(&found.status),
                    "eta {eta:e}, {share}: {found:?}"
                );
            } else {
                assert_eq!(found.status, Status::Ok, "eta {eta:e}, {share}");
            }
            let Some(amplitude) = found.amplitude_m() else {
                continue;
            };
            let error = relative(amplitude, exact);
            assert!(error < 2e-3, "eta {eta:e}, {share}: {error:e}");
        }
    }
}
