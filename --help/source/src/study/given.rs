//! What a program that uses the library has in memory, in the place of files that a study names.

use std::sync::Arc;

use crate::model::sector::SectorModel;
use crate::response::mistuning::PatternRecords;

/// Parts of a study that its text leaves out.
#[derive(Debug, Clone, Default)]
pub(crate) struct Given {
    /// In the place of `[model]`.
    pub(crate) model: Option<Arc<SectorModel>>,
    /// In the place of the file that `mistuning.file` names.
    pub(crate) records: Option<PatternRecords>,
}
