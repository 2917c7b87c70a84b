//! The two quantities that populations are judged by.

use serde::{Deserialize, Serialize};

use crate::population::monte_carlo::ResponseRow;
use crate::response::harmonic_balance::Status;

/// A quantity of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Peak amplitude, m.
    PeakAmplitudeM,
    /// Amplification factor.
    AmplificationFactor,
}

impl Quantity {
    /// Both quantities, in the order of reports.
    pub const ALL: [Self; 2] = [Self::PeakAmplitudeM, Self::AmplificationFactor];

    /// Name in tables, `snake_case`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PeakAmplitudeM => "peak_amplitude_m",
            Self::AmplificationFactor => "amplification_factor",
        }
    }

    /// Value of the quantity in `row`; none where the row failed.
    #[must_use]
    pub fn of(self, row: &ResponseRow) -> Option<f64> {
        let value = match self {
            Self::PeakAmplitudeM => row.peak_amplitude_m,
            Self::AmplificationFactor => row.amplification_factor,
        };
        value.filter(|_| row.status == Status::Ok)
    }
}
