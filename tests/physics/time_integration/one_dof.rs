//! One mass on a spring with one contact pair: closed forms for the integrator.

use std::f64::consts::{PI, TAU};

use blisk::linalg::{Complex64, Matrix};
use blisk::model::cyclic::ContactGeometry;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{ContactInterface, Damping, Status, Structure};
use blisk::response::mistuning::{ModalRows, StructuralModes};
use blisk::verification::time_integration::{
    MarchedWheel, Settled, TimeOptions, TimeStepper, WheelState, settle,
};

/// A unit mass whose tangential motion along t1 the pair sees.
struct OneDof {
    structure: Structure,
    interface: ContactInterface,
    force: [Complex64; 1],
    omega: f64,
}

impl OneDof {
    fn new(stiffness: f64, damping: f64, slider: (f64, f64), force: f64, omega: f64) -> Self {
        let rows = |rows: Matrix<f64>| ModalRows {
            real: rows,
            imaginary: None,
        };
        let modes = StructuralModes {
            eigenvalues: vec![stiffness],
            tuned_eigenvalues: vec![stiffness],
            added_damping_per_s: vec![0.0],
            rotation: None,
            contact: rows(Matrix::identity(1)),
            observed: rows(Matrix::from_fn(3, 1, |i, _| f64::from(u8::from(i == 0)))),
            sectors: 1,
        };
        let (kt, limit) = slider;
        Self {
            structure: Structure::new(
                modes,
                Damping::Rayleigh {
                    mass_per_s: damping,
                    stiffness_s: 0.0,
                },
            ),
            interface: ContactInterface {
                law: ContactLaw::MacroSlip1d,
                geometry: ContactGeometry {
                    weights: vec![1.0],
                    load_weights: vec![1.0],
                    rows: vec![[None, Some(0), None]],
                    ring_motion: vec![[[0.0; 2]; 2]],
                    ring_free: [false; 2],
                },
                pairs: vec![PairParameters {
                    normal_load_n: limit,
                    normal_stiffness_n_per_m: 0.0,
                    tangential_stiffness_n_per_m: kt,
                    friction_coefficient: 1.0,
                }],
            },
            force: [Complex64::from(force)],
            omega,
        }
    }

    fn marched(&self) -> MarchedWheel<'_> {
        MarchedWheel {
            structure: &self.structure,
            interface: &self.interface,
            force: &self.force,
            omega: self.omega,
        }
    }

    fn settle_from_rest(&self, options: &TimeOptions) -> Settled {
        let wheel = self.marched();
        settle(&wheel, &WheelState::at_rest(&wheel), options)
    }

    /// Position after `periods` periods from rest.
    fn position_after(&self, periods: usize, steps_per_period: usize) -> f64 {
        let wheel = self.marched();
        let state = WheelState::at_rest(&wheel);
        let mut stepper = TimeStepper::new(&wheel, &state, steps_per_period).unwrap();
        for _ in 0..periods * steps_per_period {
            stepper.advance().unwrap();
        }
        stepper.position()[0]
    }
}

#[test]
fn without_contact_every_step_is_exact_whatever_its_size() {
    // From rest: x = Re(X (e^{i w t} - homogeneous)), with k = 4, c = 0.3, F = 2, w = 1.7.
    let (k, c, f, w) = (4.0, 0.3, 2.0, 1.7);
    let one = OneDof::new(k, c, (0.0, 0.0), f, w);
    let x = f / Complex64::new(k - w * w, w * c);
    let damped = (k - 0.25 * c * c).sqrt();
    let (a, b) = (-x.re, (w * x.im - 0.5 * c * x.re) / damped);
    for (periods, steps) in [(1, 8), (3, 8), (3, 20)] {
        let t = periods as f64 * TAU / w;
        let homogeneous = (-0.5 * c * t).exp() * (a * (damped * t).cos() + b * (damped * t).sin());
        let found = one.position_after(periods, steps);
        assert!((found - x.re - homogeneous).abs() < 1e-13, "{found}");
    }
}

#[test]
fn undamped_at_resonance_the_motion_grows_as_it_must() {
    // x = F t sin(w t) / (2 w): at whole periods x = 0, a quarter later F t / (2 w).
    let one = OneDof::new(1.0, 0.0, (0.0, 0.0), 1.0, 1.0);
    let wheel = one.marched();
    let mut stepper = TimeStepper::new(&wheel, &WheelState::at_rest(&wheel), 16).unwrap();
    for _ in 0..5 * 16 + 4 {
        stepper.advance().unwrap();
    }
    let expected = 0.5 * TAU * 5.25;
    assert!((stepper.position()[0] / expected - 1.0).abs() < 1e-12);
}

#[test]
fn a_stuck_slider_is_a_spring_solved_to_second_order() {
    // Stuck: the linear oscillator with k + kt.
    let (k, kt, c, w) = (4.0, 3.0, 0.2, 2.1);
    let one = OneDof::new(k, c, (kt, 1e9), 1.0, w);
    let exact = (1.0 / Complex64::new(k + kt - w * w, w * c)).norm();
    let errors = [64, 128, 256].map(|steps_per_period| {
        let settled = one.settle_from_rest(&TimeOptions {
            steps_per_period,
            periodicity_tolerance: 1e-11,
            drift_tolerance: 1e-11,
            ..TimeOptions::default()
        });
        assert_eq!(settled.status, Status::Ok);
        (settled.fundamental_m[0] / exact - 1.0).abs()
    });
    println!("stuck: {errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.1, "{errors:?}");
    }
}

#[test]
fn a_slipping_slider_converges_with_the_square_of_the_step() {
    let one = OneDof::new(4.0, 0.1, (3.0, 0.4), 1.0, 2.0);
    let found = [256, 512, 1024, 2048, 16384].map(|steps_per_period| {
        let settled = one.settle_from_rest(&TimeOptions {
            steps_per_period,
            minimum_periods: 300,
            ..TimeOptions::default()
        });
        assert_eq!(settled.status, Status::Ok);
        settled.fundamental_m[0]
    });
    let errors: Vec<f64> = found[..4]
        .iter()
        .map(|x| (x / found[4] - 1.0).abs())
        .collect();
    println!("slipping: {errors:?}");
    assert!(errors[3] < 2e-6);
    // Whether a kink falls on an instant or between two makes single ratios uneven.
    assert!(errors[0] / errors[3] > 30.0, "{errors:?}");
}

#[test]
fn den_hartog_without_stops() {
    // b = w/wn, r = Ff/F0: x_max k/F0 = sqrt(V^2 - r^2 G^2).
    for (b, r, tabulated) in [
        (0.7, 0.3, 1.885_699_85),
        (1.3, 0.3, 1.315_348_20),
        (1.6, 0.2, 0.613_120_34),
    ] {
        let v: f64 = 1.0 / (1.0 - b * b);
        let g = (PI / b).sin() / (b * (1.0 + (PI / b).cos()));
        let exact = (v * v - r * r * g * g).sqrt();
        assert!((exact / tabulated - 1.0_f64).abs() < 1e-8);
        // A rigid slider is the limit of a stiff one. At a reversal the force takes a time of the
        // order 1/sqrt(kt) to change its sign: that error is extrapolated away.
        let [soft, stiff] = [1e3, 4e3].map(|kt| {
            let one = OneDof::new(1.0, 0.0, (kt, r), 1.0, b);
            let settled = one.settle_from_rest(&TimeOptions {
                steps_per_period: 8192,
                ..TimeOptions::default()
            });
            assert_eq!(settled.status, Status::Ok);
            settled.time_maximum_m[0]
        });
        let error = ((2.0 * stiff - soft) / exact - 1.0).abs();
        println!(
            "Den Hartog {b} {r}: {error:.1e}, {:.1e}",
            stiff / exact - 1.0
        );
        assert!(
            (stiff / exact - 1.0).abs() < 1e-2 && error < 2e-4,
            "{error:e}"
        );
    }
}

#[test]
fn a_force_above_four_pi_of_friction_grows_without_bound_at_resonance() {
    // Modal resonance with constant Coulomb friction: bounded if and only if F0 <= 4 Ff / pi.
    let grown = [0.95, 1.05].map(|share| {
        let limit = 1.0;
        let one = OneDof::new(1.0, 0.0, (200.0, limit), share * 4.0 * limit / PI, 1.0);
        one.settle_from_rest(&TimeOptions {
            steps_per_period: 2048,
            minimum_periods: 400,
            maximum_periods: 400,
            ..TimeOptions::default()
        })
    });
    println!(
        "{:?}",
        grown.each_ref().map(|s| (s.status, s.fundamental_m[0]))
    );
    assert_eq!(grown[0].status, Status::Ok);
    assert_eq!(grown[1].status, Status::WorkBudget);
    // Energy per period pi A (F0 - 4 Ff/pi) = d(A^2/2): A grows by pi (F0 - 4 Ff / pi) per period.
    let expected = 400.0 * PI * 0.05 * 4.0 / PI;
    assert!((grown[1].fundamental_m[0] / expected - 1.0).abs() < 0.05);
}
