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
}

impl AccuracyOptions {
    /// Accepted where nothing is said. The settings of a study without `[accuracy]` are those for it on tuned receptances, unchecked.
    pub const DEFAULT: f64 = 0.01;
    /// Errors that can be asked for.
    pub const ACCEPTED: Range = Range::from_to(1e-3, 0.2);

    /// An accepted error.
    #[must_use]
    pub fn within(amplitude_error: f64) -> Self {
        Self { amplitude_error }
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
            "\n[accuracy]\namplitude_error = {:e}\n",
            self.amplitude_error
        );
        text
    }
}
