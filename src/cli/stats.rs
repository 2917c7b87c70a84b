//! `blisk stats`: the summary of a results folder, from its tables.

use std::path::Path;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::report::{StatisticsReport, StudySummary};
use crate::study::{fit_result_tails, summarise};

pub(super) fn command(results: &Path, tails: bool, json: bool) -> Result<ExitStatus, Failure> {
    let summary = summarise(results)?;
    let report = StatisticsReport {
        tails: tails.then(|| fit_result_tails(results)).transpose()?,
        summary,
    };
    output::result(json, &report);
    Ok(status_of(&report.summary))
}

/// How a command that shows `summary` ends.
pub(super) fn status_of(summary: &StudySummary) -> ExitStatus {
    if summary.failures_cost_a_statistic() {
        ExitStatus::FailureGate
    } else {
        ExitStatus::Done
    }
}
