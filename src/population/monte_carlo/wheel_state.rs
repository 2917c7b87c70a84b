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
