//! `[nodal_diameter_damping]`: damping ratios by nodal diameter, for instance aerodynamic ones.

use serde::Serialize;

use crate::model::reduction::{DampedModes, NodalDiameterDamping};

/// Damping ratios by nodal diameter as a study has them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodalDiameterTable {
    /// Nodal diameters with their ratios, as written; the others have none.
    pub ratios: Vec<(u32, f64)>,
    /// Which modes they damp.
    pub modes: DampedModes,
}

impl NodalDiameterTable {
    /// What it damps of each nodal diameter.
    pub(super) fn damping(&self) -> NodalDiameterDamping {
        let last = self.ratios.iter().map(|&(h, _)| h as usize).max();
        let mut ratios = vec![0.0; last.map_or(0, |last| last + 1)];
        for &(h, ratio) in &self.ratios {
            ratios[h as usize] = ratio;
        }
        NodalDiameterDamping {
            ratios,
            modes: self.modes,
        }
    }
}
