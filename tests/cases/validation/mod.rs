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
    Entry {
        name: "contact-models",
        title: "Fast path, full contact model and an independent code",
        compute: contact_models::section,
    },
    Entry {
        name: "time-integration",
        title: "Harmonic balance and time integration",
        compute: time_integration::section,
    },
    Entry {
        name: "harmonics",
        title: "Default settings against converged harmonics",
        compute: harmonics::section,
    },
    Entry {
        name: "basis-families",
        title: "Two families of modes against either alone",
        compute: basis_families::section,
    },
    Entry {
        name: "contact-laws",
        title: "Contact laws, and a ring that creeps",
        compute: contact_laws::section,
    },
    Entry {
        name: "calculix",
        title: "Frequencies of a cyclic sector by CalculiX",
        compute: calculix::section,
    },
    Entry {
        name: "oracles",
        title: "Oracles",
        compute: oracles::section,
    },
    Entry {
        name: "named-tests",
        title: "Oracles held by tests alone",
        compute: named_tests::section,
    },
    Entry {
        name: "optimal-load",
        title: "Optimal normal load, tuned and mistuned",
        compute: optimal_load::section,
    },
    Entry {
        name: "nodal-diameters",
        title: "Effect of the ring by nodal diameter",
        compute: nodal_diameters::section,
    },
];

/// All sections, or those that `BLISK_VALIDATION_SECTIONS` names, separated by commas; the others are then kept
/// as they stand in the report.
#[test]
#[ignore = "minutes on two idle cores; writes results/validation/report.md"]
fn the_validation_report() {
    let wanted = std::env::var("BLISK_VALIDATION_SECTIONS").ok();
    let failed = write_report(&SECTIONS, wanted.as_deref());
    assert!(failed.is_empty(), "sections not computed: {failed:?}");
}
