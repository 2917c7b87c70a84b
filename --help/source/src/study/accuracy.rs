//! `[accuracy]`: how much numerical error a study accepts.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

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

/// What a user says of the accuracy instead of the settings that make it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AccuracyOptions {
    /// Accepted relative error of the peak amplitude of 95 % of the rows. Default 0.01.
    pub amplitude_error: f64,
    /// Whether a simpler contact law may take the place of that of the study, where the error allows it. Default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub simpler_contact_law: bool,
}

impl AccuracyOptions {
    /// Accepted where nothing is said. The settings of a study without `[accuracy]` are those for it on tuned receptances, unchecked.
    pub const DEFAULT: f64 = 0.01;
    /// Errors that can be asked for, in words.
    pub const ACCEPTED: &str = "a number from 0.001 to 0.2, relative error of the peak amplitude";

    /// An accepted error with everything else as it is if nothing is said.
    #[must_use]
    pub fn within(amplitude_error: f64) -> Self {
        Self {
            amplitude_error,
            simpler_contact_law: false,
        }
    }

    /// Whether an error can be asked for.
    #[must_use]
    pub fn accepts(amplitude_error: f64) -> bool {
        (1e-3..=0.2).contains(&amplitude_error)
    }

    /// The text of a study file with these at its end.
    #[must_use]
    pub(super) fn appended_to(self, text: &str) -> String {
        let mut text = text.to_owned();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "\n[accuracy]\namplitude_error = {:e}\nsimpler_contact_law = {}\n",
            self.amplitude_error, self.simpler_contact_law
        );
        text
    }
}
