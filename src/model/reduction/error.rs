//! What is known of the error of a reduction, and from where on it is too large.

use serde::{Deserialize, Serialize};

/// Error of the relative displacement at the contact that a basis allows, and where it is largest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactDisplacementError {
    /// Relative error in the norm of the relative displacement.
    pub error: f64,
    /// Engine order.
    pub engine_order: u32,
    /// Normal load per sector, N.
    pub normal_load_n: f64,
    /// Temporal harmonic k.
    pub harmonic: u32,
    /// Nodal diameter of the wave, 0 to N/2.
    pub nodal_diameter: usize,
}

/// Errors of the relative displacement in the waves that the tuned wheel moves in, and in all waves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactDisplacementErrors {
    /// Largest over the harmonics k, each in its nodal diameter `k EO mod N`.
    pub tuned: ContactDisplacementError,
    /// Largest over the harmonics in any nodal diameter: a mistuned wheel moves in all of them.
    pub any_nodal_diameter: ContactDisplacementError,
}

impl ContactDisplacementErrors {
    /// The larger of either kind.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        let larger = |a: ContactDisplacementError, b: ContactDisplacementError| {
            if b.error > a.error { b } else { a }
        };
        Self {
            tuned: larger(self.tuned, other.tuned),
            any_nodal_diameter: larger(self.any_nodal_diameter, other.any_nodal_diameter),
        }
    }

    /// Largest error in any nodal diameter for a wanted relative error of the peak: a hundred times
    /// that, and at most 0.1. Measured in docs/reduction-error.md.
    #[must_use]
    pub fn accepted(wanted_error: f64) -> f64 {
        f64::min(100.0 * wanted_error, 0.1)
    }
}

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
