//! Harmonic sets up to 31, and the fewest samples that tell them apart.

use blisk::response::forced_response::{AmplitudeMeasure, Harmonics, SolverOptions};
use blisk::response::harmonic_balance::Status;

use super::wheels::{
    ORDER, SECTORS, amplitude, chain, one_dimensional, solved, spatial, spatial_sector, uneven,
    with_sector,
};
use crate::wheels::{full, relative};

fn odd(highest: u32) -> Vec<u32> {
    (1..=highest).step_by(2).collect()
}

fn settings(samples: usize) -> SolverOptions {
    SolverOptions {
        samples_per_period: samples,
        peak_tolerance: 1e-5,
        ..SolverOptions::default()
    }
}

/// Odd harmonics of a slider: the peak converges as the set grows to 31.
#[test]
fn a_slider_converges_over_odd_harmonics_up_to_31() {
    let wheel = one_dimensional(&chain());
    for load in [20.0, 60.0] {
        let peaks = [1, 3, 7, 15, 31].map(|highest| {
            let solver = wheel.solver(&odd(highest), settings(256));
            let row = solved(&solver, ORDER, &uneven(SECTORS, 0.04), full(load)).1;
            amplitude(&row)
        });
        let finest = peaks[4];
        let errors = peaks.map(|peak| relative(peak, finest));
        println!("{load} N: 1, 3, 7, 15 against 31: {errors:?}");
        assert!(errors[3] < 1e-3, "{load} N: {errors:?}");
        // Even harmonics of a slider under constant load are zero: the full set says the same.
        let whole: Vec<u32> = (0..=31).collect();
        let row = solved(
            &wheel.solver(&whole, settings(256)),
            ORDER,
            &uneven(SECTORS, 0.04),
            full(load),
        )
        .1;
        assert!(relative(amplitude(&row), finest) < 1e-4, "{load} N");
    }
}

/// All harmonics 0 to 31 of a contact with variable normal load that does not separate: the peak is that of
/// fewer. Three sectors, because every harmonic has all of their modes.
#[test]
fn a_contact_in_space_takes_harmonics_0_to_31() {
    let wheel = with_sector(&spatial(), &spatial_sector(3));
    let options = SolverOptions {
        samples_per_period: 128,
        ..SolverOptions::default()
    };
    let [few, all] = [7, 31].map(|highest| {
        let set: Vec<u32> = (0..=highest).collect();
        let row = solved(
            &wheel.solver(&set, options.clone()),
            ORDER,
            &uneven(3, 0.04),
            full(1000.0),
        )
        .1;
        println!(
            "0-{highest}: {} {:?}, slipping {:?}, {} solves, {} iterations",
            row.status.name(),
            row.peak_amplitude_m,
            row.slipping_fraction,
            row.nonlinear_solves,
            row.newton_iterations
        );
        assert!(row.slipping_fraction > Some(0.0) && row.separated_fraction == Some(0.0));
        amplitude(&row)
    });
    assert!(relative(few, all) < 2e-3, "{few} {all}");
}

/// A set needs more samples than twice its highest harmonic; fewer are refused, not aliased.
#[test]
fn too_few_samples_for_the_set_are_refused() {
    use blisk::population::monte_carlo::RowSolver;
    let wheel = one_dimensional(&chain());
    for (highest, samples, accepted) in
        [(31, 62, false), (31, 63, true), (1, 2, false), (1, 3, true)]
    {
        let options = SolverOptions {
            harmonics: Harmonics::Set(odd(highest)),
            ..settings(samples)
        };
        let settings = wheel.settings(&odd(highest), options);
        let made = RowSolver::new(std::sync::Arc::clone(&wheel.model), settings);
        assert_eq!(made.is_ok(), accepted, "{highest} in {samples}");
        if let Ok(solver) = made {
            let row = solved(&solver, ORDER, &uneven(SECTORS, 0.04), full(20.0)).1;
            println!("{highest} in {samples}: {}", row.status.name());
        }
    }
}

/// The largest displacement over a period of a set that has harmonic 1 alone is its amplitude, to the
/// spacing of the instants; with 31 harmonics it is finite and close.
#[test]
fn the_largest_value_over_time_takes_any_set() {
    let wheel = one_dimensional(&chain());
    let over_time = SolverOptions {
        amplitude: AmplitudeMeasure::TimeMaximum,
        ..settings(256)
    };
    let row = |set: &[u32], options: &SolverOptions| {
        let solver = wheel.solver(set, options.clone());
        solved(&solver, ORDER, &uneven(SECTORS, 0.04), full(20.0)).1
    };
    let fundamental = amplitude(&row(&[1], &settings(256)));
    assert!(relative(amplitude(&row(&[1], &over_time)), fundamental) < 2e-5);
    let many = row(&odd(31), &over_time);
    assert_eq!(many.status, Status::Ok);
    assert!(relative(amplitude(&many), fundamental) < 0.05);
}
