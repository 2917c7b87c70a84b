//! `blisk stats`: the summary of a results folder, from its tables.

use std::path::Path;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::report::StudySummary;
use crate::study::summarise;

pub(super) fn command(results: &Path, json: bool) -> Result<ExitStatus, Failure> {
    let summary = summarise(results)?;
    output::result(json, &summary);
    Ok(status_of(&summary))
}

/// How a command that shows `summary` ends.
pub(super) fn status_of(summary: &StudySummary) -> ExitStatus {
    if summary.failures_cost_a_statistic() {
        ExitStatus::FailureGate
    } else {
        ExitStatus::Done
    }
}
