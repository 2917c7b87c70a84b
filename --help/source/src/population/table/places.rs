//! The places of a results folder: what they are called, and what may stand in them.
//!
//! Whatever a stored file says, nothing outside of its folder is read, moved or removed for it: names are those of the
//! lists here, and a link in the place of a file or folder is damage, as everything but a plain file or folder is.

use std::collections::BTreeMap;
use std::fs::FileType;
use std::io::{self, ErrorKind};
use std::path::Path;

use super::{TableError, digest_file};

/// Name of the manifest in its folder.
pub const MANIFEST: &str = "manifest.json";

/// Files that a manifest lists with their digests.
pub const TABLES: [&str; 7] = [
    "responses.parquet",
    "scenarios.parquet",
    "percentiles.parquet",
    "distribution.parquet",
    "main_effects.parquet",
    "patterns.parquet",
    "summary.txt",
];

/// Files that commands beside `run` write into a results folder.
pub const SIDE_FILES: [&str; 9] = [
    "checksums.json",
    "tradeoff.parquet",
    "tradeoff_rows.parquet",
    "tradeoff_times.parquet",
    "verification.parquet",
    "peak_audit.parquet",
    "tail_fits.parquet",
    "sample.parquet",
    "estimate.json",
];

/// Folders of a results folder that a run writes to.
pub const FOLDERS: [&str; 4] = ["parts", "runs", "next", "model"];

/// Name of the folder of the parts.
pub(super) const PARTS: &str = "parts";
/// The folder that finished tables wait in.
pub(super) const NEXT: &str = "next";
/// Folders that files are moved to.
pub const ASIDE: [&str; 2] = [DAMAGED, SUPERSEDED];

/// The folder that damaged files are moved to.
pub(super) const DAMAGED: &str = "damaged";
/// The folder that results of another build are moved to.
pub(super) const SUPERSEDED: &str = "superseded";

/// What stands in a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Nothing.
    Nothing,
    /// A file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link, wherever it leads.
    Link,
    /// A pipe, a socket or a device.
    Special,
}

impl Standing {
    /// What stands in `path`, which is not followed.
    ///
    /// # Errors
    /// The file system refused.
    pub fn at(path: &Path) -> io::Result<Self> {
        match std::fs::symlink_metadata(path) {
            Ok(found) => Ok(Self::of(found.file_type())),
            // Below what is no folder there is nothing.
            Err(error)
                if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                Ok(Self::Nothing)
            }
            Err(error) => Err(error),
        }
    }

    fn of(kind: FileType) -> Self {
        if kind.is_symlink() {
            Self::Link
        } else if kind.is_file() {
            Self::File
        } else if kind.is_dir() {
            Self::Folder
        } else {
            Self::Special
        }
    }

    /// The noun for a message.
    fn noun(self) -> &'static str {
        match self {
            Self::Nothing => "nothing",
            Self::File => "a file",
            Self::Folder => "a folder",
            Self::Link => "a symbolic link",
            Self::Special => "no plain file",
        }
    }
}

/// Whether there is a file in `path`.
///
/// # Errors
/// Something else is, or the file system refused.
pub fn is_file(path: &Path) -> Result<bool, TableError> {
    is(path, Standing::File)
}

/// Whether there is a folder in `path`.
///
/// # Errors
/// Something else is, or the file system refused.
pub fn is_folder(path: &Path) -> Result<bool, TableError> {
    is(path, Standing::Folder)
}

fn is(path: &Path, wanted: Standing) -> Result<bool, TableError> {
    match Standing::at(path).map_err(TableError::io("read", path))? {
        Standing::Nothing => Ok(false),
        found if found == wanted => Ok(true),
        found => Err(misplaced(path, found, wanted)),
    }
}

fn misplaced(path: &Path, found: Standing, wanted: Standing) -> TableError {
    let why = match found {
        Standing::Link => {
            "; a results folder is read without following links, so replace it by what it points to"
        }
        _ => "",
    };
    let reason = format!(
        "it is {}, and has to be {}{why}; `blisk verify DIR --repair` sets it aside",
        found.noun(),
        wanted.noun()
    );
    TableError::damaged(path, reason)
}

/// BLAKE3 digest, hexadecimal, of the file in `path`; none if there is none.
///
/// # Errors
/// Something else than a file is there, or it cannot be read.
pub fn digest_stored(path: &Path) -> Result<Option<String>, TableError> {
    if !is_file(path)? {
        return Ok(None);
    }
    match digest_file(path) {
        Ok(digest) => Ok(Some(digest)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(TableError::io("read", path)(error)),
    }
}

/// Places of the folder `results` in which something else stands than what belongs there.
///
/// # Errors
/// The file system refused.
pub fn misplacements(results: &Path) -> Result<Vec<TableError>, TableError> {
    let folders = FOLDERS.iter().chain(&ASIDE).chain(&["shards"]);
    let files = TABLES.iter().chain(&[MANIFEST, ".lock"]);
    let wanted = folders
        .map(|name| (*name, Standing::Folder))
        .chain(files.map(|name| (*name, Standing::File)));
    let mut found = Vec::new();
    for (name, wanted) in wanted {
        match is(&results.join(name), wanted) {
            Ok(_) => {}
            Err(error @ TableError::Damaged { .. }) => found.push(error),
            Err(error) => return Err(error),
        }
    }
    Ok(found)
}

/// Whether `text` is a BLAKE3 digest, hexadecimal.
pub(super) fn is_digest(text: &str) -> bool {
    let digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    text.len() == 2 * blake3::OUT_LEN && text.bytes().all(digit)
}

/// Checks that `tables`, which the file `path` lists, are those of a results folder.
pub(super) fn check_tables(
    path: &Path,
    tables: &BTreeMap<String, String>,
) -> Result<(), TableError> {
    for (name, digest) in tables {
        if !TABLES.contains(&name.as_str()) {
            let accepted = TABLES.join(", ");
            let reason = format!("it lists a table {name:?}; accepted: {accepted}");
            return Err(TableError::damaged(path, reason));
        }
        check_digest(path, name, digest)?;
    }
    Ok(())
}

/// Checks that what the file `path` lists as the digest of `name` is one.
pub(super) fn check_digest(path: &Path, name: &str, digest: &str) -> Result<(), TableError> {
    if is_digest(digest) {
        return Ok(());
    }
    let reason = format!("the digest of {name} is {digest:?}; accepted: 64 hexadecimal digits");
    Err(TableError::damaged(path, reason))
}
