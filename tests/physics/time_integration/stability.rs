//! Floquet multipliers against closed forms and against what the march does.

use std::f64::consts::TAU;

use blisk::linalg::{Complex64, Matrix};
use blisk::model::cyclic::ContactGeometry;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{ContactInterface, Damping, Status, Structure};
use blisk::response::mistuning::{ModalRows, StructuralModes};
use blisk::verification::time_integration::{
    MarchedWheel, PeriodicMotion, TimeOptions, WheelState, periodic_motion, settle,
};

const STEPS: usize = 512;

/// A unit mass on a unit spring that one pair sees along its normal (0) or its first tangent (1).
struct OneDof {
    structure: Structure,
    interface: ContactInterface,
    force: [Complex64; 1],
    omega: f64,
    damping: f64,
}

impl OneDof {
    fn new(direction: usize, pair: PairParameters, damping: f64, force: f64, omega: f64) -> Self {
        let rows = |rows: Matrix<f64>| ModalRows {
            real: rows,
            imaginary: None,
        };
        let modes = StructuralModes {
            eigenvalues: vec![1.0],
            tuned_eigenvalues: vec![1.0],
            added_damping_per_s: vec![0.0],
            rotation: None,
            contact: rows(Matrix::identity(1)),
            observed: rows(Matrix::from_fn(3, 1, |i, _| f64::from(u8::from(i == 0)))),
            sectors: 1,
        };
        let mut directions = [None; 3];
        directions[direction] = Some(0);
        Self {
            structure: Structure::new(
                modes,
                Damping::Rayleigh {
                    mass_per_s: damping,
                    stiffness_s: 0.0,
                },
            ),
            interface: ContactInterface {
                law: ContactLaw::Simplified3d,
                geometry: ContactGeometry {
                    weights: vec![1.0],
                    load_weights: vec![1.0],
                    rows: vec![directions],
                    ring_motion: vec![[[0.0; 2]; 2]],
                    ring_free: [false; 2],
                },
                pairs: vec![pair],
            },
            force: [Complex64::from(force)],
            omega,
            damping,
        }
    }

    fn wheel(&self) -> MarchedWheel<'_> {
        MarchedWheel {
            structure: &self.structure,
            interface: &self.interface,
            force: &self.force,
            omega: self.omega,
        }
    }

    /// At rest but for a position and a velocity.
    fn state(&self, position: f64, velocity: f64) -> WheelState {
        let mut state = WheelState::at_rest(&self.wheel());
        state.position[0] = position;
        state.velocity[0] = velocity;
        state
    }

    fn motion(&self, start: &WheelState) -> PeriodicMotion {
        periodic_motion(&self.wheel(), start, STEPS)
    }

    /// Every force but damping has a potential where nothing slips, so the flow shrinks areas by
    /// `e^{-c T}`: the product of the multipliers of position and velocity.
    fn shrinks(&self) -> f64 {
        (-self.damping * TAU / self.omega).exp()
    }
}

fn pair(kn: f64, kt: f64, normal_load_n: f64) -> PairParameters {
    PairParameters {
        normal_load_n,
        normal_stiffness_n_per_m: kn,
        tangential_stiffness_n_per_m: kt,
        friction_coefficient: 1.0,
    }
}

/// Product of the multipliers that are neither of a friction force that is reset (0) nor of one that
/// stays (1).
fn product(motion: &PeriodicMotion) -> f64 {
    let sizes = motion
        .multipliers
        .iter()
        .map(|multiplier| multiplier.norm());
    sizes.filter(|size| *size > 1e-6).product()
}

#[test]
fn a_pair_that_sticks_has_the_multipliers_of_the_spring_that_it_is() {
    // x'' + c x' + (1 + kt) x = F cos(w t): s = -c/2 +- i sqrt(1 + kt - c^2/4).
    let (kt, c, w) = (3.0_f64, 0.2_f64, 1.3);
    let one = OneDof::new(1, pair(0.0, kt, 1e3), c, 1.0, w);
    let motion = one.motion(&one.state(0.3, 0.0));
    assert_eq!(motion.status, Status::Ok);
    assert_eq!(motion.is_stable(), Some(true));
    let period = TAU / w;
    let turn = (1.0 + kt - 0.25 * c * c).sqrt() * period;
    let expected = Complex64::from_polar((-0.5 * c * period).exp(), turn);
    for expected in [expected, expected.conj()] {
        let nearest = motion.multipliers.iter().map(|m| (m - expected).norm());
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-4, "{motion:?}");
    }
    // The other two are the friction forces, which keep any offset.
    let offsets = motion
        .multipliers
        .iter()
        .filter(|m| (*m - 1.0).norm() < 1e-6);
    assert_eq!(offsets.count(), 2);
}

#[test]
fn friction_that_slips_forgets_its_offset_and_damps() {
    let one = OneDof::new(1, pair(0.0, 3.0, 0.2), 1e-3, 1.0, 0.9);
    let motion = one.motion(&one.state(2.0, 0.0));
    assert_eq!(motion.status, Status::Ok);
    assert!(motion.shares.slipping > 0.0);
    assert_eq!(motion.is_stable(), Some(true));
    assert!(motion.largest_multiplier().unwrap() < 1.0 + 1e-6 && product(&motion) < one.shrinks());
}

/// A contact that opens softens: below the resonance of the closed contact the mass has three
/// periodic motions, and the one in between is unstable. The march agrees with every multiplier.
#[test]
fn of_three_motions_over_a_fold_the_middle_one_is_unstable_and_the_march_leaves_it() {
    let one = OneDof::new(0, pair(1.0, 0.0, 1.0), 0.05, 0.12, 1.36);
    let mut motions: Vec<PeriodicMotion> = Vec::new();
    for place in -12..=12 {
        for speed in [-1.2, -0.4, 0.4, 1.2] {
            let motion = one.motion(&one.state(0.2 * f64::from(place), speed));
            let same = |other: &PeriodicMotion| {
                (other.fundamental_m[0] / motion.fundamental_m[0] - 1.0).abs() < 1e-4
            };
            if motion.status == Status::Ok && !motions.iter().any(same) {
                motions.push(motion);
            }
        }
    }
    motions.sort_by(|a, b| a.fundamental_m[0].total_cmp(&b.fundamental_m[0]));
    let stable: Vec<bool> = motions.iter().map(|m| m.is_stable().unwrap()).collect();
    let heights: Vec<f64> = motions
        .iter()
        .map(|motion| motion.fundamental_m[0])
        .collect();
    println!("{heights:?} {stable:?}");
    assert_eq!(stable, [true, false, true]);
    // Nothing separates on the lowest: F / (2 - w^2 + i c w).
    let (c, w) = (one.damping, one.omega);
    let closed = 0.12 / Complex64::new(2.0 - w * w, c * w).norm();
    assert!((heights[0] / closed - 1.0).abs() < 1e-4);
    assert!(motions[0].shares.separated < 0.5 && motions[1].shares.separated > 0.5);
    let options = TimeOptions {
        steps_per_period: STEPS,
        ..TimeOptions::default()
    };
    for motion in &motions {
        assert!(
            (product(motion) / one.shrinks() - 1.0).abs() < 1e-3,
            "{motion:?}"
        );
        let mut aside = motion.state.clone();
        aside.position[0] *= 1.0 + 1e-3;
        let settled = settle(&one.wheel(), &aside, &options);
        assert_eq!(settled.status, Status::Ok);
        let returned = (settled.fundamental_m[0] / motion.fundamental_m[0] - 1.0).abs() < 1e-3;
        assert_eq!(Some(returned), motion.is_stable());
    }
}
