//! Points of finite-element and lumped wheels: multipliers about harmonic balance against the marched motion disturbed.

use std::path::Path;
use std::sync::Arc;

use blisk::linalg::Matrix;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::bundle;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;
use blisk::response::mistuning::{ContactFactors, Deviations, Pattern, Projection, WheelBasis};
use blisk::response::receptance::{
    EngineModel, EngineOptions, EngineWheel, ReceptanceEngine, WaveForce,
};
use blisk::response::stability::{ContactMotion, Multipliers, StabilityOptions, multipliers};
use blisk::response::time_integration::{PointCase, TimeStepper};

const ENGINE_ORDER: u32 = 3;

/// A point of the wheel of eight blades, pattern 1 of its reference where mistuned.
#[derive(Debug, Clone)]
struct Point {
    loss_factor: f64,
    normal_load_n: f64,
    mistuned: bool,
    frequency_hz: f64,
    highest: u32,
    lowest: u32,
    basis: BasisChoice,
}

/// Steps per period of both.
const STEPS: usize = 1024;

fn data(name: &str) -> std::path::PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    root.join("tests/data").join(name)
}

fn deviations(pattern: u32) -> Vec<f64> {
    let text = std::fs::read_to_string(data("wheel8/reference/patterns.csv")).unwrap();
    let cells = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let own = cells.filter(|cells| cells[0] == pattern.to_string());
    own.map(|cells| cells[2].parse().unwrap()).collect()
}

/// What the multipliers say, and the change of the motion from one period to the next at the end of a march over its first ones.
///
/// The march begins beside harmonic balance. What it changes by over a period is the distance of two motions, and moves as a
/// disturbance does.
fn both(point: &Point, periods: usize) -> Option<(Multipliers, f64)> {
    let damping = Damping::StructuralLossFactor(point.loss_factor);
    let (kn, kt) = (8e8, 4e8);
    let springs = ContactStiffness {
        normal_n_per_m: kn,
        tangential_1_n_per_m: kt,
        tangential_2_n_per_m: kt,
    };
    let sector = bundle::read(&data("wheel8")).unwrap();
    let reduction = Reduction::new(&sector, springs, 25, 0).unwrap();
    let model = Arc::new(reduction.reduce(point.basis, None).unwrap());
    let basis = WheelBasis::new(Arc::clone(&model));
    let pattern = point.mistuned.then(|| Pattern {
        id: 1,
        deviations: Deviations::PerBlade(deviations(1)),
        contact: ContactFactors::default(),
    });
    let change: Option<Matrix<f64>> = point
        .mistuned
        .then(|| basis.blade_stiffness_change(&deviations(1)));
    let solver = SolverOptions {
        samples_per_period: 512,
        ..SolverOptions::default()
    };
    let harmonics: Vec<u32> = (point.lowest..=point.highest).collect();
    let factors = ContactFactors::default();
    let case = PointCase {
        basis: &basis,
        stiffness_change: change.as_ref(),
        damping,
        engine_order: ENGINE_ORDER,
        amplitude_n: 1.0,
        law: ContactLaw::Simplified3d,
        sector: PairParameters {
            normal_load_n: point.normal_load_n,
            normal_stiffness_n_per_m: kn,
            tangential_stiffness_n_per_m: kt,
            friction_coefficient: 0.3,
        },
        factors: &factors,
        harmonics: &harmonics,
        solver: &solver,
        frequency_hz: point.frequency_hz,
    };
    let clock = std::time::Instant::now();
    let Ok(solved) = case.solved() else {
        println!("{point:?}: not solved");
        return None;
    };
    println!(
        "{point:?}: solved in {:.1} s, {} modes",
        clock.elapsed().as_secs_f64(),
        basis.size()
    );
    let options = EngineOptions {
        damping,
        projection: Projection::Exact,
        forces: vec![WaveForce::new(&model, ENGINE_ORDER, 1.0)],
        deviation: 0.1,
        band_hz: None,
    };
    let own = EngineModel::new(&model, &options).unwrap();
    let engine = ReceptanceEngine::new(&own, &options).unwrap();
    let wheel = EngineWheel::new(pattern.as_ref(), model.sectors);
    let free = engine.free_wheel(&wheel, solved.omega).unwrap();
    let marched = solved.marched();
    let motion = ContactMotion {
        harmonics: solved.motion.contact_rows(marched.structure),
    };
    let clock = std::time::Instant::now();
    let options = StabilityOptions {
        steps_per_period: STEPS,
        ..StabilityOptions::default()
    };
    let found = multipliers(&free, &solved.interface, &motion, solved.omega, &options).unwrap();
    let largest = solved
        .harmonic_balance_m
        .iter()
        .copied()
        .fold(0.0, f64::max);
    println!(
        "  {largest:.4e} m, |{:.5}| {found:?} in {:.1} s",
        found.largest.norm(),
        clock.elapsed().as_secs_f64()
    );
    if periods == 0 {
        return None;
    }
    let mut state = solved.motion.start(&marched, STEPS);
    for (place, q) in state.position.iter_mut().enumerate() {
        *q *= 1.0 + 1e-3 * (1.0 + place as f64).sin();
    }
    let clock = std::time::Instant::now();
    let mut stepper = TimeStepper::new(&marched, &state, STEPS).unwrap();
    let mut before = stepper.state().velocity;
    let mut changes = Vec::new();
    for _ in 0..periods {
        for _ in 0..STEPS {
            stepper.advance().unwrap();
        }
        let after = stepper.state().velocity;
        let change = after.iter().zip(&before).map(|(a, b)| (a - b).powi(2));
        let size: f64 = after.iter().map(|v| v * v).sum();
        changes.push((change.sum::<f64>() / size).sqrt());
        before = after;
    }
    let largest = |of: &[f64]| of.iter().copied().fold(0.0, f64::max);
    let ratio = largest(&changes[periods - 20..]) / largest(&changes[..3]);
    println!(
        "  change {:.1e} to {:.1e}, ratio {ratio:.3} in {:.1} s",
        largest(&changes[..3]),
        largest(&changes[periods - 20..]),
        clock.elapsed().as_secs_f64()
    );
    Some((found, ratio))
}

#[test]
fn scratch() {
    let chosen = |name: &str, or: &str| std::env::var(name).unwrap_or(or.to_owned());
    let numbers =
        |text: String| -> Vec<f64> { text.split(',').map(|x| x.parse().unwrap()).collect() };
    let basis = match chosen("BASIS", "cb").as_str() {
        "sa" => BasisChoice::StickAttachment { stick: 4 },
        _ => BasisChoice::CraigBampton,
    };
    for loss_factor in numbers(chosen("ETA", "0.002")) {
        for normal_load_n in numbers(chosen("LOADS", "400")) {
            for frequency_hz in numbers(chosen("HZ", "615.08")) {
                let point = Point {
                    loss_factor,
                    normal_load_n,
                    mistuned: chosen("MISTUNED", "no") == "yes",
                    frequency_hz,
                    lowest: chosen("LOW", "0").parse().unwrap(),
                    highest: chosen("HIGH", "9").parse().unwrap(),
                    basis,
                };
                both(&point, chosen("PERIODS", "0").parse().unwrap());
            }
        }
    }
}
