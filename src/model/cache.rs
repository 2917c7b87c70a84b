//! Reduced models on disk, found again by the digest of all that they depend on.

use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::sector::SectorModel;
use crate::identity::{self, bytes_of};

/// Layout and meaning of the stored bytes; part of every digest, so that an older file is never misread.
const LAYOUT: u32 = 6;
/// Attempts to write an entry whose unfinished file another process takes away.
const ATTEMPTS: u32 = 3;

/// A cache that cannot be written. An unreadable entry is no error: it is made anew.
#[derive(Debug, Error)]
#[error("cannot write the reduced model to {}: {source}", path.display())]
pub struct CacheError {
    /// File or folder.
    pub path: PathBuf,
    /// Cause.
    pub source: io::Error,
}

/// Digest, hexadecimal, of a sector model and of all that its reduction depends on besides, for this build.
#[must_use]
pub fn reduction_digest(model: &SectorModel, key: &(impl Serialize + ?Sized)) -> String {
    let layout = format!("{LAYOUT} build {}", identity::BUILD);
    let parts = (layout, key, sector_digest(model));
    blake3::hash(&bytes_of(&parts)).to_hex().to_string()
}

/// Digest, hexadecimal, of a sector model.
#[must_use]
pub fn sector_digest(model: &SectorModel) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut part = |bytes: Vec<u8>| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(&bytes);
    };
    part(bytes_of(&(&model.name, model.sectors, &model.dofs)));
    part(bytes_of(&(&model.cyclic_pairs, &model.contact_pairs)));
    part(bytes_of(&model.load_case_forces.len()));
    for force in std::iter::once(&model.force).chain(&model.load_case_forces) {
        let numbers = force.iter().map(|(dof, force)| (dof, force.re, force.im));
        part(bytes_of(&numbers.collect::<Vec<_>>()));
    }
    part(bytes_of(&(&model.observed, &model.rigid_points)));
    for matrix in [&model.stiffness, &model.mass, &model.blade_stiffness] {
        for (row, column, value) in matrix.lower_entries() {
            hasher.update(&(row as u64).to_le_bytes());
            hasher.update(&(column as u64).to_le_bytes());
            hasher.update(&value.to_bits().to_le_bytes());
        }
        hasher.update(&(matrix.dimension() as u64).to_le_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// Reads the entry `key` of the cache `folder`; none if it is absent, damaged, or an entry under another name.
///
/// What is read has to fit to what asks for it: sizes are for the caller to check.
#[must_use]
pub fn read_cached<T: DeserializeOwned>(folder: &Path, key: &str) -> Option<T> {
    let bytes = whole_entry(&folder.join(key), key)?;
    let (value, rest) = postcard::take_from_bytes(bytes.get(blake3::OUT_LEN..)?).ok()?;
    rest.is_empty().then_some(value)
}

/// Whether the file `path` of a cache is as it was written under its name.
#[must_use]
pub fn is_whole_entry(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| whole_entry(path, name).is_some())
}

/// The bytes of an entry, checksum first, if that is the checksum of the key and the rest.
fn whole_entry(path: &Path, key: &str) -> Option<Vec<u8>> {
    // A link could lead to an entry of another cache, and a pipe to nowhere.
    let is_file = std::fs::symlink_metadata(path).is_ok_and(|found| found.is_file());
    let bytes = is_file.then(|| std::fs::read(path).ok()).flatten()?;
    let (checksum, payload) = bytes.split_at_checked(blake3::OUT_LEN)?;
    (checksum_of(key, payload).as_bytes() == checksum).then_some(bytes)
}

/// Checksum of an entry: of its key and its content together, so that an entry is worth nothing under another name.
fn checksum_of(key: &str, payload: &[u8]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&(key.len() as u64).to_le_bytes());
    hasher.update(key.as_bytes());
    hasher.update(payload);
    hasher.finalize()
}

/// Writes the entry `key` of the cache `folder`: a checksum, then the value; first under
/// another name, so that an interrupted write leaves no entry.
///
/// # Errors
/// If the folder or file cannot be written.
pub fn write_cached<T: Serialize>(folder: &Path, key: &str, value: &T) -> Result<(), CacheError> {
    let path = folder.join(key);
    let failed = |source| CacheError {
        path: path.clone(),
        source,
    };
    let payload =
        postcard::to_stdvec(value).map_err(|error| failed(io::Error::other(error.to_string())))?;
    std::fs::create_dir_all(folder).map_err(failed)?;
    let partial = folder.join(format!("{key}.{}.partial", std::process::id()));
    let write = || -> io::Result<()> {
        // Of a process with the same number that was killed.
        let _ = std::fs::remove_file(&partial);
        let mut file = File::create_new(&partial)?;
        file.write_all(checksum_of(key, &payload).as_bytes())?;
        file.write_all(&payload)?;
        file.sync_all()?;
        std::fs::rename(&partial, &path)
    };
    let mut written = write();
    for _ in 1..ATTEMPTS {
        // On another machine that shares the folder this process can seem to have ended.
        if written
            .as_ref()
            .is_err_and(|error| error.kind() == ErrorKind::NotFound)
        {
            written = write();
        }
    }
    written
        .inspect_err(|_| {
            // Nothing more can be done about a leftover than to try to remove it.
            let _ = std::fs::remove_file(&partial);
        })
        .map_err(failed)
}

/// The process that wrote the file `name` of a cache and did not finish it; none for any other file.
#[must_use]
pub fn writer_of_leftover(name: &str) -> Option<u32> {
    let (_, process) = name.strip_suffix(".partial")?.rsplit_once('.')?;
    process.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_is_read_back_and_a_damaged_one_is_not() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let value = vec![1.0_f64, -0.0, f64::MIN_POSITIVE];
        write_cached(folder.path(), "abc", &value).expect("written");
        assert_eq!(read_cached(folder.path(), "abc"), Some(value));
        let path = folder.path().join("abc");
        let mut bytes = std::fs::read(&path).expect("read");
        let last = bytes.len() - 1;
        bytes[last] ^= 1;
        std::fs::write(&path, bytes).expect("written");
        assert_eq!(read_cached::<Vec<f64>>(folder.path(), "abc"), None);
        assert_eq!(read_cached::<Vec<f64>>(folder.path(), "other"), None);
    }

    #[test]
    fn a_whole_entry_under_another_name_is_none() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        write_cached(folder.path(), "abc", &vec![1.0_f64]).expect("written");
        std::fs::copy(folder.path().join("abc"), folder.path().join("abd")).expect("copied");
        assert_eq!(read_cached::<Vec<f64>>(folder.path(), "abd"), None);
        assert!(is_whole_entry(&folder.path().join("abc")));
        assert!(!is_whole_entry(&folder.path().join("abd")));
        // Nor is one whose value is only the beginning of what is stored.
        assert_eq!(read_cached::<u8>(folder.path(), "abc"), None);
    }

    #[test]
    fn an_unfinished_file_names_its_writer() {
        assert_eq!(writer_of_leftover("abc.17.partial"), Some(17));
        for other in ["abc", "abc.partial", "17.partial.tmp", "abc.x.partial"] {
            assert_eq!(writer_of_leftover(other), None, "{other}");
        }
    }
}
