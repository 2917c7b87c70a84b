//! `[accuracy]`: how much numerical error a study accepts.

use std::fmt::Write;

use serde::{Deserialize, Serialize};

use crate::input::Range;

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
    /// Errors that can be asked for.
    pub const ACCEPTED: Range = Range::from_to(1e-3, 0.2);

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
        Self::ACCEPTED.holds(amplitude_error)
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
