//! What can be wrong with a study file: where, which key, which value, and what is accepted.

use std::path::PathBuf;

use thiserror::Error;

use crate::input::{Finding, listed};
use crate::model::sector::ModelError;
use crate::population::table::PatternParquetError;
use crate::response::mistuning::PatternFileError;

/// A study that cannot be used.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The study file cannot be read.
    #[error("cannot read the study {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Keys or values are not accepted; every one that was found.
    #[error("{}", listed(path, findings))]
    Invalid {
        /// The file.
        path: PathBuf,
        /// What was found.
        findings: Vec<Finding>,
    },
    /// The file of patterns is not accepted.
    #[error(transparent)]
    Patterns(#[from] PatternFileError),
    /// The Parquet file of patterns is not accepted.
    #[error(transparent)]
    PatternTable(#[from] PatternParquetError),
    /// The model is refused that a number of the study is made from.
    #[error(transparent)]
    Model(Box<ModelError>),
    /// An input file that the study names cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}
