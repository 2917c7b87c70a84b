//! One key of a study file, and how keys are found.

use strsim::damerau_levenshtein;

use super::Value;
use super::contact_keys::CONTACT_KEYS;
use super::model_keys::MODEL_KEYS;
use super::study_keys::{LEADING_KEYS, REDUCTION_KEYS, STUDY_KEYS};

/// Parameters that `[contact.variation]` can let vary.
const CONTACT_PARAMETERS: [&str; 4] = [
    "friction_coefficient",
    "tangential_stiffness",
    "normal_stiffness",
    "normal_load",
];

/// What a study file may say under one key.
#[derive(Debug, Clone, PartialEq)]
pub struct KeySpec {
    /// Full key, like `solver.peak_tolerance`.
    pub key: String,
    /// What it accepts.
    pub value: Value,
    /// Its default in words or as it would be written; none for a table.
    pub default: &'static str,
    /// Whether a study (or the table that it is in) must have it.
    pub required: bool,
    /// What it means, with its unit, in the Markdown of docs/study-file.md.
    pub meaning: &'static str,
}

/// A key as it stands in the tables of this module. `*` in its name stands for each contact parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) key: &'static str,
    pub(super) value: Value,
    pub(super) default: &'static str,
    pub(super) meaning: &'static str,
}

/// Default of a key that must be there.
pub(super) const REQUIRED: &str = "required";

/// A key with its value, default and meaning.
pub(super) const fn entry(
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

/// Every key in the order of docs/study-file.md.
#[must_use]
pub fn keys() -> Vec<KeySpec> {
    let of = |entry: &Entry, key: String| KeySpec {
        key,
        value: entry.value,
        default: entry.default,
        required: entry.default == REQUIRED,
        meaning: entry.meaning,
    };
    let entries = [
        LEADING_KEYS,
        MODEL_KEYS,
        REDUCTION_KEYS,
        CONTACT_KEYS,
        STUDY_KEYS,
    ]
    .concat();
    let stretches = entries.chunk_by(|a, b| a.key.contains('*') == b.key.contains('*'));
    let mut keys = Vec::new();
    for stretch in stretches {
        let names: &[&str] = if stretch[0].key.contains('*') {
            &CONTACT_PARAMETERS
        } else {
            &[""]
        };
        for name in names {
            let named = stretch
                .iter()
                .map(|entry| of(entry, entry.key.replace('*', name)));
            keys.extend(named);
        }
    }
    keys
}

/// The key `name` and all below it; all keys for an empty name.
#[must_use]
pub fn keys_below(name: &str) -> Vec<KeySpec> {
    let below = format!("{name}.");
    keys()
        .into_iter()
        .filter(|key| name.is_empty() || key.key == name || key.key.starts_with(&below))
        .collect()
}

/// The keys that `name` may be meant for: those that end in it, or else the nearest in spelling.
#[must_use]
pub fn nearest_keys(name: &str) -> Vec<String> {
    let all = keys();
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
