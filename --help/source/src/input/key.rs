//! One key of a TOML file, and how a key is found by a name that is near to it.

use strsim::damerau_levenshtein;

use super::Value;

/// What a file may say under one key.
#[derive(Debug, Clone, PartialEq)]
pub struct KeySpec {
    /// Full key, like `solver.peak_tolerance`.
    pub key: String,
    /// What it accepts.
    pub value: Value,
    /// Its default in words or as it would be written; none for a table.
    pub default: &'static str,
    /// Whether the file (or the table that it is in) must have it.
    pub required: bool,
    /// What it means, with its unit, in Markdown.
    pub meaning: &'static str,
}

/// A key as it stands in a table of the program.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) key: &'static str,
    pub(crate) value: Value,
    pub(crate) default: &'static str,
    pub(crate) meaning: &'static str,
}

/// Default of a key that must be there.
pub(crate) const REQUIRED: &str = "required";

/// A key with its value, default and meaning.
pub(crate) const fn entry(
    key: &'static str,
    value: Value,
    default: &'static str,
    meaning: &'static str,
) -> Entry {
    Entry {
        key,
        value,
        default,
        meaning,
    }
}

impl KeySpec {
    /// The key of a table's entry under its full name.
    pub(crate) fn new(entry: &Entry, key: String) -> Self {
        Self {
            key,
            value: entry.value,
            default: entry.default,
            required: entry.default == REQUIRED,
            meaning: entry.meaning,
        }
    }
}

/// The keys of `all` that `name` may be meant for: those that end in it, or else the nearest in spelling.
#[must_use]
pub fn nearest_key_names(all: &[KeySpec], name: &str) -> Vec<String> {
    let last = |key: &KeySpec| key.key.rsplit('.').next().unwrap_or_default().to_owned();
    let wanted = name.rsplit('.').next().unwrap_or_default();
    let same: Vec<String> = all
        .iter()
        .filter(|key| last(key) == wanted)
        .map(|key| key.key.clone())
        .collect();
    if !same.is_empty() {
        return same;
    }
    let distance = |key: &KeySpec| {
        damerau_levenshtein(name, &key.key).min(damerau_levenshtein(wanted, &last(key)))
    };
    let nearest = all.iter().min_by_key(|key| distance(key));
    nearest.map(|key| key.key.clone()).into_iter().collect()
}
