//! Continuation in frequency: its derivative, and folds known in closed form.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix};
use blisk::model::cyclic::ContactGeometry;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{
    ContactInterface, Continuation, ContinuationBounds, Damping, HarmonicBlock, HarmonicSystem,
    HarmonicTransform, NewtonBounds, PathPoint, Status, Structure,
};
use blisk::response::mistuning::{ModalRows, StructuralModes};

use super::contact::random::Random;

mod oscillator {
    //! One mass on a spring, held by a preloaded contact that can open: it softens, and its
    //! response to one harmonic is known in closed form.
    use super::*;

    pub const STIFFNESS: f64 = 1e6;
    pub const CONTACT_STIFFNESS: f64 = 4e5;
    pub const LOSS_FACTOR: f64 = 0.01;
    pub const FORCE_N: f64 = 1.0;
    pub const PRELOAD_N: f64 = 12.0;

    /// Unit mass; harmonic 1 alone.
    pub fn system(samples: usize, preload_n: f64) -> HarmonicSystem {
        let rows = |value: f64, count: usize| ModalRows {
            real: Matrix::from_fn(count, 1, |_, _| value),
            imaginary: None,
        };
        let modes = StructuralModes {
            eigenvalues: vec![STIFFNESS],
            tuned_eigenvalues: vec![STIFFNESS],
            rotation: None,
            contact: rows(1.0, 1),
            observed: rows(1.0, 3),
            sectors: 1,
        };
        let structure = Arc::new(Structure::new(
            modes,
            Damping::StructuralLossFactor(LOSS_FACTOR),
        ));
        let stuck = Arc::new(structure.contact_stiffness(&[CONTACT_STIFFNESS]));
        HarmonicSystem::new(
            vec![HarmonicBlock {
                harmonic: 1,
                structure,
                stuck,
            }],
            vec![Complex64::new(FORCE_N, 0.0)],
            ContactInterface {
                law: ContactLaw::Simplified3d,
                geometry: ContactGeometry {
                    weights: vec![1.0],
                    rows: vec![[Some(0), None, None]],
                },
                pairs: vec![PairParameters {
                    normal_load_n: preload_n,
                    normal_stiffness_n_per_m: CONTACT_STIFFNESS,
                    tangential_stiffness_n_per_m: 1.0,
                    friction_coefficient: 0.3,
                }],
            },
            Arc::new(HarmonicTransform::new(&[1], samples).unwrap()),
        )
    }

    /// Stiffness that the fundamental of `max(-N0, kn A cos)` has at the amplitude A.
    fn contact_stiffness(amplitude: f64, preload_n: f64) -> f64 {
        let a = (preload_n / (CONTACT_STIFFNESS * amplitude)).min(1.0);
        CONTACT_STIFFNESS * (0.5 + (a.asin() + a * (1.0 - a * a).sqrt()) / PI)
    }

    /// The two angular frequencies at which the amplitude is A:
    /// `((k + k_c(A) - omega^2)^2 + (eta k)^2) A^2 = F^2`, the lower one first.
    pub fn frequencies(amplitude: f64, preload_n: f64) -> Option<[f64; 2]> {
        let damping = LOSS_FACTOR * STIFFNESS;
        let rest = (FORCE_N / amplitude).powi(2) - damping * damping;
        let middle = STIFFNESS + contact_stiffness(amplitude, preload_n);
        // At the top, rounding may leave less than nothing.
        (rest >= -1e-6 * damping * damping)
            .then(|| [-1.0, 1.0].map(|side| (middle + side * rest.max(0.0).sqrt()).sqrt()))
    }

    pub fn highest() -> f64 {
        FORCE_N / (LOSS_FACTOR * STIFFNESS)
    }

    /// Extremes of the frequency along one side of the curve, as `(omega, amplitude)`.
    pub fn folds(side: usize, preload_n: f64) -> Vec<(f64, f64)> {
        let omega = |amplitude: f64| frequencies(amplitude, preload_n).unwrap()[side];
        let (low, high) = (0.05 * highest(), highest() * (1.0 - 1e-9));
        let count = 20_000;
        let grid: Vec<f64> = (0..=count)
            .map(|i| low + (high - low) * f64::from(i) / f64::from(count))
            .collect();
        grid.windows(3)
            .filter(|w| {
                let (a, b, c) = (omega(w[0]), omega(w[1]), omega(w[2]));
                (b - a) * (c - b) < 0.0
            })
            .map(|w| {
                let sign = if omega(w[1]) > omega(w[0]) { 1.0 } else { -1.0 };
                let (mut a, mut b) = (w[0], w[2]);
                for _ in 0..200 {
                    let (left, right) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                    if sign * omega(left) < sign * omega(right) {
                        a = left;
                    } else {
                        b = right;
                    }
                }
                (omega(a), a)
            })
            .collect()
    }
}

fn amplitude(point: &PathPoint) -> f64 {
    point.solution[0].hypot(point.solution[1])
}

/// The linear stuck solution, exact far from resonance.
fn stuck(omega: f64) -> Vec<f64> {
    use oscillator::{CONTACT_STIFFNESS, FORCE_N, LOSS_FACTOR, STIFFNESS};
    let z = Complex64::new(
        STIFFNESS + CONTACT_STIFFNESS - omega * omega,
        LOSS_FACTOR * STIFFNESS,
    );
    let x = Complex64::new(FORCE_N, 0.0) / z;
    vec![x.re, x.im]
}

fn bounds() -> ContinuationBounds {
    ContinuationBounds::new(NewtonBounds::with_tolerance(1e-10), 5.0)
}

/// Points and folds from one frequency to beyond the other.
fn walk(
    system: &HarmonicSystem,
    from: f64,
    to: f64,
) -> (Vec<PathPoint>, Vec<(f64, f64, bool)>, u64) {
    let rising = to > from;
    let mut walk = Continuation::new(system, from, &stuck(from), rising, bounds()).unwrap();
    let mut points = vec![walk.point()];
    let mut folds = Vec::new();
    while (points[points.len() - 1].omega < to) == rising {
        if let Some(fold) = walk.advance().unwrap() {
            folds.push((fold.point.omega, amplitude(&fold.point), fold.largest));
        }
        points.push(walk.point());
    }
    (points, folds, walk.work().factorisations)
}

#[test]
fn both_folds_of_an_opening_contact_are_found_where_the_closed_form_has_them() {
    let system = oscillator::system(4096, oscillator::PRELOAD_N);
    let expected = oscillator::folds(0, oscillator::PRELOAD_N);
    assert_eq!(expected.len(), 2, "{expected:?}");
    for (from, to) in [(900.0, 1300.0), (1300.0, 900.0)] {
        let (points, mut folds, factorisations) = walk(&system, from, to);
        println!(
            "{} points, {factorisations} factorisations, folds {folds:?}, expected {expected:?}",
            points.len()
        );
        assert!(points.len() < 400);
        folds.sort_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(folds.len(), 2);
        for ((omega, amplitude), fold) in expected.iter().zip(&folds) {
            assert!((fold.0 / omega - 1.0).abs() < 1e-6, "{fold:?} for {omega}");
            assert!((fold.1 / amplitude - 1.0).abs() < 1e-3);
        }
        // The lower branch ends at the higher frequency: the curve leans to the left.
        assert!(folds[0].2 && !folds[1].2 && folds[0].0 > folds[1].0);
        for point in &points {
            let omega = oscillator::frequencies(amplitude(point), oscillator::PRELOAD_N).unwrap();
            let off = omega.map(|omega| (omega / point.omega - 1.0).abs());
            assert!(off[0].min(off[1]) < 1e-6, "{} {omega:?}", point.omega);
        }
    }
}
