//! Continuation in frequency: folds known in closed form, complete curves, contact that is stiff.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use blisk::linalg::{Complex64, Matrix, SymmetricSparse};
use blisk::model::cyclic::ContactGeometry;
use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{
    Body, Component, ContactPair, ContactSide, Dof, ObservedNode, SectorModel, lumped,
};
use blisk::response::forced_response::{PointSettings, PointSolver, ResponseTrace, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{
    ContactInterface, Continuation, ContinuationBounds, Damping, HarmonicBlock, HarmonicSystem,
    HarmonicTransform, NewtonBounds, PathPoint, Status, Structure,
};
use blisk::response::mistuning::{ModalRows, StructuralModes};

use super::sector_sources::lumped::lumped24;
use super::wheels::{ENGINE_ORDER, Wheel, full};

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
            added_damping_per_s: vec![0.0],
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
                    load_weights: vec![1.0],
                    rows: vec![[Some(0), None, None]],
                    ring_motion: vec![[[0.0; 2]; 2]],
                    ring_free: [false; 2],
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
        // At the top, the sampled contact force may leave less than nothing.
        (rest >= -1e-5 * damping * damping)
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
    // Contact opens at samples, not between them, which gives the curve a ripple as the phase turns from
    // sample to sample. Its slope goes as the inverse of their number; near a fold, where the curve's own
    // slope vanishes, a coarse ripple makes folds of its own.
    let system = oscillator::system(65_536, oscillator::PRELOAD_N);
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
            // At the top a millionth of the amplitude is a thousandth of a half-bandwidth.
            assert!(off[0].min(off[1]) < 1e-5, "{} {omega:?}", point.omega);
        }
    }
}

/// The same oscillator as the blades of a wheel: blade and a ring node that hardly moves, radial.
fn oscillator_wheel() -> Wheel {
    let diagonal = |blade: f64, ring: f64| {
        SymmetricSparse::from_lower_triplets(2, &[(0, 0, blade), (1, 1, ring)])
    };
    let dof = |node, body| Dof {
        node,
        component: Component::Radial,
        position_m: [1.0, 0.0, 0.0],
        body,
    };
    let sector = SectorModel {
        name: "opening contact".to_owned(),
        sectors: 3,
        stiffness: diagonal(oscillator::STIFFNESS, 1e12),
        mass: diagonal(1.0, 1.0),
        blade_stiffness: diagonal(oscillator::STIFFNESS, 0.0),
        dofs: vec![dof(0, Body::Blisk), dof(1, Body::Ring)],
        cyclic_pairs: Vec::new(),
        contact_pairs: vec![ContactPair {
            first: ContactSide::Node(0),
            second: ContactSide::Node(1),
            normal: [1.0, 0.0, 0.0],
            weight: 1.0,
            load_weight: None,
        }],
        force: vec![(0, Complex64::new(oscillator::FORCE_N, 0.0))],
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "blade".to_owned(),
            node: 0,
        }],
    };
    Wheel::of(
        &sector,
        ContactLaw::Simplified3d,
        PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: oscillator::CONTACT_STIFFNESS,
            tangential_stiffness_n_per_m: 1.0,
            friction_coefficient: 0.3,
        },
        Damping::StructuralLossFactor(oscillator::LOSS_FACTOR),
        BasisChoice::CraigBampton,
    )
}

fn point_settings(wheel: &Wheel, harmonics: &[u32], options: &SolverOptions) -> PointSettings {
    let contact = Some((wheel.law, wheel.sector));
    PointSettings::new(options, harmonics, contact, wheel.model.contact.clone()).unwrap()
}

fn traces(
    wheel: &Wheel,
    harmonics: &[u32],
    options: &SolverOptions,
    load: f64,
    grid: &[f64],
) -> [ResponseTrace; 2] {
    let excited = wheel.tuned(harmonics);
    let settings = point_settings(wheel, harmonics, options);
    let (first, last) = (grid[0], grid[grid.len() - 1]);
    [(first, last), (last, first)].map(|(start, stop)| {
        PointSolver::new(&excited, full(load), &settings).trace(start, stop, grid)
    })
}

fn hertz(omega: f64) -> f64 {
    omega / TAU
}

#[test]
fn both_directions_pass_every_branch_and_sweeps_differ_between_the_folds() {
    let wheel = oscillator_wheel();
    let options = SolverOptions {
        samples_per_period: 4096,
        ..SolverOptions::default()
    };
    let expected = oscillator::folds(0, oscillator::PRELOAD_N);
    let (low, high) = (hertz(expected[1].0), hertz(expected[0].0));
    let grid: Vec<f64> = (0..=60).map(|i| 160.0 + f64::from(i)).collect();
    let [up, down] = traces(&wheel, &[1], &options, oscillator::PRELOAD_N, &grid);
    let mut several = 0;
    for trace in [&up, &down] {
        assert_eq!(trace.status, Status::Ok);
        let intervals = trace.multivalued_hz();
        assert_eq!(intervals.len(), 1);
        assert!((intervals[0].0 / low - 1.0).abs() < 2e-6, "{intervals:?}");
        assert!((intervals[0].1 / high - 1.0).abs() < 2e-6, "{intervals:?}");
    }
    for &hz in &grid {
        let (above, below) = (up.at(hz), down.at(hz));
        let count = if hz > low && hz < high { 3 } else { 1 };
        assert_eq!((above.len(), below.len()), (count, count), "{hz} Hz");
        for (a, b) in above.iter().zip(below.iter().rev()) {
            let (a, b) = (a.point.amplitudes_m[0], b.point.amplitudes_m[0]);
            assert!((a / b - 1.0).abs() < 1e-6, "{hz} Hz: {a:e} {b:e}");
            let omega = oscillator::frequencies(a, oscillator::PRELOAD_N).unwrap();
            let off = omega.map(|omega| (hertz(omega) / hz - 1.0).abs());
            assert!(off[0].min(off[1]) < 2e-6, "{hz} Hz: {a:e}");
        }
        if count == 3 {
            several += 1;
            // What a sweep follows before it jumps: branch 0 of either direction.
            let first = |trace: &ResponseTrace| trace.at(hz)[0].point.amplitudes_m[0];
            assert!(first(&down) > 1.5 * first(&up), "{hz} Hz");
        }
    }
    assert!(several >= 5, "{several}");
}

/// The top of the folded curve is where reactance vanishes: `F / (eta k)` whatever the preload.
#[test]
fn the_peak_of_a_folded_curve_is_its_top_or_has_a_status() {
    let wheel = oscillator_wheel();
    let options = SolverOptions {
        samples_per_period: 1024,
        ..SolverOptions::default()
    };
    let tolerance = options.peak_tolerance;
    let solver = wheel.solver(&[1], options);
    let (mut folded, mut failed) = (0, 0);
    for load in (2..=60).map(f64::from) {
        let peak = solver.tuned_peak(ENGINE_ORDER, full(load));
        let ratio = peak
            .amplitude_m()
            .map(|found| found / oscillator::highest());
        println!(
            "{load} N: {} {ratio:?}, bracketed {}, {:?}",
            peak.status.name(),
            peak.bracketed,
            peak.work
        );
        folded += usize::from(peak.work.folds > 0);
        match ratio {
            Some(ratio) => assert!((ratio - 1.0).abs() < tolerance, "{load} N: {ratio}"),
            None => failed += 1,
        }
    }
    // Wanted is a top of every row. Where the search ends beside a cliff without lower samples on both sides the row has
    // a status: 7 of those that pass folds, and 2 of the lightest loads, at which Newton's method fails.
    assert!(
        folded >= 33 && failed <= 9,
        "{folded} folded, {failed} failed"
    );
}

#[test]
fn friction_alone_gives_one_complete_curve_in_both_directions() {
    let grid: Vec<f64> = (0..=30).map(|i| 340.0 + f64::from(i)).collect();
    let wheel = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    let [up, down] = traces(&wheel, &[1, 3], &SolverOptions::default(), 50.0, &grid);
    let highest = up.largest().unwrap().0.point.largest_amplitude_m();
    for trace in [&up, &down] {
        assert_eq!(trace.status, Status::Ok);
        assert_eq!(trace.folds().count(), 0);
    }
    for &hz in &grid {
        let (up, down) = (up.at(hz), down.at(hz));
        assert_eq!((up.len(), down.len()), (1, 1));
        let off = up[0].point.amplitudes_m[0] - down[0].point.amplitudes_m[0];
        assert!(off.abs() < 1e-6 * highest, "{hz} Hz: {off:e}");
    }
}

#[test]
fn contact_a_million_times_stiffer_than_the_disk_converges_from_nothing() {
    let wheel = Wheel::lumped24();
    let sector = PairParameters {
        tangential_stiffness_n_per_m: 1e6 * wheel.sector.tangential_stiffness_n_per_m,
        ..wheel.sector
    };
    let wheel = Wheel {
        amplitude_n: 10.0,
        ..Wheel::of(
            &lumped::build(&lumped24()).unwrap(),
            wheel.law,
            sector,
            wheel.damping,
            BasisChoice::CraigBampton,
        )
    };
    let excited = wheel.tuned(&[1, 3]);
    let settings = point_settings(&wheel, &[1, 3], &SolverOptions::default());
    let mut retries = 0;
    for i in 0..=50 {
        let mut solver = PointSolver::new(&excited, full(50.0), &settings);
        let frequency = 330.0 + f64::from(i);
        let status = solver.solve(frequency).err();
        assert_eq!(status, None, "{frequency} Hz");
        retries += solver.work().retries;
    }
    println!("{retries} of 51 points needed more than Newton's method");
    assert!(
        retries > 0,
        "Newton's method alone does it: no test of the ladder"
    );
}
