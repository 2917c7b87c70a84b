//! The checks of the table `[stop]`.

use super::check::Check;
use crate::population::statistics::{CONFIDENCE, Quantity, StopOptions, smallest_sample};
use crate::study::keys::solver::StopTable;

/// The stopping rule of a study of at most `patterns`, drawn or of a file; none where a number is missing.
pub(super) fn stop(
    check: &mut Check,
    stop: &StopTable,
    patterns: u32,
    is_of_file: bool,
) -> Option<StopOptions> {
    let percentile = check.given("stop.percentile", stop.percentile)?;
    let relative_width = check.given("stop.relative_width", stop.relative_width)?;
    let needed = smallest_sample(percentile / 100.0, CONFIDENCE);
    if u64::from(patterns) < needed {
        let accepted = if is_of_file {
            format!("a mistuning.file of {needed} wheels or more, or no [stop]")
        } else {
            format!("study.patterns from {needed} on")
        };
        check.conflict(
            "stop.percentile",
            &format!("P{percentile} of {patterns} patterns has no interval; accepted: {accepted}"),
        );
    }
    Some(StopOptions {
        percentile,
        relative_width,
        quantity: stop.quantity.unwrap_or(Quantity::PeakAmplitudeM),
    })
}

/// The stopping rule as a study file has it.
pub(super) fn stop_table(stop: &StopOptions) -> StopTable {
    StopTable {
        percentile: Some(stop.percentile),
        relative_width: Some(stop.relative_width),
        quantity: Some(stop.quantity),
    }
}
