//! `blisk stats`: the summary of a results folder, from its tables.

use std::path::PathBuf;

use clap::Args;

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::report::{StatisticsReport, StudySummary};
use crate::study::{fit_result_tails, summarise};

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
}

pub(super) fn command(arguments: &StatsArguments) -> Result<ExitStatus, Failure> {
    let results = &arguments.results;
    let tails = arguments.tails.then(|| fit_result_tails(results));
    let report = StatisticsReport {
        summary: summarise(results)?,
        tails: tails.transpose()?,
    };
    output::result(arguments.json, &report);
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
