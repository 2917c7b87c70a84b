//! What a search knows beforehand: how wide peaks are, how exactly the highest is wanted, and which points tell of it.

/// What is known beforehand of the width of peaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// Height times half-bandwidth of the strongest linear resonance, m Hz.
    pub strength: f64,
    /// Smallest half-bandwidth of a linear resonance in the band, Hz.
    pub linear_half_bandwidth_hz: f64,
}

impl Envelope {
    /// Share of the strongest resonance that a competing mode is assumed to have at least.
    const COMPETITOR: f64 = 0.7;

    /// Half-bandwidth assumed of a hidden peak at most, over that of a linear resonance: where
    /// friction holds the best peak far below the linear ones, a competitor need not be as broad.
    const BROADEST: f64 = 5.0;

    /// Distance, Hz, of first points that are told apart.
    pub(in crate::response::forced_response) fn resolution_hz(&self) -> f64 {
        0.05 * self.linear_half_bandwidth_hz
    }

    /// Half-bandwidth, Hz, assumed of a hidden peak of height `amplitude`.
    pub(super) fn half_bandwidth(&self, amplitude: f64) -> f64 {
        let linear = self.linear_half_bandwidth_hz;
        Self::COMPETITOR * (self.strength / amplitude).clamp(linear, Self::BROADEST * linear)
    }
}

/// Settings of one search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Relative tolerance of the peak amplitude.
    pub tolerance: f64,
    /// Largest number of evaluations.
    pub evaluations: usize,
    /// Largest number of times that the band is widened while the largest value lies at its end.
    pub extensions: usize,
    /// Share of the best that other tops are found from: 1, unless what they are worth is decided elsewhere.
    pub rivals_from: f64,
}

impl SearchSettings {
    /// Distance d of neighbours within which their parabola is trusted: the cubic term it neglects,
    /// about `0.1 (d/gamma)^3`, is below the tolerance.
    pub(super) fn trusted_hz(self, gamma: f64) -> f64 {
        gamma * (10.0 * self.tolerance).cbrt()
    }
}

/// Share of the tolerance that the summit may lie above the best: what a polynomial predicts is an
/// estimate, no bound, and must leave room within the tolerance.
pub(in crate::response::forced_response) const VERTEX_SHARE: f64 = 0.125;
/// Share of the trusted distance below which cubics tell nothing but rounding errors.
pub(super) const NEAR: f64 = 0.1;
/// A summit nearer to its sample than this share of the samples' span is the sample.
pub(super) const RESOLVED: f64 = 1e-3;
