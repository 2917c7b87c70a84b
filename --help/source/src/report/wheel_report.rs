//! Wheels of one scenario solved again: response curves, blades and contact at the peak.

use serde::Serialize;

/// The wheels of one scenario that a report shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WheelReport {
    /// The scenario.
    pub scenario: usize,
    /// The tuned wheel, under the contact of the scenario.
    pub tuned: ResponseCurve,
    /// The wheel of the median peak amplitude.
    pub median: WheelCurves,
    /// The wheel of the largest peak amplitude.
    pub worst: WheelCurves,
    /// Blades and contact of the worst wheel at its peak; none where the peak was not found again.
    pub state: Option<WheelStateReport>,
}

/// A delivered row, and its curves solved again.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WheelCurves {
    /// Pattern id.
    pub pattern: u32,
    /// Peak amplitude as delivered, m.
    pub peak_amplitude_m: f64,
    /// Frequency of the delivered peak, Hz.
    pub peak_frequency_hz: f64,
    /// Blade of the delivered peak.
    pub peak_blade: u32,
    /// Amplification factor of the delivered peak.
    pub amplification_factor: Option<f64>,
    /// Bound on its relative error.
    pub stated_error: Option<f64>,
    /// Harmonics that it was solved with.
    pub harmonics: String,
    /// Curve under the contact of the scenario.
    pub full: ResponseCurve,
    /// Curve with stuck contact; none where the scenario has no friction.
    pub stuck: Option<ResponseCurve>,
    /// Curve with sliding contact; none where the scenario has no friction.
    pub slide: Option<ResponseCurve>,
}

/// Largest amplitude over the blades against frequency.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct ResponseCurve {
    /// Frequencies, Hz.
    pub frequency_hz: Vec<f64>,
    /// Largest amplitude over the blades, m; none where there is no solution.
    pub amplitude_m: Vec<Option<f64>>,
}

/// A wheel at the frequency of its peak.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WheelStateReport {
    /// Amplitude of every blade, m.
    pub amplitude_m: Vec<f64>,
    /// Deviation of every blade.
    pub deviation: Vec<f64>,
    /// Blade-alone mode that the deviations are of; none = all.
    pub deviation_mode: Option<u32>,
    /// Contact pairs per sector.
    pub pairs_per_sector: usize,
    /// Contact pairs, sector by sector; empty without friction.
    pub contact: Vec<PairReport>,
}

/// What a contact pair does at the peak.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairReport {
    /// `stick`, `slip` or `separation`, the last where it opens at any instant.
    pub state: &'static str,
    /// Share of the period in which it slips; none for a ring that drifts.
    pub slipping_share: Option<f64>,
    /// Share of the period in which it is open.
    pub separated_share: f64,
}
