//! Every file of a results folder read and compared with its checksum; nothing is changed.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use super::folders_inside::{folders_of_loads, shard_folders};
use super::lock::holder;
use super::results_folder::RESPONSES;
use crate::model::{is_whole_entry, writer_of_leftover};
use crate::population::table::{
    ASIDE, CHECKSUMS, FOLDERS, MANIFEST, Manifest, PartHeader, RunRecord, SIDE_FILES, SideTables,
    Standing, TABLES, TableError, digest_stored, misplacements, part_files, read_estimate,
    unlisted_parts,
};
use crate::study::PipelineError;

/// What a file is found to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FileState {
    /// As it was written.
    Whole,
    /// Not as it was written, or not what belongs in its place.
    Damaged,
    /// Listed and not there.
    Missing,
    /// Without a checksum; no command reads numbers from it.
    Unverified,
    /// None of the files that the program writes.
    Foreign,
}

/// A file of a results folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CheckedFile {
    /// Its path below the folder.
    pub file: PathBuf,
    /// What it is found to be.
    pub state: FileState,
    /// Why, where it is not whole.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub reason: String,
}

/// What all files of a results folder are found to be.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Integrity {
    /// The folder.
    pub folder: PathBuf,
    /// Identity of the build that solved its rows, where that can be read.
    pub build: Option<String>,
    /// Its files, in order.
    pub files: Vec<CheckedFile>,
}

impl Integrity {
    /// Whether no file is damaged or missing.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let bad = [FileState::Damaged, FileState::Missing];
        self.files.iter().all(|file| !bad.contains(&file.state))
    }
}

/// Reads all files of the folder `results` and of the shards in it.
///
/// # Errors
/// The folder holds nothing of this program, a process works in it, or the file system refused.
pub fn integrity(results: &Path) -> Result<Integrity, PipelineError> {
    if let Some((holder, true)) = holder(results) {
        return Err(PipelineError::Locked {
            folder: results.to_owned(),
            holder: holder.to_string(),
        });
    }
    let mut work = Work {
        results: results.to_owned(),
        files: Vec::new(),
        build: None,
    };
    work.folder()?;
    // Files that are no concern of the program make no results.
    if work
        .files
        .iter()
        .all(|file| file.state == FileState::Foreign)
    {
        return Err(PipelineError::NoResults {
            folder: results.to_owned(),
        });
    }
    work.files.sort_by(|a, b| a.file.cmp(&b.file));
    Ok(Integrity {
        folder: work.results,
        build: work.build,
        files: work.files,
    })
}

struct Work {
    results: PathBuf,
    files: Vec<CheckedFile>,
    build: Option<String>,
}

impl Work {
    /// Notes what a file is found to be, unless it is noted already.
    fn note(&mut self, path: &Path, state: FileState, reason: &str) {
        let file = path.strip_prefix(&self.results).unwrap_or(path).to_owned();
        if self.files.iter().all(|known| known.file != file) {
            self.files.push(CheckedFile {
                file,
                state,
                reason: reason.to_owned(),
            });
        }
    }

    /// Notes what came of reading `path`; what was read, if it is whole.
    fn read<T>(
        &mut self,
        path: &Path,
        read: Result<T, TableError>,
    ) -> Result<Option<T>, TableError> {
        match read {
            Ok(value) => {
                self.note(path, FileState::Whole, "");
                Ok(Some(value))
            }
            Err(TableError::Damaged { path, reason }) => {
                let there = std::fs::symlink_metadata(&path).is_ok();
                let state = if there {
                    FileState::Damaged
                } else {
                    FileState::Missing
                };
                self.note(&path, state, &reason);
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// A file that may be absent.
    fn read_if_there<T>(
        &mut self,
        path: &Path,
        read: Result<Option<T>, TableError>,
    ) -> Result<Option<T>, TableError> {
        match read {
            Ok(None) => Ok(None),
            Ok(Some(value)) => self.read(path, Ok(value)),
            Err(error) => self.read(path, Err(error)),
        }
    }

    fn folder(&mut self) -> Result<(), PipelineError> {
        for error in misplacements(&self.results)? {
            if let TableError::Damaged { path, reason } = error {
                self.note(&path, FileState::Damaged, &reason);
            }
        }
        self.tables()?;
        self.parts()?;
        self.side_tables()?;
        self.runs()?;
        self.model()?;
        self.others()?;
        let shards = match shard_folders(&self.results) {
            Err(PipelineError::Table(TableError::Damaged { path, reason })) => {
                self.note(&path, FileState::Damaged, &reason);
                return Ok(());
            }
            shards => shards?,
        };
        let loads = folders_of_loads(&self.results).into_iter();
        for folder in shards.into_values().chain(loads.map(|(_, folder)| folder)) {
            match integrity(&folder) {
                Err(PipelineError::NoResults { .. }) => {}
                Err(error) => return Err(error),
                Ok(below) => self.below(&folder, below),
            }
        }
        Ok(())
    }

    /// Takes over what was found in `folder`, which lies in this one.
    fn below(&mut self, folder: &Path, found: Integrity) {
        self.build = self.build.take().or(found.build);
        let of = |file: &CheckedFile| {
            let path = folder.join(&file.file);
            path.strip_prefix(&self.results)
                .map_or_else(|_| folder.to_owned(), Path::to_owned)
        };
        let files = found.files.into_iter();
        let named = files.map(|checked| CheckedFile {
            file: of(&checked),
            ..checked
        });
        self.files.extend(named);
    }

    /// The manifest and its tables, or those that are on their way into their places.
    fn tables(&mut self) -> Result<(), TableError> {
        let next = self.results.join("next");
        let decided = self.read_if_there(&next.join(MANIFEST), Manifest::read(&next))?;
        let path = self.results.join(MANIFEST);
        let manifest = self.read_if_there(&path, Manifest::read(&self.results))?;
        let Some(manifest) = decided.as_ref().or(manifest.as_ref()) else {
            let table = self.results.join(RESPONSES);
            if matches!(Standing::at(&table), Ok(Standing::File)) {
                self.note(&path, FileState::Missing, "its tables are there");
            }
            return Ok(());
        };
        self.build = Some(manifest.build.clone());
        for (name, digest) in &manifest.tables {
            let staged = next.join(name);
            let waits = decided.is_some() && matches!(Standing::at(&staged), Ok(Standing::File));
            let place = if waits {
                staged
            } else {
                self.results.join(name)
            };
            let found = digest_stored(&place);
            match self.read_if_there(&place, found)? {
                Some(found) if found != *digest => {
                    self.files
                        .retain(|file| self.results.join(&file.file) != place);
                    self.note(
                        &place,
                        FileState::Damaged,
                        "its content is not what was written",
                    );
                }
                Some(_) => {}
                None => self.note(&place, FileState::Missing, "the manifest lists it"),
            }
        }
        Ok(())
    }

    fn parts(&mut self) -> Result<(), TableError> {
        let path = self.results.join("parts").join("header.json");
        let header = match PartHeader::read(&self.results) {
            Ok(None) => {
                if !unlisted_parts(&self.results)?.is_empty() {
                    self.note(&path, FileState::Missing, "there are parts");
                }
                return Ok(());
            }
            Ok(Some(header)) => self.read(&path, Ok(header))?,
            Err(error) => self.read(&path, Err(error))?,
        };
        let Some(header) = header else {
            return Ok(());
        };
        self.build.get_or_insert(header.build);
        for part in part_files(&self.results)? {
            let checked = part.check();
            self.read(&part.path, checked)?;
        }
        for path in unlisted_parts(&self.results)? {
            self.note(
                &path,
                FileState::Damaged,
                "the header of the parts does not list it",
            );
        }
        Ok(())
    }

    fn side_tables(&mut self) -> Result<(), TableError> {
        let path = self.results.join(CHECKSUMS);
        if matches!(Standing::at(&path), Ok(Standing::Nothing)) {
            return self.estimate();
        }
        let noted = SideTables::read(&self.results);
        for (name, table) in self.read(&path, noted)?.unwrap_or_default().tables {
            let place = self.results.join(&name);
            let checked = table.check(&place);
            // One that was about to take its place for the first time is not there yet.
            let waits = table.replaces.as_deref() == Some("") && checked.is_ok();
            if !waits || matches!(Standing::at(&place), Ok(Standing::File)) {
                self.read(&place, checked)?;
            }
        }
        self.estimate()
    }

    fn estimate(&mut self) -> Result<(), TableError> {
        let read = read_estimate(&self.results);
        let path = self.results.join("estimate.json");
        let Some(estimate): Option<Value> = self.read_if_there(&path, read)? else {
            return Ok(());
        };
        let table = self.results.join("sample.parquet");
        let found = digest_stored(&table)?;
        match found.as_deref() {
            None => self.note(&table, FileState::Missing, "estimate.json lists it"),
            found if found == estimate["sample_digest"].as_str() => {
                self.note(&table, FileState::Whole, "");
            }
            _ => self.note(
                &table,
                FileState::Damaged,
                "its content is not what was written",
            ),
        }
        Ok(())
    }

    fn runs(&mut self) -> Result<(), TableError> {
        for path in entries(&self.results.join("runs"))? {
            if path.extension().is_some_and(|ending| ending == "json") {
                let record = RunRecord::read(&path);
                self.read(&path, record)?;
            } else {
                self.leftover_or_foreign(&path);
            }
        }
        Ok(())
    }

    fn model(&mut self) -> Result<(), TableError> {
        let damaged = damaged_entries(&self.results)?;
        for path in entries(&self.results.join("model"))? {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if damaged.contains(&path) {
                let reason = "it is no model of its name; it is made anew";
                self.note(&path, FileState::Damaged, reason);
            } else if writer_of_leftover(&name).is_some() {
                self.leftover_or_foreign(&path);
            } else {
                self.note(&path, FileState::Whole, "");
            }
        }
        Ok(())
    }

    /// Everything else in the folder.
    fn others(&mut self) -> Result<(), TableError> {
        let folders = FOLDERS
            .iter()
            .chain(&ASIDE)
            .chain(&["shards", "slurm", ".lock"]);
        let folders: Vec<&&str> = folders.collect();
        let loads = folders_of_loads(&self.results);
        for path in entries(&self.results)? {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let written = SIDE_FILES.iter().chain(&TABLES).chain(&["report.html"]);
            let is_load = loads.iter().any(|(_, folder)| *folder == path);
            if is_load || folders.iter().any(|known| **known == name) {
                continue;
            }
            if written.into_iter().any(|known| *known == name) {
                self.note(
                    &path,
                    FileState::Unverified,
                    "nothing holds a checksum of it",
                );
            } else {
                self.leftover_or_foreign(&path);
            }
        }
        for path in entries(&self.results.join("next"))? {
            self.note(
                &path,
                FileState::Unverified,
                "an interrupted command left it",
            );
        }
        Ok(())
    }

    fn leftover_or_foreign(&mut self, path: &Path) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_hidden = name.starts_with('.') && name.ends_with(".tmp");
        if is_hidden || writer_of_leftover(&name).is_some() {
            self.note(
                path,
                FileState::Unverified,
                "an interrupted command left it",
            );
        } else {
            self.note(path, FileState::Foreign, "no command writes it");
        }
    }
}

/// What stands in `model/` of the folder `results` and is neither a model of its name nor left by an interrupted command.
pub(in crate::campaign) fn damaged_entries(results: &Path) -> Result<Vec<PathBuf>, TableError> {
    let mut found = entries(&results.join("model"))?;
    found.retain(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        !is_whole_entry(path) && writer_of_leftover(&name).is_none()
    });
    Ok(found)
}

/// What stands in a folder, in order; nothing where there is no folder.
fn entries(folder: &Path) -> Result<Vec<PathBuf>, TableError> {
    if !matches!(Standing::at(folder), Ok(Standing::Folder)) {
        return Ok(Vec::new());
    }
    let unread = |source| TableError::Io {
        action: "read",
        path: folder.to_owned(),
        source,
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        found.push(entry.map_err(unread)?.path());
    }
    found.sort();
    Ok(found)
}
