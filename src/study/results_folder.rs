//! The results folder of a study: who may write to it, and whether it is the same study.

use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::{PipelineError, Study, StudyDigest, digest_file};
use crate::population::table::{Manifest, RunState, TableError};

/// A results folder that this process alone writes to.
#[derive(Debug)]
pub(super) struct ResultsFolder {
    path: PathBuf,
    /// Held as long as the folder is; the lock ends with the process, however it ends.
    _lock: File,
}

/// What a results folder holds of a study.
#[derive(Debug)]
pub(super) enum Found {
    /// Nothing, or an interrupted run, or fewer patterns.
    Unfinished,
    /// Everything that the study asks for.
    Finished(Box<Manifest>),
}

impl ResultsFolder {
    /// Makes the folder if need be and locks it.
    pub(super) fn open(path: &Path) -> Result<Self, PipelineError> {
        let io = |action: &'static str| {
            move |source| TableError::Io {
                action,
                path: path.to_owned(),
                source,
            }
        };
        std::fs::create_dir_all(path).map_err(io("create the folder"))?;
        let lock_path = path.join(".lock");
        let mut lock = File::options()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&lock_path)
            .map_err(io("write to the folder"))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let holder = std::fs::read_to_string(&lock_path).unwrap_or_default();
                return Err(PipelineError::Locked {
                    folder: path.to_owned(),
                    holder: if holder.is_empty() {
                        "another process".to_owned()
                    } else {
                        holder
                    },
                });
            }
            Err(TryLockError::Error(source)) => return Err(io("lock the folder")(source).into()),
        }
        lock.set_len(0).map_err(io("write to the folder"))?;
        write!(lock, "process {} on {}", std::process::id(), host_name())
            .map_err(io("write to the folder"))?;
        Ok(Self {
            path: path.to_owned(),
            _lock: lock,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What the folder holds of `study`.
    ///
    /// # Errors
    /// It holds a different study, or its manifest is damaged.
    pub(super) fn find(&self, study: &Study, digest: &StudyDigest) -> Result<Found, PipelineError> {
        let Some(manifest) = Manifest::read(&self.path)? else {
            return Ok(Found::Unfinished);
        };
        let mut differences = digest.differences(&manifest.number_keys);
        if manifest.patterns > u64::from(study.patterns) {
            differences.push((
                "study.patterns".to_owned(),
                manifest.patterns.to_string(),
                format!("{} (a total, which can grow only)", study.patterns),
            ));
        }
        if !differences.is_empty() {
            return Err(PipelineError::DifferentStudy {
                folder: self.path.clone(),
                differences,
            });
        }
        if manifest.state == RunState::Finished {
            verify_tables(&self.path, &manifest)?;
        }
        let complete =
            manifest.state == RunState::Finished && manifest.patterns == u64::from(study.patterns);
        Ok(if complete {
            Found::Finished(Box::new(manifest))
        } else {
            Found::Unfinished
        })
    }
}

/// Checks that the tables of a finished run are those that were written.
///
/// # Errors
/// A table is missing or has changed.
pub(super) fn verify_tables(results: &Path, manifest: &Manifest) -> Result<(), TableError> {
    let Some(name) = changed_tables(results, manifest)?.into_iter().next() else {
        return Ok(());
    };
    let path = results.join(name);
    let reason = if path.exists() {
        "its content is not what was written; restore it, or remove the folder and run again"
    } else {
        "it is missing; restore it, or remove the folder and run again"
    };
    Err(TableError::Damaged {
        path,
        reason: reason.to_owned(),
    })
}

/// Tables of a finished run that are missing or not as they were written.
///
/// # Errors
/// A table cannot be read.
pub(super) fn changed_tables(
    results: &Path,
    manifest: &Manifest,
) -> Result<Vec<String>, TableError> {
    let mut changed = Vec::new();
    for (name, expected) in &manifest.tables {
        let path = results.join(name);
        match digest_file(&path) {
            Ok(found) if found == *expected => {}
            Ok(_) => changed.push(name.clone()),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                changed.push(name.clone());
            }
            Err(source) => {
                return Err(TableError::Io {
                    action: "read",
                    path,
                    source,
                });
            }
        }
    }
    Ok(changed)
}

/// Name of this machine, for people; empty if it has none.
pub(super) fn host_name() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname")
        .ok()
        .or_else(|| std::env::var("HOSTNAME").ok())
        .or_else(|| std::env::var("COMPUTERNAME").ok())
        .unwrap_or_default()
        .trim()
        .to_owned()
}
