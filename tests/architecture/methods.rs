//! In how many files the methods of a type stand: those of a trait are not counted.

use std::collections::{BTreeMap, BTreeSet};

use super::paths::{Crate, Source};
use super::{complain, source_files};

/// Most files of the methods of one type.
const MOST_FILES: usize = 2;

/// Types whose methods still stand in more files: the file of the type under `src/`, its name, and how many files.
/// One that is brought together comes off this list, or has its number lowered.
const OPEN: &[(&str, &str, usize)] = &[];

/// A type, by its file under `src/` and its name.
type Type = (String, String);

/// `text` after the generic parameters that it may begin with.
fn after_generics(text: &str) -> &str {
    if !text.starts_with('<') {
        return text;
    }
    let mut depth = 0;
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        match c {
            '<' => depth += 1,
            '>' if before != '-' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return &text[at + 1..];
        }
        before = c;
    }
    ""
}

/// Paths of the types that have methods here, as written after `impl`.
fn with_methods(code: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut start = 0;
    for line in code.split_inclusive('\n') {
        let indented = line.len() - line.trim_start().len();
        let rest = &code[start + indented..];
        start += line.len();
        let Some(rest) = rest.strip_prefix("impl") else {
            continue;
        };
        if !rest.starts_with([' ', '<']) {
            continue;
        }
        let rest = after_generics(rest).trim_start();
        let head = rest.split(['{', ';']).next().unwrap_or(rest);
        let head = head.split("where").next().unwrap_or(head);
        if head.contains(" for ") {
            continue;
        }
        let end = head.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
        found.push(head[..end.unwrap_or(head.len())].to_owned());
    }
    found
}

/// The type that `source` calls `written`; none where its file cannot be told.
fn type_of(files: &Crate, source: &Source, written: &str) -> Option<Type> {
    let name = written.rsplit("::").next().unwrap_or(written);
    let is_here = ["struct", "enum", "union"].iter().any(|kind| {
        let word = format!("{kind} {name}");
        let mut places = source.code.match_indices(&word);
        places.any(|(at, _)| {
            let next = source.code[at + word.len()..].chars().next();
            !next.is_some_and(|c| c.is_alphanumeric() || c == '_')
        })
    });
    if is_here && written == name {
        return Some((source.inside(), name.to_owned()));
    }
    let mut named = source.paths.iter();
    let path = named.find(|path| path.last().is_some_and(|last| last == name))?;
    let file = &files.files[files.file_of(path)?];
    Some((file.inside(), name.to_owned()))
}

/// The files in which each type has methods; those whose file cannot be told stand under no file.
fn files_of_methods(files: &[Source]) -> BTreeMap<Type, BTreeSet<String>> {
    let own = Crate::new(files);
    let mut found: BTreeMap<Type, BTreeSet<String>> = BTreeMap::new();
    for source in files {
        for written in with_methods(&source.code) {
            let of = type_of(&own, source, &written).unwrap_or((String::new(), written));
            found.entry(of).or_default().insert(source.inside());
        }
    }
    found
}

/// What `open` does not list of the types with methods in too many files, and what it lists that is so no more.
fn unlisted_and_gone(
    found: &BTreeMap<Type, BTreeSet<String>>,
    open: &[(&str, &str, usize)],
) -> [Vec<String>; 2] {
    let listed = |(file, name): &Type| {
        let own = open.iter().find(|own| own.0 == file && own.1 == name);
        own.map(|own| own.2)
    };
    let too_many = |files: &BTreeSet<String>| files.len() > MOST_FILES;
    let unlisted = found
        .iter()
        .filter(|(of, files)| too_many(files) && listed(of).is_none_or(|most| files.len() > most));
    let gone = open.iter().filter(|(file, name, count)| {
        let files = found.get(&((*file).to_owned(), (*name).to_owned()));
        files.is_none_or(|files| !too_many(files) || files.len() < *count)
    });
    [
        unlisted
            .map(|((file, name), files)| format!("{name} of {file}: {files:?}"))
            .collect(),
        gone.map(|own| format!("{own:?}")).collect(),
    ]
}

#[test]
fn methods_of_a_type_stand_in_at_most_two_files() {
    let found = files_of_methods(&source_files());
    assert!(found.len() > 100, "only {} types were found", found.len());
    let unknown = found.iter().filter(|((file, _), _)| file.is_empty());
    let unknown: Vec<String> = unknown.map(|own| format!("{own:?}")).collect();
    complain("a type has methods, and its file is not seen", &unknown);
    let [unlisted, gone] = unlisted_and_gone(&found, OPEN);
    complain("methods of a type stand in more files than two", &unlisted);
    complain(
        "a listed type has its methods in fewer files: lower its number or take it off the list",
        &gone,
    );
}

#[test]
fn scattered_methods_are_seen_and_types_of_one_name_told_apart() {
    let source = |name: &str, module: &[&str], text: &str| {
        Source::new(std::path::Path::new(name), module, text)
    };
    let files = [
        source("/src/a/mod.rs", &["a"], "mod one;\npub use one::One;\n"),
        source(
            "/src/a/one.rs",
            &["a", "one"],
            "pub struct One<F>(F);\nimpl<F: Fn(u8) -> u8> One<F> {}\nimpl Clone for One<u8> {}\n",
        ),
        source(
            "/src/b.rs",
            &["b"],
            "use crate::a::One;\nimpl One<u8> {}\n// impl Two {}\n",
        ),
        source(
            "/src/c.rs",
            &["c"],
            "impl<F> crate::a::One<F>\nwhere\n    F: Fn(),\n{}\n",
        ),
        // Another type of this name, and a trait.
        source(
            "/src/d.rs",
            &["d"],
            "struct One;\nimpl One {}\nuse crate::a::One as Other;\nimpl Seen for Other {}\n",
        ),
    ];
    let found = files_of_methods(&files);
    let one: Type = ("a/one.rs".to_owned(), "One".to_owned());
    let in_files: BTreeSet<String> = ["a/one.rs", "b.rs", "c.rs"].map(str::to_owned).into();
    assert_eq!(found[&one], in_files);
    assert_eq!(found.len(), 2, "{found:?}");
    let counts =
        |open: &[(&str, &str, usize)]| unlisted_and_gone(&found, open).map(|own| own.len());
    assert_eq!(counts(&[]), [1, 0]);
    assert_eq!(counts(&[("a/one.rs", "One", 3)]), [0, 0]);
    // A number too large or too small, a type with few files, and one that is not there.
    assert_eq!(counts(&[("a/one.rs", "One", 4)]), [0, 1]);
    assert_eq!(counts(&[("a/one.rs", "One", 2)]), [1, 0]);
    let others = [
        ("a/one.rs", "One", 3),
        ("d.rs", "One", 1),
        ("e.rs", "Two", 3),
    ];
    assert_eq!(counts(&others), [0, 2]);
}
