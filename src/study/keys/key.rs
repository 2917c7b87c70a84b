//! The keys of a study file, and how they are found.

use std::sync::LazyLock;

use super::study_file::StudyFile;
use crate::input::{KeySpec, all_keys, mentions, nearest_key_names};

static KEYS: LazyLock<Vec<KeySpec>> = LazyLock::new(|| all_keys(StudyFile::KEYS));

/// Every key in the order of docs/study-file.md.
#[must_use]
pub fn keys() -> Vec<KeySpec> {
    KEYS.clone()
}

/// The key of a study file at `place`, which may be in a list of tables: `excitation.load_case[1].name`.
pub(in crate::study) fn study_key(place: &str) -> Option<&'static KeySpec> {
    let steps = place.split('.');
    let names: Vec<&str> = steps
        .map(|step| step.split('[').next().unwrap_or(step))
        .collect();
    let name = names.join(".");
    KEYS.iter().find(|key| key.key == name)
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

/// The keys whose name or meaning has every one of `words`, in any case of letters.
#[must_use]
pub fn keys_about(words: &str) -> Vec<KeySpec> {
    keys()
        .into_iter()
        .filter(|key| {
            mentions(&[&key.key, key.meaning], words)
                || key.accepted().contains(&format!("\"{words}\""))
        })
        .collect()
}

/// The keys that `name` may be meant for: those that end in it or have it, or else the nearest in spelling; none where no key
/// is near.
#[must_use]
pub fn nearest_keys(name: &str) -> Vec<String> {
    nearest_key_names(&KEYS, name)
}
