//! Jenkins element against exact loops and closed-form harmonics.
//!
//! Convention of the tables: `x = A cos th`, force `a0 + a1 cos th + b1 sin th + ...`, `b1 = -A w
//! c_eq = -E/(pi A)`.

use std::f64::consts::{FRAC_2_PI, PI, TAU};

use blisk::response::friction::{
    ContactHistory, ContactLaw, PairDisplacement, PairParameters, PairState, PeriodicSlider,
};

const MANY: usize = 1 << 18;

fn cosine(amplitude: f64, n_samples: usize) -> Vec<f64> {
    (0..n_samples)
        .map(|j| amplitude * (TAU * j as f64 / n_samples as f64).cos())
        .collect()
}

/// `(a_k, b_k)` of a sampled force.
fn harmonic(force: &[f64], k: usize) -> (f64, f64) {
    let n = force.len();
    let angle = |j: usize| TAU * ((j * k) % n) as f64 / n as f64;
    let scale = if k == 0 { 1.0 } else { 2.0 } / n as f64;
    let a = force
        .iter()
        .enumerate()
        .map(|(j, f)| f * angle(j).cos())
        .sum::<f64>();
    let b = force
        .iter()
        .enumerate()
        .map(|(j, f)| f * angle(j).sin())
        .sum::<f64>();
    (scale * a, scale * b)
}

/// Loop area of `force` over `x` by the trapezoidal rule.
fn loop_area(force: &[f64], x: &[f64]) -> f64 {
    let n = x.len();
    (0..n)
        .map(|j| 0.5 * (force[j] + force[(j + 1) % n]) * (x[(j + 1) % n] - x[j]))
        .sum()
}

/// Force `kt x + y` under the constant limit `limit` (mu = 1).
fn constant_load_force(kt: f64, limit: f64, x: &[f64]) -> Vec<f64> {
    let mut slider = PeriodicSlider::new(x.len());
    slider.solve(kt, 1.0, x, &vec![limit; x.len()]);
    x.iter()
        .zip(slider.offset_n())
        .map(|(x, y)| kt * x + y)
        .collect()
}

/// Closed forms for `A > Fs/kt`: `k_eq`, `w c_eq`, `E`.
fn closed_form(kt: f64, limit: f64, amplitude: f64) -> (f64, f64, f64) {
    if amplitude <= limit / kt {
        return (kt, 0.0, 0.0);
    }
    let theta = (1.0 - 2.0 * limit / (kt * amplitude)).acos();
    (
        kt / PI * (theta - 0.5 * (2.0 * theta).sin()),
        kt / PI * theta.sin().powi(2),
        4.0 * limit * (amplitude - limit / kt),
    )
}

#[test]
fn constant_load_matches_the_table_and_its_closed_forms() {
    let (kt, limit) = (2.0, 3.0);
    // A, k_eq, w c_eq, E, cos3 / A, sin3 / A.
    let table = [
        [1.5, 2.0, 0.0, 0.0, 0.0, 0.0],
        [
            2.0,
            1.608_997_781,
            0.477_464_829,
            6.0,
            -0.137_832,
            0.079_577,
        ],
        [3.0, 1.0, FRAC_2_PI, 18.0, 0.0, 0.212_207],
        [
            5.0,
            0.504_631_575,
            0.534_760_609,
            42.0,
            0.130_698,
            0.121_212,
        ],
        [
            50.0,
            0.017_482_881,
            0.074_102_542,
            582.0,
            0.015_843,
            -0.018_950,
        ],
    ];
    for [amplitude, stiffness, damping, energy, cos3, sin3] in table {
        let x = cosine(amplitude, MANY);
        let force = constant_load_force(kt, limit, &x);
        let (a1, b1) = harmonic(&force, 1);
        let (a3, b3) = harmonic(&force, 3);
        assert!(
            (a1 / amplitude - stiffness).abs() < 1e-9,
            "k_eq at {amplitude}: {a1}"
        );
        assert!(
            (-b1 / amplitude - damping).abs() < 1e-9,
            "w c_eq at {amplitude}: {b1}"
        );
        assert!((loop_area(&force, &x) - energy).abs() < 1e-7 * (1.0 + energy));
        assert!(
            (a3 / amplitude - cos3).abs() < 6e-7,
            "cos3 at {amplitude}: {}",
            a3 / amplitude
        );
        assert!(
            (b3 / amplitude - sin3).abs() < 6e-7,
            "sin3 at {amplitude}: {}",
            b3 / amplitude
        );
        let (exact_stiffness, exact_damping, exact_energy) = closed_form(kt, limit, amplitude);
        assert!((a1 / amplitude - exact_stiffness).abs() < 2e-10 * kt);
        assert!((-b1 / amplitude - exact_damping).abs() < 2e-10 * kt);
        assert!((-PI * amplitude * b1 - exact_energy).abs() < 2e-9 * (1.0 + exact_energy));
        for even in [0, 2, 4] {
            let (a, b) = harmonic(&force, even);
            assert!(a.abs() < 1e-12 * amplitude && b.abs() < 1e-12 * amplitude);
        }
    }
}

#[test]
fn sampling_error_falls_with_the_square_of_the_number_of_samples() {
    let (kt, limit) = (2.0, 3.0);
    // Where a transition falls between two samples scatters the error: root mean square over
    // amplitudes.
    let error = |n_samples: usize| {
        let square = |amplitude: f64| {
            let (stiffness, damping, _) = closed_form(kt, limit, amplitude);
            let (a1, b1) = harmonic(
                &constant_load_force(kt, limit, &cosine(amplitude, n_samples)),
                1,
            );
            (a1 / amplitude - stiffness).powi(2) + (b1 / amplitude + damping).powi(2)
        };
        (0..50)
            .map(|i| square(2.0 + 0.1 * f64::from(i)))
            .sum::<f64>()
            .sqrt()
    };
    for n_samples in [64, 128, 256, 512] {
        let order = (error(n_samples) / error(4 * n_samples)).log(4.0);
        assert!(
            (1.8..2.2).contains(&order),
            "order {order} from {n_samples} samples"
        );
    }
}

#[test]
fn largest_loss_is_at_twice_the_slip_amplitude() {
    let (kt, limit) = (2.0, 3.0);
    let loss = |amplitude: f64| {
        -harmonic(
            &constant_load_force(kt, limit, &cosine(amplitude, 1 << 14)),
            1,
        )
        .1 / amplitude
    };
    assert!((loss(3.0) - kt / PI).abs() < 1e-7);
    assert!(loss(2.95) < loss(3.0) && loss(3.05) < loss(3.0));
}

#[test]
fn rigid_slider_has_the_square_wave_harmonic() {
    let (kt, limit) = (1e6, 3.0);
    let (a1, b1) = harmonic(&constant_load_force(kt, limit, &cosine(5.0, 1 << 16)), 1);
    assert!((a1.hypot(b1) - 4.0 * limit / PI).abs() < 1e-3 * limit);
}

#[test]
fn loop_is_exact_point_by_point() {
    // The virgin curve of this path starts at (0, 0); in the periodic state the first point is the
    // last one.
    let x = [0.0, 5.0, 3.5, 2.0, -5.0, -3.5, -2.0, 0.0];
    let force = constant_load_force(2.0, 3.0, &x);
    assert_eq!(force, [3.0, 3.0, 0.0, -3.0, -3.0, 0.0, 3.0, 3.0]);
}

/// Response of a pair with in-phase normal motion: `N = max(0, 6 + g x)`, kt = 2, mu = 0.5, A = 5.
fn variable_load(g: f64, x: &[f64]) -> (ContactHistory, Vec<f64>, PairState) {
    let parameters = PairParameters {
        normal_load_n: 6.0,
        normal_stiffness_n_per_m: g,
        tangential_stiffness_n_per_m: 2.0,
        friction_coefficient: 0.5,
    };
    let mut history = ContactHistory::new(x.len());
    let rest = vec![0.0; x.len()];
    let displacement = PairDisplacement {
        normal: x,
        tangential: [x, &rest],
    };
    let state = history.respond(ContactLaw::Simplified3d, &parameters, displacement);
    history.locate_clips();
    let force = x
        .iter()
        .zip(history.sliders()[0].offset_n())
        .map(|(x, y)| 2.0 * x + y)
        .collect();
    (history, force, state)
}

/// Rows `g, x1, x2` (`xs` where it separates)`, E, a0, a1, b1` for [`variable_load`].
#[rustfmt::skip]
const VARIABLE_LOAD: [[f64; 7]; 6] = [
    [0.0, 2.0, -2.0, 42.0, 0.0, 2.523_158, -2.673_803_044],
    [0.4, 1.363_636_364, -2.777_777_778, 41.010_101_010, 0.656_484, 2.551_649, -2.610_784_117],
    [1.0, 0.6, -4.333_333_333, 35.466_666_667, 1.573_613, 2.756_048, -2.257_878_126],
    [1.2, 0.384_615_385, -5.0, 32.307_692_308, 1.825_139, 2.932_004, -2.056_771_572],
    [2.0, -0.333_333_333, -3.0, 21.333_333_333, 2.642_631, 4.068_074, -1.358_122_181],
    [3.0, -1.0, -2.0, 10.5, 3.716_104, 5.481_612, -0.668_450_761],
];

/// Closed form of the dissipated energy for [`variable_load`].
fn variable_load_energy(g: f64) -> f64 {
    let (kt, limit, k, amplitude) = (2.0, 3.0, 0.5 * g, 5.0);
    let closing = 2.0 * (limit + k * amplitude).powi(2) / (kt + k);
    if 6.0 >= g * amplitude {
        4.0 * limit * amplitude - closing - 2.0 * (limit - k * amplitude).powi(2) / (kt - k)
    } else {
        k * (amplitude + 6.0 / g).powi(2) - closing
    }
}

#[test]
fn variable_load_matches_the_table_with_separation() {
    let x = cosine(5.0, MANY);
    let step = TAU * 5.0 / MANY as f64;
    for [g, x1, x2, energy, a0, a1, b1] in VARIABLE_LOAD {
        let (history, force, state) = variable_load(g, &x);
        let separates = g > 1.3;
        assert!(state.slipping);
        if (g - 1.2).abs() > 0.1 {
            assert_eq!(state.separated, separates);
        }
        let slider = &history.sliders()[0];
        let mut clips = slider.clip_samples().iter().zip(slider.clip_signs());
        let first_negative = clips
            .clone()
            .find(|(r, sign)| **r > 0 && **sign < 0.0)
            .unwrap()
            .0;
        assert!(
            (x[*first_negative] - x1).abs() < 2.0 * step,
            "x1 at g = {g}: {}",
            x[*first_negative]
        );
        if separates {
            let first_open = history
                .normal_load_n()
                .iter()
                .position(|&load| load <= 0.0)
                .unwrap();
            assert!(
                (x[first_open] - x2).abs() < 2.0 * step,
                "xs at g = {g}: {}",
                x[first_open]
            );
            // On re-contact it slips at once.
            let last_open = history
                .normal_load_n()
                .iter()
                .rposition(|&load| load <= 0.0)
                .unwrap();
            assert!(clips.any(|(r, sign)| *r == last_open + 1 && *sign > 0.0));
        } else {
            let first_positive = clips
                .find(|(r, sign)| **r > MANY / 2 && **sign > 0.0)
                .unwrap()
                .0;
            assert!(
                (x[*first_positive] - x2).abs() < 2.0 * step,
                "x2 at g = {g}: {}",
                x[*first_positive]
            );
        }
        assert!(
            (loop_area(&force, &x) - energy).abs() < 2e-8 * energy,
            "E at g = {g}"
        );
        assert!(
            (harmonic(&force, 0).0 - a0).abs() < 6e-7,
            "a0 at g = {g}: {}",
            harmonic(&force, 0).0
        );
        // The displacement has no mean, so the mean force is that of the slider.
        assert!((history.mean_friction_n()[0] - a0).abs() < 6e-7);
        assert!(
            (harmonic(&force, 1).0 - a1).abs() < 6e-7,
            "a1 at g = {g}: {}",
            harmonic(&force, 1).0
        );
        assert!(
            (harmonic(&force, 1).1 - b1).abs() < 1e-9,
            "b1 at g = {g}: {}",
            harmonic(&force, 1).1
        );
        let direct = variable_load_energy(g);
        assert!((-5.0 * PI * harmonic(&force, 1).1 - direct).abs() < 1e-8 * direct);
    }
}

#[test]
fn slip_starts_at_the_same_amplitude_whatever_the_normal_motion() {
    for g in [0.0, 0.4, 1.0] {
        for (amplitude, slips) in [(1.499, false), (1.501, true)] {
            let (_, _, state) = variable_load(g, &cosine(amplitude, 4096));
            assert_eq!(state.slipping, slips, "g = {g}, amplitude {amplitude}");
        }
    }
}
