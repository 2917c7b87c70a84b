//! The checks of the table `[accuracy]`, and of the keys that it stands for.

use std::path::Path;

use super::raw::RawAccuracy;
use super::validate::Check;
use super::{AccuracyOptions, Finding, Problem, Study, StudyError};
use crate::input::SourceMap;
use crate::model::reduction::Basis;

/// Keys that the program sets itself under `[accuracy]`, unless the study says them.
pub(super) const KEYS_OF_ACCURACY: [&str; 11] = [
    "reduction.basis",
    "reduction.error",
    "reduction.stick_modes",
    "reduction.slide_modes",
    "solver.harmonics",
    "solver.search_harmonics",
    "solver.harmonic_tolerance",
    "solver.rows_beyond_tolerance",
    "solver.samples_per_period",
    "solver.residual_tolerance",
    "solver.peak_tolerance",
];
/// Those of a basis: the ladder is one of bases, and none of its settings is left where the study says one.
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

impl Study {
    /// Reads and checks the study file `path` as if it had these `[accuracy]`, if there are any.
    ///
    /// # Errors
    /// The file cannot be read, or everything in it that is not accepted.
    pub fn read_with(path: &Path, accuracy: Option<AccuracyOptions>) -> Result<Self, StudyError> {
        let text = std::fs::read_to_string(path).map_err(|source| StudyError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        match accuracy {
            None => Self::parse(path, &text),
            Some(accuracy) => {
                // A file that is no TOML is described when it is parsed.
                let written = SourceMap::new(&text).ok();
                let line = written
                    .filter(|map| map.holds("accuracy"))
                    .map(|map| map.line("accuracy"));
                if let Some(line) = line {
                    let reason = "--accuracy is given too; accepted: one of the two".to_owned();
                    return Err(StudyError::Invalid {
                        path: path.to_owned(),
                        findings: vec![Finding {
                            line,
                            key: "accuracy".to_owned(),
                            problem: Problem::Conflict { reason },
                            excerpt: None,
                        }],
                    });
                }
                Self::parse(path, &accuracy.appended_to(&text))
            }
        }
    }

    /// The study with the accepted error in the place of those of its own tolerances that it does not say.
    pub(super) fn with_accuracy(
        mut self,
        accuracy: Option<AccuracyOptions>,
        is_stated: impl Fn(&str) -> bool,
    ) -> Self {
        self.accuracy = accuracy;
        if let Some(AccuracyOptions {
            amplitude_error, ..
        }) = accuracy
        {
            if !is_stated("reduction.error") {
                self.reduction.error = amplitude_error;
            }
            if !is_stated("solver.harmonic_tolerance") {
                self.solver.harmonic_tolerance = amplitude_error;
            }
        }
        self
    }

    /// Whether the study file says the key `key`, which nothing chosen takes the place of.
    pub(super) fn states(&self, key: &str) -> bool {
        self.map.holds(key)
    }
}
