//! One mass or two with one contact pair on a prescribed periodic motion: multipliers by hand.

use std::f64::consts::{PI, TAU};

use blisk::linalg::{Complex64, Matrix, eigenvalues, exponential};
use blisk::model::cyclic::ContactGeometry;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::ContactInterface;
use blisk::response::receptance::{FreeWave, FreeWheel};
use blisk::response::stability::{ContactMotion, Multipliers, StabilityOptions, multipliers};

/// Rows of the wheel's only pair, by the modes of its only wave; the pair sees them along n or t1.
struct Small {
    eigenvalues: Vec<f64>,
    damping: f64,
    along: usize,
    rows: Vec<f64>,
    pair: PairParameters,
    omega: f64,
}

fn pair(kn: f64, kt: f64, normal_load_n: f64) -> PairParameters {
    PairParameters {
        normal_load_n,
        normal_stiffness_n_per_m: kn,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: 1.0,
    }
}

impl Small {
    fn multipliers(&self, amplitude_m: f64, steps_per_period: usize) -> Multipliers {
        let modes = self.eigenvalues.len();
        let free = FreeWheel {
            sectors: 1,
            waves: vec![FreeWave {
                eigenvalues: self.eigenvalues.clone(),
                viscous: vec![self.damping; modes],
                contact: Matrix::from_fn(1, modes, |_, mode| Complex64::from(self.rows[mode])),
                strain: Matrix::zeros(0, modes),
            }],
            loss_factor: 0.0,
            deviations: Vec::new(),
        };
        let mut directions = [None; 3];
        directions[self.along] = Some(0);
        let interface = ContactInterface {
            law: ContactLaw::Simplified3d,
            geometry: ContactGeometry {
                weights: vec![1.0],
                load_weights: vec![1.0],
                rows: vec![directions],
                ring_motion: vec![[[0.0; 2]; 2]],
                ring_free: [false; 2],
            },
            pairs: vec![self.pair],
        };
        let motion = ContactMotion {
            harmonics: vec![(1, vec![Complex64::from(amplitude_m)])],
        };
        let options = StabilityOptions {
            steps_per_period,
            ..StabilityOptions::default()
        };
        multipliers(&free, &interface, &motion, self.omega, &options).unwrap()
    }
}

/// `x'' + c x' + k x = 0` over the time t: position and velocity from those before.
fn swing(k: f64, c: f64, t: f64) -> [[f64; 2]; 2] {
    let omega = (k - 0.25 * c * c).sqrt();
    let (sine, cosine) = (omega * t).sin_cos();
    let decay = (-0.5 * c * t).exp();
    let part = 0.5 * c / omega * sine;
    [
        [decay * (cosine + part), decay * sine / omega],
        [-decay * k * sine / omega, decay * (cosine - part)],
    ]
}

fn times(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

/// The larger modulus of the eigenvalues of a 2 x 2 matrix.
fn largest(a: [[f64; 2]; 2]) -> f64 {
    let (half, det) = (
        0.5 * (a[0][0] + a[1][1]),
        a[0][0] * a[1][1] - a[0][1] * a[1][0],
    );
    let root = Complex64::from(half * half - det).sqrt();
    (half + root).norm().max((half - root).norm())
}

/// The slider of `x = A cos(w t)` turns with the mass, sticks until the spring is turned over, `A (1 - cos w t1) = 2 R / kt`,
/// and slips to the next turn, with the disturbance of the slider that of the mass where slip ended.
#[test]
fn a_slider_that_sticks_and_slips_has_the_multipliers_of_both_in_turn() {
    for (c, limit) in [(0.02, 0.3), (0.2, 0.3), (0.02, 1.2), (0.02, 0.01)] {
        let (k, kt, amplitude, omega) = (1.0, 2.0, 1.0, 0.9);
        let small = Small {
            eigenvalues: vec![k],
            damping: c,
            along: 1,
            rows: vec![1.0],
            pair: pair(0.0, kt, limit),
            omega,
        };
        let sticks = (1.0_f64 - 2.0 * limit / (kt * amplitude)).acos() / omega;
        let stuck = swing(k + kt, c, sticks);
        // About the place k x + kt (x - w) = 0 of a disturbed slider w = x_0.
        let place = kt / (k + kt);
        let stuck = [
            [place + stuck[0][0] * (1.0 - place), stuck[0][1]],
            [stuck[1][0] * (1.0 - place), stuck[1][1]],
        ];
        let half = times(swing(k, c, PI / omega - sticks), stuck);
        let expected = largest(times(half, half));
        let found = small.multipliers(amplitude, 4096);
        println!("c {c}, limit {limit}: {expected:.6}, {found:?}");
        assert!((found.largest.norm() - expected).abs() < 2e-3 * expected);
        assert_eq!(found.stable, Some(expected < 1.0));
    }
}

/// A pair that opens for a part of every period: a spring that is switched on and off, which can drive the mass (Meissner).
#[test]
fn a_contact_that_opens_drives_a_mass_where_meissners_equation_is_unstable() {
    let (mut stable, mut unstable) = (0, 0);
    for place in 0..12 {
        let omega = 0.8 + 0.2 * f64::from(place);
        let (k, kn, c, load, amplitude) = (1.0, 1.5, 0.02, 0.5, 1.0);
        let small = Small {
            eigenvalues: vec![k],
            damping: c,
            along: 0,
            rows: vec![1.0],
            pair: pair(kn, 1.0, load),
            omega,
        };
        // Closed while load + kn A cos(w t) > 0.
        let closed = 2.0 * (-load / (kn * amplitude)).acos() / omega;
        let map = times(swing(k, c, TAU / omega - closed), swing(k + kn, c, closed));
        let expected = largest(map);
        let found = small.multipliers(amplitude, 4096);
        println!("omega {omega:.1}: {expected:.6}, {found:?}");
        assert!((found.largest.norm() - expected).abs() < 2e-3 * expected);
        if (expected - 1.0).abs() > 5e-3 {
            assert_eq!(found.stable, Some(expected < 1.0));
            *(if expected < 1.0 {
                &mut stable
            } else {
                &mut unstable
            }) += 1;
        }
    }
    assert!(stable > 2 && unstable > 1, "{stable} {unstable}");
}

/// A mass on a spring and a ring that nothing holds, between them a slider: the drift of the ring has the multiplier 1 and is
/// no part of the answer.
#[test]
fn the_drift_of_a_free_ring_is_taken_out() {
    let (k, kt, c, limit, amplitude, omega) = (1.0_f64, 2.0, 0.02, 0.3, 1.0, 0.9);
    let rows = [1.0, -0.7];
    let small = Small {
        eigenvalues: vec![k, 0.0],
        damping: c,
        along: 1,
        rows: rows.to_vec(),
        pair: pair(0.0, kt, limit),
        omega,
    };
    // (q_1, q_2, v_1, v_2, w): what sticks, and what slips with the slider where the pair is.
    let flow = |sticks: bool, t: f64| {
        let spring = if sticks { kt } else { 0.0 };
        let mut a = Matrix::<f64>::zeros(5, 5);
        for i in 0..2 {
            a[(i, 2 + i)] = t;
            a[(2 + i, 2 + i)] = -c * t;
            a[(2 + i, i)] -= small.eigenvalues[i] * t;
            for j in 0..2 {
                a[(2 + i, j)] -= spring * rows[i] * rows[j] * t;
            }
            a[(2 + i, 4)] += spring * rows[i] * t;
            if !sticks {
                a[(4, 2 + i)] = rows[i] * t;
            }
        }
        exponential(&a)
    };
    // Where slip begins the slider is let go of: from there on it is as far off as the pair.
    let mut follows = Matrix::<f64>::identity(5);
    follows[(4, 4)] = 0.0;
    (follows[(4, 0)], follows[(4, 1)]) = (rows[0], rows[1]);
    let sticks = (1.0_f64 - 2.0 * limit / (kt * amplitude)).acos() / omega;
    let slips = flow(false, PI / omega - sticks).times(&follows);
    let half = slips.times(&flow(true, sticks));
    let values = eigenvalues(&half.times(&half));
    assert!((values[0] - 1.0).norm() < 1e-12, "{values:?}");
    let found = small.multipliers(amplitude, 4096);
    println!("{values:?}, {found:?}");
    assert!((found.largest.norm() - values[1].norm()).abs() < 2e-3);
    assert!(values[1].norm() < 0.99);
    assert_eq!(found.stable, Some(true));
}

/// Where it never slips, the pair is a spring: the place of its slider is no part of the answer.
#[test]
fn a_slider_that_never_slips_is_a_spring() {
    let (k, kt, c, omega) = (1.0, 3.0, 0.05, 1.3);
    let small = Small {
        eigenvalues: vec![k],
        damping: c,
        along: 1,
        rows: vec![1.0],
        pair: pair(0.0, kt, 1e3),
        omega,
    };
    let expected = (-0.5 * c * TAU / omega).exp();
    let found = small.multipliers(1.0, 512);
    assert!(
        (found.largest.norm() - expected).abs() < 1e-4,
        "{expected} {found:?}"
    );
    assert_eq!(found.stable, Some(true));
}
