//! The work of a peak, counted: what a change of the method costs or saves is seen here, on any machine.

use std::path::Path;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::bundle;
use blisk::response::forced_response::{
    FrequencyBand, Peak, PointSettings, SolverOptions, mistuned_window, peak, tuned_span,
};
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};

use super::contact::random::Random;
use super::wheels::{Wheel, full};

/// Solid elements, six stick and six slide modes per nodal diameter: 1152 unknowns with two harmonics, enough
/// for factors without the couplings to lower harmonics.
pub fn wheel24() -> Wheel {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/wheel24");
    Wheel::of(
        &bundle::read(&folder).unwrap(),
        ContactLaw::Simplified3d,
        PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: 2e8,
            tangential_stiffness_n_per_m: 1e8,
            friction_coefficient: 0.3,
        },
        Damping::StructuralLossFactor(0.002),
        BasisChoice::StickSlide { stick: 6, slide: 6 },
    )
}

fn peak_at(wheel: &Wheel, load: f64) -> Peak {
    let options = SolverOptions::default();
    let contact = Some((wheel.law, wheel.sector));
    let settings = PointSettings::new(&options, &[1, 3], contact, wheel.model.contact.clone());
    let deviations = wheel.deviations(&mut Random(7), 0.03);
    let excited = wheel.mistuned(&deviations, &[1, 3]);
    let span = tuned_span(&wheel.tuned(&[1, 3]), full(load), None).unwrap();
    let largest = deviations.iter().fold(0.0, |a: f64, d| a.max(d.abs()));
    let window = mistuned_window(span, largest, FrequencyBand::Auto);
    let tolerance = options.peak_tolerance;
    peak(&excited, full(load), &settings.unwrap(), window, tolerance)
}

/// Solves, Newton iterations and factorisations of each row within a tenth, and three, of those written down;
/// rounding, which differs between processors, moves a few.
fn assert_work(wheel: &Wheel, expected: &[(f64, [u64; 3])]) {
    let mut beyond = Vec::new();
    for (load, counts) in expected {
        let row = peak_at(wheel, *load);
        let found = [
            row.work.nonlinear_solves,
            row.work.newton_iterations,
            row.work.factorisations,
        ];
        println!("{load} N: {found:?}, {} retries", row.work.retries);
        assert_eq!(row.status, Status::Ok, "{load} N");
        let near = |(found, expected): (&u64, &u64)| found.abs_diff(*expected) <= 3 + expected / 10;
        if !found.iter().zip(counts).all(near) {
            beyond.push(format!("{load} N: {found:?} for {counts:?}"));
        }
    }
    assert!(beyond.is_empty(), "{beyond:#?}");
}

#[test]
fn a_peak_of_a_wheel_of_many_unknowns_takes_the_work_known_for_it() {
    assert_work(
        &wheel24(),
        &[
            (160.0, [18, 151, 10]),
            (320.0, [18, 93, 14]),
            (1280.0, [28, 126, 14]),
        ],
    );
}

/// A lumped wheel, all of whose pairs slip.
#[test]
fn a_peak_of_a_wheel_of_few_unknowns_takes_the_work_known_for_it() {
    let wheel = Wheel {
        amplitude_n: 10.0,
        ..Wheel::lumped24()
    };
    assert_work(
        &wheel,
        &[
            (25.0, [19, 185, 40]),
            (50.0, [20, 170, 53]),
            (150.0, [25, 144, 41]),
        ],
    );
}
