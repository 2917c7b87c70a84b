//! A study from file to results folder.

use crate::campaign::{RunOutcome, RunRequest};
use crate::settings::{Progress, ReducedEngineSource};
use crate::study::PipelineError;

/// Creates or continues a study in its results folder, as the command `blisk run` does, with the same tables.
///
/// A finished study is not solved again. `progress` is told of every row, and may ask the run to stop; `&()` does neither.
///
/// # Errors
/// A stage that failed or was stopped. What is stored stays stored, and the same call continues.
pub fn run(request: RunRequest<'_>, progress: &dyn Progress) -> Result<RunOutcome, PipelineError> {
    crate::campaign::run(request, &ReducedEngineSource, progress)
}
