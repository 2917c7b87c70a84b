//! The checks of the table `[accuracy]`, and of the keys that it stands for.

use super::check::Check;
use crate::model::reduction::Basis;
use crate::study::keys::solver::AccuracyTable;
use crate::study::{AccuracyOptions, Study};

/// Keys of a basis, which conflict with an accepted error: its settings are those of tuned receptances.
const KEYS_OF_A_BASIS: [&str; 2] = ["reduction.stick_modes", "reduction.slide_modes"];

/// The accepted error.
pub(super) fn accuracy(check: &mut Check, table: AccuracyTable, basis: Basis) -> AccuracyOptions {
    const KEY: &str = "accuracy.amplitude_error";
    let basis =
        (!matches!(basis, Basis::Auto | Basis::TunedReceptances)).then_some("reduction.basis");
    for key in KEYS_OF_A_BASIS.into_iter().chain(basis) {
        if check.is_written(key) {
            let reason = format!("{KEY} chooses it; accepted: one of the two keys");
            check.conflict(key, &reason);
        }
    }
    let mut options = AccuracyOptions::within(AccuracyOptions::DEFAULT);
    check.put("accuracy", Some(table), &mut options, &[]);
    options
}

/// `study` with the accepted error in the place of those of its own tolerances that it does not say.
pub(super) fn with_accuracy(
    mut study: Study,
    accuracy: Option<AccuracyOptions>,
    is_stated: impl Fn(&str) -> bool,
) -> Study {
    study.accuracy = accuracy;
    if let Some(AccuracyOptions {
        amplitude_error, ..
    }) = accuracy
    {
        if !is_stated("reduction.error") {
            study.reduction.error = amplitude_error;
        }
        if !is_stated("solver.harmonic_tolerance") {
            study.solver.harmonic_tolerance = amplitude_error;
        }
    }
    study
}
