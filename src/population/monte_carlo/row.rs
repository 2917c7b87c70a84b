//! One row of `responses.parquet`: what became of one (scenario, pattern), and its amplification factor.

use serde::Serialize;

use super::Scenario;
use crate::response::forced_response::{ErrorEstimate, Peak};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::PairFactors;

/// Result of one pattern under one scenario. Values of a failed row are `None`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResponseRow {
    /// Scenario index.
    pub scenario: usize,
    /// Pattern id.
    pub pattern: u32,
    /// How the solution ended.
    pub status: Status,
    /// Means of the factors on its contact parameters; none where the contact does not vary.
    pub contact_factors: Option<PairFactors>,
    /// Largest amplitude over blades and frequency, m.
    pub peak_amplitude_m: Option<f64>,
    /// Frequency of the largest amplitude, Hz.
    pub peak_frequency_hz: Option<f64>,
    /// Blade of the largest amplitude.
    pub peak_blade: Option<u32>,
    /// Peak amplitude over the tuned peak of the same scenario.
    pub amplification_factor: Option<f64>,
    /// Whether lower amplitudes were seen on both sides of the peak.
    pub peak_bracketed: Option<bool>,
    /// Harmonic set, like `"1-3"`.
    pub harmonics: String,
    /// Nonlinear solves used.
    pub nonlinear_solves: u64,
    /// Steps of the iteration; in Newton's method on tuned receptances products with the derivative.
    pub newton_iterations: u64,
    /// Jacobians assembled and factored.
    pub factorisations: u64,
    /// On a basis the nonlinear solves that needed more than their first attempt; on tuned receptances every attempt after the
    /// first of a solve.
    pub retries: u64,
    /// Residual at the peak: on tuned receptances of the contact motions relative to them, on a basis of the forces relative to the
    /// excitation.
    pub residual: Option<f64>,
    /// Share of pairs slipping in any direction at any sample, at the peak.
    pub slipping_fraction: Option<f64>,
    /// Share of pairs with no normal load at some sample, at the peak.
    pub separated_fraction: Option<f64>,
    /// Mean friction force on the ring along theta at the peak, N per sector.
    pub mean_friction_circumferential_n: Option<f64>,
    /// Mean friction force on the ring along z at the peak, N per sector.
    pub mean_friction_axial_n: Option<f64>,
    /// Shortcut used, or `"none"`.
    pub shortcut: String,
    /// Relative change of the amplitude by finer sampling. On a basis it is one Newton correction at 4 times the samples. On tuned
    /// receptances the peak is solved on with more samples; where fewer harmonics led to an automatic set of all, the change is
    /// that of the wheels that judge.
    pub sampling_error: Option<f64>,
    /// Relative change of the amplitude by the harmonics up to 15 outside of the set, or by those up to 25 where the set has all
    /// up to 15.
    pub harmonic_error: Option<f64>,
    /// Bound on the relative error of the amplitude, see `stated_error.rs`.
    pub stated_error: Option<f64>,
    /// Whether sampling and harmonic error are within their tolerances.
    pub error_within_tolerance: Option<bool>,
    /// Basis of the reduced model that the row was solved on.
    pub basis: String,
}

impl ResponseRow {
    /// A row without any result, of no work.
    #[must_use]
    pub fn without_result(scenario: usize, pattern: u32, status: Status) -> Self {
        Self {
            scenario,
            pattern,
            status,
            contact_factors: None,
            peak_amplitude_m: None,
            peak_frequency_hz: None,
            peak_blade: None,
            amplification_factor: None,
            peak_bracketed: None,
            harmonics: String::new(),
            nonlinear_solves: 0,
            newton_iterations: 0,
            factorisations: 0,
            retries: 0,
            residual: None,
            slipping_fraction: None,
            separated_fraction: None,
            mean_friction_circumferential_n: None,
            mean_friction_axial_n: None,
            shortcut: "none".to_owned(),
            sampling_error: None,
            harmonic_error: None,
            stated_error: None,
            error_within_tolerance: None,
            basis: String::new(),
        }
    }
}

/// A peak as a row states it.
pub(super) struct MistunedPeak {
    pub(super) peak: Peak,
    pub(super) errors: Option<ErrorEstimate>,
}

/// Peak of the tuned wheel of a scenario, the denominator of its amplification factors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TunedReference {
    /// Scenario index.
    pub scenario: usize,
    /// How the solution ended.
    pub status: Status,
    /// Peak amplitude, m.
    pub amplitude_m: Option<f64>,
    /// Peak frequency, Hz.
    pub frequency_hz: Option<f64>,
    /// Share of separated pairs at the peak.
    pub separated_fraction: Option<f64>,
    /// Share of slipping pairs at the peak.
    pub slipping_fraction: Option<f64>,
    /// Harmonic set, like `"1-3"`.
    pub harmonics: String,
    /// Errors of the solution at the peak.
    pub errors: Option<ErrorEstimate>,
}

impl TunedReference {
    /// Of a peak that was found with the set of harmonics named so, and its errors.
    pub(super) fn of_peak(
        scenario: &Scenario,
        found: &Peak,
        harmonics: String,
        errors: Option<ErrorEstimate>,
    ) -> Self {
        let point = found.point.as_ref().filter(|_| found.status == Status::Ok);
        Self {
            scenario: scenario.index,
            status: found.status,
            amplitude_m: found.amplitude_m(),
            frequency_hz: point.map(|point| point.frequency_hz),
            separated_fraction: point.map(|point| point.shares.separated),
            slipping_fraction: point.map(|point| point.shares.slipping),
            harmonics,
            errors,
        }
    }
}

/// Largest amplitude over blades and frequency of the mistuned wheel over that of the tuned wheel
/// with the same normal load, engine order and settings.
#[must_use]
pub fn amplification_factor(mistuned_m: Option<f64>, tuned_m: Option<f64>) -> Option<f64> {
    Some(mistuned_m? / tuned_m?)
}

/// Harmonic set in the column `harmonics`, like `1-3`.
#[must_use]
pub fn harmonics_name(harmonics: &[u32]) -> String {
    let names: Vec<String> = harmonics.iter().map(u32::to_string).collect();
    names.join("-")
}
