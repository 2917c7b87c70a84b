//! Exact properties of the response: scaling, symmetry, tuned wheel, limits of load and friction.

use std::f64::consts::TAU;
use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix};
use blisk::model::reduction::BasisChoice;
use blisk::model::{BladeEnergy, ReducedModel};
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use super::contact::random::Random;
use super::wheels::{
    ENGINE_ORDER, Wheel, full, pattern, relative, solve_row, wheel8_contact, wheel8_sector,
};

/// Every case with loads at which friction works: wheel, harmonics, loads.
fn cases() -> Vec<(Wheel, &'static [u32], [f64; 3])> {
    let lumped = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    vec![
        (Wheel::wheel8(), &[1], [250.0, 400.0, 1600.0]),
        (Wheel::wheel8(), &[1, 3], [250.0, 400.0, 1600.0]),
        (lumped, &[1], [20.0, 50.0, 200.0]),
    ]
}

fn tight() -> SolverOptions {
    SolverOptions {
        peak_tolerance: 1e-7,
        residual_tolerance: 1e-11,
        ..SolverOptions::default()
    }
}

/// Amplitude and amplification factor of a row that must have ended well.
fn outcome(row: &ResponseRow) -> (f64, f64) {
    assert_eq!(row.status, Status::Ok);
    (
        row.peak_amplitude_m.unwrap(),
        row.amplification_factor.unwrap(),
    )
}

#[test]
fn force_and_normal_load_scale_the_response_together() {
    let mut random = Random(31);
    for (wheel, harmonics, loads) in cases() {
        let deviations = pattern(&wheel.deviations(&mut random, 0.03));
        for load in loads {
            let solve = |scale: f64| {
                let wheel = Wheel {
                    amplitude_n: scale * wheel.amplitude_n,
                    ..wheel.clone()
                };
                let solver = wheel.solver(harmonics, SolverOptions::default());
                outcome(&solve_row(&solver, &deviations, full(scale * load)).1)
            };
            let (amplitude, factor) = solve(1.0);
            // Powers of two change no mantissa, so not one rounding differs.
            assert_eq!(solve(8.0), (8.0 * amplitude, factor));
            assert_eq!(solve(0.25), (0.25 * amplitude, factor));
            let (scaled, same) = solve(1.7);
            assert!(relative(scaled, 1.7 * amplitude) < 1e-9, "{load} N");
            assert!(relative(same, factor) < 1e-8, "{load} N");
        }
    }
}

#[test]
fn turning_the_pattern_turns_the_response() {
    let mut random = Random(32);
    for (wheel, harmonics, loads) in cases() {
        let solver = wheel.solver(harmonics, tight());
        let deviations = wheel.deviations(&mut random, 0.03);
        for load in loads {
            let solve = |shift: usize| {
                let mut turned = deviations.clone();
                turned.rotate_right(shift);
                solve_row(&solver, &pattern(&turned), full(load)).1
            };
            let still = solve(0);
            for shift in [1, 3] {
                let turned = solve(shift);
                let (amplitude, factor) = outcome(&turned);
                let (expected, expected_factor) = outcome(&still);
                let error = relative(amplitude, expected).max(relative(factor, expected_factor));
                assert!(error < 1e-9, "{load} N, {shift}: {error:e}");
                let blades = wheel.model.sectors as u32;
                let blade = (still.peak_blade.unwrap() + shift as u32) % blades;
                assert_eq!(turned.peak_blade, Some(blade));
            }
        }
    }
}

#[test]
fn a_wheel_without_deviations_is_the_tuned_sector() {
    for (wheel, harmonics, loads) in cases() {
        // With few samples the amplitude is rough over frequency, by 5e-4, and two searches may end at different tops of it.
        let options = SolverOptions {
            samples_per_period: 4096,
            ..tight()
        };
        let solver = wheel.solver(harmonics, options);
        let none = pattern(&vec![0.0; wheel.model.sectors]);
        let limits = [
            ContactCondition::Stuck,
            ContactCondition::Slide,
            ContactCondition::Free,
        ];
        for contact in loads.map(full).into_iter().chain(limits) {
            let (tuned, row) = solve_row(&solver, &none, contact);
            let (amplitude, factor) = outcome(&row);
            assert!(
                relative(amplitude, tuned.amplitude_m.unwrap()) < 1e-6,
                "{contact:?}"
            );
            assert!(relative(factor, 1.0) < 1e-6, "{contact:?}");
        }
    }
}

#[test]
fn as_friction_vanishes_the_contact_slides() {
    let mut random = Random(33);
    for (wheel, harmonics, _) in cases() {
        let deviations = pattern(&wheel.deviations(&mut random, 0.03));
        let error = |friction_coefficient: f64| {
            let sector = PairParameters {
                friction_coefficient,
                ..wheel.sector
            };
            let wheel = Wheel {
                sector,
                ..wheel.clone()
            };
            let solver = wheel.solver(harmonics, tight());
            // So high a load that no pair separates.
            let rough = solve_row(&solver, &deviations, full(1e6)).1;
            let slide = solve_row(&solver, &deviations, ContactCondition::Slide).1;
            relative(outcome(&rough).0, outcome(&slide).0)
        };
        let [coarse, fine] = [1e-6, 1e-8].map(error);
        println!("friction of 1 N and 0.01 N: {coarse:.2e} and {fine:.2e} from sliding");
        assert!(fine < 1e-2 && fine > 0.0, "{fine:e}");
        let ratio = coarse / fine;
        assert!((80.0..120.0).contains(&ratio), "linear in mu: {ratio}");
    }
}

#[test]
fn under_high_normal_load_the_contact_is_stuck() {
    let mut random = Random(34);
    for (wheel, harmonics, _) in cases() {
        let solver = wheel.solver(harmonics, SolverOptions::default());
        let deviations = pattern(&wheel.deviations(&mut random, 0.03));
        for frequency in [345.0, 352.5, 605.0, 615.0, 617.5, 640.0] {
            let amplitudes = |contact| {
                let curve = solver.curve(ENGINE_ORDER, contact, Some(&deviations), &[frequency]);
                curve.unwrap().remove(0).1.unwrap()
            };
            let stuck = amplitudes(ContactCondition::Stuck);
            for load_over_force in [1e5, 1e9, 1e15] {
                assert_eq!(amplitudes(full(load_over_force * wheel.amplitude_n)), stuck);
            }
        }
        let stuck = outcome(&solve_row(&solver, &deviations, ContactCondition::Stuck).1).0;
        for load_over_force in [1e5, 1e9, 1e15] {
            let row = solve_row(
                &solver,
                &deviations,
                full(load_over_force * wheel.amplitude_n),
            )
            .1;
            assert_eq!(
                (row.slipping_fraction, row.separated_fraction),
                (Some(0.0), Some(0.0))
            );
            let error = relative(outcome(&row).0, stuck);
            assert!(error < 1e-3, "peak to its own tolerance: {error:e}");
        }
    }
}

#[test]
fn contact_without_springs_is_no_contact() {
    let none = PairParameters {
        normal_stiffness_n_per_m: 0.0,
        tangential_stiffness_n_per_m: 0.0,
        ..wheel8_contact()
    };
    let wheel = Wheel::of(
        &wheel8_sector(),
        ContactLaw::Simplified3d,
        none,
        Damping::StructuralLossFactor(0.002),
        BasisChoice::StickSlide { stick: 4, slide: 4 },
    );
    let solver = wheel.solver(&[1], tight());
    let deviations = pattern(&wheel.deviations(&mut Random(35), 0.03));
    let free = outcome(&solve_row(&solver, &deviations, ContactCondition::Free).1);
    for contact in [
        full(100.0),
        ContactCondition::Stuck,
        ContactCondition::Slide,
    ] {
        let (amplitude, factor) = outcome(&solve_row(&solver, &deviations, contact).1);
        assert!(relative(amplitude, free.0) < 1e-6, "{contact:?}");
        assert!(relative(factor, free.1) < 1e-6, "{contact:?}");
    }
}

/// The same model with every travelling mode of the basis turned by an angle of its own, which
/// turns each degenerate pair of the wheel.
pub fn turned(model: &ReducedModel, random: &mut Random) -> ReducedModel {
    let mut turned = model.clone();
    let size = model.blade_energy.size();
    let mut rotation = Matrix::<f64>::zeros(size, size);
    let mut start = 0;
    for (h, nd) in turned.nodal_diameters.iter_mut().enumerate() {
        let n = nd.eigenvalues.len();
        for mode in 0..n {
            // A standing wave has a real basis: no angle but none.
            let angle = if model.is_standing(h) {
                0.0
            } else {
                random.uniform(0.0, TAU)
            };
            let phase = Complex64::cis(angle);
            for rows in [&mut nd.contact, &mut nd.observed] {
                rows.column_mut(mode)
                    .iter_mut()
                    .for_each(|entry| *entry *= phase);
            }
            nd.force[(mode, 0)] *= phase.conj();
            nd.conjugate_force[(mode, 0)] *= phase;
            // Re(B e^{ia}) = cos a Re B - sin a Im B, Im(B e^{ia}) = sin a Re B + cos a Im B.
            let (re, im) = (start + mode, start + n + mode);
            rotation[(re, re)] = phase.re;
            rotation[(im, re)] = -phase.im;
            rotation[(re, im)] = phase.im;
            rotation[(im, im)] = phase.re;
        }
        start += 2 * n;
    }
    let energy = model.blade_energy.gram();
    turned.blade_energy = BladeEnergy::Gram(rotation.adjoint_times(&energy.times(&rotation)));
    turned
}

#[test]
fn the_orientation_of_degenerate_modes_does_not_matter() {
    let mut random = Random(36);
    for (wheel, harmonics, loads) in cases() {
        let deviations = pattern(&wheel.deviations(&mut random, 0.03));
        let other = Wheel {
            model: Arc::new(turned(&wheel.model, &mut random)),
            ..wheel.clone()
        };
        let [one, other] = [wheel, other].map(|wheel| wheel.solver(harmonics, tight()));
        for load in loads {
            let (amplitude, factor) = outcome(&solve_row(&one, &deviations, full(load)).1);
            let (same, same_factor) = outcome(&solve_row(&other, &deviations, full(load)).1);
            assert!(relative(same, amplitude) < 1e-9, "{load} N");
            // The top of the tuned wheel is a kink where its pairs begin to slip alike.
            let error = relative(same_factor, factor);
            assert!(error < 1e-5, "{load} N: {error:e}");
        }
    }
}
