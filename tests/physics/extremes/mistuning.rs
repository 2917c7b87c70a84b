//! Mistuning from none to 30 %, blades without stiffness, and the wheel assembled by hand.

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::{LumpedOptions, lumped};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::response::mistuning::{ContactFactors, Deviations, Pattern};

use super::wheels::{
    CHAIN_LOADS, ORDER, SECTORS, amplitude, chain, one_dimensional, solved, solved_pattern,
    spatial, tight, uneven,
};
use crate::contact::random::Random;
use crate::sector_sources::lumped::wheel as assembled;
use crate::wheels::{LUMPED_KT, full, relative};

const LIMITS: [ContactCondition; 3] = [
    ContactCondition::Free,
    ContactCondition::Slide,
    ContactCondition::Stuck,
];

/// Without deviations, and with those of rounding size, the factor is 1 to the search's tolerance.
#[test]
fn no_deviation_is_an_amplification_factor_of_one() {
    for wheel in [one_dimensional(&chain()), spatial()] {
        let solver = wheel.solver(&[1, 3], tight());
        for contact in LIMITS.into_iter().chain([20.0, 60.0, 1e3].map(full)) {
            for size in [0.0, -0.0, 1e-300, 1e-16, 1e-13] {
                let row = solved(&solver, ORDER, &uneven(SECTORS, size), contact).1;
                let error = relative(row.amplification_factor.unwrap(), 1.0);
                assert!(
                    error < 1e-8,
                    "{}, {contact:?}, {size:e}: {error:e}",
                    wheel.model.name
                );
            }
        }
    }
}

/// Solves `a x = b` by elimination with row exchange: shares no code with the library.
fn solve(mut a: Vec<Vec<[f64; 2]>>, mut b: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let times = |x: [f64; 2], y: [f64; 2]| [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]];
    let minus = |x: [f64; 2], y: [f64; 2]| [x[0] - y[0], x[1] - y[1]];
    let size = |x: [f64; 2]| x[0].hypot(x[1]);
    let over = |x: [f64; 2], y: [f64; 2]| {
        let square = y[0] * y[0] + y[1] * y[1];
        let z = times(x, [y[0], -y[1]]);
        [z[0] / square, z[1] / square]
    };
    let n = b.len();
    for column in 0..n {
        let pivot = (column..n)
            .max_by(|&i, &j| size(a[i][column]).total_cmp(&size(a[j][column])))
            .unwrap();
        a.swap(column, pivot);
        b.swap(column, pivot);
        let (above, below) = a.split_at_mut(column + 1);
        let pivot = &above[column];
        for (row, line) in below.iter_mut().enumerate() {
            let factor = over(line[column], pivot[column]);
            for (entry, other) in line.iter_mut().zip(pivot).skip(column) {
                *entry = minus(*entry, times(factor, *other));
            }
            b[column + 1 + row] = minus(b[column + 1 + row], times(factor, b[column]));
        }
    }
    for row in (0..n).rev() {
        for k in row + 1..n {
            b[row] = minus(b[row], times(a[row][k], b[k]));
        }
        b[row] = over(b[row], a[row][row]);
    }
    b
}

/// Largest blade amplitude of the wheel assembled mass by mass, stuck, with a loss factor on K.
fn assembled_amplitude(options: &LumpedOptions, deviations: &[f64], eta: f64, hz: f64) -> f64 {
    let model = lumped::build(options).unwrap();
    let per_sector = model.dofs.len() - model.cyclic_pairs.len();
    let n = options.sectors * per_sector;
    let omega = std::f64::consts::TAU * hz;
    let mut z = vec![vec![[0.0; 2]; n]; n];
    for (row, column, value) in assembled(&model, &model.stiffness, per_sector).entries() {
        z[row][column][0] += value;
        z[row][column][1] += eta * value;
    }
    for (row, column, value) in assembled(&model, &model.mass, per_sector).entries() {
        z[row][column][0] -= omega * omega * value;
    }
    for (sector, deviation) in deviations.iter().enumerate() {
        let at = |dof: usize| sector * per_sector + dof;
        for (row, column, value) in model.blade_stiffness.entries() {
            z[at(row)][at(column)][0] += deviation * value;
            z[at(row)][at(column)][1] += eta * deviation * value;
        }
        // The contact spring between disk (1) and ring (2), undamped.
        for (row, column, sign) in [(1, 1, 1.0), (2, 2, 1.0), (1, 2, -1.0), (2, 1, -1.0)] {
            z[at(row)][at(column)][0] += sign * LUMPED_KT;
        }
    }
    let angle = std::f64::consts::TAU * f64::from(ORDER) / options.sectors as f64;
    let mut force = vec![[0.0; 2]; n];
    for sector in 0..options.sectors {
        let phase = angle * sector as f64;
        force[sector * per_sector] = [10.0 * phase.cos(), 10.0 * phase.sin()];
    }
    let x = solve(z, force);
    (0..options.sectors)
        .map(|sector| x[sector * per_sector][0].hypot(x[sector * per_sector][1]))
        .fold(0.0, f64::max)
}

/// Linear peaks at 30 % mistuning and with any ring against the assembled wheel, to 1e-9 at the
/// frequency found; nothing higher lies a half-bandwidth around it.
#[test]
fn the_stuck_peak_is_that_of_the_assembled_wheel() {
    let mut random = Random(71);
    for ring in [1e-4, 1.0, 10.0] {
        let options = LumpedOptions {
            ring_mass_kg: ring * chain().ring_mass_kg,
            ..chain()
        };
        let solver = one_dimensional(&options).solver(&[1], tight());
        for size in [0.0, 0.1, 0.3] {
            let deviations = random.vector(SECTORS, 3.0_f64.sqrt() * size);
            let row = solved(&solver, ORDER, &deviations, ContactCondition::Stuck).1;
            let at = row.peak_frequency_hz.unwrap();
            let by_hand = |hz: f64| assembled_amplitude(&options, &deviations, 0.002, hz);
            let error = relative(amplitude(&row), by_hand(at));
            assert!(error < 1e-9, "ring x {ring:e}, {size}: {error:e}");
            let around = (-20..=20).map(|i| by_hand(at * (1.0 + 1e-4 * f64::from(i))));
            let highest = around.fold(0.0, f64::max);
            assert!(
                highest <= amplitude(&row) * (1.0 + 1e-9),
                "ring x {ring:e}, {size}"
            );
        }
    }
}

/// Rows of a standard deviation from 0 to 30 %: those of the chain all end well, of the wheel with three directions at most
/// `most_failed` do not. No peak exceeds the highest of the linear limits of its own pattern. Amplification factors are
/// between 0.2 and 5 up to 20 %; at 30 % up to `highest`, where friction holds the tuned peak far below those limits.
fn ends_well(rows: usize, most_failed: usize, highest: f64) {
    for (wheel, most_failed) in [(one_dimensional(&chain()), 0), (spatial(), most_failed)] {
        let name = &wheel.model.name;
        let solver = wheel
            .solver_up_to(0.9, &[1, 3], SolverOptions::default())
            .unwrap();
        let mut random = Random(72);
        let mut failed = 0;
        for deviation in [0.0, 0.001, 0.01, 0.03, 0.1, 0.2, 0.3] {
            let mut range = [f64::INFINITY, 0.0];
            let mut over_limits = 0.0;
            for _ in 0..rows {
                let deviations = random.vector(SECTORS, 3.0_f64.sqrt() * deviation);
                let limits =
                    LIMITS.map(|limit| amplitude(&solved(&solver, ORDER, &deviations, limit).1));
                let limit = limits.into_iter().fold(0.0, f64::max);
                for load in CHAIN_LOADS.into_iter().chain([500.0]) {
                    let row = solved(&solver, ORDER, &deviations, full(load)).1;
                    if row.status == Status::Ok {
                        let factor = row.amplification_factor.unwrap();
                        range = [f64::min(range[0], factor), f64::max(range[1], factor)];
                        over_limits = f64::max(over_limits, amplitude(&row) / limit);
                    } else {
                        failed += 1;
                        println!(
                            "{name}, {deviation}, {load} N: {} {deviations:?}",
                            row.status.name()
                        );
                    }
                }
            }
            println!(
                "{name} at {deviation}: {failed} failed so far, factors {range:?}, {over_limits} of the limits"
            );
            assert!(over_limits < 1.001, "{name}, {deviation}: {over_limits}");
            let most = if deviation > 0.2 { highest } else { 5.0 };
            assert!(
                range[0] > 0.2 && range[1] < most,
                "{name}, {deviation}: {range:?}"
            );
        }
        assert!(failed <= most_failed, "{name}: {failed}");
    }
}

#[test]
fn thirty_percent_of_mistuning_is_solved() {
    ends_well(2, 0, 7.5);
}

#[test]
#[ignore = "about 5 minutes: `cargo test --release --test physics extremes -- --ignored`"]
fn thirty_percent_of_mistuning_is_solved_long() {
    ends_well(100, 1, 7.7);
}

#[test]
fn a_blade_without_stiffness_is_refused_and_one_with_hardly_any_is_not() {
    for wheel in [one_dimensional(&chain()), spatial()] {
        let solver = wheel.solver(&[1], SolverOptions::default());
        let bad = [
            -1.0,
            -1.0 - 1e-12,
            -2.0,
            -1e300,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ];
        for contact in LIMITS.into_iter().chain([full(20.0)]) {
            let status = |deviation: f64| {
                let mut deviations = uneven(SECTORS, 0.01);
                deviations[SECTORS - 1] = deviation;
                solved(&solver, ORDER, &deviations, contact).1.status
            };
            for deviation in bad {
                assert_eq!(status(deviation), Status::InvalidPattern, "{deviation}");
            }
            for deviation in [-1.0 + 1e-12, -0.999, 10.0, 1e6, 1e12, 1e300] {
                let ended = status(deviation);
                println!(
                    "{}, {contact:?}, {deviation:e}: {}",
                    wheel.model.name,
                    ended.name()
                );
                assert_ne!(ended, Status::Panicked);
            }
        }
    }
}

/// A deviation per mode of a blade with one mode is one of the blade, at any size.
#[test]
fn modes_of_a_single_mass_blade_are_the_blade() {
    let model = lumped::build(&chain()).unwrap();
    let reduction = blisk::model::reduction::Reduction::new(
        &model,
        crate::wheels::springs(
            blisk::response::friction::ContactLaw::MacroSlip1d,
            one_dimensional(&chain()).sector,
        ),
        25,
        0,
    )
    .unwrap();
    let wheel = crate::wheels::Wheel {
        model: std::sync::Arc::new(
            reduction
                .reduce(BasisChoice::CraigBampton, Some(1))
                .unwrap(),
        ),
        damping: Damping::StructuralLossFactor(0.002),
        ..one_dimensional(&chain())
    };
    let solver = wheel.solver(&[1], tight());
    for size in [0.01, 0.3] {
        let deviations = uneven(SECTORS, size);
        let of_mode = Pattern {
            id: 0,
            deviations: Deviations::PerMode {
                modes: vec![0],
                values: deviations.clone(),
            },
            contact: ContactFactors::default(),
        };
        let blade = solved(&solver, ORDER, &deviations, full(20.0)).1;
        let mode = solved_pattern(&solver, ORDER, &of_mode, full(20.0)).1;
        assert!(
            relative(amplitude(&mode), amplitude(&blade)) < 1e-9,
            "{size}"
        );
    }
}
