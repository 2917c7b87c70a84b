//! The mistuning of a study: projection, and a law or a file of patterns.

use std::path::PathBuf;

use crate::response::mistuning::{Distribution, PatternRecords, Projection};

/// Where the patterns come from.
#[derive(Debug, Clone, PartialEq)]
pub enum MistuningSource {
    /// A law, scaled to unit standard deviation; the standard deviations are in the sweep.
    Law(Distribution),
    /// A file of patterns.
    File {
        /// The file as written in the study.
        written: String,
        /// The file, resolved against the study file.
        path: PathBuf,
        /// Its records.
        records: PatternRecords,
    },
}

/// Mistuning of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Mistuning {
    /// How a deviation enters the reduced stiffness.
    pub projection: Projection,
    /// Cantilevered-blade modes of the classical projection; none for the exact one.
    pub cantilever_mode_count: Option<usize>,
    /// Source of the patterns.
    pub source: MistuningSource,
}
