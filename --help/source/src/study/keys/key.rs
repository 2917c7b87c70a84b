//! The keys of a study file, and how they are found.

use super::contact_keys::CONTACT_KEYS;
use super::model_keys::MODEL_KEYS;
use super::study_keys::{LEADING_KEYS, REDUCTION_KEYS, STUDY_KEYS};
use crate::input::mentions;
use crate::input::{KeySpec, nearest_key_names};

/// Parameters that `[contact.variation]` can let vary.
const CONTACT_PARAMETERS: [&str; 4] = [
    "friction_coefficient",
    "tangential_stiffness",
    "normal_stiffness",
    "normal_load",
];

/// Every key in the order of docs/study-file.md.
#[must_use]
pub fn keys() -> Vec<KeySpec> {
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
                .map(|entry| KeySpec::new(entry, entry.key.replace('*', name)));
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

/// The keys whose name or meaning has every one of `words`, in any case of letters.
#[must_use]
pub fn keys_about(words: &str) -> Vec<KeySpec> {
    keys()
        .into_iter()
        .filter(|key| mentions(&[&key.key, key.meaning], words))
        .collect()
}

/// The keys that `name` may be meant for: those that end in it, or else the nearest in spelling.
#[must_use]
pub fn nearest_keys(name: &str) -> Vec<String> {
    nearest_key_names(&keys(), name)
}
