//! Reduced models on disk, found again by the digest of all that they depend on.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::sector::SectorModel;
use crate::identity;

/// Layout and meaning of the stored bytes; part of every digest, so that an older file is never misread.
const LAYOUT: u32 = 5;

/// A cache that cannot be written. An unreadable entry is no error: it is made anew.
#[derive(Debug, Error)]
#[error("cannot write the reduced model to {}: {source}", path.display())]
pub struct CacheError {
    /// File or folder.
    pub path: PathBuf,
    /// Cause.
    pub source: std::io::Error,
}

/// Digest, hexadecimal, of a sector model and of the settings `key` of its reduction.
#[must_use]
pub fn reduction_digest(model: &SectorModel, key: &str) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut text = |part: &str| {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    };
    text(&format!("{LAYOUT} build {}", identity::BUILD));
    text(key);
    text(&format!(
        "{:?} {} {:?} {:?} {:?} {:?} {:?}",
        model.name,
        model.sectors,
        model.dofs,
        model.cyclic_pairs,
        model.contact_pairs,
        model.force,
        model.observed,
    ));
    if !model.load_case_forces.is_empty() {
        text(&format!("{:?}", model.load_case_forces));
    }
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

/// Reads the entry `digest` of the cache `folder`; none if it is absent or damaged.
#[must_use]
pub fn read_cached<T: DeserializeOwned>(folder: &Path, digest: &str) -> Option<T> {
    let bytes = std::fs::read(folder.join(digest)).ok()?;
    let (checksum, payload) = bytes.split_at_checked(blake3::OUT_LEN)?;
    if blake3::hash(payload).as_bytes() != checksum {
        return None;
    }
    postcard::from_bytes(payload).ok()
}

/// Writes the entry `digest` of the cache `folder`: a checksum, then the value; first under
/// another name, so that an interrupted write leaves no entry.
///
/// # Errors
/// If the folder or file cannot be written.
pub fn write_cached<T: Serialize>(
    folder: &Path,
    digest: &str,
    value: &T,
) -> Result<(), CacheError> {
    let path = folder.join(digest);
    let failed = |source| CacheError {
        path: path.clone(),
        source,
    };
    let payload = postcard::to_stdvec(value)
        .map_err(|error| failed(std::io::Error::other(error.to_string())))?;
    std::fs::create_dir_all(folder).map_err(failed)?;
    let partial = folder.join(format!("{digest}.{}.partial", std::process::id()));
    let write = || -> std::io::Result<()> {
        let mut file = std::fs::File::create(&partial)?;
        file.write_all(blake3::hash(&payload).as_bytes())?;
        file.write_all(&payload)?;
        file.sync_all()?;
        std::fs::rename(&partial, &path)
    };
    write()
        .inspect_err(|_| {
            // Nothing more can be done about a leftover than to try to remove it.
            let _ = std::fs::remove_file(&partial);
        })
        .map_err(failed)
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
}
