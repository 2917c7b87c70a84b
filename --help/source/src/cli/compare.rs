//! `blisk compare`: scenarios against each other, on common patterns where there are any.

use std::path::PathBuf;

use clap::Args;

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::campaign::{CompareRequest, compare};

/// Arguments of `blisk compare`.
#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Results folders; the baseline is in the first.
    #[arg(required = true, value_name = "DIR")]
    results: Vec<PathBuf>,
    /// Scenario of the first folder, counted from 0, that all others are compared with [default: the best
    /// load of one folder, the same load of several].
    #[arg(long, value_name = "I")]
    baseline: Option<usize>,
    /// The percentile.
    #[arg(long, value_name = "P", default_value = "95", value_parser = percent)]
    percentile: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

pub(super) fn command(arguments: &CompareArguments) -> Result<ExitStatus, Failure> {
    let report = compare(&CompareRequest {
        folders: arguments.results.clone(),
        baseline: arguments.baseline,
        percent: arguments.percentile,
    })?;
    output::result(arguments.json, &report)?;
    Ok(if report.failures_cost_a_comparison() {
        ExitStatus::FailureGate
    } else {
        ExitStatus::Done
    })
}

/// A percentile on the command line: between 0 and 100, both excluded.
pub(super) fn percent(text: &str) -> Result<f64, String> {
    text.parse::<f64>()
        .ok()
        .filter(|percent| *percent > 0.0 && *percent < 100.0)
        .ok_or_else(|| "accepted: a number above 0 and below 100, for instance 95".to_owned())
}
