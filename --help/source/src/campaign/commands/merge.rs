//! Shards of a study joined to its results.

use std::path::{Path, PathBuf};

use crate::campaign::pipeline::{Clock, Facts, RowCounts, RunOutcome, TableWork};
use crate::campaign::store::{
    ResultsFolder, StoredStudy, finished_rows, shard_folders, verify_tables,
};
use crate::identity;
use crate::population::table::{Manifest, RowStore, RunState, ScenarioEntry, Shard};
use crate::settings::EngineSource;
use crate::study::{PipelineError, StudyDigest};

/// Missing shards that a message names.
const NAMED: usize = 20;

/// A finished shard.
struct Part {
    folder: PathBuf,
    shard: Shard,
    manifest: Manifest,
}

/// Joins the shards in `folders`, or in the `shards/` of a folder, to the results folder `results`.
/// The order of the shards does not matter, and tables are the same bytes as those of a run at once.
/// Inputs are sought beside `study_file`, or beside the study file of the shards' last run.
///
/// # Errors
/// A shard is missing, there twice, of another study, unfinished or damaged, or a file cannot be written.
pub fn merge(
    folders: &[PathBuf],
    results: &Path,
    study_file: Option<&Path>,
    source: &dyn EngineSource,
) -> Result<RunOutcome, PipelineError> {
    let clock = Clock::start();
    let mut parts = Vec::new();
    for folder in expanded(folders)? {
        parts.push(read(folder)?);
    }
    parts.sort_by_key(|part| part.shard.number);
    let Some(first) = parts.first() else {
        return Err(shards("there are no shards to merge".to_owned()));
    };
    for part in &parts {
        belongs(part, first)?;
    }
    if first.manifest.build != identity::BUILD {
        return Err(PipelineError::DifferentBuild {
            folder: first.folder.clone(),
            stored: first.manifest.build.clone(),
        });
    }
    covers(&parts)?;
    for part in &parts {
        verify_tables(&part.folder, &part.manifest)?;
    }
    let stored = StoredStudy::open(&first.folder, study_file)?;
    let digest = StudyDigest::of(&stored.study)?;
    let model = stored.model()?;
    let folder = ResultsFolder::open(results)?;
    folder.find(&stored.study, &digest, None)?;
    let facts = facts(first);
    let all = (None, model.patterns.ids());
    let tables = TableWork::new(&stored.study, &digest, &model.patterns, all, facts);
    let files = parts
        .iter()
        .flat_map(|part| finished_rows(&part.folder, &part.manifest))
        .collect();
    let store = RowStore::of_files(tables.schema().clone(), files);
    let engine = TableWork::wants_engine(&stored.study, None)
        .then(|| stored.engine(&model, source))
        .transpose()?;
    let (manifest, summary) = tables.publish(&store, results, None, engine.as_deref())?;
    let rows = RowCounts {
        solved: 0,
        reused: tables.planned(),
    };
    let threads = 1;
    clock
        .record(&stored.study.path, threads, rows, manifest.tables)
        .write(results)?;
    Ok(RunOutcome {
        summary,
        rows_solved: 0,
        rows_reused: tables.planned(),
    })
}

fn shards(reason: String) -> PipelineError {
    PipelineError::Shards { reason }
}

/// The folders, those that hold shards replaced by their shards.
fn expanded(folders: &[PathBuf]) -> Result<Vec<PathBuf>, PipelineError> {
    let mut all = Vec::new();
    for folder in folders {
        let inside = shard_folders(folder)?;
        let is_shard = Manifest::read(folder)?.is_some_and(|manifest| manifest.shard.is_some());
        if inside.is_empty() || is_shard {
            all.push(folder.clone());
        } else {
            all.extend(inside.into_values());
        }
    }
    Ok(all)
}

fn read(folder: PathBuf) -> Result<Part, PipelineError> {
    let Some(manifest) = Manifest::read(&folder)? else {
        return Err(PipelineError::NoResults { folder });
    };
    let place = folder.display();
    let Some(shard) = manifest.shard else {
        return Err(shards(format!(
            "{place} holds a whole study and no shard; accepted: folders of `blisk run STUDY --shard k/n`"
        )));
    };
    if manifest.state != RunState::Finished {
        return Err(shards(format!(
            "shard {shard} in {place} is not complete; `blisk run STUDY --shard {shard}` continues it"
        )));
    }
    Ok(Part {
        folder,
        shard,
        manifest,
    })
}

/// Whether a shard is one of the same study, cut the same way and solved by the same arithmetic.
fn belongs(part: &Part, first: &Part) -> Result<(), PipelineError> {
    let (ours, theirs) = (&part.manifest, &first.manifest);
    let mut differences: Vec<(String, String, String)> = Vec::new();
    let keys = ours.number_keys.keys().chain(theirs.number_keys.keys());
    let keys: std::collections::BTreeSet<&String> = keys.collect();
    let value = |manifest: &Manifest, key: &String| {
        let known = manifest.number_keys.get(key).cloned();
        known.unwrap_or_else(|| "(absent)".to_owned())
    };
    for key in keys {
        differences.push((key.clone(), value(ours, key), value(theirs, key)));
    }
    differences.push((
        "study.patterns".to_owned(),
        ours.patterns.to_string(),
        theirs.patterns.to_string(),
    ));
    let builds = [ours, theirs].map(|manifest| identity::named(&manifest.build).to_owned());
    let [of_this, of_first] = builds;
    differences.push(("build".to_owned(), of_this, of_first));
    differences.retain(|(_, ours, theirs)| ours != theirs);
    if !differences.is_empty() {
        return Err(PipelineError::DifferentShards {
            folder: part.folder.clone(),
            other: first.folder.clone(),
            differences,
        });
    }
    if part.shard.count != first.shard.count {
        return Err(shards(format!(
            "{} is shard {}, and {} is shard {}: all must be cut into the same number",
            first.folder.display(),
            first.shard,
            part.folder.display(),
            part.shard
        )));
    }
    if facts(part) != facts(first) {
        return Err(shards(format!(
            "shard {} in {} and shard {} in {} come from different reduced models of the same study: \
             their machines calculate differently; solve them on machines of one kind, or with one \
             results folder, which shares its reduced model",
            first.shard,
            first.folder.display(),
            part.shard,
            part.folder.display()
        )));
    }
    Ok(())
}

fn facts(part: &Part) -> Facts {
    let entries = &part.manifest.scenarios;
    Facts {
        tuned: entries.iter().map(ScenarioEntry::tuned).collect(),
        row_digests: entries
            .iter()
            .map(|entry| entry.row_digest.clone())
            .collect(),
        chosen: part.manifest.chosen.clone(),
        reduction: part.manifest.reduction.clone(),
    }
}

/// Whether every shard is there once; `parts` are sorted by number and cut alike.
fn covers(parts: &[Part]) -> Result<(), PipelineError> {
    if let Some(pair) = parts
        .windows(2)
        .find(|pair| pair[0].shard.number == pair[1].shard.number)
    {
        return Err(shards(format!(
            "shard {} is there twice: {} and {}",
            pair[0].shard,
            pair[0].folder.display(),
            pair[1].folder.display()
        )));
    }
    let count = parts.first().map_or(0, |part| part.shard.count);
    let mut missing = (1..=count).filter(|number| {
        let place = parts.binary_search_by_key(number, |part| part.shard.number);
        place.is_err()
    });
    let mut named: Vec<String> = missing
        .by_ref()
        .take(NAMED)
        .map(|number| format!("{number}/{count}"))
        .collect();
    if named.is_empty() {
        return Ok(());
    }
    match missing.count() {
        0 => {}
        others => named.push(format!("and {others} others")),
    }
    Err(shards(format!("missing shards: {}", named.join(", "))))
}
