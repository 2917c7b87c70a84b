//! `checksums.json`: digests of the tables that commands beside `run` write into a results folder.
//!
//! A table waits in `next/` while its digest is noted beside that of the table it replaces, and then takes its place; so
//! whenever the process is killed, the table in its place is one that is noted.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::TableError;
use super::atomic::move_file;
use super::checked_json::{read_checked_json, write_checked_json};
use super::places::{NEXT, SIDE_FILES, check_digest, digest_stored, is_file};
use super::publication::discard;
use crate::identity;

/// Name of the file.
pub const CHECKSUMS: &str = "checksums.json";

/// What a reader is told of a table that nothing vouches for.
const NOT_NOTED: &str = "checksums.json does not note it, so that nothing tells whether it is as it was written; have its command write it again, or remove it";
/// What a reader is told of a table that has changed.
const CHANGED: &str =
    "its content is not what was written; have its command write it again, or remove it";
/// What is told of a table that is not there.
const MISSING: &str = "it is missing; have its command write it again";

/// A table that a command beside `run` wrote.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SideTable {
    /// Its BLAKE3 digest.
    pub digest: String,
    /// Identity of the build that wrote it.
    pub build: String,
    /// While it takes its place: the digest of what stands there before, empty if nothing does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replaces: Option<String>,
}

impl SideTable {
    /// Checks the table `path` that it is about.
    ///
    /// # Errors
    /// The table is missing or not as it was written, or cannot be read.
    pub fn check(&self, path: &Path) -> Result<(), TableError> {
        let found = digest_stored(path)?.unwrap_or_default();
        if found == self.digest || self.replaces.as_ref() == Some(&found) {
            return Ok(());
        }
        let reason = if found.is_empty() { MISSING } else { CHANGED };
        Err(TableError::damaged(path, reason))
    }
}

/// What is noted of the tables that commands beside `run` wrote.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SideTables {
    /// By file name.
    pub tables: BTreeMap<String, SideTable>,
}

impl SideTables {
    /// Reads `checksums.json` of the folder `results`; empty if there is none.
    ///
    /// # Errors
    /// The file cannot be read or is damaged.
    pub fn read(results: &Path) -> Result<Self, TableError> {
        let path = results.join(CHECKSUMS);
        let noted: Self = read_checked_json(&path)?.unwrap_or_default();
        for (name, table) in &noted.tables {
            if !SIDE_FILES.contains(&name.as_str()) {
                let reason = format!(
                    "it notes a table {name:?}; accepted: {}",
                    SIDE_FILES.join(", ")
                );
                return Err(TableError::damaged(&path, reason));
            }
            check_digest(&path, name, &table.digest)?;
        }
        Ok(noted)
    }

    /// Notes the table `name` of the folder `results` no longer.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn without(results: &Path, name: &str) -> Result<(), TableError> {
        let mut noted = Self::read(results)?;
        noted.tables.remove(name);
        noted.write(results)
    }

    fn write(&self, results: &Path) -> Result<(), TableError> {
        write_checked_json(&results.join(CHECKSUMS), self)
    }
}

/// Has `write` write the table `name` of the folder `results`, which this process has locked, and notes its digest.
///
/// # Errors
/// A file cannot be read or written.
pub fn write_side_table(
    results: &Path,
    name: &str,
    write: impl FnOnce(&Path) -> Result<(), TableError>,
) -> Result<(), TableError> {
    let (path, staged) = (results.join(name), results.join(NEXT).join(name));
    write(&staged)?;
    // What is noted and damaged is noted anew: nothing else would ever make it whole.
    let mut noted = match SideTables::read(results) {
        Err(TableError::Damaged { .. }) => SideTables::default(),
        noted => noted?,
    };
    let mut table = SideTable {
        digest: digest_stored(&staged)?.unwrap_or_default(),
        build: identity::BUILD.to_owned(),
        replaces: Some(digest_stored(&path)?.unwrap_or_default()),
    };
    noted.tables.insert(name.to_owned(), table.clone());
    noted.write(results)?;
    move_file(&staged, &path)?;
    table.replaces = None;
    noted.tables.insert(name.to_owned(), table);
    noted.write(results)?;
    discard(results)
}

/// Checks the table `name` of the folder `results` against its digest; what is noted of it, or none if there is no
/// such table.
///
/// # Errors
/// Its digest is not noted or another, or a file cannot be read.
pub(super) fn check_side_table(
    results: &Path,
    name: &str,
) -> Result<Option<SideTable>, TableError> {
    let path = results.join(name);
    if !is_file(&path)? {
        return Ok(None);
    }
    match SideTables::read(results)?.tables.remove(name) {
        Some(table) => table.check(&path).map(|()| Some(table)),
        None => Err(TableError::damaged(&path, NOT_NOTED)),
    }
}
