//! Every filter of `cargo test` or `.ci/long` that a page shows names a test that is there.

use std::path::Path;

use super::complain;
use super::links::pages;

/// A documented run of tests: the test program, none for those of the library or of all programs, and the filter.
type Run = (Option<String>, String);

/// The runs of tests with a filter in the lines and code of a page.
fn runs(page: &str) -> Vec<Run> {
    let flowing = page.replace('\n', " ");
    let spans = flowing.split('`').skip(1).step_by(2);
    let lines = page.lines().chain(spans);
    lines.filter_map(run).collect()
}

fn run(line: &str) -> Option<Run> {
    let line = line.split("  #").next()?.trim();
    if let Some(filter) = line.strip_prefix(".ci/long ") {
        let filter = filter.split_whitespace().next()?;
        let is_open = filter.chars().all(|letter| letter.is_ascii_uppercase());
        return (!is_open).then(|| (None, filter.to_owned()));
    }
    let mut words = line.strip_prefix("cargo test ")?.split_whitespace();
    let (mut program, mut filter) = (None, None);
    while let Some(word) = words.next() {
        match word {
            "--test" => program = words.next(),
            option if option.starts_with('-') => {}
            name => filter = filter.or(Some(name)),
        }
    }
    Some((program.map(str::to_owned), filter?.to_owned()))
}

/// Names of functions under a folder after those of their folders and files, as `folder::file::function`.
fn names(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            names(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let file = path.with_extension("").display().to_string();
            let file = file.replace(std::path::MAIN_SEPARATOR, "::");
            let text = std::fs::read_to_string(&path).unwrap();
            let functions = text.lines().filter_map(|line| {
                let rest = line.trim_start().trim_start_matches("async ");
                rest.strip_prefix("fn ")?.split(['(', '<']).next()
            });
            found.extend(functions.map(|function| format!("{file}::{function}")));
        }
    }
}

fn is_found((program, filter): &Run, root: &Path) -> bool {
    let mut found = Vec::new();
    let folders = match program {
        Some(program) => vec![root.join("tests").join(program)],
        None => vec![root.join("tests"), root.join("src")],
    };
    for folder in folders.iter().filter(|folder| folder.is_dir()) {
        names(folder, &mut found);
    }
    found.iter().any(|name| name.contains(filter.as_str()))
}

#[test]
fn documented_filters_name_tests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    let mut wrong = Vec::new();
    for path in pages(root) {
        for run in runs(&std::fs::read_to_string(&path).unwrap()) {
            count += 1;
            if !is_found(&run, root) {
                wrong.push(format!("{}: {run:?}", path.display()));
            }
        }
    }
    complain("filters that name no test", &wrong);
    assert!(count > 20, "{count}");
}

#[test]
fn a_filter_without_a_test_is_seen() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = "See `cargo test --release --test architecture a_filter_without -- --nocapture`.\n\n    \
                cargo test --release --test architecture no_such_test_here -- --ignored\n    \
                .ci/long no_such_test_either\n";
    let runs = runs(page);
    assert_eq!(runs.len(), 3, "{runs:?}");
    let found: Vec<bool> = runs.iter().map(|run| is_found(run, root)).collect();
    // This file holds the names as text alone; none is a function.
    assert_eq!(found.iter().filter(|found| **found).count(), 1, "{runs:?}");
}
