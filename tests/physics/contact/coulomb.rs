//! `coulomb_3d`: closed forms, brute force, its simplification, rotation, limits.
#![allow(clippy::float_cmp)] // exact zeros and exact powers of two are the point here

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use blisk::response::friction::{
    ContactHistory, ContactLaw, CoupledSlider, PairDisplacement, PairParameters,
};
use blisk::response::harmonic_balance::{HarmonicTransform, PairHarmonics, PairJacobian};

use super::random::Random;

const SCALE_TOLERANCE: f64 = 1e-12;

fn pair(n0: f64, mu: f64) -> PairParameters {
    PairParameters {
        normal_load_n: n0,
        normal_stiffness_n_per_m: 2.0,
        tangential_stiffness_n_per_m: 1.5,
        friction_coefficient: mu,
    }
}

/// A plane motion and a normal load over one period.
struct Motion {
    x: [Vec<f64>; 2],
    load: Vec<f64>,
}

impl Motion {
    /// Harmonics 1 to 5, the second direction `flatness` times the first.
    fn random(random: &mut Random, flatness: f64) -> Self {
        let n_samples = random.integer(12, 130);
        let transform = HarmonicTransform::new(&[1, 2, 3, 4, 5], n_samples).unwrap();
        let mut history = |size: f64| {
            let mut samples = vec![0.0; n_samples];
            transform.synthesize_by_sums(&random.vector(10, size), &mut samples);
            samples
        };
        let (first, second, closing) = (history(1.0), history(flatness), history(1.0));
        let (n0, kn) = (random.magnitude(0.05, 60.0), random.magnitude(0.01, 10.0));
        Self {
            x: [first, second],
            load: closing.iter().map(|g| (n0 + kn * g).max(0.0)).collect(),
        }
    }

    fn n_samples(&self) -> usize {
        self.load.len()
    }

    fn size(&self) -> f64 {
        let norms = self.x[0].iter().zip(&self.x[1]);
        norms.map(|(a, b)| a.hypot(*b)).fold(0.0, f64::max)
    }

    fn solve(&self, kt: f64, mu: f64) -> CoupledSlider {
        let mut slider = CoupledSlider::new(self.n_samples());
        slider.solve(kt, mu, [&self.x[0], &self.x[1]], &self.load);
        slider
    }
}

/// Forces of the return map in its textbook form, from the force `start`: one period after
/// `periods` others, and by how much the last one changed it.
fn marched(
    motion: &Motion,
    kt: f64,
    mu: f64,
    mut force: [f64; 2],
    periods: usize,
) -> ([Vec<f64>; 2], f64) {
    let n = motion.n_samples();
    let mut history = [vec![0.0; n], vec![0.0; n]];
    let mut change = 0.0;
    for _ in 0..=periods {
        let before = force;
        let [first, second] = &mut history;
        for (j, (first, second)) in first.iter_mut().zip(second).enumerate() {
            for (k, force) in force.iter_mut().enumerate() {
                *force += kt * (motion.x[k][j] - motion.x[k][(j + n - 1) % n]);
            }
            let (size, limit) = (force[0].hypot(force[1]), mu * motion.load[j]);
            if size > limit {
                force = force.map(|component| component * (limit / size));
            }
            (*first, *second) = (force[0], force[1]);
        }
        change = (force[0] - before[0]).hypot(force[1] - before[1]);
    }
    (history, change)
}

#[test]
fn periodic_state_is_where_every_marched_history_ends() {
    let mut random = Random(31);
    let (mut slipping, mut stuck, mut most_periods) = (0, 0, 0);
    for case in 0..600 {
        let motion = Motion::random(&mut random, [1.0, 0.1, 1e-3][case % 3]);
        let (kt, mu) = (random.magnitude(0.1, 10.0), random.uniform(0.05, 1.0));
        let slider = motion.solve(kt, mu);
        assert!(slider.is_closed(), "case {case}: {}", slider.periods());
        most_periods = most_periods.max(slider.periods());
        let scale = kt * motion.size();
        for (j, load) in motion.load.iter().enumerate() {
            let [t1, t2] = [0, 1].map(|k| kt * motion.x[k][j] + slider.offset_n()[k][j]);
            assert!(t1.hypot(t2) <= mu * load + SCALE_TOLERANCE * scale);
        }
        if !slider.is_slipping() {
            stuck += 1;
            for offset in slider.offset_n() {
                let (low, high) = offset.iter().fold((f64::MAX, f64::MIN), |(low, high), &y| {
                    (low.min(y), high.max(y))
                });
                assert!(high - low <= 1e-12 * scale);
            }
            continue;
        }
        slipping += 1;
        for _ in 0..2 {
            let start = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
            let (force, change) = marched(&motion, kt, mu, start, 1000);
            if change > 1e-14 * scale {
                // A little slip fades slowly across its direction: not there yet.
                continue;
            }
            for ((x, y), force) in motion.x.iter().zip(slider.offset_n()).zip(&force) {
                for ((x, y), force) in x.iter().zip(y).zip(force) {
                    assert!((kt * x + y - force).abs() < 1e-9 * scale, "case {case}");
                }
            }
        }
    }
    println!("{slipping} slipping, {stuck} stuck, at most {most_periods} periods");
    assert!(slipping > 300 && stuck > 100);
    assert!(most_periods < 15);
}

#[test]
fn slip_far_shorter_than_the_limit_closes_too() {
    // The offset across the slip fades by the factor exp(-slip / limit) per period when marched.
    let mut random = Random(32);
    let n = 128;
    let mut most_periods = 0;
    for exponent in 1..12 {
        for _ in 0..50 {
            let excess = 10.0_f64.powi(-exponent);
            let phase = random.uniform(0.0, TAU);
            let angle = |j: usize| TAU * j as f64 / n as f64;
            let motion = Motion {
                x: [
                    (0..n).map(|j| (1.0 + excess) * angle(j).cos()).collect(),
                    (0..n)
                        .map(|j| 0.3 * excess * (angle(j) - phase).cos())
                        .collect(),
                ],
                load: vec![1.0; n],
            };
            let slider = motion.solve(1.0, 1.0);
            assert!(slider.is_closed() && slider.is_slipping());
            most_periods = most_periods.max(slider.periods());
        }
    }
    println!("at most {most_periods} periods");
    assert!(most_periods < 15);
}

/// Where two short slips opposite to each other determine the offset across them, whole Newton steps can go to and fro.
#[test]
fn a_narrow_ellipse_that_slips_a_little_at_both_ends_closes() {
    let mut random = Random(34);
    let n: usize = 128;
    let (mut slipping, mut most_periods) = (0, 0);
    for _ in 0..3000 {
        let (width, width_phase) = (random.uniform(0.03, 0.1), random.uniform(0.0, TAU));
        let (swing, swing_phase) = (random.uniform(0.0, 0.35), random.uniform(0.0, TAU));
        let level = random.uniform(0.9, 1.1);
        let wave = |phase: f64| (0..n).map(move |j| (TAU * j as f64 / n as f64 - phase).cos());
        let motion = Motion {
            x: [
                wave(0.0).collect(),
                wave(width_phase).map(|x| width * x).collect(),
            ],
            load: wave(swing_phase)
                .map(|x| level * (1.0 + swing * x))
                .collect(),
        };
        let slider = motion.solve(1.0, 1.0);
        assert!(slider.is_closed());
        slipping += usize::from(slider.is_slipping());
        most_periods = most_periods.max(slider.periods());
    }
    println!("{slipping} slipping, at most {most_periods} periods");
    assert!(slipping > 1500);
    assert!(most_periods < 15);
}

#[test]
fn circular_motion_has_a_force_of_constant_size_and_known_lead() {
    // Sliding round a circle of radius A, the force has the size mu N and leads the displacement by
    // phi, cos phi = mu N / (kt A); sampled, mu N cos(d/2) = kt A cos(phi + d/2) for steps of d.
    let (kt, mu, load) = (2.0, 0.5, 6.0);
    for amplitude in [1.6, 2.0, 3.0, 15.0, 1e4] {
        for n_samples in [16, 128, 1024] {
            for direction in [1.0, -1.0] {
                let step = TAU / n_samples as f64;
                let angle = |j: usize| direction * step * j as f64;
                let motion = Motion {
                    x: [
                        (0..n_samples).map(|j| amplitude * angle(j).cos()).collect(),
                        (0..n_samples).map(|j| amplitude * angle(j).sin()).collect(),
                    ],
                    load: vec![load; n_samples],
                };
                let slider = motion.solve(kt, mu);
                assert!(slider.is_slipping() && slider.is_closed());
                let limit = mu * load;
                let lead = (limit * (0.5 * step).cos() / (kt * amplitude)).acos() - 0.5 * step;
                let mut work = 0.0;
                for j in 0..n_samples {
                    let [t1, t2] = [0, 1].map(|k| kt * motion.x[k][j] + slider.offset_n()[k][j]);
                    let (s, c) = (angle(j) + direction * lead).sin_cos();
                    let error = (t1 - limit * c).hypot(t2 - limit * s);
                    assert!(error < 2e-12 * kt * amplitude, "{amplitude}: {error:e}");
                    // Against the velocity of the circle.
                    let (s, c) = angle(j).sin_cos();
                    work += direction * step * amplitude * (t2 * c - t1 * s);
                }
                let continuous = (limit / (kt * amplitude)).acos();
                if n_samples == 1024 {
                    let loss = TAU * amplitude * limit * continuous.sin();
                    assert!((work - loss).abs() < 1e-2 * loss, "{work} {loss}");
                }
            }
        }
    }
}

#[test]
fn circular_motion_within_the_circle_sticks_without_offset() {
    let angle = |j: usize| TAU * j as f64 / 64.0;
    let motion = Motion {
        x: [
            (0..64).map(|j| 1.499 * angle(j).cos()).collect(),
            (0..64).map(|j| 1.499 * angle(j).sin()).collect(),
        ],
        load: vec![6.0; 64],
    };
    let slider = motion.solve(2.0, 0.5);
    assert!(!slider.is_slipping() && slider.slips().is_empty());
    assert!(slider.offsets_n().iter().all(|&y| y == 0.0));
}

#[test]
fn motion_along_one_tangent_is_that_of_simplified_3d() {
    let mut random = Random(33);
    let sets: [&[usize]; 3] = [&[1], &[1, 3], &[0, 1, 2, 3]];
    let mut slipping = 0;
    for case in 0..300 {
        let transform = Arc::new(HarmonicTransform::new(sets[case % 3], 128).unwrap());
        let n = transform.n_coefficients();
        let mut coulomb = PairHarmonics::new(ContactLaw::Coulomb3d, Arc::clone(&transform));
        let mut simplified = PairHarmonics::new(ContactLaw::Simplified3d, transform);
        let moving = 1 + case % 2;
        let mut coefficients = random.vector(3 * n, 1.0);
        coefficients[(3 - moving) * n..][..n].fill(0.0);
        let parameters = pair(random.magnitude(0.1, 30.0), random.uniform(0.05, 0.9));
        let (mut one, mut other) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        let mut jacobians = [PairJacobian::new(n), PairJacobian::new(n)];
        let [first, second] = &mut jacobians;
        let state = coulomb.evaluate(&parameters, &coefficients, &mut one, Some(first));
        let same = simplified.evaluate(&parameters, &coefficients, &mut other, Some(second));
        assert_eq!(state.separated, same.separated);
        // Along the other tangent nothing moves, and without load at one instant nothing slips.
        assert_eq!(state.slipping, same.slipping, "case {case}");
        slipping += usize::from(state.slipping);
        for (one, other) in one.iter().zip(&other) {
            assert!((one - other).abs() < 1e-12, "case {case}: {one} {other}");
        }
        let means = [&coulomb, &simplified].map(|pairs| pairs.history().mean_friction_n());
        assert!((means[0][moving - 1] - means[1][moving - 1]).abs() < 1e-12);
        let blocks = |jacobian: &PairJacobian| {
            let mut blocks = jacobian.normal_normal.clone();
            blocks.extend(&jacobian.tangential_tangential[moving - 1]);
            blocks.extend(&jacobian.tangential_normal[moving - 1]);
            blocks
        };
        for (one, other) in blocks(first).iter().zip(&blocks(second)) {
            assert!((one - other).abs() < 1e-12, "case {case}: {one} {other}");
        }
        for cross in first.tangential_cross.iter().flatten() {
            assert!(cross.iter().all(|value| value.abs() < 1e-12), "case {case}");
        }
    }
    assert!(slipping > 150);
}

#[test]
fn turning_the_tangents_turns_the_force_but_not_that_of_simplified_3d() {
    let mut random = Random(34);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n = transform.n_coefficients();
    let mut worst = [0.0_f64; 2];
    for _ in 0..200 {
        let angle = random.uniform(0.0, PI);
        let turned = |coefficients: &[f64]| {
            let (s, c) = angle.sin_cos();
            let mut turned = coefficients.to_vec();
            for i in n..2 * n {
                turned[i] = c * coefficients[i] - s * coefficients[i + n];
                turned[i + n] = s * coefficients[i] + c * coefficients[i + n];
            }
            turned
        };
        let coefficients = random.vector(3 * n, 1.0);
        let parameters = pair(random.magnitude(0.5, 10.0), 0.4);
        for (worst, law) in worst
            .iter_mut()
            .zip([ContactLaw::Coulomb3d, ContactLaw::Simplified3d])
        {
            let mut pairs = PairHarmonics::new(law, Arc::clone(&transform));
            let (mut one, mut other) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
            pairs.evaluate(&parameters, &coefficients, &mut one, None);
            pairs.evaluate(&parameters, &turned(&coefficients), &mut other, None);
            for (one, other) in turned(&one).iter().zip(&other) {
                *worst = worst.max((one - other).abs());
            }
        }
    }
    assert!(worst[0] < 1e-11, "{:e}", worst[0]);
    assert!(worst[1] > 0.1);
}

#[test]
fn every_slip_dissipates() {
    let mut random = Random(35);
    for _ in 0..500 {
        let motion = Motion::random(&mut random, 1.0);
        let (kt, mu) = (random.magnitude(0.1, 10.0), random.uniform(0.05, 1.0));
        let slider = motion.solve(kt, mu);
        let [y1, y2] = slider.offset_n();
        for slip in slider.slips() {
            let j = slip.sample;
            let before = if j == 0 { y1.len() - 1 } else { j - 1 };
            let force = [kt * motion.x[0][j] + y1[j], kt * motion.x[1][j] + y2[j]];
            let moved = [y1[before] - y1[j], y2[before] - y2[j]];
            let dissipated = force[0] * moved[0] + force[1] * moved[1];
            assert!(dissipated >= -1e-12 * (kt * motion.size()).powi(2));
        }
    }
}

#[test]
fn corrections_scale_with_displacement_and_load() {
    let mut random = Random(36);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n = transform.n_coefficients();
    let mut pairs = PairHarmonics::new(ContactLaw::Coulomb3d, transform);
    for _ in 0..200 {
        let coefficients = random.vector(3 * n, 1.0);
        let n0 = random.magnitude(0.5, 50.0);
        let (mut one, mut other) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        let state = pairs.evaluate(&pair(n0, 0.3), &coefficients, &mut one, None);
        for factor in [2.0_f64.powi(-30), 2.0, 2.0_f64.powi(40)] {
            let scaled: Vec<f64> = coefficients.iter().map(|value| factor * value).collect();
            let again = pairs.evaluate(&pair(factor * n0, 0.3), &scaled, &mut other, None);
            assert_eq!(state, again);
            assert!(
                one.iter()
                    .zip(&other)
                    .all(|(one, other)| factor * one == *other)
            );
        }
    }
}

#[test]
fn sticks_exactly_at_any_high_load_and_loses_the_force_without_friction() {
    let mut random = Random(37);
    let transform = Arc::new(HarmonicTransform::new(&[0, 1, 2, 3], 128).unwrap());
    let n = transform.n_coefficients();
    let mut pairs = PairHarmonics::new(ContactLaw::Coulomb3d, transform);
    let coefficients = random.vector(3 * n, 1.0);
    let mut correction = vec![1.0; 3 * n];
    let mut jacobian = PairJacobian::new(n);
    for n0 in [200.0, 1e3, 1e9, 1e300] {
        let state = pairs.evaluate(
            &pair(n0, 0.3),
            &coefficients,
            &mut correction,
            Some(&mut jacobian),
        );
        assert!(!state.slipping && !state.separated && !state.unclosed);
        assert!(correction.iter().all(|&value| value == 0.0));
        assert_eq!(jacobian, PairJacobian::new(n));
    }
    for mu in [0.0, 1e-9] {
        pairs.evaluate(
            &pair(100.0, mu),
            &coefficients,
            &mut correction,
            Some(&mut jacobian),
        );
        for direction in [1, 2] {
            assert_eq!(correction[direction * n], 0.0);
            for c in direction * n + 1..(direction + 1) * n {
                assert!((correction[c] + 1.5 * coefficients[c]).abs() < 1e-13 + 1e3 * mu);
            }
        }
    }
}

#[test]
fn a_stuck_pair_at_a_load_of_1e9_is_not_touched_by_another_one_slipping() {
    // N0 = 1e9 but mu N0 within reach of the motion: the correction is still free of the size of N0.
    let mut random = Random(38);
    let transform = Arc::new(HarmonicTransform::new(&[1], 128).unwrap());
    let mut pairs = PairHarmonics::new(ContactLaw::Coulomb3d, transform);
    let coefficients = random.vector(6, 1.0);
    let reference = PairParameters {
        normal_stiffness_n_per_m: 0.0,
        ..pair(1.0, 0.5)
    };
    let heavy = PairParameters {
        normal_load_n: 2.0_f64.powi(30),
        friction_coefficient: 0.5 * 2.0_f64.powi(-30),
        ..reference
    };
    let (mut one, mut other) = (vec![0.0; 6], vec![0.0; 6]);
    assert!(
        pairs
            .evaluate(&reference, &coefficients, &mut one, None)
            .slipping
    );
    pairs.evaluate(&heavy, &coefficients, &mut other, None);
    assert_eq!(one, other);
}

#[test]
fn the_sum_of_both_tangents_never_exceeds_the_circle_where_simplified_3d_does() {
    let n_samples = 256;
    let angle = |j: usize| TAU * j as f64 / f64::from(256);
    let x: Vec<f64> = (0..n_samples).map(|j| 10.0 * angle(j).cos()).collect();
    let rest = vec![0.0; n_samples];
    let largest = |law: ContactLaw| {
        let mut history = ContactHistory::new(n_samples);
        let displacement = PairDisplacement {
            normal: &rest,
            tangential: [&x, &x],
        };
        history.respond(law, &pair(4.0, 0.5), displacement);
        let [y1, y2] = history.tangential_correction_n();
        (0..n_samples)
            .map(|j| (1.5 * x[j] + y1[j]).hypot(1.5 * x[j] + y2[j]))
            .fold(0.0, f64::max)
    };
    assert!((largest(ContactLaw::Coulomb3d) - 2.0).abs() < 1e-12);
    assert!((largest(ContactLaw::Simplified3d) - 2.0 * 2.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn values_that_are_not_finite_pass_without_a_panic() {
    let transform = Arc::new(HarmonicTransform::new(&[0, 1], 32).unwrap());
    let mut pairs = PairHarmonics::new(ContactLaw::Coulomb3d, transform);
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

/// Under a load far above what the motion needs, offsets round by more than closing allows: dragged
/// along the rim of such disks by a drift, the state does not close, and the pair says so.
#[test]
fn a_pair_that_does_not_close_is_marked_after_its_periods() {
    const N_SAMPLES: usize = 64;
    let (mut closed, mut unclosed) = (0, 0);
    for seed in 0..20 {
        let mut random = Random(seed);
        let transform = HarmonicTransform::new(&[1], N_SAMPLES).unwrap();
        let mut x = [vec![0.0; N_SAMPLES], vec![0.0; N_SAMPLES]];
        for history in &mut x {
            transform.synthesize_by_sums(&random.vector(2, 1.0), history);
        }
        let mut slider = CoupledSlider::new(N_SAMPLES);
        let load = vec![random.magnitude(1e2, 1e8); N_SAMPLES];
        let drift = [random.magnitude(1e-8, 1.0), 0.0];
        let slips = slider.solve_drifting(1.0, 0.3, [&x[0], &x[1]], &load, drift);
        if slider.is_closed() {
            closed += 1;
        } else {
            assert!(slips);
            assert_eq!(slider.periods(), 200, "seed {seed}");
            unclosed += 1;
        }
    }
    println!("{closed} closed, {unclosed} not");
    assert!(unclosed > 0);
}
