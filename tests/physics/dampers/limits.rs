//! Limits of every contact law on small wheels of solid elements with every built-in damper.

use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::Status;

use super::built_in::{KINDS, SECTORS};
use crate::extremes::wheels::uneven;
use crate::wheels::{Wheel, full, pattern, relative, solve_row};

/// Peak of a mistuned wheel under a friction coefficient and a condition of its contact.
fn peak(wheel: &Wheel, friction_coefficient: f64, condition: ContactCondition) -> ResponseRow {
    let sector = PairParameters {
        friction_coefficient,
        ..wheel.sector
    };
    let options = SolverOptions {
        peak_tolerance: 1e-7,
        residual_tolerance: 1e-11,
        ..SolverOptions::default()
    };
    let solver = Wheel {
        sector,
        ..wheel.clone()
    }
    .solver(&[1], options);
    let (_, row) = solve_row(&solver, &pattern(&uneven(SECTORS, 0.03)), condition);
    assert_eq!(row.status, Status::Ok, "{condition:?}");
    row
}

fn amplitude_m(row: &ResponseRow) -> f64 {
    row.peak_amplitude_m.unwrap()
}

/// Without friction the contact slides, and it comes there in proportion to the coefficient.
#[test]
fn as_friction_vanishes_every_kind_slides_under_every_law() {
    for kind in &KINDS {
        for law in ContactLaw::ALL {
            let wheel = kind.wheel(law);
            let slide = amplitude_m(&peak(&wheel, 0.3, ContactCondition::Slide));
            // So high a load that no pair separates.
            let [coarse, fine] = [1e-7, 1e-9].map(|coefficient| {
                let row = peak(&wheel, coefficient, full(1e6));
                assert_eq!(row.separated_fraction, Some(0.0), "{}", kind.name);
                relative(amplitude_m(&row), slide)
            });
            println!(
                "{} {law:?}: {coarse:.2e} and {fine:.2e} from sliding",
                kind.name
            );
            assert!(fine > 0.0 && fine < 1e-3, "{} {law:?}: {fine:e}", kind.name);
            let ratio = coarse / fine;
            assert!(
                (80.0..120.0).contains(&ratio),
                "{} {law:?}: linear in mu: {ratio}",
                kind.name
            );
        }
    }
}

/// Where the normal load is constant, none is sliding and much is sticking; much is sticking under the other laws, too.
#[test]
fn no_load_and_much_load_are_the_linear_limits_of_every_kind() {
    for kind in &KINDS {
        for law in ContactLaw::ALL {
            let wheel = kind.wheel(law);
            let of = |condition| amplitude_m(&peak(&wheel, 0.3, condition));
            let [slide, stuck] = [ContactCondition::Slide, ContactCondition::Stuck].map(of);
            assert!(
                relative(slide, stuck) > 0.01,
                "{}: the contact matters",
                kind.name
            );
            let near = |what: &str, found: f64, limit: f64, bar: f64| {
                let error = relative(found, limit);
                println!("{} {law:?}: {what} {error:.1e}", kind.name);
                assert!(error < bar, "{} {law:?}: {found} {limit}", kind.name);
            };
            if !law.has_variable_load() {
                near("no load", of(full(1e-6)), slide, 1e-5);
            }
            near("much load", of(full(1e9)), stuck, 1e-6);
        }
    }
}
