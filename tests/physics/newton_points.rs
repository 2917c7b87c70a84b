//! Points of a mistuned wheel by Newton's method with Jacobians that are kept: those that a Jacobian at every step leads to.

use std::f64::consts::TAU;
use std::sync::Arc;

use blisk::linalg::LuWorkspace;
use blisk::response::friction::PairParameters;
use blisk::response::harmonic_balance::{
    ContactInterface, HarmonicSystem, HarmonicTransform, NewtonBounds, NewtonWorkspace, Status,
    solve,
};

use super::contact::random::Random;
use super::wheels::Wheel;

/// A mistuned wheel under `normal_load_n` per sector.
fn system(wheel: &Wheel, harmonics: &[u32], normal_load_n: f64) -> HarmonicSystem {
    let excited = wheel.mistuned(&wheel.deviations(&mut Random(11), 0.02), harmonics);
    let sector = PairParameters {
        normal_load_n,
        ..wheel.sector
    };
    let weights = &wheel.model.contact.weights;
    let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
    HarmonicSystem::new(
        excited.blocks.clone(),
        excited.force.clone(),
        ContactInterface {
            law: wheel.law,
            geometry: wheel.model.contact.clone(),
            pairs: weights.iter().map(|&weight| sector.share(weight)).collect(),
        },
        Arc::new(HarmonicTransform::new(&set, 128).unwrap()),
    )
}

fn lumped() -> Wheel {
    Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    }
}

/// Newton's method by the dense Jacobian, a step halved while the residual does not fall.
fn solved_whole(system: &HarmonicSystem, omega: f64, x: &mut [f64]) -> f64 {
    let n = x.len();
    let mut workspace = system.workspace();
    let mut factors = LuWorkspace::new(n);
    let mut residual = vec![0.0; n];
    let mut last = f64::INFINITY;
    for _ in 0..60 {
        let (norm, _) = system.residual(omega, x, &mut residual, true, &mut workspace);
        last = norm;
        if norm < 1e-12 {
            break;
        }
        system.jacobian(omega, &mut workspace, factors.matrix_mut());
        assert!(factors.factor());
        let mut step = residual.clone();
        factors.solve(&mut step);
        let mut factor = 1.0;
        let moved = loop {
            let moved: Vec<f64> = x.iter().zip(&step).map(|(x, s)| x - factor * s).collect();
            let (next, _) = system.residual(omega, &moved, &mut residual, false, &mut workspace);
            if next < norm || factor < 1e-3 {
                break moved;
            }
            factor *= 0.5;
        };
        x.copy_from_slice(&moved);
    }
    last
}

#[test]
fn points_are_those_of_a_jacobian_at_every_step() {
    let wheel = lumped();
    for harmonics in [&[1][..], &[1, 3], &[1, 3, 5]] {
        for normal_load_n in [25.0, 50.0, 150.0] {
            let system = system(&wheel, harmonics, normal_load_n);
            let mut workspace = NewtonWorkspace::new(&system);
            let mut x = vec![0.0; system.unknowns()];
            let mut slipping = 0.0;
            for frequency_hz in [348.0, 350.5, 351.0, 354.0] {
                let omega = TAU * frequency_hz;
                let bounds = NewtonBounds::with_tolerance(1e-11);
                let outcome = solve(&system, omega, &mut x, bounds, None, &mut workspace);
                let case = format!("{harmonics:?} {normal_load_n} N {frequency_hz} Hz");
                assert_eq!(outcome.status, Status::Ok, "{case}");
                slipping = f64::max(slipping, outcome.shares.slipping);
                // What is accepted is the residual of the whole equation.
                let mut residual = vec![0.0; x.len()];
                let mut buffers = system.workspace();
                let (norm, _) = system.residual(omega, &x, &mut residual, false, &mut buffers);
                assert!(norm <= 1e-11, "{case}: {norm:e}");
                let mut random = Random(3);
                let mut whole: Vec<f64> = x
                    .iter()
                    .map(|x| x * (1.0 + 0.05 * random.uniform(-1.0, 1.0)))
                    .collect();
                assert!(solved_whole(&system, omega, &mut whole) < 1e-11, "{case}");
                let scale = x.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
                let apart = x.iter().zip(&whole).map(|(a, b)| (a - b).abs());
                let apart = apart.fold(0.0, f64::max) / scale;
                assert!(apart < 1e-9, "{case}: {apart:e}");
            }
            assert!(
                slipping > 0.3,
                "{harmonics:?} {normal_load_n} N: {slipping}"
            );
        }
    }
}
