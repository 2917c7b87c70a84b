//! Where the dofs of a sector model lie: by node, on the faces, one sector on.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::error::ModelError;
use super::error_place::{Item, Place};
use super::sector_model::{Component, SectorModel};

/// Tolerance on positions, as a fraction of the largest distance from the origin.
const POSITION_TOLERANCE: f64 = 1e-6;

/// Dofs by node, and which of them lie on the high face.
pub(super) struct Layout {
    /// Dofs of each node.
    pub(super) node_dofs: HashMap<usize, Vec<usize>>,
    /// Whether a dof lies on the high face.
    pub(super) high: Vec<bool>,
}

impl Layout {
    /// Components, sorted, and position, m, of what a contact pair names: a point of a rigid body, or a node that must
    /// exist and lie off the high face.
    pub(super) fn contact_point(
        &self,
        model: &SectorModel,
        place: Place,
        node: usize,
    ) -> Result<(Vec<Component>, [f64; 3]), ModelError> {
        if let Some(point) = model.rigid_point(node) {
            return Ok((Component::DISPLACEMENTS.to_vec(), point.position_m));
        }
        let first = self.low_or_inner(place, node)?;
        let mut components: Vec<Component> = self.node_dofs[&node]
            .iter()
            .map(|&dof| model.dofs[dof].component)
            .collect();
        components.sort_unstable();
        Ok((components, model.dofs[first].position_m))
    }

    /// The first dof of a node that must exist and lie off the high face.
    pub(super) fn low_or_inner(&self, place: Place, node: usize) -> Result<usize, ModelError> {
        let dofs = self
            .node_dofs
            .get(&node)
            .ok_or(ModelError::NodeUnknown { place, node })?;
        if dofs.iter().any(|&dof| self.high[dof]) {
            return Err(ModelError::OnHighFace {
                place,
                item: Item::Node(node),
            });
        }
        Ok(dofs[0])
    }
}

/// Refuses what is infinite or no number.
pub(super) fn finite(place: Place, value: f64) -> Result<(), ModelError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(ModelError::NotFinite { place, value })
    }
}

/// The tolerance on the positions of a model, m.
pub(super) fn position_tolerance_of(positions_m: impl Iterator<Item = [f64; 3]>) -> f64 {
    let largest = positions_m
        .map(|position| distance(position, [0.0; 3]))
        .fold(0.0, f64::max);
    POSITION_TOLERANCE * largest
}

/// A position turned by one sector in +theta.
pub(super) fn advanced([x, y, z]: [f64; 3], sectors: usize) -> [f64; 3] {
    let (sin, cos) = (TAU / sectors as f64).sin_cos();
    [x * cos - y * sin, x * sin + y * cos, z]
}

/// Distance between two positions, m.
pub(super) fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
