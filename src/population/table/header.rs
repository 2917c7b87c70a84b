//! What every table says of itself: version, study, compression, load cases.

use serde::{Deserialize, Serialize};

use super::ColumnSpec;
use super::column::key;
use crate::population::monte_carlo::{LoadCaseName, Scenario};

/// Version of the tables; raised when a column changes its meaning.
pub const SCHEMA_VERSION: u32 = 1;

/// Key of the study digest in the metadata of a file.
pub(super) const STUDY_DIGEST_KEY: &str = "blisk.study_digest";
/// Key of the digests of what the rows of each scenario are made from, separated by commas.
pub(super) const ROW_DIGESTS_KEY: &str = "blisk.row_digests";

/// Compression of the pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Compression {
    /// Zstandard; small. Default.
    #[default]
    Zstd,
    /// Snappy; for readers without Zstandard.
    Snappy,
}

/// What every table of a study says about itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableHeader {
    /// Digest of the study, hexadecimal.
    pub study_digest: String,
    /// Compression of its tables.
    pub compression: Compression,
    /// Load case of each scenario, in their order; empty in a study without load cases. Every table
    /// with scenarios and engine orders then has the column `load_case`.
    pub load_cases: Vec<LoadCaseName>,
}

impl TableHeader {
    /// Load case of each of `scenarios`, where the study has any.
    #[must_use]
    pub fn load_cases_of(scenarios: &[Scenario]) -> Vec<LoadCaseName> {
        scenarios
            .iter()
            .filter_map(|scenario| scenario.load_case)
            .collect()
    }

    /// Place of the column `load_case` in a table of `columns`, if it has one.
    pub(super) fn place_of_load_case(&self, columns: &[ColumnSpec]) -> Option<usize> {
        let has_load_cases = !self.load_cases.is_empty() && columns.contains(&key::SCENARIO);
        let engine_order = || {
            columns
                .iter()
                .position(|column| *column == key::ENGINE_ORDER)
        };
        has_load_cases.then(engine_order).flatten()
    }
}
