//! `manifest.json`: what a results folder holds and what it was made from; and `runs/<n>.json`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::checked_json::{read_checked_json, write_checked_json};
use super::places::{check_tables, is_folder};
use super::{MANIFEST, SCHEMA_VERSION, TableError};
use crate::population::monte_carlo::{LoadCaseName, Scenario, TunedReference};
use crate::population::statistics::{Accounting, ScenarioStability, StopOutcome};
use crate::response::forced_response::{ContactCondition, ErrorEstimate};
use crate::response::harmonic_balance::Status;

/// Amplitudes of tuned peaks are below it, m; what is computed with them then stays finite.
const MOST_AMPLITUDE_M: f64 = 1e100;
/// Frequencies of tuned peaks are below it, Hz.
const MOST_FREQUENCY_HZ: f64 = 1e30;
/// Name of the folder of the records of runs.
pub(super) const RUNS: &str = "runs";

/// Whether a results folder is complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunState {
    /// Rows may be missing; the same command continues.
    Running,
    /// Every row is there.
    Finished,
}

/// Rows by status, as [`Accounting`] counts them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct StatusCounts {
    /// All rows.
    pub planned: u64,
    /// Rows that are `ok`.
    pub ok: u64,
    /// Rows of every other status.
    pub failed: u64,
    /// Rows by status, those that are not zero.
    pub by_status: BTreeMap<String, u64>,
}

impl From<&Accounting> for StatusCounts {
    fn from(accounting: &Accounting) -> Self {
        Self {
            planned: accounting.planned(),
            ok: accounting.ok(),
            failed: accounting.failed(),
            by_status: accounting
                .by_status()
                .into_iter()
                .map(|(status, count)| (status.to_owned(), count))
                .collect(),
        }
    }
}

/// One scenario in the manifest: keys, tuned reference, counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScenarioEntry {
    /// Index.
    pub scenario: usize,
    /// Load case; absent: the study has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_case: Option<LoadCaseName>,
    /// Engine order.
    pub engine_order: u32,
    /// Standard deviation, if the study has one.
    pub standard_deviation: Option<f64>,
    /// Contact condition.
    pub contact: ContactCondition,
    /// How the tuned solution ended.
    pub tuned_status: Status,
    /// Tuned peak amplitude, m.
    pub tuned_amplitude_m: Option<f64>,
    /// Tuned peak frequency, Hz.
    pub tuned_frequency_hz: Option<f64>,
    /// Share of pairs that slip at the tuned peak.
    pub tuned_slipping_fraction: Option<f64>,
    /// Share of pairs that separate at the tuned peak.
    pub tuned_separated_fraction: Option<f64>,
    /// Harmonic set of the tuned solution and of the rows.
    pub harmonics: String,
    /// Errors of the tuned solution at its peak.
    pub tuned_errors: Option<ErrorEstimate>,
    /// Digest of what the rows are made from.
    pub row_digest: String,
    /// Rows by status.
    pub counts: StatusCounts,
    /// What is known of the stability of its motions; absent: none was looked at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<ScenarioStability>,
}

impl ScenarioEntry {
    /// The entry of a scenario.
    #[must_use]
    pub fn new(
        scenario: &Scenario,
        tuned: &TunedReference,
        row_digest: &str,
        accounting: &Accounting,
    ) -> Self {
        Self {
            scenario: scenario.index,
            load_case: scenario.load_case,
            engine_order: scenario.engine_order,
            standard_deviation: scenario.standard_deviation,
            contact: scenario.contact,
            tuned_status: tuned.status,
            tuned_amplitude_m: tuned.amplitude_m,
            tuned_frequency_hz: tuned.frequency_hz,
            tuned_slipping_fraction: tuned.slipping_fraction,
            tuned_separated_fraction: tuned.separated_fraction,
            harmonics: tuned.harmonics.clone(),
            tuned_errors: tuned.errors,
            row_digest: row_digest.to_owned(),
            counts: accounting.into(),
            stability: None,
        }
    }

    /// Its keys.
    #[must_use]
    pub fn keys(&self) -> Scenario {
        Scenario {
            index: self.scenario,
            load_case: self.load_case,
            engine_order: self.engine_order,
            standard_deviation: self.standard_deviation,
            contact: self.contact,
        }
    }

    /// Its tuned reference.
    #[must_use]
    pub fn tuned(&self) -> TunedReference {
        TunedReference {
            scenario: self.scenario,
            status: self.tuned_status,
            amplitude_m: self.tuned_amplitude_m,
            frequency_hz: self.tuned_frequency_hz,
            separated_fraction: self.tuned_separated_fraction,
            slipping_fraction: self.tuned_slipping_fraction,
            harmonics: self.harmonics.clone(),
            errors: self.tuned_errors,
        }
    }
}

/// Shards of a study at most, each a folder and a task.
const MOST_SHARDS: u32 = 100_000;

/// One of `count` shares of the patterns of a study, cut by their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Which one, from 1.
    pub number: u32,
    /// How many there are.
    pub count: u32,
}

impl Shard {
    /// Whether there is such a share of `patterns` patterns.
    #[must_use]
    pub fn is_of(self, patterns: u64) -> bool {
        (1..=self.count).contains(&self.number) && u64::from(self.count) <= Self::most(patterns)
    }

    /// Shards that `patterns` patterns can be cut into at most.
    #[must_use]
    pub fn most(patterns: u64) -> u64 {
        patterns.min(u64::from(MOST_SHARDS))
    }

    /// The patterns of this shard among all `ids`.
    #[must_use]
    pub fn of(self, ids: &[u32]) -> &[u32] {
        &ids[self.cut(self.number - 1, ids.len())..self.cut(self.number, ids.len())]
    }

    /// Number of its patterns of `patterns` in all.
    #[must_use]
    pub fn size(self, patterns: usize) -> usize {
        self.cut(self.number, patterns) - self.cut(self.number - 1, patterns)
    }

    fn cut(self, number: u32, patterns: usize) -> usize {
        (patterns as u64 * u64::from(number) / u64::from(self.count)) as usize
    }

    /// The shard whose folder this is by its name.
    #[must_use]
    pub fn of_folder(folder: &Path) -> Option<Self> {
        let (number, count) = folder.file_name()?.to_str()?.split_once("-of-")?;
        let shard = Self {
            number: number.parse().ok()?,
            count: count.parse().ok()?,
        };
        shard.is_of(u64::from(MOST_SHARDS)).then_some(shard)
    }

    /// Name of its folder.
    #[must_use]
    pub fn folder_name(self) -> String {
        format!("{}-of-{}", self.number, self.count)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

/// Content of `manifest.json`. The same study gives the same bytes on every machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the tables and of this file.
    pub schema: u32,
    /// Version of the program.
    pub version: String,
    /// Identity of the build that solved the rows; empty in results of 0.1.0.
    #[serde(default)]
    pub build: String,
    /// Whether the folder is complete.
    pub state: RunState,
    /// Name of the study.
    pub name: String,
    /// Digest of everything that can change a number.
    pub study_digest: String,
    /// Seed of the patterns.
    pub seed: u64,
    /// Random number generator.
    pub generator: String,
    /// Number of patterns.
    pub patterns: u64,
    /// What the stopping rule of a finished study came to; absent: it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<StopOutcome>,
    /// The share of the patterns that the folder is about; absent: all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<Shard>,
    /// What the digest is made from, key by key.
    pub number_keys: BTreeMap<String, String>,
    /// Digests of the input files, by path as written in the study.
    pub inputs: BTreeMap<String, String>,
    /// The study with every default filled in.
    pub study: Value,
    /// Settings that the program chose where the study says `auto`.
    pub chosen: Value,
    /// Facts about the reduced model.
    pub reduction: Value,
    /// Rows by status over all scenarios.
    pub counts: StatusCounts,
    /// BLAKE3 digests of the tables of a finished run, by file name.
    pub tables: BTreeMap<String, String>,
    /// The scenarios, in order.
    pub scenarios: Vec<ScenarioEntry>,
}

impl Manifest {
    /// Reads `manifest.json` of the folder `results`; none if there is none.
    ///
    /// # Errors
    /// The file cannot be read or is damaged, or says what no run writes.
    pub fn read(results: &Path) -> Result<Option<Self>, TableError> {
        let path = results.join(MANIFEST);
        let manifest: Option<Self> = read_checked_json(&path)?;
        if let Some(manifest) = &manifest {
            manifest.check(&path)?;
        }
        Ok(manifest)
    }

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
            let most = Shard::most(self.patterns);
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

    /// Writes `manifest.json` into the folder `results`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, results: &Path) -> Result<(), TableError> {
        write_checked_json(&results.join(MANIFEST), self)
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

/// Content of `runs/<n>.json`: what a run took and where; never part of the results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Start, seconds since 1970-01-01 UTC.
    pub started_unix_s: u64,
    /// Wall time, s.
    pub wall_time_s: f64,
    /// Host name.
    pub host: String,
    /// Threads.
    pub threads: usize,
    /// Version of the program.
    pub version: String,
    /// Identity of the build; empty in records of 0.1.0.
    #[serde(default)]
    pub build: String,
    /// Rows solved by this run.
    pub rows_solved: u64,
    /// Rows taken over from earlier runs.
    pub rows_reused: u64,
    /// The study file, beside which its inputs lie.
    #[serde(default)]
    pub study_file: PathBuf,
    /// BLAKE3 digests of the tables when the run ended, by file name; none if it was interrupted.
    #[serde(default)]
    pub tables: BTreeMap<String, String>,
}

impl RunRecord {
    /// The intact records of the folder `results`, the last one first.
    #[must_use]
    pub fn all(results: &Path) -> Vec<Self> {
        let numbers = Self::numbers(results).unwrap_or_default();
        let read = |number: &u32| Self::read(&place(results, *number)).ok().flatten();
        numbers.iter().rev().filter_map(read).collect()
    }

    /// Reads the record in the file `path`; none if there is none.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    pub fn read(path: &Path) -> Result<Option<Self>, TableError> {
        let record: Option<Self> = read_checked_json(path)?;
        if let Some(record) = &record {
            check_tables(path, &record.tables)?;
        }
        Ok(record)
    }

    /// Where the records of the folder `results` are, in order.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn places(results: &Path) -> Result<Vec<PathBuf>, TableError> {
        let numbers = Self::numbers(results)?.into_iter();
        Ok(numbers.map(|number| place(results, number)).collect())
    }

    /// Numbers of the records of the folder `results`, ascending.
    fn numbers(results: &Path) -> Result<Vec<u32>, TableError> {
        let folder = results.join(RUNS);
        if !is_folder(&folder)? {
            return Ok(Vec::new());
        }
        let mut numbers = Vec::new();
        for entry in std::fs::read_dir(&folder).map_err(TableError::io("read", &folder))? {
            let name = entry.map_err(TableError::io("read", &folder))?.file_name();
            let number = name.to_str().and_then(|name| name.strip_suffix(".json"));
            numbers.extend(number.and_then(|number| number.parse::<u32>().ok()));
        }
        numbers.sort_unstable();
        Ok(numbers)
    }

    /// Writes the record under the next free number of `runs/` in the folder `results`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, results: &Path) -> Result<(), TableError> {
        let last = Self::numbers(results)?.pop().unwrap_or(0);
        match last.checked_add(1) {
            Some(free) => write_checked_json(&place(results, free), self),
            None => Ok(()),
        }
    }
}

fn place(results: &Path, number: u32) -> PathBuf {
    results.join(RUNS).join(format!("{number}.json"))
}
