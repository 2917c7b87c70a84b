//! Why a study could not be carried out.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::StudyError;
use crate::identity;
use crate::model::CacheError;
use crate::model::sector::ModelError;
use crate::population::table::TableError;
use crate::response::harmonic_balance::TransformError;

/// A stage of the pipeline that failed. Rows that fail are no errors: they are rows.
#[derive(Debug, Error)]
pub enum PipelineError {
    /// The study is invalid.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The model is invalid.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A table cannot be written or read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The results folder belongs to another study.
    #[error("{} holds the results of a different study; choose another --out, or restore these keys:\n{}", folder.display(), listed(differences))]
    DifferentStudy {
        /// The folder.
        folder: PathBuf,
        /// `(key, value in the folder, value in the study)`.
        differences: Vec<(String, String, String)>,
    },
    /// The results folder holds rows that another build of the program solved.
    #[error("{} holds rows of another build of the program, and rows of two builds are never mixed:\n  build: stored {}, this program {}\n`blisk run` with --solve-anew sets them aside and solves everything anew; or choose another --out, or go on with the build that solved them (`blisk --version` names it)", folder.display(), identity::named(stored), identity::BUILD)]
    DifferentBuild {
        /// The folder.
        folder: PathBuf,
        /// Identity of the build that solved them; empty in results of 0.1.0.
        stored: String,
    },
    /// A shard belongs to another study than another.
    #[error("{} is no shard of the study of {}:\n{}", folder.display(), other.display(), between(differences))]
    DifferentShards {
        /// The folder.
        folder: PathBuf,
        /// The folder that it is compared with.
        other: PathBuf,
        /// `(key, value in the folder, value in the other)`.
        differences: Vec<(String, String, String)>,
    },
    /// What a results folder was made from is no longer the same.
    #[error("{} was not made from the present inputs or by the present version; restore them, or run the study again:\n{}", folder.display(), listed(differences))]
    InputsChanged {
        /// The folder.
        folder: PathBuf,
        /// `(key, value in the folder, value now)`.
        differences: Vec<(String, String, String)>,
    },
    /// Another process works in the results folder.
    #[error("{} is in use by {holder}; wait for it to end or choose another --out", folder.display())]
    Locked {
        /// The folder.
        folder: PathBuf,
        /// Who holds it.
        holder: String,
    },
    /// The folder holds no results of a study.
    #[error("{} holds no results: there is no manifest.json{}", folder.display(), not_merged(folder))]
    NoResults {
        /// The folder.
        folder: PathBuf,
    },
    /// The results folder is not complete.
    #[error("{} is not complete; `blisk run` continues it, `blisk stats` and `blisk status` show what there is", folder.display())]
    Unfinished {
        /// The folder.
        folder: PathBuf,
    },
    /// The run was asked to stop.
    #[error("interrupted: {stored} of {planned} rows are stored in {}; the same command continues", folder.display())]
    Interrupted {
        /// The folder.
        folder: PathBuf,
        /// Rows stored.
        stored: u64,
        /// Rows of the study.
        planned: u64,
    },
    /// A population was asked to stop; nothing of it is stored.
    #[error("stopped: {solved} of {planned} rows were solved, and none is stored")]
    Stopped {
        /// Rows solved.
        solved: u64,
        /// Rows of the population.
        planned: u64,
    },
    /// Shards that do not make up a study.
    #[error("{reason}")]
    Shards {
        /// What is missing, there twice or foreign, and what to do.
        reason: String,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// Number of threads.
        threads: usize,
        /// Why.
        reason: String,
    },
    /// The reduced model cannot be stored.
    #[error(transparent)]
    Cache(#[from] CacheError),
    /// The samples per period cannot tell the harmonics apart.
    #[error("solver.harmonics and solver.samples_per_period do not fit: {0}")]
    Harmonics(#[from] TransformError),
    /// A load or a contact limit is asked for where there is no contact.
    #[error("{reason}; accepted: --load free")]
    NoContact {
        /// What is missing.
        reason: &'static str,
    },
    /// A row is to be integrated in time that cannot be.
    #[error("{reason}")]
    NoTimeDomain {
        /// What is missing, and what is accepted.
        reason: &'static str,
    },
    /// Models of which there is no Campbell table.
    #[error("{reason}")]
    NoCampbell {
        /// What does not fit, and what is accepted.
        reason: String,
    },
    /// The study has no such pattern.
    #[error("there is no pattern {id}; accepted: tuned, or {accepted}")]
    NoPattern {
        /// The id asked for.
        id: u32,
        /// The ids there are, in words.
        accepted: String,
    },
    /// A results folder has no such scenario.
    #[error(
        "there is no scenario {scenario} to compare with; accepted: a number below {scenarios}"
    )]
    NoScenario {
        /// Scenario asked for.
        scenario: usize,
        /// Number of scenarios.
        scenarios: usize,
    },
    /// There is nothing to search a best load of.
    #[error("{reason}")]
    NoOptimum {
        /// Why, and what is accepted.
        reason: String,
    },
    /// There is nothing to estimate.
    #[error("{reason}")]
    NoEstimate {
        /// Why, and what is accepted.
        reason: String,
    },
    /// There is no accuracy to trade.
    #[error("{reason}")]
    NoTradeoff {
        /// Why, and what is accepted.
        reason: String,
    },
    /// A results folder has no such row.
    #[error(
        "there is no row of scenario {scenario} and pattern {pattern}; accepted: a scenario below {scenarios}, and a pattern of the study"
    )]
    NoRow {
        /// Scenario asked for.
        scenario: usize,
        /// Pattern asked for.
        pattern: u32,
        /// Number of scenarios.
        scenarios: usize,
    },
}

/// What to do where the results of a folder are still those of shards.
fn not_merged(folder: &Path) -> String {
    let own = folder.display();
    if folder.join("shards").is_dir() {
        format!(
            " of all shards; `blisk merge {own} --out {own}` makes it, `blisk status {own}` shows what is missing"
        )
    } else {
        String::new()
    }
}

fn listed(differences: &[(String, String, String)]) -> String {
    differences
        .iter()
        .map(|(key, theirs, ours)| format!("  {key}: {theirs} in the folder, {ours} in the study"))
        .collect::<Vec<_>>()
        .join("\n")
}

fn between(differences: &[(String, String, String)]) -> String {
    differences
        .iter()
        .map(|(key, ours, theirs)| format!("  {key}: {ours} in the first, {theirs} in the second"))
        .collect::<Vec<_>>()
        .join("\n")
}
