//! What a user chooses about the mistuning.

use serde::{Deserialize, Serialize};

/// How a blade's deviation enters the reduced stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Projection {
    /// Projection of the blade's stiffness on the basis: exact for a stiffness deviation.
    Exact,
    /// Classical component mode mistuning through cantilevered-blade modes; per-mode deviations.
    CantileverModes,
}

/// Law of a blade's deviation, scaled to zero mean and unit standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Distribution {
    /// Normal.
    Normal,
    /// Uniform on +-sqrt(3) standard deviations.
    Uniform,
    /// Normal cut off at `+-truncation` parent standard deviations, rescaled to unit standard
    /// deviation after truncation.
    TruncatedNormal {
        /// Cut-off in standard deviations of the parent normal law.
        truncation: f64,
    },
}
