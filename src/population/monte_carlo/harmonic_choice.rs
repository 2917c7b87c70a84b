//! The harmonic set of a scenario.

use serde::{Deserialize, Serialize};

use crate::response::forced_response::ContactCondition;

/// Harmonic set under one engine order and contact condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HarmonicChoice {
    /// Engine order.
    pub engine_order: u32,
    /// Contact condition.
    pub contact: ContactCondition,
    /// The set, ascending, with 1.
    pub harmonics: Vec<u32>,
    /// What the set leaves out of the tuned peak of the full contact model, on tuned receptances of that of every judging wheel, by
    /// [`crate::response::forced_response::ErrorEstimate::harmonics`] and its doubt; none where one has no peak.
    pub remainder: Option<f64>,
    /// The largest of [`crate::response::forced_response::ErrorEstimate::sampling`] there; none on a basis, whose rows are asked
    /// themselves.
    pub sampling: Option<f64>,
    /// What the reduced model leaves out of the tops of the wheels that judge; none on a basis, whose error counts for all conditions.
    pub reduced_model: Option<f64>,
}

/// Harmonics that intermittent contact excites first of all.
const OF_SEPARATION: [u32; 2] = [0, 2];

impl HarmonicChoice {
    /// Whether the set has what contacts that separate need.
    #[must_use]
    pub fn admits_separation(&self) -> bool {
        OF_SEPARATION.iter().all(|k| self.harmonics.contains(k))
    }

    /// Adds what contacts that separate need.
    pub fn admit_separation(&mut self) {
        self.harmonics.extend(OF_SEPARATION);
        self.harmonics.sort_unstable();
        self.harmonics.dedup();
    }
}
