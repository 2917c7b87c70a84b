//! The validation report: the program against references, measured anew by one command.
//!
//! `studies/validation/run.sh` writes `results/validation/report.md`, its verdicts and `results/README.md`, and ends with
//! exit code 1 if a bar is not met that is not listed in `results/validation/open_bars.toml`.

mod bars;
mod basis_families;
mod calculix;
#[path = "../../physics/calculix_sector.rs"]
mod calculix_sector;
mod contact_laws;
mod contact_models;
mod harmonics;
mod identity;
mod models;
mod named_tests;
mod nodal_diameters;
mod optimal_load;
mod oracles;
mod quickstart;
mod report;
mod time_integration;

use report::{Entry, make_report};

/// The sections in the order of the report.
const SECTIONS: [Entry; 11] = [
    Entry {
        name: quickstart::NAME,
        title: "The study of the README",
        compute: quickstart::section,
    },
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

/// All sections; or those that `BLISK_VALIDATION_SECTIONS` names, separated by commas, which are printed and judged and
/// written nowhere.
#[test]
#[ignore = "about ten minutes on two idle cores: studies/validation/run.sh"]
fn the_validation_report() {
    let wanted = std::env::var("BLISK_VALIDATION_SECTIONS").ok();
    let problems = make_report(&SECTIONS, wanted.as_deref());
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}
