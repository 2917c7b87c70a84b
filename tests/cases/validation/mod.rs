//! The validation report: the program against references, measured anew by one command.
//!
//! `cargo test --release --test cases -- --ignored --nocapture the_validation_report` writes
//! `results/validation/report.md`.

mod basis_families;
mod calculix;
#[path = "../../physics/calculix_sector.rs"]
mod calculix_sector;
mod contact_laws;
mod contact_models;
mod harmonics;
mod models;
mod named_tests;
mod nodal_diameters;
mod optimal_load;
mod oracles;
mod report;
mod time_integration;

use report::{Entry, write_report};

/// The sections in the order of the report.
const SECTIONS: [Entry; 10] = [
    ("contact-models", contact_models::section),
    ("time-integration", time_integration::section),
    ("harmonics", harmonics::section),
    ("basis-families", basis_families::section),
    ("contact-laws", contact_laws::section),
    ("calculix", calculix::section),
    ("oracles", oracles::section),
    ("named-tests", named_tests::section),
    ("optimal-load", optimal_load::section),
    ("nodal-diameters", nodal_diameters::section),
];

#[test]
#[ignore = "a quarter of an hour on two cores; writes results/validation/report.md"]
fn the_validation_report() {
    let failed = write_report(&SECTIONS);
    assert!(failed.is_empty(), "sections not computed: {failed:?}");
}

/// `BLISK_VALIDATION_SECTION=oracles cargo test --release --test cases -- --ignored --nocapture one_section`
#[test]
#[ignore = "prints the section that BLISK_VALIDATION_SECTION names, or the names"]
fn one_section() {
    let names = SECTIONS.map(|(name, _)| name);
    let Ok(wanted) = std::env::var("BLISK_VALIDATION_SECTION") else {
        println!("BLISK_VALIDATION_SECTION is one of {names:?}");
        return;
    };
    let found = SECTIONS.iter().find(|(name, _)| *name == wanted);
    let (_, section) = found.unwrap_or_else(|| panic!("{wanted:?} is none of {names:?}"));
    println!("{}", section().markdown());
}
