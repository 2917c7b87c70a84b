//! What a wheel does at one frequency: blade amplitudes and the state of every contact pair.

use crate::response::harmonic_balance::{PairContact, Status};

/// The wheel of a row at the frequency of its peak.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelState {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude of every blade, m.
    pub amplitudes_m: Vec<f64>,
    /// State of every contact pair, sector by sector; none for a linear limit.
    pub contact: Option<Vec<PairContact>>,
}

/// Amplitudes of every blade at one frequency.
pub type CurveResult = (f64, Result<Vec<f64>, Status>);

/// How the points of a curve are solved.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CurveSettings {
    /// With the fewest harmonics that rows without a peak are solved with, in place of those of the load; there is no solution where none
    /// are fewer.
    pub fewest_harmonics: bool,
    /// No point is solved to a smaller residual, whatever the study asks for.
    pub least_residual_tolerance: f64,
}
