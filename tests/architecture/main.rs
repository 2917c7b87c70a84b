//! The order of wings and rooms under `src/`, read from the paths in the sources.
//!
//! A module may name those that stand before it in [`WINGS`], inside a wing those that stand before
//! it in its list of rooms; never one that stands after it.

#![allow(clippy::unwrap_used)]

mod circles;
mod citation;
mod documented_tests;
mod glossary;
mod links;
mod long_tests;
mod map;
mod methods;
mod paths;
mod rooms;
mod sentences;

use std::path::Path;

use paths::{Source, sources};

/// Wings in order, each with its rooms in order; a wing without rooms has no order inside.
const WINGS: &[(&str, &[&str])] = &[
    ("identity", &[]),
    ("platform", &[]),
    ("linalg", &[]),
    ("input", &[]),
    (
        "model",
        &[
            "sector",
            "cyclic",
            "blade_energy",
            "reduced_model",
            "reduction",
            "cache",
        ],
    ),
    (
        "response",
        &[
            "mistuning",
            "friction",
            "harmonic_balance",
            "receptance",
            "forced_response",
            "stability",
        ],
    ),
    ("verification", &["reference", "time_integration"]),
    ("population", &["monte_carlo", "statistics", "table"]),
    ("report", &[]),
    ("study", &[]),
    ("settings", &[]),
    ("campaign", &["store", "pipeline", "commands"]),
    ("library", &[]),
    ("cli", &[]),
];

/// Most lines of a source file.
const MOST_LINES: usize = 499;

fn wing_of(name: &str) -> Option<usize> {
    WINGS.iter().position(|(wing, _)| *wing == name)
}

fn source_files() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let found = sources(&root);
    assert!(found.len() > 50, "only {} files were found", found.len());
    found
}

fn complain(rule: &str, violations: &[String]) {
    assert!(violations.is_empty(), "{rule}:\n{}", violations.join("\n"));
}

#[test]
fn every_wing_and_room_is_in_the_order() {
    let mut violations = Vec::new();
    for source in source_files() {
        let Some(wing) = source.module.first() else {
            continue;
        };
        match wing_of(wing) {
            None => violations.push(format!("{}: wing {wing}", source.name)),
            Some(place) => {
                let rooms = WINGS[place].1;
                if let Some(room) = source.module.get(1)
                    && !rooms.is_empty()
                    && !rooms.contains(&room.as_str())
                {
                    violations.push(format!("{}: room {room} of {wing}", source.name));
                }
            }
        }
    }
    complain("not listed in this test", &violations);
}

#[test]
fn a_wing_names_only_those_before_it() {
    let mut violations = Vec::new();
    for source in source_files() {
        // `main.rs` and `lib.rs` stand above all wings.
        let Some(own) = source.module.first().and_then(|wing| wing_of(wing)) else {
            continue;
        };
        for path in &source.paths {
            if path.first().and_then(|wing| wing_of(wing)) > Some(own) {
                violations.push(format!("{}: {}", source.name, path.join("::")));
            }
        }
    }
    complain("a wing names one that stands after it", &violations);
}

#[test]
fn a_room_names_only_those_before_it() {
    let files = source_files();
    let mut violations = Vec::new();
    for source in &files {
        let [wing, room, ..] = source.module.as_slice() else {
            continue;
        };
        let rooms = wing_of(wing).map_or(&[][..], |place| WINGS[place].1);
        let place = |name: &str| rooms.iter().position(|room| *room == name);
        let Some(own) = place(room) else { continue };
        for path in source
            .paths
            .iter()
            .filter(|path| path.first() == Some(wing))
        {
            let Some(second) = path.get(1) else { continue };
            // An item that the wing itself offers is one of the room that it re-exports it from.
            let named = place(second).or_else(|| place(room_of_item(&files, wing, second)?));
            if named > Some(own) {
                violations.push(format!("{}: {}", source.name, path.join("::")));
            }
        }
    }
    complain("a room names one that stands after it", &violations);
}

/// The room from which the wing re-exports `item`.
fn room_of_item<'a>(files: &'a [Source], wing: &str, item: &str) -> Option<&'a str> {
    let of_wing = files
        .iter()
        .find(|source| source.module == [wing] && source.name.ends_with("mod.rs"))?;
    of_wing
        .paths
        .iter()
        .find(|path| path.len() > 2 && path.last().is_some_and(|name| name == item))
        .map(|path| path[1].as_str())
}

#[test]
fn what_composes_is_named_by_nothing_below_it() {
    let mut violations = Vec::new();
    for source in source_files() {
        let own = source.module.first().map(String::as_str);
        for path in &source.paths {
            let named = path.first().map(String::as_str);
            let allowed = match named {
                Some("cli") => own == Some("cli"),
                Some("library") => own == Some("library"),
                Some("campaign") => matches!(own, Some("campaign" | "library" | "cli")),
                Some("study" | "settings") => {
                    matches!(
                        own,
                        Some("study" | "settings" | "campaign" | "library" | "cli")
                    )
                }
                _ => true,
            };
            // `main.rs` calls `blisk::cli::main`, which is no path within the library.
            if !allowed {
                violations.push(format!("{}: {}", source.name, path.join("::")));
            }
        }
    }
    complain(
        "study, settings, campaign, library and cli compose and are named by nothing below",
        &violations,
    );
}

#[test]
fn each_heavy_crate_has_one_place() {
    let places: [(&str, &[&str]); 2] =
        [("faer", &["linalg"]), ("polars", &["population", "table"])];
    let mut violations = Vec::new();
    for source in source_files() {
        for (name, place) in places {
            let inside = place
                .iter()
                .zip(&source.module)
                .filter(|(expected, own)| *expected == own)
                .count()
                == place.len();
            if !inside && source.has_word(&format!("{name}::")) {
                violations.push(format!("{}: {name}", source.name));
            }
        }
    }
    complain("a crate is named outside its place", &violations);
}

#[test]
fn only_the_platform_asks_the_operating_system() {
    let mut violations = Vec::new();
    for source in source_files() {
        let asks = source.module.first().is_some_and(|wing| wing == "platform");
        for words in ["\"/proc", "sysinfo::"] {
            if !asks && source.text.contains(words) {
                violations.push(format!("{}: {words}", source.name));
            }
        }
    }
    complain("a file outside src/platform asks the system", &violations);
}

/// Whether a statement of the program digests text for a developer, which changes with a name, makes a key of it, or compares it.
fn compares_debug_text(text: &str) -> bool {
    let program = text.split("#[cfg(test)]").next().unwrap_or_default();
    let statements = program
        .split(';')
        .filter(|statement| statement.contains(":?}"));
    let mut joined = statements.map(|statement| statement.split_whitespace().collect::<String>());
    let compares = ["as_bytes()", "==format!", "!=format!", "key=format!"];
    joined.any(|statement| compares.iter().any(|word| statement.contains(word)))
}

#[test]
fn no_digest_is_made_of_debug_text() {
    let files = source_files().into_iter();
    let found = files.filter(|source| compares_debug_text(&source.text));
    let violations: Vec<String> = found.map(|source| source.name).collect();
    complain(
        "a digest or a comparison of rows is made of debug text",
        &violations,
    );
}

#[test]
fn a_digest_of_debug_text_is_found() {
    let digest = "fn f() { blake3::hash(format!(\"{x:?}\").as_bytes()) }";
    assert!(compares_debug_text(digest));
    assert!(compares_debug_text(
        "format!(\"{a:?}\") == format!(\"{b:?}\")"
    ));
    assert!(!compares_debug_text(
        "fn f() { blake3::hash(x) }\n#[cfg(test)]\n\"{x:?}\""
    ));
    assert!(!compares_debug_text("fn f() { format!(\"{x:?}\") }"));
}

#[test]
fn one_file_prints() {
    let macros = ["print!", "println!", "eprint!", "eprintln!", "dbg!"];
    let streams = ["stdout()", "stderr()"];
    let mut violations = Vec::new();
    let mut printing = 0;
    for source in source_files() {
        let prints = source.module == ["cli", "output"];
        printing += usize::from(prints);
        for name in macros {
            if source.has_word(name) {
                violations.push(format!("{}: {name}", source.name));
            }
        }
        for name in streams {
            // Also as `io::stdout()`.
            if !prints && source.code.contains(name) {
                violations.push(format!("{}: {name}", source.name));
            }
        }
    }
    assert_eq!(printing, 1, "src/cli/output.rs is gone");
    complain("a file other than src/cli/output.rs prints", &violations);
}

#[test]
fn every_file_is_short_and_says_what_it_is_for() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut violations = Vec::new();
    for folder in ["src", "benches", "python/src"] {
        for source in sources(&root.join(folder)) {
            let lines = source.text.lines().count();
            if lines > MOST_LINES {
                violations.push(format!("{}: {lines} lines", source.name));
            }
            if !source.text.starts_with("//! ") {
                violations.push(format!("{}: no sentence at its head", source.name));
            }
        }
    }
    complain(
        "files have at most 499 lines and open with //!",
        &violations,
    );
}

#[test]
fn the_reading_of_paths_sees_nested_and_relative_ones() {
    let source = Source::new(
        Path::new("src/model/reduction/basis.rs"),
        &["model", "reduction", "basis"],
        "//! Text.\n\
         use crate::linalg::{Complex64, dense::{self, Lu as Factor}};\n\
         use super::super::cache;\n\
         // use crate::cli::nothing;\n\
         fn f() { let s = \"crate::cli\"; crate::report::f(super::blade::g::<u8>()) }\n\
         #[cfg(test)]\nmod tests { use crate::cli::Allowed; }\n",
    );
    let paths: Vec<String> = source.paths.iter().map(|path| path.join("::")).collect();
    assert_eq!(
        paths,
        [
            "linalg::Complex64",
            "linalg::dense",
            "linalg::dense::Lu",
            "model::cache",
            "report::f",
            "model::reduction::blade::g",
        ]
    );
}
