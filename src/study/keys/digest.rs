//! Digest of everything in a study that can change a number.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use super::study_key;
use crate::identity;
use crate::identity::bytes_of;
use crate::input::Effect;
use crate::population::monte_carlo::Scenario;
use crate::population::table::digest_file;
use crate::study::{ForceSource, MistuningSource, ModelSource, Study, StudyError};

/// What the digest of a study is made from, and the digest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyDigest {
    /// Every key that can change a number, by its full name; values as compact JSON.
    pub number_keys: BTreeMap<String, String>,
    /// Digests of the input files, by path as written in the study.
    pub inputs: BTreeMap<String, String>,
}

/// Whether `key` of a resolved study, or a table that it is in, is declared to have this effect. What is no key, like the version of the
/// program, changes every number.
fn has_effect(key: &str, effect: Effect) -> bool {
    study_key(key).is_some_and(|spec| spec.effect == effect)
}

impl StudyDigest {
    /// The digest of `study`, its input files included.
    ///
    /// # Errors
    /// An input file cannot be read.
    pub fn of(study: &Study) -> Result<Self, StudyError> {
        let inputs = input_digests(study)?;
        let mut number_keys = BTreeMap::new();
        let mut resolved = study.resolved();
        without_places(&mut resolved);
        flatten("", &resolved, &mut number_keys);
        number_keys.retain(|key, _| !has_effect(key, Effect::None));
        number_keys.insert("version".to_owned(), identity::VERSION.to_owned());
        // The content of an input and its role count, not where it lies.
        for (name, digest) in &inputs {
            let of_load_case = study.load_cases.iter().filter(|case| match &case.force {
                ForceSource::File { written, .. } => written == name,
                _ => false,
            });
            let mut roles: Vec<String> = of_load_case
                .map(|case| format!("excitation.load_case/{}", case.name))
                .collect();
            let in_bundle = match &study.model {
                ModelSource::Bundle { written, .. } => name.strip_prefix(&format!("{written}/")),
                _ => None,
            };
            roles.extend(in_bundle.map(|file| format!("model.bundle/{file}")));
            if roles.is_empty() {
                roles.push("mistuning.file".to_owned());
            }
            for role in roles {
                number_keys.insert(format!("input {role}"), digest.clone());
            }
        }
        Ok(Self {
            number_keys,
            inputs,
        })
    }

    /// The digest, hexadecimal.
    #[must_use]
    pub fn hex(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for (key, value) in &self.number_keys {
            hasher.update(format!("{key} = {value}\n").as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// Digest, hexadecimal, of what the rows of `scenario` are made from: the keys that every row
    /// depends on, those of the scenario, and what the engine was built from.
    #[must_use]
    pub fn of_rows(&self, scenario: &Scenario, engine: &str) -> String {
        let mut hasher = blake3::Hasher::new();
        for (key, value) in &self.number_keys {
            if !has_effect(key, Effect::Scenarios) {
                hasher.update(format!("{key} = {value}\n").as_bytes());
            }
        }
        let keys = (
            scenario.engine_order,
            scenario.standard_deviation,
            scenario.contact,
            &scenario.load_case,
        );
        hasher.update(&bytes_of(&(keys, engine)));
        hasher.finalize().to_hex().to_string()
    }

    /// Keys whose values differ from those of another study: `(key, other, this)`.
    #[must_use]
    pub fn differences(&self, other: &BTreeMap<String, String>) -> Vec<(String, String, String)> {
        let absent = || "(absent)".to_owned();
        let keys: std::collections::BTreeSet<&String> =
            self.number_keys.keys().chain(other.keys()).collect();
        keys.into_iter()
            .map(|key| {
                let theirs = other.get(key).cloned().unwrap_or_else(absent);
                let ours = self.number_keys.get(key).cloned().unwrap_or_else(absent);
                (key.clone(), theirs, ours)
            })
            .filter(|(_, theirs, ours)| theirs != ours)
            .collect()
    }
}

/// Takes the places of the force files out of a list, whose members have no names of their own.
fn without_places(resolved: &mut Value) {
    let cases = resolved.pointer_mut("/excitation/load_case");
    let cases = cases.and_then(Value::as_array_mut);
    for case in cases.into_iter().flatten() {
        if let Some(force) = case.get_mut("force") {
            *force = Value::from("file");
        }
    }
}

fn flatten(path: &str, value: &Value, into: &mut BTreeMap<String, String>) {
    match value {
        Value::Object(fields) => {
            for (key, field) in fields {
                let full = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                flatten(&full, field, into);
            }
        }
        other => {
            into.insert(path.to_owned(), other.to_string());
        }
    }
}

fn input_digests(study: &Study) -> Result<BTreeMap<String, String>, StudyError> {
    let mut inputs = BTreeMap::new();
    let mut add = |written: String, path: &Path| -> Result<(), StudyError> {
        let digest = digest_file(path).map_err(|source| StudyError::Input {
            path: path.to_owned(),
            source,
        })?;
        inputs.insert(written, digest);
        Ok(())
    };
    if let ModelSource::Bundle { written, path } = &study.model {
        let header = path.join("model.toml");
        add(format!("{written}/model.toml"), &header)?;
        for file in files_of_bundle(&header) {
            add(format!("{written}/{file}"), &path.join(&file))?;
        }
    }
    for case in &study.load_cases {
        if let ForceSource::File { written, path } = &case.force {
            add(written.clone(), path)?;
        }
    }
    if let MistuningSource::File { written, path, .. } = &study.mistuning.source {
        add(written.clone(), path)?;
    }
    Ok(inputs)
}

/// Files that the header of a bundle names; a header that is no TOML is reported by its reader.
fn files_of_bundle(header: &Path) -> Vec<String> {
    let table: Option<toml::Table> = std::fs::read_to_string(header)
        .ok()
        .and_then(|text| toml::from_str(&text).ok());
    table
        .as_ref()
        .and_then(|table| table.get("files"))
        .and_then(toml::Value::as_table)
        .map(|files| {
            files
                .values()
                .filter_map(|file| file.as_str().map(str::to_owned))
                .collect()
        })
        .unwrap_or_default()
}
