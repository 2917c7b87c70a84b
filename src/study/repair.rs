//! Damaged files of a results folder set aside, and what they held solved again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::lock::FolderLock;
use super::pipeline::{RunScope, run_in};
use super::results_folder::{RESPONSES, changed_tables, manifest_lost};
use super::stored_study::study_of;
use super::{EngineSource, PipelineError, Progress, RunOutcome, RunRequest, Study};
use crate::identity;
use crate::population::table::{
    MANIFEST, Manifest, RunRecord, RunState, Shard, TableError, complete_publication, keep_as_part,
    part_files, set_aside,
};

/// What a repair came to.
#[derive(Debug, Clone)]
pub struct Repair {
    /// Damaged files, and where they are now.
    pub set_aside: Vec<(PathBuf, PathBuf)>,
    /// Tables that were missing.
    pub missing: Vec<PathBuf>,
    /// The run that solved the rows of a finished study again; none where nothing was to be done, or
    /// the study was not finished.
    pub outcome: Option<RunOutcome>,
    /// Tables that are not the same bytes as before.
    pub different: Vec<String>,
}

/// Sets the damaged files of the folder `results` aside and, if its study was finished, solves again
/// what they held. The study is that of the manifest, its inputs beside `study_file` or beside the
/// study file of the last run; where the manifest is damaged, it is that file itself.
///
/// # Errors
/// The folder holds no study, or the run fails.
pub fn repair(
    results: &Path,
    study_file: Option<&Path>,
    threads: usize,
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<Repair, PipelineError> {
    let (lock, _) = FolderLock::take(results)?;
    let mut repair = Repair {
        set_aside: Vec::new(),
        missing: Vec::new(),
        outcome: None,
        different: Vec::new(),
    };
    let next = results.join("next");
    repair.manifest(results, &next)?;
    complete_publication(results)?;
    let manifest = repair.manifest(results, results)?;
    let records = RunRecord::all(results);
    let beside = study_file
        .map(Path::to_owned)
        .or_else(|| Some(records.first()?.study_file.clone()));
    let tables = match &manifest {
        Some(manifest) => manifest.tables.clone(),
        None => tables_of(&records),
    };
    if manifest.is_none() && tables.is_empty() && part_files(results)?.is_empty() {
        if results.join(RESPONSES).exists() {
            return Err(manifest_lost(results).into());
        }
        return Err(PipelineError::NoResults {
            folder: results.to_owned(),
        });
    }
    refuse_other_builds(results, manifest.as_ref(), &records, &tables)?;
    let goes_on = !part_files(results)?.is_empty();
    let tables_are_whole = repair.tables(results, &tables)?;
    repair.parts(results)?;
    let finished = match &manifest {
        Some(manifest) => manifest.state == RunState::Finished,
        None => !tables.is_empty(),
    };
    if !finished || (manifest.is_some() && tables_are_whole) {
        return Ok(repair);
    }
    // What is left of the rows is known by its digest, as a part is.
    if let Some(digest) = tables.get(RESPONSES) {
        keep_as_part(results, &results.join(RESPONSES), digest)?;
    }
    if manifest.is_some() {
        let path = results.join(MANIFEST);
        std::fs::remove_file(&path).map_err(|source| TableError::Io {
            action: "remove",
            path,
            source,
        })?;
    }
    if goes_on {
        // The study that goes on from these results is not known here, and needs its parts.
        return Ok(repair);
    }
    let study = match (&manifest, beside) {
        (Some(manifest), beside) => {
            let beside = beside.unwrap_or_else(|| results.join(MANIFEST));
            study_of(&manifest.study, &beside, results)?
        }
        (None, Some(file)) => Study::read(&file)?,
        (None, None) => {
            return Err(PipelineError::NoResults {
                folder: results.to_owned(),
            });
        }
    };
    drop(lock);
    let shard = match &manifest {
        Some(manifest) => manifest.shard,
        None => Shard::of_folder(results),
    };
    let model = match shard {
        None => results.join("model"),
        Some(_) => results.join("../../model"),
    };
    let request = RunRequest {
        study: &study,
        results,
        threads,
    };
    let scope = RunScope {
        shard,
        model_cache: &model,
        held: manifest.as_ref().map_or(0, |manifest| manifest.patterns),
    };
    repair.outcome = Some(run_in(request, scope, source, progress)?);
    if let Some(after) = Manifest::read(results)? {
        repair.different = tables
            .into_iter()
            .filter(|(name, digest)| after.tables.get(name) != Some(digest))
            .map(|(name, _)| name)
            .collect();
    }
    Ok(repair)
}

/// Rows of another build are left as they are: what is solved again would be of this one.
fn refuse_other_builds(
    results: &Path,
    manifest: Option<&Manifest>,
    records: &[RunRecord],
    tables: &BTreeMap<String, String>,
) -> Result<(), PipelineError> {
    let stored = match (manifest, records.first()) {
        (Some(manifest), _) => &manifest.build,
        (None, Some(record)) => &record.build,
        (None, None) => return Ok(()),
    };
    let whole = || -> Result<bool, TableError> {
        let parts = part_files(results)?;
        Ok(manifest.is_some()
            && changed_tables(results, tables)?.is_empty()
            && parts.iter().all(|part| part.check().is_ok()))
    };
    if stored == identity::BUILD || whole()? {
        return Ok(());
    }
    Err(PipelineError::DifferentBuild {
        folder: results.to_owned(),
        stored: stored.clone(),
    })
}

/// The tables of the last run that wrote some.
fn tables_of(records: &[RunRecord]) -> BTreeMap<String, String> {
    let last = records.iter().find(|record| !record.tables.is_empty());
    last.map_or_else(BTreeMap::new, |record| record.tables.clone())
}

impl Repair {
    /// The manifest in `folder`; set aside if it is damaged.
    fn manifest(&mut self, results: &Path, folder: &Path) -> Result<Option<Manifest>, TableError> {
        match Manifest::read(folder) {
            Err(TableError::Damaged { path, .. }) => {
                self.put(results, path)?;
                Ok(None)
            }
            other => other,
        }
    }

    /// Whether all tables are as they were written.
    fn tables(
        &mut self,
        results: &Path,
        tables: &BTreeMap<String, String>,
    ) -> Result<bool, TableError> {
        let changed = changed_tables(results, tables)?;
        let whole = changed.is_empty();
        for name in changed {
            let path = results.join(name);
            if path.exists() {
                self.put(results, path)?;
            } else {
                self.missing.push(path);
            }
        }
        // Without a digest nothing vouches for it.
        let unknown = results.join(RESPONSES);
        if !tables.contains_key(RESPONSES) && unknown.exists() {
            self.put(results, unknown)?;
        }
        Ok(whole)
    }

    fn parts(&mut self, results: &Path) -> Result<(), TableError> {
        for part in part_files(results)? {
            match part.check() {
                Err(TableError::Damaged { path, .. }) => self.put(results, path)?,
                other => other?,
            }
        }
        Ok(())
    }

    fn put(&mut self, results: &Path, path: PathBuf) -> Result<(), TableError> {
        let place = set_aside(results, &path)?;
        self.set_aside.push((path, place));
        Ok(())
    }
}
