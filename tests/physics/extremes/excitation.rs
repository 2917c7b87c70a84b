//! No excitation at all, excitation at the ends of the range of numbers, and bands without a peak.

use blisk::response::forced_response::{ContactCondition, FrequencyBand, SolverOptions};
use blisk::response::harmonic_balance::Status;

use super::wheels::{
    ORDER, SECTORS, amplitude, chain, one_dimensional, solved, spatial, tight, uneven,
};
use crate::wheels::{Wheel, full};

const CONTACTS: [ContactCondition; 4] = [
    ContactCondition::Free,
    ContactCondition::Slide,
    ContactCondition::Stuck,
    ContactCondition::Full {
        normal_load_n: 20.0,
    },
];

/// A wheel that nothing excites has no peak: every row says so and none has a number. (A study file
/// with `amplitude_n = 0` is refused: `studies_with_an_extreme_value_are_refused_or_sound`.)
#[test]
fn a_wheel_that_nothing_excites_has_no_peak() {
    for wheel in [one_dimensional(&chain()), spatial()] {
        for force in [0.0, -0.0] {
            let wheel = Wheel {
                amplitude_n: force,
                ..wheel.clone()
            };
            let solver = wheel.solver(&[1, 3], SolverOptions::default());
            for contact in CONTACTS {
                let (tuned, row) = solved(&solver, ORDER, &uneven(SECTORS, 0.03), contact);
                println!(
                    "{}, {contact:?}: {} and {}",
                    wheel.model.name,
                    tuned.status.name(),
                    row.status.name()
                );
                assert_ne!(tuned.status, Status::Ok);
                assert_ne!(row.status, Status::Ok);
            }
        }
    }
}

/// Forces at the ends of the range of numbers end in a finite number or a status.
#[test]
fn forces_at_the_ends_of_the_range_end_with_a_status() {
    for wheel in [one_dimensional(&chain()), spatial()] {
        for force in [
            1e-300,
            1e-160,
            1e-30,
            1e30,
            1e160,
            1e300,
            f64::MAX,
            f64::INFINITY,
            f64::NAN,
        ] {
            let wheel = Wheel {
                amplitude_n: force,
                ..wheel.clone()
            };
            let Some(solver) = wheel.solver_or_none(&[1], SolverOptions::default()) else {
                println!("{}, {force:e} N: no receptances", wheel.model.name);
                assert!(!(1e-30..=1e30).contains(&force), "what a study may say");
                continue;
            };
            for contact in CONTACTS.into_iter().chain([force, 0.0, f64::MAX].map(full)) {
                let (tuned, row) = solved(&solver, ORDER, &uneven(SECTORS, 0.03), contact);
                println!(
                    "{}, {force:e} N, {contact:?}: {} and {}",
                    wheel.model.name,
                    tuned.status.name(),
                    row.status.name()
                );
            }
        }
    }
}

/// A band off the resonance has no peak inside, below as well as above it.
#[test]
fn a_band_that_misses_the_resonance_is_not_bracketed() {
    for wheel in [one_dimensional(&chain()), spatial()] {
        for contact in CONTACTS {
            let anywhere = wheel.solver(&[1], SolverOptions::default());
            let row = solved(&anywhere, ORDER, &uneven(SECTORS, 0.03), contact).1;
            let at = row.peak_frequency_hz.unwrap();
            for (low, high) in [
                (0.5, 0.6),
                (1e-6, 1e-3),
                (0.7, 0.700_001),
                (20.0, 30.0),
                (1e6, 2e6),
            ] {
                let options = SolverOptions {
                    frequency_band: FrequencyBand::Fixed {
                        start_hz: low * at,
                        stop_hz: high * at,
                    },
                    ..SolverOptions::default()
                };
                let solver = wheel.solver(&[1], options);
                let (tuned, row) = solved(&solver, ORDER, &uneven(SECTORS, 0.03), contact);
                let name = &wheel.model.name;
                assert_eq!(
                    tuned.status,
                    Status::NotBracketed,
                    "{name}, {contact:?}, {low}"
                );
                assert_eq!(
                    row.status,
                    Status::NotBracketed,
                    "{name}, {contact:?}, {low}"
                );
            }
        }
    }
}

/// A band so narrow that its ends are neighbours, on the resonance: a peak or the typed refusal.
#[test]
fn a_band_of_no_width_ends_with_a_status() {
    let wheel = one_dimensional(&chain());
    for contact in CONTACTS {
        let anywhere = wheel.solver(&[1], tight());
        let peak = solved(&anywhere, ORDER, &uneven(SECTORS, 0.03), contact).1;
        let at = peak.peak_frequency_hz.unwrap();
        for width in [1e-15, 1e-12, 1e-9, 1e-6] {
            let options = SolverOptions {
                frequency_band: FrequencyBand::Fixed {
                    start_hz: at * (1.0 - width),
                    stop_hz: at * (1.0 + width),
                },
                ..SolverOptions::default()
            };
            let row = solved(
                &wheel.solver(&[1], options),
                ORDER,
                &uneven(SECTORS, 0.03),
                contact,
            )
            .1;
            println!("{contact:?}, {width:e}: {}", row.status.name());
            let accepted = [Status::Ok, Status::NotBracketed];
            assert!(
                accepted.contains(&row.status),
                "{contact:?}, {width:e}: {row:?}"
            );
            if row.status == Status::Ok {
                assert!((amplitude(&row) / amplitude(&peak) - 1.0).abs() < 1e-6);
            }
        }
    }
}
