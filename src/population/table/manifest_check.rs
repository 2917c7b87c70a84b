//! What a manifest may say. Its checksum tells that it is as it was written, not who wrote it.

use std::collections::BTreeMap;
use std::path::Path;

use super::places::{TABLES, is_digest};
use super::{Manifest, SCHEMA_VERSION, ScenarioEntry, TableError};

/// Amplitudes of tuned peaks are below it, m; what is computed with them then stays finite.
const MOST_AMPLITUDE_M: f64 = 1e100;
/// Frequencies of tuned peaks are below it, Hz.
const MOST_FREQUENCY_HZ: f64 = 1e30;

/// Checks that `tables`, which the file `path` lists, are those of a results folder.
pub(super) fn check_tables(
    path: &Path,
    tables: &BTreeMap<String, String>,
) -> Result<(), TableError> {
    for (name, digest) in tables {
        if !TABLES.contains(&name.as_str()) {
            let accepted = TABLES.join(", ");
            let reason = format!("it lists a table {name:?}; accepted: {accepted}");
            return Err(TableError::damaged(path, reason));
        }
        check_digest(path, name, digest)?;
    }
    Ok(())
}

/// Checks that what the file `path` lists as the digest of `name` is one.
pub(super) fn check_digest(path: &Path, name: &str, digest: &str) -> Result<(), TableError> {
    if is_digest(digest) {
        return Ok(());
    }
    let reason = format!("the digest of {name} is {digest:?}; accepted: 64 hexadecimal digits");
    Err(TableError::damaged(path, reason))
}

impl Manifest {
    /// Checks that it says what a run could have written into the file `path`.
    pub(super) fn check(&self, path: &Path) -> Result<(), TableError> {
        check_tables(path, &self.tables)?;
        match self.wrong() {
            Some(reason) => Err(TableError::damaged(path, reason)),
            None => Ok(()),
        }
    }

    /// The first thing that no run writes.
    fn wrong(&self) -> Option<String> {
        if self.schema != SCHEMA_VERSION {
            return Some(format!(
                "schema is {}; accepted: {SCHEMA_VERSION}",
                self.schema
            ));
        }
        let patterns = u64::from(u32::MAX);
        if !(1..=patterns).contains(&self.patterns) {
            return Some(format!(
                "patterns is {}; accepted: 1 to {patterns}",
                self.patterns
            ));
        }
        if let Some(shard) = self.shard.filter(|shard| !shard.is_of(self.patterns)) {
            let most = super::Shard::most(self.patterns);
            return Some(format!(
                "shard is {shard}; accepted: k/n with n up to {most} and k from 1 to n"
            ));
        }
        if let Some(stop) = &self.stop
            && !(stop.confidence > 0.0 && stop.confidence < 1.0)
        {
            return Some(format!(
                "stop.confidence is {}; accepted: above 0 and below 1",
                stop.confidence
            ));
        }
        if self.scenarios.is_empty() {
            return Some("it has no scenarios".to_owned());
        }
        let mut all = self.scenarios.iter().enumerate();
        all.find_map(|(index, entry)| wrong_of(index, entry))
    }
}

/// The first thing that no run writes of the scenario at `index`.
fn wrong_of(index: usize, entry: &ScenarioEntry) -> Option<String> {
    if entry.scenario != index {
        return Some(format!(
            "scenario {} stands in place {index}",
            entry.scenario
        ));
    }
    let numbers = [
        (
            "tuned_amplitude_m",
            entry.tuned_amplitude_m,
            MOST_AMPLITUDE_M,
        ),
        (
            "tuned_frequency_hz",
            entry.tuned_frequency_hz,
            MOST_FREQUENCY_HZ,
        ),
        (
            "tuned_slipping_fraction",
            entry.tuned_slipping_fraction,
            1.0,
        ),
        (
            "tuned_separated_fraction",
            entry.tuned_separated_fraction,
            1.0,
        ),
        ("standard_deviation", entry.standard_deviation, f64::MAX),
        ("normal_load_n", entry.contact.normal_load_n(), f64::MAX),
    ];
    numbers.into_iter().find_map(|(name, value, most)| {
        let value = value.filter(|value| !(0.0..=most).contains(value))?;
        Some(format!(
            "{name} of scenario {index} is {value:e}; accepted: 0 to {most:e}"
        ))
    })
}
