//! How far a results folder is, seen without touching it.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::LockHolder;
use super::folders_inside::shard_folders;
use super::lock::{holder, unix_seconds};
use super::summary::{planned_rows, row_store};
use crate::population::statistics::Accounting;
use crate::population::table::{
    Manifest, ResponseReader, RunRecord, RunState, TableError, part_files,
};
use crate::study::PipelineError;

/// What becomes of a results folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Work {
    /// A process works in the folder.
    Running,
    /// All rows are there.
    Finished,
    /// No process works in the folder; `run` goes on.
    Interrupted,
}

/// How far a results folder is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FolderStatus {
    /// Name of the study.
    pub name: String,
    /// The share of the patterns that the folder is about, like `3/8`; none: all of them.
    pub shard: Option<String>,
    /// What becomes of it.
    pub work: Work,
    /// Rows when it is finished.
    pub planned: u64,
    /// Rows stored, by status.
    pub rows: Accounting,
    /// Rows solved per second: since the present process began, or by the last run.
    pub rows_per_second: Option<f64>,
    /// Time that the rows not solved yet take at `rows_per_second`, s.
    pub seconds_left: Option<f64>,
    /// Who works in the folder, or worked in it last and was broken off.
    pub holder: Option<LockHolder>,
    /// Status of the shards of the folder, by number.
    pub shards: Vec<FolderStatus>,
    /// Numbers of the shards that are not finished.
    pub missing_shards: Vec<u32>,
}

/// The status of the results folder `results` and of the shards in it.
///
/// # Errors
/// The folder holds no study, or a file of it is damaged.
pub fn status_of_folder(results: &Path) -> Result<FolderStatus, PipelineError> {
    let mut shards = Vec::new();
    let mut missing = Vec::new();
    let mut known = BTreeMap::new();
    for (cut, folder) in shard_folders(results)? {
        // A folder that no shard has begun in tells nothing, not even how many shards there are.
        if let Some(status) = own_status(&folder)? {
            known.insert(cut, status);
        }
    }
    let count = known.keys().map(|(count, _)| *count).max().unwrap_or(0);
    for number in 1..=count {
        let shard = known.remove(&(count, number));
        if shard
            .as_ref()
            .is_none_or(|shard| shard.work != Work::Finished)
        {
            missing.push(number);
        }
        shards.extend(shard);
    }
    let mut status = match own_status(results)? {
        Some(status) => status,
        None => together(&shards, &missing).ok_or_else(|| PipelineError::NoResults {
            folder: results.to_owned(),
        })?,
    };
    status.shards = shards;
    status.missing_shards = missing;
    Ok(status)
}

/// The status of a folder by itself; none if it has no study. Looks again where a file has gone
/// since: the folder has just been finished.
fn own_status(folder: &Path) -> Result<Option<FolderStatus>, PipelineError> {
    let look = || -> Result<Option<FolderStatus>, PipelineError> {
        Ok(match Manifest::read(folder)? {
            Some(manifest) => Some(status_of(folder, &manifest)?),
            None => None,
        })
    };
    look().or_else(|_| look())
}

fn status_of(folder: &Path, manifest: &Manifest) -> Result<FolderStatus, PipelineError> {
    let holder = holder(folder);
    let lives = holder.as_ref().is_some_and(|(_, lives)| *lives);
    let announced = holder
        .as_ref()
        .and_then(|(holder, _)| holder.rows)
        .filter(|_| lives);
    let mut rows = Accounting::default();
    row_store(folder, manifest)?.visit(|row| {
        rows.add(row.status);
        Ok(())
    })?;
    if manifest.state == RunState::Finished && announced.is_some() {
        // A finished study that is being extended: its new rows are in the parts.
        for part in part_files(folder)? {
            part.check()?;
            count_rows(&part.path, &mut rows)?;
        }
    }
    let planned = announced.map_or_else(|| planned_rows(manifest), |(planned, _)| planned);
    let rate = match (&holder, announced) {
        (Some((holder, _)), Some((_, before))) => {
            let seconds = unix_seconds().saturating_sub(holder.since_unix_s);
            let solved = rows.planned().saturating_sub(before);
            (seconds > 0 && solved > 0).then(|| solved as f64 / seconds as f64)
        }
        _ => RunRecord::all(folder)
            .first()
            .filter(|record| record.rows_solved > 0)
            .map(|record| record.rows_solved as f64 / record.wall_time_s.max(1e-9)),
    };
    let left = planned.saturating_sub(rows.planned());
    Ok(FolderStatus {
        name: manifest.name.clone(),
        shard: manifest.shard.map(|shard| shard.to_string()),
        work: match manifest.state {
            _ if lives => Work::Running,
            RunState::Finished => Work::Finished,
            RunState::Running => Work::Interrupted,
        },
        planned,
        rows,
        rows_per_second: rate,
        seconds_left: rate.filter(|_| left > 0).map(|rate| left as f64 / rate),
        holder: holder.map(|(holder, _)| holder),
        shards: Vec::new(),
        missing_shards: Vec::new(),
    })
}

fn count_rows(path: &Path, rows: &mut Accounting) -> Result<(), TableError> {
    let mut reader = ResponseReader::open(path)?;
    loop {
        let batch = reader.next_batch()?;
        if batch.is_empty() {
            return Ok(());
        }
        for row in batch {
            rows.add(row.status);
        }
    }
}

/// The status of shards that have not been merged; none if there are none.
fn together(shards: &[FolderStatus], missing: &[u32]) -> Option<FolderStatus> {
    let first = shards.first()?;
    let mut rows = Accounting::default();
    for shard in shards {
        rows.merge(&shard.rows);
    }
    let running = shards.iter().any(|shard| shard.work == Work::Running);
    let rates: f64 = shards
        .iter()
        .filter(|shard| shard.work == Work::Running)
        .filter_map(|shard| shard.rows_per_second)
        .sum();
    let planned: u64 = shards.iter().map(|shard| shard.planned).sum();
    let left = planned.saturating_sub(rows.planned());
    Some(FolderStatus {
        name: first.name.clone(),
        shard: None,
        work: if running {
            Work::Running
        } else if missing.is_empty() {
            Work::Finished
        } else {
            Work::Interrupted
        },
        planned,
        rows,
        rows_per_second: (rates > 0.0).then_some(rates),
        seconds_left: (rates > 0.0 && left > 0).then(|| left as f64 / rates),
        holder: None,
        shards: Vec::new(),
        missing_shards: Vec::new(),
    })
}
