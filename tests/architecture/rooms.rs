//! Folders below the wings: how many files one holds, the order of its rooms, and what still ties settings to a study file.

use std::collections::{BTreeMap, BTreeSet};

use super::paths::{Crate, Source};
use super::{complain, source_files};

/// Most source files that stand in one folder, those of folders inside of it not counted.
const MOST_FILES: usize = 30;

/// Folders whose own files stand before their rooms, each with its rooms in order.
pub const ROOMS: &[(&[&str], &[&str])] = &[
    (
        &["response", "harmonic_balance"],
        &["pairs", "equation", "solver", "follow"],
    ),
    (&["study"], &["keys", "checks"]),
    (&["settings"], &["ladder", "accuracy", "engines"]),
];

/// Files under `src/settings` that still name the study file: numbers are to be chosen for a problem, whoever states it.
/// One that names it no more comes off this list. When the list is empty, `settings` stands before `study` in the order.
const NAME_THE_STUDY: &[&str] = &[
    "settings/accuracy/accuracy_choice.rs",
    "settings/accuracy/chosen_settings.rs",
    "settings/accuracy/receptance_accuracy.rs",
    "settings/accuracy/receptance_setting.rs",
    "settings/basis_choice.rs",
    "settings/engines/accurate_engine.rs",
    "settings/engines/engine.rs",
    "settings/engines/reduced_engine.rs",
    "settings/fixed_interface.rs",
    "settings/full_model.rs",
    "settings/harmonics_on_basis.rs",
    "settings/ladder/bench.rs",
    "settings/ladder/cost.rs",
    "settings/ladder/reference.rs",
    "settings/ladder/sample.rs",
    "settings/ladder/search.rs",
    "settings/ladder/setting.rs",
    "settings/harmonics_on_receptances.rs",
    "settings/receptances_of_basis.rs",
    "settings/reduced_study.rs",
    "settings/row_settings.rs",
    "settings/tuned_receptances.rs",
];

/// Files directly in each folder under `src/`.
fn counts(files: &[Source]) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for source in files {
        let inside = source.inside();
        let folder = inside.rsplit_once('/').map_or("", |(folder, _)| folder);
        *counts.entry(folder.to_owned()).or_default() += 1;
    }
    counts
}

/// Folders with more files than [`MOST_FILES`].
fn overfull(files: &[Source]) -> Vec<String> {
    let counts = counts(files).into_iter();
    counts
        .filter(|(_, count)| *count > MOST_FILES)
        .map(|(folder, count)| format!("src/{folder}: {count} files"))
        .collect()
}

/// Files of `folder` that name one of its rooms after their own; a file that stands in no room is before them all.
fn against_the_order(files: &[Source], folder: &[&str], rooms: &[&str]) -> Vec<String> {
    let own = Crate::new(files);
    let place = |module: &[String]| {
        let inside = module.len() > folder.len() && folder.iter().zip(module).all(|(a, b)| a == b);
        let room = module.get(folder.len()).filter(|_| inside)?;
        Some(
            rooms
                .iter()
                .position(|name| name == room)
                .map_or(0, |at| at + 1),
        )
    };
    let mut violations = Vec::new();
    for source in files {
        let Some(from) = place(&source.module) else {
            continue;
        };
        for path in &source.paths {
            let named = own.file_of(path).map(|at| &files[at].module);
            if named.and_then(|module| place(module)) > Some(from) {
                violations.push(format!("{}: {}", source.inside(), path.join("::")));
            }
        }
    }
    violations
}

/// Files of the wing `from` that name the wing `to`.
fn naming(files: &[Source], from: &str, to: &str) -> BTreeSet<String> {
    let of_wing = files
        .iter()
        .filter(|source| source.module.first().is_some_and(|wing| wing == from));
    let names = |source: &&Source| {
        let mut wings = source.paths.iter().filter_map(|path| path.first());
        wings.any(|wing| wing == to)
    };
    of_wing.filter(names).map(Source::inside).collect()
}

#[test]
fn no_folder_holds_more_than_thirty_files() {
    complain("a folder is to be divided", &overfull(&source_files()));
}

#[test]
fn inside_a_folder_a_room_names_only_those_before_it() {
    let files = source_files();
    let of = |(folder, rooms): &(&[&str], &[&str])| against_the_order(&files, folder, rooms);
    let violations: Vec<String> = ROOMS.iter().flat_map(of).collect();
    complain("a room names one that stands after it", &violations);
    for (folder, rooms) in ROOMS {
        for room in *rooms {
            let path: Vec<&str> = folder.iter().chain([room]).copied().collect();
            let is_there = files.iter().any(|source| source.module == path);
            assert!(is_there, "{path:?} is in the order and not under src/");
        }
    }
}

#[test]
fn the_files_of_settings_that_name_the_study_file_are_listed() {
    let found = naming(&source_files(), "settings", "study");
    let listed: BTreeSet<String> = NAME_THE_STUDY.iter().map(|&file| file.to_owned()).collect();
    let of = |names: BTreeSet<String>| names.into_iter().collect::<Vec<_>>();
    complain(
        "a file of settings names the study file and is not listed",
        &of(&found - &listed),
    );
    complain(
        "a listed file names the study file no more: take it off the list",
        &of(&listed - &found),
    );
}

#[test]
fn an_overfull_folder_and_a_room_out_of_order_are_seen() {
    let source = |name: &str, module: &[&str], text: &str| {
        Source::new(std::path::Path::new(name), module, text)
    };
    let many: Vec<Source> = (0..=MOST_FILES)
        .map(|number| source(&format!("/src/a/f{number}.rs"), &["a", "f"], ""))
        .chain([source("/src/a/b/one.rs", &["a", "b", "one"], "")])
        .collect();
    assert_eq!(overfull(&many), ["src/a: 31 files"]);
    assert!(overfull(&many[1..]).is_empty());

    let files = [
        source("/src/a/mod.rs", &["a"], "mod c;\npub use c::Late;\n"),
        source("/src/a/top.rs", &["a", "top"], "use super::b::f;\n"),
        source("/src/a/b/mod.rs", &["a", "b"], "mod one;\n"),
        // Through what the folder offers, and by its place.
        source(
            "/src/a/b/one.rs",
            &["a", "b", "one"],
            "use crate::a::Late;\nuse crate::a::top;\n",
        ),
        source(
            "/src/a/c/mod.rs",
            &["a", "c"],
            "mod two;\npub use two::Late;\n",
        ),
        source(
            "/src/a/c/two.rs",
            &["a", "c", "two"],
            "use crate::a::b::f;\n",
        ),
        source("/src/d.rs", &["d"], "use crate::a::c;\n"),
    ];
    let expected = ["a/top.rs: a::b::f", "a/b/one.rs: a::Late"];
    assert_eq!(against_the_order(&files, &["a"], &["b", "c"]), expected);
    let named: BTreeSet<String> = ["d.rs".to_owned()].into();
    assert_eq!(naming(&files, "d", "a"), named);
    assert!(naming(&files, "a", "d").is_empty());
}
