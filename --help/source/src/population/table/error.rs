//! What can go wrong with the tables of a results folder.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::response::mistuning::PatternFileError;

/// A table that cannot be written or read.
#[derive(Debug, Error)]
pub enum TableError {
    /// The file system refused.
    #[error("cannot {action} {}: {source}", path.display())]
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
    /// A Parquet file is to be read or written without the feature that does it.
    #[error("{} is a Parquet file, and this build of blisk has none of them; accepted: the feature `parquet`", path.display())]
    NoParquet {
        /// The file.
        path: PathBuf,
    },
}

/// What is wrong with a Parquet file of patterns.
#[derive(Debug, Error)]
pub enum PatternParquetError {
    /// The file cannot be read as Parquet.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Its content is not accepted.
    #[error(transparent)]
    Content(#[from] PatternFileError),
}

impl TableError {
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io {
            action,
            path: path.to_owned(),
            source,
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
