//! Periodic state against brute force, its closure, limits and scaling.
#![allow(clippy::float_cmp)] // exact zeros and exact powers of two are the point here

use std::sync::Arc;

use blisk::response::friction::{
    ContactHistory, ContactLaw, PairDisplacement, PairParameters, PeriodicSlider,
};
use blisk::response::harmonic_balance::{HarmonicTransform, PairHarmonics, PairJacobian};

use super::random::Random;

/// A random history of harmonics 1 to 5 with `n_samples` samples.
fn history(random: &mut Random, n_samples: usize, size: f64) -> Vec<f64> {
    let highest = 5.min((n_samples - 1) / 2);
    let harmonics: Vec<usize> = (1..=highest).collect();
    let transform = HarmonicTransform::new(&harmonics, n_samples).unwrap();
    let coefficients = random.vector(transform.n_coefficients(), size);
    let mut samples = vec![0.0; n_samples];
    transform.synthesize_by_sums(&coefficients, &mut samples);
    samples
}

/// Tangential force of the return map `T <- clip(T + kt dx, -mu N, mu N)` after `periods` periods
/// from rest.
fn marched(kt: f64, mu: f64, x: &[f64], load: &[f64], periods: usize) -> Vec<f64> {
    let n = x.len();
    let mut force = vec![0.0; n];
    let mut current: f64 = 0.0;
    for _ in 0..periods {
        for j in 0..n {
            let trial = current + kt * (x[j] - x[(j + n - 1) % n]);
            current = trial.clamp(-mu * load[j], mu * load[j]);
            force[j] = current;
        }
    }
    force
}

#[test]
fn periodic_state_is_where_many_marched_periods_end() {
    let mut random = Random(1);
    let mut counts = [0; 3];
    for case in 0..3000 {
        let n_samples = random.integer(8, 130);
        let (kt, mu) = (random.magnitude(0.1, 10.0), random.uniform(0.05, 1.0));
        let x = history(&mut random, n_samples, 1.0);
        let g = history(&mut random, n_samples, 1.0);
        let n0 = random.magnitude(0.05, 100.0);
        let kn = random.magnitude(0.01, 10.0);
        let load: Vec<f64> = g.iter().map(|g| (n0 + kn * g).max(0.0)).collect();
        let mut slider = PeriodicSlider::new(n_samples);
        let slipping = slider.solve(kt, mu, &x, &load);
        let force: Vec<f64> = x
            .iter()
            .zip(slider.offset_n())
            .map(|(x, y)| kt * x + y)
            .collect();
        let brute = marched(kt, mu, &x, &load, 12);
        let scale = kt * x.iter().fold(0.0, |a: f64, x| a.max(x.abs()))
            + mu * load.iter().fold(0.0, |a: f64, n| a.max(*n));
        let constant = if slipping { 0.0 } else { brute[0] - force[0] };
        for j in 0..n_samples {
            assert!(
                (brute[j] - force[j] - constant).abs() < 1e-12 * scale,
                "case {case}, sample {j}"
            );
            assert!(force[j].abs() <= mu * load[j] + 1e-14 * scale);
        }
        counts[usize::from(slipping)] += 1;
        counts[2] += usize::from(load.contains(&0.0));
    }
    assert!(
        counts.iter().all(|&count| count > 300),
        "cases stuck, slipping, separated: {counts:?}"
    );
}

#[test]
fn one_more_period_changes_nothing_and_clips_explain_every_offset() {
    let mut random = Random(2);
    for case in 0..2000 {
        let n_samples = random.integer(8, 130);
        let (kt, mu) = (random.magnitude(0.1, 10.0), random.uniform(0.05, 1.0));
        let x = history(&mut random, n_samples, 1.0);
        let g = history(&mut random, n_samples, 1.0);
        let n0 = random.magnitude(0.05, 20.0);
        let load: Vec<f64> = g.iter().map(|g| (n0 + g).max(0.0)).collect();
        let mut slider = PeriodicSlider::new(n_samples);
        let slipping = slider.solve(kt, mu, &x, &load);
        let mut y = slider.offset_n()[n_samples - 1];
        for j in 0..n_samples {
            y = y
                .max(-mu * load[j] - kt * x[j])
                .min(mu * load[j] - kt * x[j]);
            assert_eq!(
                y.to_bits(),
                slider.offset_n()[j].to_bits(),
                "case {case}, sample {j}"
            );
        }
        slider.locate_clips();
        let clips: Vec<(usize, f64)> = slider
            .clip_samples()
            .iter()
            .copied()
            .zip(slider.clip_signs().iter().copied())
            .collect();
        assert!(clips.is_sorted_by(|a, b| a.0 < b.0));
        assert_eq!(clips.is_empty(), !slipping && slider.offset_n()[0] == 0.0);
        for j in 0..n_samples {
            let ruling = clips.iter().rev().find(|clip| clip.0 <= j).or(clips.last());
            let explained = ruling.map_or(0.0, |&(r, sign)| -kt * x[r] + sign * mu * load[r]);
            assert!(
                (slider.offset_n()[j] - explained).abs() < 1e-14 * (kt + mu * n0),
                "case {case}, sample {j}"
            );
        }
    }
}

#[test]
fn slider_agrees_with_the_start_at_the_lowest_upper_bound() {
    let mut random = Random(3);
    for _ in 0..2000 {
        let n = random.integer(5, 130);
        let (kt, mu) = (random.magnitude(0.1, 10.0), random.uniform(0.05, 1.0));
        let x = history(&mut random, n, 1.0);
        let load: Vec<f64> = history(&mut random, n, 1.0)
            .iter()
            .map(|g| (1.0 + g).max(0.0))
            .collect();
        let mut slider = PeriodicSlider::new(n);
        let lower: Vec<f64> = (0..n).map(|j| -mu * load[j] - kt * x[j]).collect();
        let upper: Vec<f64> = (0..n).map(|j| mu * load[j] - kt * x[j]).collect();
        if slider.solve(kt, mu, &x, &load) {
            let start = (0..n)
                .min_by(|&i, &j| upper[i].total_cmp(&upper[j]))
                .unwrap();
            let mut y = upper[start];
            for j in (start..n).chain(0..start) {
                y = y.max(lower[j]).min(upper[j]);
                assert_eq!(y.to_bits(), slider.offset_n()[j].to_bits());
            }
        }
    }
}

#[test]
fn values_that_are_not_finite_pass_without_a_panic() {
    let transform = Arc::new(HarmonicTransform::new(&[0, 1], 32).unwrap());
    let mut pairs = PairHarmonics::new(ContactLaw::Simplified3d, transform);
    let mut jacobian = PairJacobian::new(3);
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        for position in 0..9 {
            let mut coefficients = [0.0, 1.0, 2.0, 0.0, 3.0, -4.0, 0.0, 5.0, 6.0];
            coefficients[position] = poison;
            let mut correction = [0.0; 9];
            pairs.evaluate(
                &pair(1.0, 0.3),
                &coefficients,
                &mut correction,
                Some(&mut jacobian),
            );
        }
    }
}

#[test]
fn few_samples_are_enough_for_the_law_itself() {
    for n_samples in 1..8 {
        let x: Vec<f64> = (0..n_samples)
            .map(|j| [1.0, -1.0, 0.5, -2.0][j % 4])
            .collect();
        let load = vec![0.25; n_samples];
        let mut slider = PeriodicSlider::new(n_samples);
        slider.solve(1.0, 1.0, &x, &load);
        let force: Vec<f64> = x
            .iter()
            .zip(slider.offset_n())
            .map(|(x, y)| x + y)
            .collect();
        if slider.is_slipping() {
            assert_eq!(force, marched(1.0, 1.0, &x, &load, 4));
        }
        assert_eq!(slider.is_slipping(), n_samples > 1);
    }
}

fn pair(n0: f64, mu: f64) -> PairParameters {
    PairParameters {
        normal_load_n: n0,
        normal_stiffness_n_per_m: 2.0,
        tangential_stiffness_n_per_m: 1.5,
        friction_coefficient: mu,
    }
}

#[test]
fn stuck_pair_has_exactly_no_correction_at_any_load() {
    let mut random = Random(4);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n_coefficients = transform.n_coefficients();
    let mut jacobian = PairJacobian::new(n_coefficients);
    for law in [ContactLaw::Simplified3d, ContactLaw::MacroSlip1d] {
        let mut pairs = PairHarmonics::new(law, Arc::clone(&transform));
        for n0 in [200.0, 1e3, 1e9, 1e300] {
            let coefficients = random.vector(3 * n_coefficients, 1.0);
            let mut correction = vec![1.0; 3 * n_coefficients];
            let state = pairs.evaluate(
                &pair(n0, 0.3),
                &coefficients,
                &mut correction,
                Some(&mut jacobian),
            );
            assert!(!state.slipping && !state.separated);
            assert!(correction.iter().all(|&value| value == 0.0));
            assert_eq!(jacobian, PairJacobian::new(n_coefficients));
        }
    }
}

#[test]
fn sticking_with_an_offset_has_no_correction_in_the_harmonics() {
    // The range of x fits between the bounds, but not round zero: |x| exceeds the limit in one
    // direction only.
    let transform = Arc::new(HarmonicTransform::new(&[1, 2], 128).unwrap());
    let mut pairs = PairHarmonics::new(ContactLaw::Simplified3d, Arc::clone(&transform));
    let mut coefficients = [0.0; 12];
    (coefficients[4], coefficients[6]) = (1.0, 0.5);
    let mut correction = [1.0; 12];
    let mut jacobian = PairJacobian::new(4);
    // kt x ranges from about -1.1 to 2.25 and the limit is 1.8: min b = 1.8 - 2.25 = -0.45.
    let state = pairs.evaluate(
        &pair(6.0, 0.3),
        &coefficients,
        &mut correction,
        Some(&mut jacobian),
    );
    assert!(!state.slipping);
    let slider = &pairs.history().sliders()[0];
    assert!((slider.offset_n()[0] + 0.45).abs() < 1e-12);
    assert!((pairs.history().mean_friction_n()[0] + 0.45).abs() < 1e-12);
    assert!(correction.iter().all(|&value| value == 0.0));
    assert_eq!(jacobian, PairJacobian::new(4));
}

#[test]
fn frictionless_pair_loses_the_whole_tangential_force() {
    let mut random = Random(5);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n = transform.n_coefficients();
    let mut pairs = PairHarmonics::new(ContactLaw::Simplified3d, transform);
    for mu in [0.0, 1e-9] {
        let coefficients = random.vector(3 * n, 1.0);
        let mut correction = vec![0.0; 3 * n];
        pairs.evaluate(&pair(100.0, mu), &coefficients, &mut correction, None);
        for direction in [1, 2] {
            assert_eq!(correction[direction * n], 0.0);
            for c in direction * n + 1..(direction + 1) * n {
                assert!((correction[c] + 1.5 * coefficients[c]).abs() < 1e-13 + 1e3 * mu);
            }
        }
    }
}

#[test]
fn pair_without_any_contact_loses_the_whole_force() {
    let transform = Arc::new(HarmonicTransform::new(&[0, 1], 128).unwrap());
    let mut pairs = PairHarmonics::new(ContactLaw::Simplified3d, transform);
    let coefficients = [-10.0, 0.5, 0.25, 0.0, 1.0, 2.0, 0.0, -1.0, 0.125];
    let mut correction = [0.0; 9];
    let state = pairs.evaluate(&pair(3.0, 0.3), &coefficients, &mut correction, None);
    assert!(state.separated);
    // N = 0 throughout: N - N0 - kn g = -3 + 20 in the mean, -kn g in harmonic 1.
    let expected = [17.0, -1.0, -0.5, 0.0, -1.5, -3.0, 0.0, 1.5, -0.1875];
    for (value, expected) in correction.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-13, "{correction:?}");
    }
}

#[test]
fn macro_slip_acts_along_the_first_tangent_only() {
    let mut random = Random(6);
    let transform = Arc::new(HarmonicTransform::new(&[1, 3], 128).unwrap());
    let mut macro_slip = PairHarmonics::new(ContactLaw::MacroSlip1d, Arc::clone(&transform));
    let mut variable = PairHarmonics::new(ContactLaw::Simplified3d, transform);
    let coefficients = random.vector(12, 3.0);
    let (mut first, mut second) = ([0.0; 12], [0.0; 12]);
    let state = macro_slip.evaluate(&pair(2.0, 0.3), &coefficients, &mut first, None);
    let bilateral = PairParameters {
        normal_stiffness_n_per_m: 0.0,
        ..pair(2.0, 0.3)
    };
    variable.evaluate(&bilateral, &coefficients, &mut second, None);
    assert!(state.slipping && !state.separated);
    assert_eq!(first[4..8], second[4..8]);
    assert!(
        first[..4]
            .iter()
            .chain(&first[8..])
            .all(|&value| value == 0.0)
    );
}

#[test]
fn corrections_scale_with_displacement_and_load() {
    let mut random = Random(7);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n = transform.n_coefficients();
    let mut pairs = PairHarmonics::new(ContactLaw::Simplified3d, transform);
    let mut slipping = 0;
    for _ in 0..300 {
        let coefficients = random.vector(3 * n, 1.0);
        let n0 = random.magnitude(0.5, 50.0);
        let (mut one, mut other) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        let state = pairs.evaluate(&pair(n0, 0.3), &coefficients, &mut one, None);
        slipping += usize::from(state.slipping);
        for factor in [2.0_f64.powi(-30), 2.0, 2.0_f64.powi(40)] {
            let scaled: Vec<f64> = coefficients.iter().map(|value| factor * value).collect();
            assert_eq!(
                pairs.evaluate(&pair(factor * n0, 0.3), &scaled, &mut other, None),
                state
            );
            assert!(
                one.iter()
                    .zip(&other)
                    .all(|(one, other)| factor * one == *other)
            );
        }
    }
    assert!(slipping > 100);
}

#[test]
fn known_stick_and_computed_stick_agree() {
    let mut random = Random(8);
    let n_samples = 64;
    let mut history_of_pair = ContactHistory::new(n_samples);
    for _ in 0..200 {
        let x = history(&mut random, n_samples, 0.1);
        let g = history(&mut random, n_samples, 0.1);
        let largest = |x: &[f64]| x.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let parameters = pair(random.magnitude(0.3, 30.0), 0.5);
        let excursions = [largest(&g), largest(&x), largest(&x)];
        let displacement = PairDisplacement {
            normal: &g,
            tangential: [&x, &x],
        };
        let state = history_of_pair.respond(ContactLaw::Simplified3d, &parameters, displacement);
        if parameters.surely_sticks(ContactLaw::Simplified3d, excursions) {
            assert!(!state.slipping && !state.separated);
            assert!(
                history_of_pair.sliders()[0]
                    .offset_n()
                    .iter()
                    .all(|&y| y == 0.0)
            );
        }
    }
}
