//! `blisk compare`: scenarios against each other, on common patterns where there are any.

use super::run_command::Failure;
use super::{ExitStatus, output};
use crate::study::{CompareRequest, compare};

pub(super) fn command(request: &CompareRequest, json: bool) -> Result<ExitStatus, Failure> {
    let report = compare(request)?;
    output::result(json, &report);
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
