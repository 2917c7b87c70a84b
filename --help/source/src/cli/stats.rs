//! `blisk stats`: the summary of a results folder, from its tables or from what is stored so far.

use std::path::PathBuf;

use clap::Args;

use serde::Serialize;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::campaign::{PartialSummary, fit_result_tails, summarise, summarise_partly};
use crate::report::{StatisticsReport, StudySummary, statistics_csv};

/// Arguments of `blisk stats`.
#[derive(Debug, Args)]
pub struct StatsArguments {
    /// The results folder.
    results: PathBuf,
    /// Fit Weibull and generalised extreme value laws to the tails, beside the percentiles.
    ///
    /// Writes `tail_fits.parquet` into the results folder.
    #[arg(long)]
    tails: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Print one table of comma-separated values, a row per scenario, for a spreadsheet.
    #[arg(long, conflicts_with_all = ["json", "tails"])]
    csv: bool,
}

pub(super) fn command(arguments: &StatsArguments) -> Result<ExitStatus, Failure> {
    let results = &arguments.results;
    let Some(partial) = summarise_partly(results)? else {
        let summary = summarise(results)?;
        if arguments.csv {
            output::text(&statistics_csv(&summary).trim_end())?;
            return Ok(status_of(&summary));
        }
        let report = StatisticsReport {
            tails: arguments
                .tails
                .then(|| fit_result_tails(results))
                .transpose()?,
            summary,
        };
        output::result(arguments.json, &report)?;
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
    if arguments.csv {
        output::message(&warning);
        output::text(&statistics_csv(summary).trim_end())?;
    } else if arguments.json {
        output::json_only(&PartialJson {
            unfinished: true,
            rows_stored: *stored,
            rows_planned: *planned,
            summary,
        })?;
    } else {
        output::text(&format!("{warning}\n\n{summary}\n{warning}"))?;
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
    } else if summary.misses_its_target() {
        ExitStatus::TargetUnmet
    } else {
        ExitStatus::Done
    }
}
