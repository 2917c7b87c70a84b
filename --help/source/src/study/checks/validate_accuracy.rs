//! The checks of the table `[accuracy]`, and of the keys that it stands for.

use super::check::Check;
use crate::model::reduction::Basis;
use crate::study::raw::RawAccuracy;
use crate::study::{AccuracyOptions, Study};

/// Keys of a basis, which conflict with an accepted error: the ladder is one of bases, and none of its
/// settings is left where the study says one.
const KEYS_OF_A_BASIS: [&str; 2] = ["reduction.stick_modes", "reduction.slide_modes"];

/// The accepted error; none where the number is refused.
pub(super) fn accuracy(
    check: &mut Check,
    raw: &RawAccuracy,
    basis: Basis,
) -> Option<AccuracyOptions> {
    const KEY: &str = "accuracy.amplitude_error";
    let basis =
        (!matches!(basis, Basis::Auto | Basis::TunedReceptances)).then_some("reduction.basis");
    for key in KEYS_OF_A_BASIS.into_iter().chain(basis) {
        if check.is_written(key) {
            let reason = format!("{KEY} chooses it; accepted: one of the two keys");
            check.conflict(key, &reason);
        }
    }
    let amplitude_error = check.given(
        KEY,
        Some(raw.amplitude_error.unwrap_or(AccuracyOptions::DEFAULT)),
        AccuracyOptions::accepts,
        AccuracyOptions::ACCEPTED,
    )?;
    let default = AccuracyOptions::within(amplitude_error);
    Some(AccuracyOptions {
        simpler_contact_law: raw
            .simpler_contact_law
            .unwrap_or(default.simpler_contact_law),
        ..default
    })
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
