//! Circles of imports between files, with what a module offers by `pub use` taken to where it stands.

use std::collections::{BTreeMap, BTreeSet};

use super::paths::Source;
use super::{complain, source_files};

/// Circles that are still open, each by its files under `src/`. One that is broken up or smaller comes off this list.
const OPEN: &[&[&str]] = &[];

/// The files of a crate and what they name.
struct Crate<'a> {
    files: &'a [Source],
    by_module: BTreeMap<&'a [String], usize>,
}

impl<'a> Crate<'a> {
    fn new(files: &'a [Source]) -> Self {
        let modules = files.iter().enumerate();
        Self {
            by_module: modules
                .map(|(at, source)| (source.module.as_slice(), at))
                .collect(),
            files,
        }
    }

    /// The file in which what `path` names stands; none for what is outside the crate.
    fn file_of(&self, path: &[String]) -> Option<usize> {
        let longest = (1..=path.len()).rev();
        let module = { longest }.find(|&length| self.by_module.contains_key(&path[..length]))?;
        let file = self.by_module[&path[..module]];
        let Some(item) = path.get(module) else {
            return Some(file);
        };
        let offers = |offered: &&Vec<String>| {
            offered.len() > module + 1
                && offered[..module] == path[..module]
                && offered.last() == Some(item)
        };
        match self.files[file].paths.iter().find(offers) {
            Some(offered) => self.file_of(offered),
            None => Some(file),
        }
    }

    /// Which files every file names; a module that re-exports its children does not need them.
    fn edges(&self) -> Vec<BTreeSet<usize>> {
        let of_file = |(at, source): (usize, &Source)| {
            let is_child = |path: &&Vec<String>| path.starts_with(&source.module);
            let is_mod = source.name.ends_with("mod.rs");
            let named = source
                .paths
                .iter()
                .filter(|path| !(is_mod && is_child(path)));
            let files = named.filter_map(|path| self.file_of(path));
            files.filter(|&file| file != at).collect()
        };
        self.files.iter().enumerate().map(of_file).collect()
    }
}

/// Sets of files each of which names every other, directly or by others; the files under `src/`, without the folder.
fn circles(files: &[Source]) -> Vec<BTreeSet<String>> {
    let edges = Crate::new(files).edges();
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
        let circle: BTreeSet<String> = circle.map(|&other| name_of(&files[other])).collect();
        if circle.len() > 1 {
            found.insert(circle);
        }
    }
    found.into_iter().collect()
}

fn name_of(source: &Source) -> String {
    let name = source.name.replace('\\', "/");
    name.rsplit_once("/src/")
        .map_or(name.clone(), |(_, inside)| inside.to_owned())
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
        source("/src/a/mod.rs", &["a"], "mod one;\npub use one::One;\n"),
        source("/src/a/one.rs", &["a", "one"], "use crate::b::two;\n"),
        source("/src/b.rs", &["b"], "use crate::a::One;\nfn two() {}\n"),
        source("/src/c.rs", &["c"], "use crate::a::One;\n"),
    ];
    let expected: BTreeSet<String> = ["a/one.rs".to_owned(), "b.rs".to_owned()].into();
    assert_eq!(circles(&files), [expected]);
}
