//! The error that a row states: its parts, and the bound that they make together.

use crate::response::forced_response::ErrorEstimate;

/// Errors that a row takes over from its scenario, relative.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ScenarioError {
    /// Measured error of the basis at the tuned peak, with the same harmonics.
    pub basis: f64,
    /// Remainder of the harmonic set at the tuned peak of the full contact model.
    pub harmonics: f64,
}

/// Tolerances by which a row is flagged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorTolerance {
    /// On the sampling error.
    pub sampling: f64,
    /// On the harmonic error.
    pub harmonics: f64,
}

impl ErrorTolerance {
    /// Whether both errors of a solution are within their tolerances.
    #[must_use]
    pub fn holds(&self, errors: &ErrorEstimate) -> bool {
        errors.sampling.abs() <= self.sampling
            && errors.harmonics.abs() + errors.unsettled <= self.harmonics
    }
}

/// Tolerance of the sampling error, unless that of the peak is larger.
const SAMPLING_TOLERANCE: f64 = 1e-3;

/// Tolerance of the sampling error of rows whose peak is sought to `peak_tolerance`.
#[must_use]
pub fn sampling_tolerance(peak_tolerance: f64) -> f64 {
    peak_tolerance.max(SAMPLING_TOLERANCE)
}

/// Factor on the estimate of the harmonics in the stated error. The estimate is made at the frequency
/// of the delivered peak and can be too small; a factor of safety on estimates of discretisation
/// errors follows Roache (1994), its size what was measured (section 8 of docs/formulation.md).
pub const HARMONIC_SAFETY: f64 = 1.5;
/// Factor on the estimate of the harmonics in the stated error of rows on tuned receptances. What is left there is that the
/// harmonics move the peak, which the estimate does not follow: true changes are up to 1.8 times the estimate over the friction
/// rows of tests/data/truth.
pub const HARMONIC_SAFETY_ON_RECEPTANCES: f64 = 2.0;

/// Bound on the relative error of a peak amplitude that is stated with it: sampling, harmonics
/// outside of the set (by the solution itself or by the tuned full contact model, whichever is
/// larger), basis, and the tolerance of the peak search. Each is a change of the delivered amplitude;
/// where all take `e` of it away, the delivered amplitude is wrong by `e / (1 - e)` of the true one.
/// Infinite where nothing of the amplitude is certain.
#[must_use]
pub fn stated_error(
    errors: &ErrorEstimate,
    scenario: &ScenarioError,
    harmonic_safety: f64,
    peak_tolerance: f64,
) -> f64 {
    let harmonics = f64::max(
        errors.harmonics.abs() + errors.unsettled,
        scenario.harmonics,
    );
    let change =
        errors.sampling.abs() + harmonic_safety * harmonics + scenario.basis + peak_tolerance;
    if change < 1.0 {
        change / (1.0 - change)
    } else {
        f64::INFINITY
    }
}
