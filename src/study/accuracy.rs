//! `[accuracy]`: how much numerical error a study accepts.

use serde::{Deserialize, Serialize};

/// What a user says of the accuracy instead of the settings that make it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AccuracyOptions {
    /// Accepted relative error of the peak amplitude of 95 % of the rows.
    pub amplitude_error: f64,
}
