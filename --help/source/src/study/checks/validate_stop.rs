//! The checks of the table `[stop]`.

use super::check::Check;
use crate::population::statistics::{CONFIDENCE, Quantity, StopOptions, smallest_sample};
use crate::study::raw::RawStop;

/// The stopping rule of a study of at most `patterns`, drawn or of a file; none where a number is missing.
pub(super) fn stop(
    check: &mut Check,
    raw: &RawStop,
    patterns: u32,
    is_of_file: bool,
) -> Option<StopOptions> {
    let percentile = check.given(
        "stop.percentile",
        raw.percentile,
        |percent| percent > 0.0 && percent < 100.0,
        "a number above 0 and below 100, in percent",
    )?;
    let relative_width = check.given(
        "stop.relative_width",
        raw.relative_width,
        |width| width > 0.0 && width <= 1.0,
        "a number above 0 and at most 1: width of the interval over the percentile",
    )?;
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
        quantity: raw.quantity.unwrap_or(Quantity::PeakAmplitudeM),
    })
}
