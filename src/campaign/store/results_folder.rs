//! The results folder of a study: who may write to it, and whether it is the same study.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::LockHolder;
use super::lock::FolderLock;
use crate::identity;
use crate::population::table::{
    MANIFEST, Manifest, PartHeader, RowFile, RunRecord, RunState, ScenarioEntry, Shard, TableError,
    check_parts, complete_publication, digest_stored, is_file, misplacements, remove_leftovers,
};
use crate::study::{PipelineError, Study, StudyDigest};

/// The table of rows.
pub(in crate::campaign) const RESPONSES: &str = "responses.parquet";

/// Lists of the study that may grow while the rows of their former members stay.
pub(in crate::campaign) const GROWING: [&str; 4] = [
    "contact.normal_load.speed_rpm",
    "excitation.engine_orders",
    "sweep.standard_deviation",
    "sweep.normal_load_n",
];

/// Name of the version among the keys of a study.
pub(super) const VERSION: &str = "version";

/// A results folder that this process alone writes to.
#[derive(Debug)]
pub(in crate::campaign) struct ResultsFolder {
    path: PathBuf,
    lock: FolderLock,
    broken_off: Option<LockHolder>,
}

/// What a results folder holds of a study.
#[derive(Debug)]
pub(in crate::campaign) enum Found {
    /// Nothing.
    Nothing,
    /// A run that did not come to its end.
    Unfinished(Box<Manifest>),
    /// A finished run of this study, or of one with fewer patterns or scenarios or another rule to stop.
    Finished(Box<Manifest>),
}

impl Found {
    /// The manifest of what is stored, finished or not.
    pub(in crate::campaign) fn manifest(&self) -> Option<&Manifest> {
        match self {
            Self::Nothing => None,
            Self::Unfinished(manifest) | Self::Finished(manifest) => Some(manifest),
        }
    }

    /// The manifest of a finished run.
    pub(in crate::campaign) fn finished(&self) -> Option<&Manifest> {
        match self {
            Self::Finished(manifest) => Some(manifest),
            Self::Nothing | Self::Unfinished(_) => None,
        }
    }
}

impl ResultsFolder {
    /// Makes the folder if need be, locks it, and completes what an interrupted process had decided.
    pub(in crate::campaign) fn open(path: &Path) -> Result<Self, PipelineError> {
        std::fs::create_dir_all(path).map_err(|source| TableError::Io {
            action: "create the folder",
            path: path.to_owned(),
            source,
        })?;
        let (lock, broken_off) = FolderLock::take(path)?;
        if let Some(error) = misplacements(path)?.into_iter().next() {
            return Err(error.into());
        }
        complete_publication(path)?;
        for folder in ["", "parts", "runs", "model"].map(|name| path.join(name)) {
            remove_leftovers(&folder)?;
        }
        Ok(Self {
            path: path.to_owned(),
            lock,
            broken_off,
        })
    }

    pub(in crate::campaign) fn path(&self) -> &Path {
        &self.path
    }

    /// The process that worked here before and did not come to its end, whose lock was taken over.
    pub(in crate::campaign) fn broken_off(&self) -> Option<&LockHolder> {
        self.broken_off.as_ref()
    }

    /// Lets everyone see how many rows are to be solved and how many were stored before.
    pub(in crate::campaign) fn announce(
        &mut self,
        planned: u64,
        stored: u64,
    ) -> Result<(), TableError> {
        self.lock.announce(planned, stored)
    }

    /// What the folder holds of `study`, or of the shard `shard` of it.
    ///
    /// # Errors
    /// It holds a different study, or a file of it is damaged.
    pub(in crate::campaign) fn find(
        &self,
        study: &Study,
        digest: &StudyDigest,
        shard: Option<Shard>,
    ) -> Result<Found, PipelineError> {
        let Some(manifest) = Manifest::read(&self.path)? else {
            self.check_parts()?;
            if is_file(&self.path.join(RESPONSES))? {
                return Err(manifest_lost(&self.path).into());
            }
            return Ok(Found::Nothing);
        };
        let mut differences = differences(&manifest, study, digest, shard);
        if manifest.build != identity::BUILD && differences.iter().all(|(key, ..)| key == VERSION) {
            return Err(self.of_another_build(manifest.build));
        }
        if !differences.is_empty() {
            if manifest.build != identity::BUILD {
                let stored = identity::named(&manifest.build).to_owned();
                differences.push(("build".to_owned(), stored, identity::BUILD.to_owned()));
            }
            return Err(PipelineError::DifferentStudy {
                folder: self.path.clone(),
                differences,
            });
        }
        self.check_parts()?;
        if manifest.state == RunState::Running {
            return Ok(Found::Unfinished(Box::new(manifest)));
        }
        verify_tables(&self.path, &manifest)?;
        Ok(Found::Finished(Box::new(manifest)))
    }
}

impl ResultsFolder {
    /// Checks that the parts are those that their header lists, solved by this build.
    ///
    /// # Errors
    /// They are not, or cannot be read.
    pub(in crate::campaign) fn check_parts(&self) -> Result<(), PipelineError> {
        match PartHeader::read(&self.path)? {
            Some(header) if header.build != identity::BUILD => {
                Err(self.of_another_build(header.build))
            }
            _ => Ok(check_parts(&self.path)?),
        }
    }

    fn of_another_build(&self, stored: String) -> PipelineError {
        PipelineError::DifferentBuild {
            folder: self.path.clone(),
            stored,
        }
    }
}

/// The manifest of the results in the folder `results`, if `run` would go on from there with `study`; nothing is written.
pub(in crate::campaign) fn continued(
    results: &Path,
    study: &Study,
    digest: &StudyDigest,
) -> Option<Manifest> {
    // What is wrong with a folder is for the run to say.
    let manifest = Manifest::read(results).ok().flatten()?;
    let is_same = differences(&manifest, study, digest, None).is_empty();
    Some(manifest).filter(|own| is_same && own.build == identity::BUILD)
}

/// Whether a finished run is all that `study` asks for: rows, their order, and tables.
pub(in crate::campaign) fn is_complete(manifest: &Manifest, study: &Study) -> bool {
    let keys = manifest.scenarios.iter().map(ScenarioEntry::keys);
    let resolved = study.resolved();
    let same = |key: &str| manifest.study[key] == resolved[key];
    manifest.study["study"]["patterns"] == resolved["study"]["patterns"]
        && same("stop")
        && keys.eq(study.scenarios())
        && same("output")
}

/// Keys of the study that are not those of the folder and may not differ: `(key, there, here)`.
pub(super) fn differences(
    manifest: &Manifest,
    study: &Study,
    digest: &StudyDigest,
    shard: Option<Shard>,
) -> Vec<(String, String, String)> {
    let mut differences = digest.differences(&manifest.number_keys);
    differences.retain_mut(|(key, theirs, ours)| {
        if !GROWING.contains(&key.as_str()) {
            return true;
        }
        let gone = is_gone(theirs, ours);
        ours.push_str(" (values can be added, none taken away)");
        gone
    });
    let patterns = u64::from(study.patterns);
    if manifest.patterns > patterns || (shard.is_some() && manifest.patterns != patterns) {
        let rule = match shard {
            None => "a total, which can only grow",
            Some(_) => "fixed in a shard",
        };
        differences.push((
            "study.patterns".to_owned(),
            manifest.patterns.to_string(),
            format!("{patterns} ({rule})"),
        ));
    }
    if manifest.shard != shard {
        let name = |shard: Option<Shard>| shard.map_or("all".to_owned(), |shard| shard.to_string());
        differences.push(("--shard".to_owned(), name(manifest.shard), name(shard)));
    }
    differences
}

/// Whether a list, as JSON, lacks a value of another.
fn is_gone(theirs: &str, ours: &str) -> bool {
    let list = |text: &str| -> Option<Vec<Value>> { serde_json::from_str(text).ok() };
    match (list(theirs), list(ours)) {
        (Some(theirs), Some(ours)) => {
            let ours: BTreeSet<String> = ours.iter().map(Value::to_string).collect();
            theirs
                .iter()
                .any(|value| !ours.contains(&value.to_string()))
        }
        _ => true,
    }
}

/// The rows of a folder that are known by their digest beside its parts.
pub(in crate::campaign) fn finished_rows(results: &Path, manifest: &Manifest) -> Vec<RowFile> {
    let digest = manifest.tables.get(RESPONSES);
    digest
        .map(|digest| RowFile {
            path: results.join(RESPONSES),
            digest: digest.clone(),
            from: 0,
        })
        .into_iter()
        .collect()
}

/// Checks that the tables of a finished run are those that were written.
///
/// # Errors
/// A table is missing or has changed.
pub(in crate::campaign) fn verify_tables(
    results: &Path,
    manifest: &Manifest,
) -> Result<(), PipelineError> {
    let Some(name) = changed_tables(results, &manifest.tables)?
        .into_iter()
        .next()
    else {
        return Ok(());
    };
    if is_file(&results.join("next").join(MANIFEST))? {
        return Err(PipelineError::Unfinished {
            folder: results.to_owned(),
        });
    }
    let path = results.join(name);
    let what = match digest_stored(&path)? {
        Some(_) => "its content is not what was written",
        None => "it is missing",
    };
    let reason = format!("{what}; restore it, or {}", repair_of(results));
    Err(TableError::Damaged { path, reason }.into())
}

/// Tables without a manifest: the records of runs may say which they were.
pub(in crate::campaign) fn manifest_lost(results: &Path) -> TableError {
    let records = RunRecord::all(results);
    let way_out = if records.iter().any(|record| !record.tables.is_empty()) {
        repair_of(results)
    } else {
        "no record in runs/ says what the tables are made from; `blisk run` with --solve-anew moves them to \
         superseded/ and solves everything anew"
            .to_owned()
    };
    TableError::Damaged {
        path: results.join(MANIFEST),
        reason: format!("it is missing beside {RESPONSES}; {way_out}"),
    }
}

/// How to have the rows of damaged files solved again.
fn repair_of(results: &Path) -> String {
    format!(
        "`blisk verify {} --repair` solves its rows again",
        results.display()
    )
}

/// Names of the tables in the folder `results` that are missing or not as they were written; `tables`
/// has the digest of each by name.
///
/// # Errors
/// A table cannot be read.
pub(in crate::campaign) fn changed_tables(
    results: &Path,
    tables: &BTreeMap<String, String>,
) -> Result<Vec<String>, TableError> {
    let mut changed = Vec::new();
    for (name, expected) in tables {
        let path = results.join(name);
        match digest_stored(&path) {
            Ok(Some(found)) if found == *expected => {}
            Ok(_) | Err(TableError::Damaged { .. }) => changed.push(name.clone()),
            Err(error) => return Err(error),
        }
    }
    Ok(changed)
}
