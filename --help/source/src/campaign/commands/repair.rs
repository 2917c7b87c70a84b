//! Damaged files of a results folder set aside, and what they held solved again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::campaign::pipeline::{RunOutcome, RunRequest, RunScope, run_in};
use crate::campaign::store::{
    FolderLock, RESPONSES, changed_tables, damaged_entries, manifest_lost, study_of,
};
use crate::identity;
use crate::population::table::{
    ASIDE, ESTIMATE, MANIFEST, Manifest, PartHeader, RunRecord, RunState, SAMPLE, Shard,
    SideTables, TableError, complete_publication, digest_stored, holds_results, is_file,
    keep_as_part, misplacements, part_files, read_estimate, renew_header, set_aside,
    unlisted_parts,
};
use crate::settings::{EngineSource, Progress};
use crate::study::{PipelineError, Study};

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
    let nothing = || PipelineError::NoResults {
        folder: results.to_owned(),
    };
    if !holds_results(results)? {
        return Err(nothing());
    }
    let (lock, _) = FolderLock::take(results)?;
    let mut repair = Repair {
        set_aside: Vec::new(),
        missing: Vec::new(),
        outcome: None,
        different: Vec::new(),
    };
    repair.misplaced(results)?;
    let next = results.join("next");
    repair.manifest(results, &next)?;
    repair.publication(results, &next)?;
    let manifest = repair.manifest(results, results)?;
    let records = RunRecord::all(results);
    let beside = study_file
        .map(Path::to_owned)
        .or_else(|| Some(records.first()?.study_file.clone()));
    let tables = match &manifest {
        Some(manifest) => manifest.tables.clone(),
        None => tables_of(&records),
    };
    let parts = listed_parts(results)?;
    if manifest.is_none() && tables.is_empty() && parts.is_empty() {
        if is_file(&results.join(RESPONSES))? {
            return Err(manifest_lost(results).into());
        }
        return Err(nothing());
    }
    refuse_other_builds(results, manifest.as_ref(), &records, &tables)?;
    let goes_on = !parts.is_empty();
    let tables_are_whole = repair.tables(results, &tables)?;
    let solved_here = match &manifest {
        Some(manifest) => manifest.build == identity::BUILD,
        None => records
            .first()
            .is_some_and(|record| record.build == identity::BUILD),
    };
    repair.parts(results, solved_here)?;
    repair.others(results)?;
    let finished = match &manifest {
        Some(manifest) => manifest.state == RunState::Finished,
        None => !tables.is_empty(),
    };
    if !finished || (manifest.is_some() && tables_are_whole) {
        return Ok(repair);
    }
    // Everything that can be refused comes before the manifest changes, which may be all that holds the study.
    let study = match (&manifest, beside) {
        // The study that goes on from these results is not known here, and needs its parts.
        _ if goes_on => None,
        (Some(manifest), beside) => {
            let beside = beside.unwrap_or_else(|| results.join(MANIFEST));
            Some(study_of(&manifest.study, &beside, results)?)
        }
        (None, Some(file)) => Some(Study::read(&file)?),
        (None, None) => return Err(nothing()),
    };
    // What is left of the rows is known by its digest, as a part is.
    if let Some(digest) = tables.get(RESPONSES) {
        keep_as_part(results, &results.join(RESPONSES), digest)?;
    }
    if let Some(manifest) = &manifest {
        let running = Manifest {
            state: RunState::Running,
            stop: None,
            tables: BTreeMap::new(),
            ..manifest.clone()
        };
        running.write(results)?;
    }
    let Some(study) = study else {
        return Ok(repair);
    };
    drop(lock);
    let again = (&study, manifest.as_ref(), threads);
    repair.outcome = Some(solve_again(results, again, source, progress)?);
    if let Some(after) = Manifest::read(results)? {
        repair.different = tables
            .into_iter()
            .filter(|(name, digest)| after.tables.get(name) != Some(digest))
            .map(|(name, _)| name)
            .collect();
    }
    Ok(repair)
}

/// Solves the rows of `study` that are lost in the folder `results`, whose manifest was `manifest`.
fn solve_again(
    results: &Path,
    (study, manifest, threads): (&Study, Option<&Manifest>, usize),
    source: &dyn EngineSource,
    progress: &dyn Progress,
) -> Result<RunOutcome, PipelineError> {
    let shard = match manifest {
        Some(manifest) => manifest.shard,
        None => Shard::of_folder(results),
    };
    let model = match shard {
        None => results.join("model"),
        Some(_) => results.join("../../model"),
    };
    let request = RunRequest {
        study,
        results,
        threads,
    };
    let scope = RunScope {
        shard,
        model_cache: &model,
        held: manifest.map_or(0, |manifest| manifest.patterns),
    };
    run_in(request, scope, source, progress)
}

/// What stands among the parts, listed or not; a damaged header is one of it.
fn listed_parts(results: &Path) -> Result<Vec<PathBuf>, TableError> {
    let listed = match part_files(results) {
        Err(TableError::Damaged { path, .. }) => return Ok(vec![path]),
        listed => listed?,
    };
    let mut all = unlisted_parts(results)?;
    all.extend(listed.into_iter().map(|part| part.path));
    Ok(all)
}

/// Rows of another build are left as they are: what is solved again would be of this one.
fn refuse_other_builds(
    results: &Path,
    manifest: Option<&Manifest>,
    records: &[RunRecord],
    tables: &BTreeMap<String, String>,
) -> Result<(), PipelineError> {
    let stored = match (manifest, records.first()) {
        (Some(manifest), _) => manifest.build.clone(),
        (None, Some(record)) => record.build.clone(),
        // An estimate that was interrupted has neither.
        (None, None) => match PartHeader::read(results) {
            Ok(Some(header)) => header.build,
            Ok(None) | Err(TableError::Damaged { .. }) => return Ok(()),
            Err(error) => return Err(error.into()),
        },
    };
    let whole = || -> Result<bool, TableError> {
        Ok(manifest.is_some()
            && changed_tables(results, tables)?.is_empty()
            && part_files(results).is_ok_and(|parts| parts.iter().all(|part| part.check().is_ok())))
    };
    if stored == identity::BUILD || whole()? {
        return Ok(());
    }
    Err(PipelineError::DifferentBuild {
        folder: results.to_owned(),
        stored,
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

    /// Completes what an interrupted process had decided on; where a table of it is damaged, the manifest in `next`
    /// goes aside, and the parts stay.
    fn publication(&mut self, results: &Path, next: &Path) -> Result<(), TableError> {
        match complete_publication(results) {
            Err(TableError::Damaged { .. }) => {
                self.put(results, next.join(MANIFEST))?;
                complete_publication(results)?;
            }
            completed => drop(completed?),
        }
        Ok(())
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
            self.put_or_miss(results, results.join(name))?;
        }
        // Without a digest nothing vouches for it.
        let unknown = results.join(RESPONSES);
        if !tables.contains_key(RESPONSES) && is_file(&unknown)? {
            self.put(results, unknown)?;
        }
        Ok(whole)
    }

    /// Links and whatever else stands in a place that it does not belong to go aside.
    fn misplaced(&mut self, results: &Path) -> Result<(), TableError> {
        for error in misplacements(results)? {
            if let TableError::Damaged { path, reason } = error {
                if ASIDE.iter().any(|name| path.ends_with(name)) {
                    let (reason, _) = reason.split_once(';').unwrap_or((&reason, ""));
                    let reason = format!("{reason}; remove it");
                    return Err(TableError::Damaged { path, reason });
                }
                self.put(results, path)?;
            }
        }
        Ok(())
    }

    /// Parts that are not as written or not listed go aside, and so do those without a header unless this
    /// build `solved` the rows of the folder; the header lists what is left.
    fn parts(&mut self, results: &Path, solved: bool) -> Result<(), TableError> {
        let before = (self.set_aside.len(), self.missing.len());
        let build = match PartHeader::read(results) {
            Err(TableError::Damaged { path, .. }) => {
                self.put(results, path)?;
                None
            }
            header => header?.map(|header| header.build),
        };
        let headed = build.is_some();
        for part in part_files(results)? {
            match part.check() {
                Err(TableError::Damaged { path, .. }) => self.put_or_miss(results, path)?,
                other => other?,
            }
        }
        let beside = unlisted_parts(results)?;
        let without_header = !headed && !beside.is_empty();
        if headed || !solved {
            for path in beside {
                self.put(results, path)?;
            }
        }
        if without_header || before != (self.set_aside.len(), self.missing.len()) {
            renew_header(results, build)?;
        }
        Ok(())
    }

    /// Tables of commands beside `run`, records of runs, models and an estimate that are not as written go aside.
    fn others(&mut self, results: &Path) -> Result<(), TableError> {
        let noted = match SideTables::read(results) {
            Err(TableError::Damaged { path, .. }) => {
                self.put(results, path)?;
                SideTables::default()
            }
            noted => noted?,
        };
        for (name, table) in &noted.tables {
            match table.check(&results.join(name)) {
                Err(TableError::Damaged { path, .. }) => {
                    SideTables::without(results, name)?;
                    self.put_or_miss(results, path)?;
                }
                other => other?,
            }
        }
        for path in RunRecord::places(results)? {
            match RunRecord::read(&path) {
                Err(TableError::Damaged { path, .. }) => self.put(results, path)?,
                other => drop(other?),
            }
        }
        for path in damaged_entries(results)? {
            self.put(results, path)?;
        }
        self.estimate(results)
    }

    /// A damaged estimate goes aside with its sample: neither says anything without the other.
    fn estimate(&mut self, results: &Path) -> Result<(), TableError> {
        let whole = match read_estimate::<Value>(results) {
            Ok(None) => return Ok(()),
            Ok(Some(estimate)) => estimate["sample_digest"].as_str().map(str::to_owned),
            Err(TableError::Damaged { .. }) => None,
            Err(error) => return Err(error),
        };
        let sample = results.join(SAMPLE);
        let found = match digest_stored(&sample) {
            Err(TableError::Damaged { .. }) => None,
            found => found?,
        };
        if whole.is_none() || found != whole {
            self.put(results, results.join(ESTIMATE))?;
            self.put_or_miss(results, sample)?;
        }
        Ok(())
    }

    /// Sets aside what stands in a place, or notes that nothing does.
    fn put_or_miss(&mut self, results: &Path, path: PathBuf) -> Result<(), TableError> {
        if std::fs::symlink_metadata(&path).is_ok() {
            return self.put(results, path);
        }
        self.missing.push(path);
        Ok(())
    }

    fn put(&mut self, results: &Path, path: PathBuf) -> Result<(), TableError> {
        let place = set_aside(results, &path)?;
        self.set_aside.push((path, place));
        Ok(())
    }
}
