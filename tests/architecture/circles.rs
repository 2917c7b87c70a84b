//! Circles of imports between files, with what a module offers by `pub use` taken to where it stands.

use std::collections::BTreeSet;

use super::paths::{Crate, Source};
use super::{complain, source_files};

/// Circles that are still open, each by its files under `src/`. One that is broken up or smaller comes off this list.
const OPEN: &[&[&str]] = &[];

/// Which files every file names; a module that re-exports its children does not need them.
fn edges(files: &[Source]) -> Vec<BTreeSet<usize>> {
    let own = Crate::new(files);
    let of_file = |(at, source): (usize, &Source)| {
        let is_child = |path: &&Vec<String>| path.starts_with(&source.module);
        let is_mod = source.name.ends_with("mod.rs");
        let named = source
            .paths
            .iter()
            .filter(|path| !(is_mod && is_child(path)));
        let files = named.filter_map(|path| own.file_of(path));
        files.filter(|&file| file != at).collect()
    };
    files.iter().enumerate().map(of_file).collect()
}

/// Sets of files each of which names every other, directly or by others; the files under `src/`, without the folder.
fn circles(files: &[Source]) -> Vec<BTreeSet<String>> {
    let edges = edges(files);
    let reached = |from: usize| -> BTreeSet<usize> {
        let mut seen = BTreeSet::new();
        let mut next: Vec<usize> = edges[from].iter().copied().collect();
        while let Some(file) = next.pop() {
            if seen.insert(file) {
                next.extend(&edges[file]);
            }
        }
        seen
    };
    let reached: Vec<BTreeSet<usize>> = (0..files.len()).map(reached).collect();
    let mut found: BTreeSet<BTreeSet<String>> = BTreeSet::new();
    for (file, others) in reached.iter().enumerate() {
        let circle = others
            .iter()
            .filter(|&&other| reached[other].contains(&file));
        let circle: BTreeSet<String> = circle.map(|&other| files[other].inside()).collect();
        if circle.len() > 1 {
            found.insert(circle);
        }
    }
    found.into_iter().collect()
}

#[test]
fn no_file_names_one_that_names_it() {
    let found = circles(&source_files());
    let open: Vec<BTreeSet<String>> = OPEN
        .iter()
        .map(|circle| circle.iter().map(|&file| file.to_owned()).collect())
        .collect();
    let listed = |circle: &BTreeSet<String>| open.contains(circle);
    let text = |circle: &BTreeSet<String>| format!("{circle:?}");
    let new: Vec<String> = found.iter().filter(|own| !listed(own)).map(text).collect();
    complain(
        "files name one another in a circle that is not listed",
        &new,
    );
    let gone: Vec<String> = open
        .iter()
        .filter(|own| !found.contains(own))
        .map(text)
        .collect();
    complain(
        "a listed circle is gone or smaller: take it off the list",
        &gone,
    );
}

#[test]
fn a_planted_circle_is_seen_through_what_a_module_offers() {
    let source = |name: &str, module: &[&str], text: &str| {
        Source::new(std::path::Path::new(name), module, text)
    };
    let files = [
        source(
            "/src/a/mod.rs",
            &["a"],
            "mod one;\npub use one::One;\nmod other;\npub(crate) use other::Other;\n",
        ),
        source("/src/a/other.rs", &["a", "other"], "use crate::d::four;\n"),
        source("/src/d.rs", &["d"], "use crate::a::Other;\nfn four() {}\n"),
        source("/src/a/one.rs", &["a", "one"], "use crate::b::two;\n"),
        source("/src/b.rs", &["b"], "use crate::a::One;\nfn two() {}\n"),
        source("/src/c.rs", &["c"], "use crate::a::One;\n"),
    ];
    let expected: BTreeSet<String> = ["a/one.rs".to_owned(), "b.rs".to_owned()].into();
    let within: BTreeSet<String> = ["a/other.rs".to_owned(), "d.rs".to_owned()].into();
    assert_eq!(circles(&files), [expected, within]);
}
