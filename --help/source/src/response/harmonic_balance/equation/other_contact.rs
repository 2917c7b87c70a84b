//! The harmonic balance equation of the same wheel under other contact: on the way of a homotopy, or under another law.

use std::sync::Arc;

use super::{ContactStiffnessMatrix, HarmonicSystem, Structure};
use crate::response::friction::{ContactLaw, PairParameters};

impl HarmonicSystem {
    /// Copy of this system under another law with the same springs.
    #[must_use]
    pub fn under(&self, law: ContactLaw) -> Self {
        let mut system = self.clone();
        system.interface.law = law;
        system
    }

    /// Copy of this system with `pairs`, which have another normal load.
    #[must_use]
    pub fn with_pairs(&self, pairs: Vec<PairParameters>) -> Self {
        let mut system = self.clone();
        system.interface.pairs = pairs;
        system
    }

    /// Copy of this system with all tangential contact springs multiplied by `factor`, in the law and in the stuck
    /// base.
    #[must_use]
    pub fn with_tangential_stiffness(&self, factor: f64) -> Self {
        let mut system = self.clone();
        for pair in &mut system.interface.pairs {
            pair.tangential_stiffness_n_per_m *= factor;
        }
        let springs = self.interface.stuck_springs(factor);
        let mut renewed: Vec<(Arc<Structure>, Arc<ContactStiffnessMatrix>)> = Vec::new();
        for block in &mut system.blocks {
            let known = renewed
                .iter()
                .find(|(structure, _)| Arc::ptr_eq(structure, &block.structure));
            let stuck = known.map_or_else(
                || Arc::new(block.structure.contact_stiffness(&springs)),
                |(_, stuck)| Arc::clone(stuck),
            );
            renewed.push((Arc::clone(&block.structure), Arc::clone(&stuck)));
            block.stuck = stuck;
        }
        system
    }
}
