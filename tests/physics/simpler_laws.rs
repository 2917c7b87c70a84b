//! A simpler contact law in the place of that of the study: what it leaves out is in the errors of a row.

use blisk::population::monte_carlo::{ResponseRow, RowSettings, RowSolver};
use blisk::response::forced_response::{ContactCondition, SolverOptions};
use blisk::response::friction::ContactLaw;
use blisk::response::harmonic_balance::Status;

use super::wheels::{Wheel, deviations_in, full, pattern, solve_row};

const HARMONICS: [u32; 2] = [1, 3];

/// A row under `law`, in the place of another one.
fn row(law: ContactLaw, in_place_of: Option<ContactLaw>, contact: ContactCondition) -> ResponseRow {
    let wheel = Wheel::wheel8();
    let options = SolverOptions {
        peak_tolerance: 1e-5,
        ..SolverOptions::default()
    };
    let settings = RowSettings {
        contact: Some((law, wheel.sector)),
        in_place_of,
        ..wheel.settings(&HARMONICS, options)
    };
    let solver = RowSolver::new(wheel.model, settings).unwrap();
    let (_, row) = solve_row(
        &solver,
        &pattern(&deviations_in("wheel8/reference/patterns.csv", 1)),
        contact,
    );
    assert_eq!(row.status, Status::Ok);
    row
}

#[test]
fn the_errors_of_a_row_say_what_its_simpler_law_leaves_out() {
    use ContactLaw::{Coulomb3d, MacroSlip2d, Simplified3d};
    let mut largest = 0.0_f64;
    for (simple, exact, name) in [
        (MacroSlip2d, Simplified3d, "constant_normal_load"),
        (Simplified3d, Coulomb3d, "uncoupled_tangents"),
        (MacroSlip2d, Coulomb3d, "constant_normal_load"),
    ] {
        for load in [200.0, 400.0, 800.0, 1600.0] {
            let truth = row(exact, None, full(load)).peak_amplitude_m.unwrap();
            let found = row(simple, Some(exact), full(load));
            assert_eq!(found.shortcut, name);
            let amplitude = found.peak_amplitude_m.unwrap();
            let alone = row(simple, None, full(load));
            assert_eq!(alone.peak_amplitude_m, found.peak_amplitude_m);
            assert_eq!(alone.shortcut, "none");
            let actual = truth / amplitude - 1.0;
            let law = found.sampling_error.unwrap() - alone.sampling_error.unwrap();
            println!("{simple:?} for {exact:?}, {load} N: {actual:+.2e}, in the errors {law:+.2e}");
            assert!((law - actual).abs() <= 0.1 * actual.abs() + 1e-4);
            assert!(actual.abs() <= found.stated_error.unwrap());
            if simple == MacroSlip2d && load <= 200.0 {
                // Half of the harmonics that the law of the study excites are not excited by the other.
                assert!(
                    (found.harmonic_error.unwrap() - alone.harmonic_error.unwrap()).abs() > 1e-3
                );
            }
            largest = largest.max(actual.abs());
        }
    }
    assert!(largest > 3e-3, "{largest:e}");
}

#[test]
fn where_every_pair_sticks_there_is_nothing_to_correct() {
    let (simple, exact) = (ContactLaw::MacroSlip2d, ContactLaw::Simplified3d);
    let found = row(simple, Some(exact), full(1e6));
    assert_eq!(found.shortcut, "constant_normal_load, stuck");
    assert!(found.sampling_error.unwrap().abs() < 1e-12);
    let limit = row(simple, Some(exact), ContactCondition::Stuck);
    assert_eq!(limit.shortcut, "linear");
}
