//! `blisk stats`: the summary of a results folder, from its tables or from what is stored so far.

use std::path::Path;

use serde::Serialize;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::report::{StatisticsReport, StudySummary};
use crate::study::{PartialSummary, fit_result_tails, summarise, summarise_partly};

pub(super) fn command(results: &Path, tails: bool, json: bool) -> Result<ExitStatus, Failure> {
    let Some(partial) = summarise_partly(results)? else {
        let summary = summarise(results)?;
        let report = StatisticsReport {
            tails: tails.then(|| fit_result_tails(results)).transpose()?,
            summary,
        };
        output::result(json, &report);
        return Ok(status_of(&report.summary));
    };
    let PartialSummary {
        summary,
        stored,
        planned,
    } = &partial;
    let warning = format!(
        "UNFINISHED: these are the statistics of {stored} of {planned} rows; `blisk run` continues the study"
    );
    if json {
        output::json_only(&PartialJson {
            unfinished: true,
            rows_stored: *stored,
            rows_planned: *planned,
            summary,
        });
    } else {
        output::text(&format!("{warning}\n\n{summary}\n{warning}"));
    }
    Ok(ExitStatus::Done)
}

/// The summary of an unfinished study as JSON.
#[derive(Serialize)]
struct PartialJson<'a> {
    unfinished: bool,
    rows_stored: u64,
    rows_planned: u64,
    #[serde(flatten)]
    summary: &'a StudySummary,
}

/// How a command that shows `summary` ends.
pub(super) fn status_of(summary: &StudySummary) -> ExitStatus {
    if summary.failures_cost_a_statistic() {
        ExitStatus::FailureGate
    } else {
        ExitStatus::Done
    }
}
