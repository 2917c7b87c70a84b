//! One harmonic of a set with the wheel that it lives in.

use std::sync::Arc;

use super::TunedWaves;
use super::structure::{ContactStiffnessMatrix, Structure};

/// One harmonic of the set: its number, and the structure it lives in.
#[derive(Debug, Clone)]
pub struct HarmonicBlock {
    /// Harmonic k.
    pub harmonic: u32,
    /// Structure; the wheel's is shared by all harmonics, a tuned wave has one per harmonic.
    pub structure: Arc<Structure>,
    /// Linear stuck contact stiffness of that structure.
    pub stuck: Arc<ContactStiffnessMatrix>,
    /// The contact of the tuned wheel, where the harmonic is taken in it instead; never for harmonic 1.
    pub waves: Option<Arc<TunedWaves>>,
}

impl HarmonicBlock {
    /// Number of complex unknowns: modal coordinates, or relative motions at the contact of the tuned wheel.
    #[must_use]
    pub fn size(&self) -> usize {
        let waves = self.waves.as_ref();
        waves.map_or_else(|| self.structure.size(), |waves| waves.size())
    }
}
