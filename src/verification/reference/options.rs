//! Settings of the full-contact model.

use std::sync::Arc;

use crate::response::forced_response::AmplitudeMeasure;
use crate::response::friction::{ContactLaw, PairParameters, Ring};
use crate::response::harmonic_balance::{Damping, HarmonicTransform};
use crate::response::mistuning::Projection;

/// What a solution on the full-contact model needs besides the model.
#[derive(Debug, Clone)]
pub struct ReferenceSettings {
    /// Harmonic set, with 1, and samples per period of the alternating frequency/time method.
    pub transform: Arc<HarmonicTransform>,
    /// Bound on the residual force relative to the excitation.
    pub residual_tolerance: f64,
    /// Relative tolerance of the peak amplitude.
    pub peak_tolerance: f64,
    /// Contact law and its parameters per sector; none for a model without contact.
    pub contact: Option<(ContactLaw, PairParameters)>,
    /// What a free ring does under mean friction.
    pub ring: Ring,
    /// Damping of the structure.
    pub damping: Damping,
    /// Factor on the model's force vector.
    pub amplitude_n: f64,
    /// Measure called amplitude.
    pub amplitude: AmplitudeMeasure,
    /// Instants of a period for [`AmplitudeMeasure::TimeMaximum`].
    pub time_samples: usize,
    /// How a deviation enters the stiffness.
    pub projection: Projection,
}

impl ReferenceSettings {
    /// Samples per period where nothing else is asked for.
    pub const SAMPLES_PER_PERIOD: usize = 512;
    /// Bound on the residual where nothing else is asked for.
    pub const RESIDUAL_TOLERANCE: f64 = 1e-9;
    /// Tolerance of the peak amplitude where nothing else is asked for.
    pub const PEAK_TOLERANCE: f64 = 1e-4;

    /// The harmonic set, ascending.
    #[must_use]
    pub fn harmonics(&self) -> Vec<u32> {
        self.transform
            .harmonics()
            .iter()
            .map(|&k| k as u32)
            .collect()
    }
}
