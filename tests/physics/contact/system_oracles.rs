//! One mass on a spring with friction to the ground: Den Hartog's solution and the resonance that
//! friction alone bounds or does not bound.
//!
//! `m = k = 1`, so forces and displacements are in units of F0 and F0/k, frequencies in those of
//! the natural frequency.

use std::f64::consts::PI;
use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix};
use blisk::model::cyclic::ContactGeometry;
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{
    ContactInterface, Damping, HarmonicBlock, HarmonicSystem, HarmonicTransform, NewtonBounds,
    NewtonWorkspace, Status, Structure, solve,
};
use blisk::response::mistuning::{ModalRows, StructuralModes};

use super::super::wheels::{Wheel, full, relative, solve_row};
use super::random::Random;

/// The mass under the force `force cos(omega t)` with a Jenkins element to the ground.
fn oscillator(
    law: ContactLaw,
    harmonics: &[usize],
    samples: usize,
    force: f64,
    kt: f64,
    limit: f64,
) -> HarmonicSystem {
    let rows = |count| ModalRows {
        real: Matrix::from_fn(count, 1, |_, _| 1.0),
        imaginary: None,
    };
    let modes = StructuralModes {
        eigenvalues: vec![1.0],
        tuned_eigenvalues: vec![1.0],
        added_damping_per_s: vec![0.0],
        rotation: None,
        contact: rows(1),
        observed: rows(3),
        sectors: 1,
    };
    let structure = Arc::new(Structure::new(modes, Damping::ModalRatio(0.0)));
    let stuck = Arc::new(structure.contact_stiffness(&[kt]));
    let blocks = harmonics
        .iter()
        .map(|&harmonic| HarmonicBlock {
            harmonic: harmonic as u32,
            structure: Arc::clone(&structure),
            stuck: Arc::clone(&stuck),
        })
        .collect();
    let interface = ContactInterface {
        law,
        geometry: ContactGeometry {
            weights: vec![1.0],
            load_weights: vec![1.0],
            rows: vec![[None, Some(0), None]],
            ring_motion: vec![[[1.0, 0.0], [0.0, 1.0]]],
            ring_free: [false; 2],
        },
        pairs: vec![PairParameters {
            normal_load_n: limit,
            normal_stiffness_n_per_m: 0.0,
            tangential_stiffness_n_per_m: kt,
            friction_coefficient: 1.0,
        }],
    };
    let transform = Arc::new(HarmonicTransform::new(harmonics, samples).unwrap());
    HarmonicSystem::new(
        blocks,
        vec![Complex64::new(force, 0.0)],
        interface,
        transform,
    )
}

/// Solves from `x`, which must converge.
fn converge(system: &HarmonicSystem, omega: f64, x: &mut Vec<f64>) {
    let bounds = NewtonBounds::with_tolerance(1e-9);
    let mut workspace = NewtonWorkspace::new(system);
    let outcome = solve(system, omega, x, bounds, None, &mut workspace);
    assert_eq!(outcome.status, Status::Ok, "omega {omega}: {outcome:?}");
}

#[test]
fn stiff_spring_and_many_harmonics_tend_to_den_hartog() {
    // Largest displacement for (b, Ff/F0), from the exact solution of both halves of the period
    // with the velocity's sign checked throughout, which agrees with Den Hartog's formula
    // x = sqrt(V^2 - Ff^2 G^2), V = 1/(1 - b^2), G = sin(pi/b) / (b (1 + cos(pi/b))).
    let table = [
        (0.7, 0.3, 1.885_699_850),
        (1.3, 0.3, 1.315_348_197),
        (1.6, 0.2, 0.613_120_337),
    ];
    let harmonics: Vec<usize> = (0..16).map(|i| 2 * i + 1).collect();
    for (b, friction, exact) in table {
        let v = 1.0 / (1.0 - b * b);
        let g = (PI / b).sin() / (b * (1.0 + (PI / b).cos()));
        let formula = (v * v - (friction * g).powi(2)).sqrt();
        assert!((formula - exact).abs() < 1e-9, "{formula} {exact}");
        for law in ContactLaw::ALL {
            let mut x = vec![0.0; 2 * harmonics.len()];
            let mut values = Vec::new();
            // The spring is stiffened step by step, each solution the start of the next.
            for power in 0..=6 {
                let kt = 2.0_f64.powi(power);
                let system = oscillator(law, &harmonics, 2048, 1.0, kt, friction);
                converge(&system, b, &mut x);
                let transform = HarmonicTransform::new(&harmonics, 2048).unwrap();
                let mut samples = vec![0.0; 2048];
                transform.synthesize_by_sums(&x, &mut samples);
                values.push(samples.into_iter().fold(0.0, f64::max));
            }
            // The spring delays every reversal by a time of order kt^(-1/2): extrapolated in that,
            // which halves from kt = 4 to 16 to 64.
            let [coarse, middle, fine] = [values[2], values[4], values[6]];
            let first = [2.0 * middle - coarse, 2.0 * fine - middle];
            let limit = (4.0 * first[1] - first[0]) / 3.0;
            let errors = [coarse, middle, fine, limit].map(|value| value / exact - 1.0);
            println!("{law:?} b = {b}: {errors:?}");
            assert!(errors[3].abs() < 2e-3, "{errors:?}");
            assert!(errors[2].abs() < 0.6 * errors[1].abs(), "{errors:?}");
        }
    }
}

/// Amplitude of harmonic 1.
fn amplitude(x: &[f64]) -> f64 {
    x[0].hypot(x[1])
}

#[test]
fn friction_alone_bounds_the_resonance_if_the_force_is_below_4_mu_n_over_pi() {
    // One harmonic, F^2 = A^2 ((1 + k_eq - w^2)^2 + (w c_eq)^2): at resonance all the force goes
    // into friction, F = A w c_eq(A), whence A = (mu N / kt) / (1 - pi F / (4 mu N)) at most. Every
    // smaller amplitude belongs to one frequency below and one above.
    let (kt, limit) = (0.8, 1.0);
    for law in ContactLaw::ALL {
        for share in [0.3, 0.85, 0.99] {
            let force = share * 4.0 * limit / PI;
            let highest = limit / kt / (1.0 - share);
            let system = oscillator(law, &[1], 1 << 14, force, kt, limit);
            for i in 1..=20 {
                let lowest = 1.05 * limit / kt;
                let expected = lowest + f64::from(i) / 20.0 * (highest - lowest);
                let theta = (1.0 - 2.0 * limit / (kt * expected)).acos();
                let stiffness = kt / PI * (theta - 0.5 * (2.0 * theta).sin());
                let loss = kt / PI * theta.sin().powi(2);
                let offset = ((force / expected).powi(2) - loss * loss).max(0.0).sqrt();
                for offset in [offset, -offset] {
                    let omega = (1.0 + stiffness - offset).sqrt();
                    let start = Complex64::new(force, 0.0) / Complex64::new(offset, loss);
                    let mut x = vec![start.re, start.im];
                    converge(&system, omega, &mut x);
                    // The curve has steep flanks, so the force that its equation gives for the
                    // amplitude found is compared, not the amplitude.
                    let found = amplitude(&x);
                    assert!(found < highest * (1.0 + 1e-5), "{found} {highest}");
                    let theta = (1.0 - 2.0 * limit / (kt * found)).acos();
                    let stiffness = kt / PI * (theta - 0.5 * (2.0 * theta).sin());
                    let loss = kt / PI * theta.sin().powi(2);
                    let implied = found * (1.0 + stiffness - omega * omega).hypot(loss);
                    let error = relative(implied, force);
                    assert!(error < 1e-6, "{law:?} {share} {expected}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn friction_alone_does_not_bound_the_resonance_if_the_force_is_above_4_mu_n_over_pi() {
    // A >> mu N / kt: friction is the square wave, and A |1 - w^2| -> sqrt(F^2 - (4 mu N / pi)^2).
    let (kt, limit) = (0.8, 1.0);
    let harmonics = [1, 3, 5];
    let wave = 4.0 * limit / PI;
    for law in ContactLaw::ALL {
        for share in [1.05, 1.5] {
            let force = share * wave;
            let system = oscillator(law, &harmonics, 1 << 12, force, kt, limit);
            let growth = (force * force - wave * wave).sqrt();
            for exponent in 3..=6 {
                let offset = 10.0_f64.powi(-exponent);
                let omega = (1.0 - offset).sqrt();
                let mut x = vec![0.0; 6];
                (x[0], x[1]) = (growth / offset, -wave / offset);
                converge(&system, omega, &mut x);
                let error = relative(amplitude(&x) * offset, growth);
                // What is left of the spring: A k_eq -> (2/3) (kt/pi) (4 mu N / kt)^(3/2) A^(-1/2).
                let large = growth / offset;
                let spring = 2.0 / 3.0 * kt / PI * (4.0 * limit / kt).powf(1.5) / large.sqrt();
                assert!(
                    error < 1.2 * spring / growth,
                    "{share}, {offset}: {error:e}"
                );
            }
        }
    }
}

#[test]
fn constant_load_of_zero_is_no_ring() {
    let wheel = Wheel::lumped24();
    let solver = wheel.solver(&[1, 3], SolverOptions::default());
    let deviations = wheel.deviations(&mut Random(43), 0.03);
    let pattern = super::super::wheels::pattern(&deviations);
    let amplitude = |contact| {
        let row = solve_row(&solver, &pattern, contact).1;
        assert_eq!(row.status, Status::Ok);
        row.peak_amplitude_m.unwrap()
    };
    let (none, free) = (amplitude(full(0.0)), amplitude(ContactCondition::Free));
    // The peak of one is sought to 1e-3 of height, that of the other far closer.
    assert!(relative(none, free) < 1e-3, "{none} {free}");
}

#[test]
fn the_share_of_the_period_in_slip_is_that_of_the_hysteresis_loop() {
    // After each reversal of x = X cos(theta) the slider sticks until x has moved by 2 x_c, x_c = limit / kt:
    // X (1 - cos(theta)) = 2 x_c, twice per period.
    const SAMPLES: usize = 4096;
    let (kt, limit) = (2.0, 0.5);
    let least = limit / kt;
    for law in ContactLaw::ALL {
        let system = oscillator(law, &[1], SAMPLES, 1.0, kt, limit);
        let mut workspace = system.workspace();
        for ratio in [0.5, 0.999, 1.001, 1.5, 4.0, 100.0] {
            let x = [ratio * least, 0.0];
            let states = system.contact_states(&x, &mut workspace);
            let [state] = states[..] else {
                panic!("one pair, {} states", states.len())
            };
            assert_eq!(state.slipping, ratio > 1.0, "{law:?} {ratio}");
            assert!(!state.separated && state.separated_share == 0.0);
            let sticks = if ratio > 1.0 {
                (1.0_f64 - 2.0 / ratio).acos() / PI
            } else {
                1.0
            };
            let share = state.slipping_share.expect("no drift");
            assert!(
                (share - (1.0 - sticks)).abs() <= 4.0 / SAMPLES as f64,
                "{law:?} {ratio}: {share}, {}",
                1.0 - sticks
            );
        }
    }
}
