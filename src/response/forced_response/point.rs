//! A solution at one frequency, and the work that solutions took.

use crate::response::harmonic_balance::ContactShares;

/// Work done for a row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Points solved nonlinearly.
    pub nonlinear_solves: u64,
    /// Steps of the iteration, all attempts. In Newton's method on tuned receptances these are products with the derivative.
    pub newton_iterations: u64,
    /// Jacobians assembled and factored.
    pub factorisations: u64,
    /// On a basis the points that needed more than the first attempt; on tuned receptances every attempt after the first of a
    /// point.
    pub retries: u64,
    /// Folds of the response curve passed by continuation.
    pub folds: u64,
}

impl Work {
    /// The sum of this work and `other`.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            nonlinear_solves: self.nonlinear_solves + other.nonlinear_solves,
            newton_iterations: self.newton_iterations + other.newton_iterations,
            factorisations: self.factorisations + other.factorisations,
            retries: self.retries + other.retries,
            folds: self.folds + other.folds,
        }
    }
}

/// A converged point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// On a basis the real unknowns of the harmonic balance, see [`crate::response::harmonic_balance::HarmonicSystem`]; for a
    /// linear limit those of harmonic 1 alone. On tuned receptances the motions at the contact of every harmonic over the
    /// waves, as [`crate::response::receptance::WheelSolution::motions`]; none for a linear limit without iteration.
    pub solution: Vec<f64>,
    /// Amplitude of every blade, m.
    pub amplitudes_m: Vec<f64>,
    /// Residual: on a basis of the forces, relative to the excitation; on tuned receptances of the contact motions, relative to
    /// them, and harmonic k counts by `1/k`. It is 0 for a linear limit without iteration.
    pub residual: f64,
    /// Shares of slipping and separated pairs.
    pub shares: ContactShares,
    /// Drift of the ring along its rigid motions, m per period: 0 unless it creeps.
    pub ring_drift_m: [f64; 2],
}

impl Point {
    /// Largest amplitude over the blades, m.
    #[must_use]
    pub fn largest_amplitude_m(&self) -> f64 {
        self.amplitudes_m.iter().copied().fold(0.0, f64::max)
    }

    /// Blade of the largest amplitude, the first where several share it.
    #[must_use]
    pub fn largest_blade(&self) -> usize {
        let amplitudes = &self.amplitudes_m;
        (0..amplitudes.len()).fold(0, |best, blade| {
            if amplitudes[blade] > amplitudes[best] {
                blade
            } else {
                best
            }
        })
    }
}

/// The point at exactly this frequency, Hz.
pub(super) fn point_at(points: &[Point], frequency_hz: f64) -> Option<&Point> {
    let same = |point: &&Point| point.frequency_hz.total_cmp(&frequency_hz).is_eq();
    points.iter().find(same)
}
