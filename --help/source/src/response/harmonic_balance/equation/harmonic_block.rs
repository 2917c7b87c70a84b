//! One harmonic of a set with the wheel that it lives in.

use std::sync::Arc;

use super::{ContactStiffnessMatrix, Structure};

/// One harmonic of the set: its number, and the structure it lives in.
#[derive(Debug, Clone)]
pub struct HarmonicBlock {
    /// Harmonic k.
    pub harmonic: u32,
    /// Structure; the wheel's is shared by all harmonics, a tuned wave has one per harmonic.
    pub structure: Arc<Structure>,
    /// Linear stuck contact stiffness of that structure.
    pub stuck: Arc<ContactStiffnessMatrix>,
}

impl HarmonicBlock {
    /// Number of complex unknowns: modal coordinates.
    #[must_use]
    pub fn size(&self) -> usize {
        self.structure.size()
    }
}
