//! What can go wrong with the tables of a results folder.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// A table that cannot be written or read.
#[derive(Debug, Error)]
pub enum TableError {
    /// The file system refused.
    #[error("cannot {action} {}: {source}{}", path.display(), remedy(source))]
    Io {
        /// What was tried, for instance `write`.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The Parquet encoder or the file under it failed.
    #[error("cannot write {}: {reason}", path.display())]
    Encoding {
        /// The file.
        path: PathBuf,
        /// Why it failed.
        reason: String,
    },
    /// The file is not what it should be.
    #[error("{} is damaged or not a table of blisk: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl TableError {
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io {
            action,
            path: path.to_owned(),
            source,
        }
    }

    /// What the encoder says: the file system's own error where there is one.
    pub(super) fn polars(path: &Path, error: polars::prelude::PolarsError) -> Self {
        use polars::prelude::PolarsError;
        match error {
            PolarsError::IO { error, .. } => Self::Io {
                action: "write",
                path: path.to_owned(),
                source: std::io::Error::new(error.kind(), error.to_string()),
            },
            other => Self::encoding(path, other.to_string()),
        }
    }

    pub(super) fn damaged(path: &Path, reason: impl Into<String>) -> Self {
        Self::Damaged {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }

    pub(super) fn encoding(path: &Path, reason: impl Into<String>) -> Self {
        Self::Encoding {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }
}

/// What can be done about an error of the file system, as the end of a sentence.
fn remedy(error: &std::io::Error) -> &'static str {
    use std::io::ErrorKind;
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            "; free some space, or choose another --out, and run again: what is stored stays stored"
        }
        ErrorKind::PermissionDenied => {
            "; grant this user access to it, or choose another --out, and run again"
        }
        ErrorKind::ReadOnlyFilesystem => {
            "; make the file system writable, or choose another --out, and run again"
        }
        ErrorKind::NotFound
        | ErrorKind::NotADirectory
        | ErrorKind::IsADirectory
        | ErrorKind::AlreadyExists => "; check the path",
        _ => "; check the disk and run again: what is stored stays stored",
    }
}
