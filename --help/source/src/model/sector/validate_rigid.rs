//! Checks of the points of rigid bodies.

use std::collections::HashMap;

use super::error::ModelError;
use super::error_place::Place;
use super::layout::{Layout, finite};
use super::rigid_problem::RigidProblem;
use super::sector_model::{Component, SectorModel};

/// Mass between displacement and rotation that is rounding, as a share of the geometric mean of mass and inertia.
const ROUNDING: f64 = 1e-6;

/// Positions and numbers of the points of rigid bodies, and the dofs and the mass of their references.
pub(super) fn check_rigid(model: &SectorModel, layout: &Layout) -> Result<(), ModelError> {
    if model.rigid_points.is_empty() {
        return Ok(());
    }
    let mass: HashMap<(usize, usize), f64> = model
        .mass
        .lower_entries()
        .map(|(row, column, value)| ((row, column), value))
        .collect();
    let mut seen: HashMap<usize, usize> = HashMap::new();
    for (place, point) in model.rigid_points.iter().enumerate() {
        let refused = |problem| {
            Err(ModelError::Rigid {
                point: place,
                problem,
            })
        };
        for (axis, &value) in point.position_m.iter().enumerate() {
            finite(Place::RigidPosition(place, axis), value)?;
        }
        let node = point.node;
        if layout.node_dofs.contains_key(&node) {
            return refused(RigidProblem::HasDofs { node });
        }
        if let Some(&earlier) = seen.get(&node) {
            return refused(RigidProblem::Duplicate { node, earlier });
        }
        seen.insert(node, place);
        layout.low_or_inner(Place::RigidPoint(place), point.reference)?;
        check_reference(model, &mass, point.reference).or_else(refused)?;
    }
    Ok(())
}

/// Six dofs, and no mass between displacements and rotations: the moment of the centrifugal load is then that of the
/// inertia alone.
fn check_reference(
    model: &SectorModel,
    mass: &HashMap<(usize, usize), f64>,
    reference: usize,
) -> Result<(), RigidProblem> {
    let mut dofs = [0; 6];
    for (dof, component) in dofs.iter_mut().zip(Component::RIGID) {
        *dof = model
            .dof_of(reference, component)
            .ok_or(RigidProblem::Components {
                reference,
                missing: component,
            })?;
    }
    let entry = |a: usize, b: usize| mass.get(&(a.max(b), a.min(b))).copied().unwrap_or(0.0);
    for displacement in 0..3 {
        for rotation in 3..6 {
            let (row, column) = (dofs[rotation], dofs[displacement]);
            let value = entry(row, column);
            let limit = ROUNDING * (entry(row, row) * entry(column, column)).sqrt();
            if value.abs() > limit {
                return Err(RigidProblem::NotCentre {
                    reference,
                    displacement: Component::RIGID[displacement],
                    rotation: Component::RIGID[rotation],
                    value,
                    limit,
                });
            }
        }
    }
    Ok(())
}
