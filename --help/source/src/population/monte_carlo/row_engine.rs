//! What the rows of one force vector share on the receptances of the tuned wheel.

use std::sync::Arc;

use crate::response::receptance::{EngineWheel, ReceptanceEngine, WaveForce};

/// The engine of a study with the excitations of one of its force vectors.
#[derive(Debug)]
pub(super) struct RowEngine {
    pub(super) engine: Arc<ReceptanceEngine>,
    /// The tuned wheel on it.
    pub(super) tuned: EngineWheel,
    /// By engine order.
    pub(super) forces: Vec<(u32, WaveForce)>,
}

impl RowEngine {
    pub(super) fn receptances(&self) -> &ReceptanceEngine {
        &self.engine
    }

    pub(super) fn force(&self, engine_order: u32) -> Option<&WaveForce> {
        let own = self.forces.iter().find(|(order, _)| *order == engine_order);
        own.map(|(_, force)| force)
    }
}
