//! Points of finite-element and lumped wheels: multipliers about harmonic balance against the marched motion disturbed.

use std::path::Path;
use std::sync::Arc;

use blisk::linalg::Matrix;
use blisk::model::reduction::{BasisChoice, ContactStiffness, Reduction};
use blisk::model::sector::bundle;
use blisk::response::forced_response::{
    ContactCondition, EngineRow, PointSettings, SolverOptions, receptance_contact_motion,
};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Damping;
use blisk::response::mistuning::{ContactFactors, Deviations, Pattern, Projection, WheelBasis};
use blisk::response::receptance::{EngineOptions, EngineWheel, ReceptanceEngine, WaveForce};
use blisk::response::stability::{ContactMotion, Multipliers, StabilityOptions, multipliers};
use blisk::verification::time_integration::{PointCase, SolvedPoint, TimeStepper};

const ENGINE_ORDER: u32 = 3;

/// A point of the wheel of eight blades, pattern 1 of its reference where mistuned.
#[derive(Debug, Clone, Copy)]
struct Point {
    loss_factor: f64,
    normal_load_n: f64,
    mistuned: bool,
    frequency_hz: f64,
}

const fn point(loss_factor: f64, normal_load_n: f64, mistuned: bool, frequency_hz: f64) -> Point {
    Point {
        loss_factor,
        normal_load_n,
        mistuned,
        frequency_hz,
    }
}

/// Stuck nearly, in micro-slip, all pairs slipping, and with separation.
const POINTS: [Point; 24] = [
    point(0.002, 400.0, false, 615.08),
    point(0.002, 1600.0, false, 617.28),
    point(0.002, 1600.0, true, 616.04),
    point(0.002, 800.0, false, 614.0),
    point(0.002, 800.0, false, 615.08),
    point(0.002, 800.0, false, 616.5),
    point(0.002, 400.0, false, 614.0),
    point(0.002, 200.0, false, 614.0),
    point(0.002, 200.0, false, 615.08),
    point(0.002, 100.0, false, 614.0),
    point(0.002, 100.0, false, 615.08),
    point(0.002, 60.0, false, 614.0),
    point(0.002, 60.0, false, 615.08),
    point(0.002, 800.0, true, 613.0),
    point(0.002, 800.0, true, 614.25),
    point(0.002, 400.0, true, 613.0),
    point(0.002, 400.0, true, 614.25),
    point(0.002, 200.0, true, 613.0),
    point(0.002, 200.0, true, 614.25),
    point(0.002, 100.0, true, 613.0),
    point(0.002, 100.0, true, 614.25),
    point(0.02, 400.0, false, 612.5),
    point(0.02, 100.0, true, 612.5),
    point(0.02, 30.0, true, 612.0),
];

/// Harmonics that the march begins with, and those of the motion whose multipliers are sought.
const HARMONICS: [u32; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
const HIGHEST: u32 = 31;
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

/// What the multipliers say, and what a march that begins beside harmonic balance does, see [`change_of_march`]: what it changes by
/// over a period is the distance of two motions, and moves as a disturbance does.
fn both(point: &Point, periods: usize) -> (Option<Multipliers>, f64) {
    let damping = Damping::StructuralLossFactor(point.loss_factor);
    let (kn, kt) = (8e8, 4e8);
    let springs = ContactStiffness {
        normal_n_per_m: kn,
        tangential_1_n_per_m: kt,
        tangential_2_n_per_m: kt,
    };
    let sector = bundle::read(&data("wheel8")).unwrap();
    let reduction = Reduction::new(&sector, springs, 25, 0).unwrap();
    let model = Arc::new(
        reduction
            .reduce(BasisChoice::StickAttachment { stick: 4 }, None)
            .unwrap(),
    );
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
        harmonics: &HARMONICS,
        solver: &solver,
        frequency_hz: point.frequency_hz,
    };
    let solved = case.solved().unwrap();
    let options = EngineOptions {
        damping,
        projection: Projection::Exact,
        forces: vec![WaveForce::new(&model, ENGINE_ORDER, 1.0)],
        deviation: 0.1,
        band_hz: None,
    };
    let (_, engine) = ReceptanceEngine::of_model((*model).clone(), &options, 1).unwrap();
    let wheel = EngineWheel::new(pattern.as_ref(), model.sectors);
    let free = engine.free_wheel(&wheel, solved.omega).unwrap();
    let row = EngineRow {
        engine: &engine,
        wheel: &wheel,
        force: &options.forces[0],
        condition: ContactCondition::Full {
            normal_load_n: point.normal_load_n,
        },
    };
    let contact = Some((case.law, case.sector));
    let geometry = model.contact.clone();
    let coarse = PointSettings::new(&solver, &HARMONICS, contact, geometry).unwrap();
    let fine: Vec<u32> = (0..=HIGHEST).collect();
    let fine = coarse.with_harmonics(&fine, &solver).unwrap();
    let harmonics = receptance_contact_motion(&row, &coarse, &fine, point.frequency_hz);
    let wanted = StabilityOptions {
        steps_per_period: STEPS,
        ..StabilityOptions::default()
    };
    let clock = std::time::Instant::now();
    // Where so many harmonics are not solved for, nothing is known.
    let found = harmonics.ok().flatten().and_then(|harmonics| {
        let motion = ContactMotion { harmonics };
        multipliers(&free, &solved.interface, &motion, solved.omega, &wanted)
    });
    println!(
        "{point:?}: {found:?} in {:.1} s",
        clock.elapsed().as_secs_f64()
    );
    (found, change_of_march(&solved, periods))
}

/// Change of the marched motion from one period to the next in the last ones, over that in the first ones: the march begins beside
/// harmonic balance.
fn change_of_march(solved: &SolvedPoint, periods: usize) -> f64 {
    let marched = solved.marched();
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
    ratio
}

/// What the march says: whether what changes from one period to the next dies out. Every disturbance that is seen to die out is
/// below a tenth of its beginning in 60 periods, and that of a motion that the wheel leaves stays as large as it was or grows.
fn dies_out(ratio: f64) -> Option<bool> {
    match ratio {
        ratio if ratio < 0.2 => Some(true),
        ratio if ratio > 0.5 => Some(false),
        _ => None,
    }
}

/// The motion of the wheel of eight blades at 400 N, 3.4 % above what the wheel does in time, is unstable.
#[test]
fn at_400_n_the_wheel_leaves_its_motion_and_at_1600_n_it_stays() {
    for (point, stable) in [(&POINTS[0], false), (&POINTS[1], true)] {
        let (found, ratio) = both(point, 60);
        assert_eq!(dies_out(ratio), Some(stable), "{ratio}");
        assert_eq!(found.unwrap().stable, Some(stable));
    }
}

#[test]
#[ignore = "minutes: 120 marched periods at each of 24 points"]
fn at_twenty_points_multipliers_say_what_the_march_does() {
    let told: Vec<(Option<bool>, Option<bool>)> = POINTS
        .iter()
        .map(|point| {
            let (found, ratio) = both(point, 120);
            (found.and_then(|found| found.stable), dies_out(ratio))
        })
        .collect();
    for (point, told) in POINTS.iter().zip(&told) {
        println!(
            "{point:?}: by multipliers {:?}, by the march {:?}",
            told.0, told.1
        );
    }
    let agree = |told: &&(Option<bool>, Option<bool>)| told.0.is_some() && told.0 == told.1;
    let differ = told
        .iter()
        .filter(|told| matches!(told, (Some(a), Some(b)) if a != b));
    assert_eq!(differ.count(), 0);
    assert!(told.iter().filter(agree).count() >= 20);
    assert!(told.iter().filter(|told| told.0 == Some(false)).count() >= 3);
}
