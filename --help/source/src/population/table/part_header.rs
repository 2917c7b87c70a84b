//! `parts/header.json`: which build solved the parts of a results folder, and which there are.
//!
//! Without it a deleted part would be missing from nothing. A part is named as coming before it takes its place, and as
//! there with the next one or at the end; so a process that is killed in between leaves no part that is listed and
//! missing, and none that is there and not listed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::checked_json::{read_checked_json, write_checked_json};
use super::places::{NEXT, PARTS, Standing, TABLES, is_digest, is_folder};
use super::{MANIFEST, RowFile, RunRecord, TableError};
use crate::identity;

/// Name of the header in that folder.
const HEADER: &str = "header.json";

/// What comes after the name of a part that should not be there.
const NOT_LISTED: &str = "parts/header.json does not list it: it is no part of this folder; `blisk verify DIR --repair` sets it aside";
/// What comes after the name of a header that should be there.
const NO_HEADER: &str = "it is missing, so that nothing says which build solved the parts beside it; `blisk verify DIR --repair` makes it anew where the manifest says which";

/// The header of the parts of a results folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PartHeader {
    /// Identity of the build that solved the rows.
    pub build: String,
    /// Names of the parts.
    pub parts: BTreeSet<String>,
    /// The part that is taking its place; not there if the process was killed before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coming: Option<String>,
}

impl PartHeader {
    /// A header without parts, of this build.
    #[must_use]
    pub fn new() -> Self {
        Self {
            build: identity::BUILD.to_owned(),
            parts: BTreeSet::new(),
            coming: None,
        }
    }

    /// Reads the header in the results folder `results`; none if there is none.
    ///
    /// # Errors
    /// It cannot be read or is damaged.
    pub fn read(results: &Path) -> Result<Option<Self>, TableError> {
        let folder = results.join(PARTS);
        if !is_folder(&folder)? {
            return Ok(None);
        }
        let path = folder.join(HEADER);
        let header: Option<Self> = read_checked_json(&path)?;
        if let Some(header) = &header {
            let mut names = header.parts.iter().chain(&header.coming);
            if let Some(name) = names.find(|name| row_file(&folder, name).is_none()) {
                let reason = format!("it lists {name:?}, which is no name of a part");
                return Err(TableError::damaged(&path, reason));
            }
        }
        Ok(header)
    }

    /// Writes it into the results folder `results`.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, results: &Path) -> Result<(), TableError> {
        write_checked_json(&results.join(PARTS).join(HEADER), self)
    }

    /// The parts that should be in the results folder `results`.
    ///
    /// # Errors
    /// The file system refused.
    fn files(&self, results: &Path) -> Result<Vec<RowFile>, TableError> {
        let folder = results.join(PARTS);
        let mut names = self.parts.clone();
        if let Some(coming) = &self.coming {
            let path = folder.join(coming);
            let standing = Standing::at(&path).map_err(TableError::io("read", &path))?;
            if standing != Standing::Nothing {
                names.insert(coming.clone());
            }
        }
        let files = names.iter().filter_map(|name| row_file(&folder, name));
        Ok(files.collect())
    }

    /// Records that the part `name` is coming, and whether the part announced before is there.
    pub(super) fn announce(&mut self, results: &Path, name: &str) -> Result<(), TableError> {
        self.settle(results)?;
        self.coming = Some(name.to_owned());
        self.write(results)
    }

    /// Takes the part that was coming for one that is there, if it is; whether it was one.
    fn settle(&mut self, results: &Path) -> Result<bool, TableError> {
        self.parts = self
            .files(results)?
            .iter()
            .filter_map(|file| Some(file.path.file_name()?.to_string_lossy().into_owned()))
            .collect();
        Ok(self.coming.take().is_some())
    }

    /// Lists the last part for good.
    pub(super) fn close(&mut self, results: &Path) -> Result<(), TableError> {
        if self.settle(results)? {
            self.write(results)?;
        }
        Ok(())
    }
}

impl Default for PartHeader {
    fn default() -> Self {
        Self::new()
    }
}

/// The part `name` of a folder: `part-<first pattern>-<digest>.parquet`; none if that is no such name.
fn row_file(folder: &Path, name: &str) -> Option<RowFile> {
    let (from, digest) = name
        .strip_prefix("part-")?
        .strip_suffix(".parquet")?
        .split_once('-')?;
    let digits = from.len() == 10 && from.bytes().all(|byte| byte.is_ascii_digit());
    (digits && is_digest(digest)).then_some(())?;
    Some(RowFile {
        path: folder.join(name),
        digest: digest.to_owned(),
        from: from.parse().ok()?,
    })
}

/// The parts of the results folder `results`, by the digests in their names.
///
/// # Errors
/// The header of the parts cannot be read or is damaged.
pub fn part_files(results: &Path) -> Result<Vec<RowFile>, TableError> {
    match PartHeader::read(results)? {
        Some(header) => header.files(results),
        None => Ok(Vec::new()),
    }
}

/// What stands in the folder of the parts beside the header and what it lists, hidden files left out; without a header
/// all of it. For the process that writes there: seen from another one, parts come at any time.
///
/// # Errors
/// The file system refused, or the header is damaged.
pub fn unlisted_parts(results: &Path) -> Result<Vec<PathBuf>, TableError> {
    let listed = part_files(results)?;
    let mut found = names_in_parts(results)?;
    found.retain(|path| listed.iter().all(|file| file.path != *path));
    Ok(found)
}

/// What stands in the folder of the parts beside the header, hidden files left out.
fn names_in_parts(results: &Path) -> Result<Vec<PathBuf>, TableError> {
    let folder = results.join(PARTS);
    if !is_folder(&folder)? {
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(TableError::io("read", &folder))? {
        let path = entry.map_err(TableError::io("read", &folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name != HEADER && !name.starts_with('.') {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Whether something stands in the results folder `results` that a run or an estimate leaves there, whole or not: a
/// manifest, rows, parts or a record.
///
/// # Errors
/// The file system refused.
pub fn holds_results(results: &Path) -> Result<bool, TableError> {
    let parts = results.join(PARTS);
    let header = parts.join(HEADER);
    let next = results.join(NEXT);
    for place in [
        results.join(MANIFEST),
        results.join(TABLES[0]),
        next.join(MANIFEST),
        header,
    ] {
        if Standing::at(&place).map_err(TableError::io("read", &place))? != Standing::Nothing {
            return Ok(true);
        }
    }
    let listed = |found: Result<Vec<PathBuf>, TableError>| match found {
        Err(TableError::Damaged { .. }) => Ok(Vec::new()),
        found => found,
    };
    let is_part = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        row_file(&parts, &name).is_some()
    };
    Ok(!listed(RunRecord::places(results))?.is_empty()
        || listed(names_in_parts(results))?.iter().any(is_part))
}

/// Checks that the folder of the parts holds a header and what that lists, and nothing else.
///
/// # Errors
/// It does not, or cannot be read.
pub fn check_parts(results: &Path) -> Result<(), TableError> {
    let Some(first) = unlisted_parts(results)?.into_iter().next() else {
        return Ok(());
    };
    if PartHeader::read(results)?.is_none() {
        let header = results.join(PARTS).join(HEADER);
        return Err(TableError::damaged(&header, NO_HEADER));
    }
    Err(TableError::damaged(&first, NOT_LISTED))
}

/// Makes the header of parts anew, from the names and contents of those that are there, which `build` has solved; none:
/// this one.
///
/// # Errors
/// A file cannot be read or written.
pub fn renew_header(results: &Path, build: Option<String>) -> Result<(), TableError> {
    let folder = results.join(PARTS);
    let mut header = PartHeader::new();
    header.build = build.unwrap_or(header.build);
    for path in names_in_parts(results)? {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if row_file(&folder, &name).is_some_and(|part| part.check().is_ok()) {
            header.parts.insert(name.into_owned());
        }
    }
    header.write(results)
}
