//! From where on a Craig-Bampton model has too few modes.

/// Frequency, Hz, up to which a Craig-Bampton model should have fixed-interface modes for harmonic k
/// of a peak: 6 times that of the fundamental (measured in docs/reduction-error.md), 1.5 times
/// that of every other harmonic.
#[must_use]
pub fn wanted_reach_hz(harmonic: u32, peak_frequency_hz: f64) -> f64 {
    match harmonic {
        1 => 6.0 * peak_frequency_hz,
        k => 1.5 * f64::from(k) * peak_frequency_hz,
    }
}
