//! Whether the stiffness of a solid couples its nodes: one of which a triangle was lost does not.

use std::collections::HashSet;

use super::error::ModelError;
use super::error_place::Matrix;
use super::sector_model::{Body, SectorModel};
use crate::linalg::SymmetricSparse;

/// Refuses a stiffness, or a blade's share of it, that couples no node of a body with another. Nodes with one
/// component are masses of a lumped sector, which may hang on springs of their own. A mass may be lumped.
pub(super) fn check_couplings(model: &SectorModel) -> Result<(), ModelError> {
    let matrices = [
        (Matrix::Stiffness, &model.stiffness),
        (Matrix::BladeStiffness, &model.blade_stiffness),
    ];
    for (matrix, values) in matrices {
        for body in [Body::Blisk, Body::Ring, Body::Damper] {
            let nodes = solid_nodes(model, values, body);
            if nodes.len() > 1 && !couples(model, values, &nodes) {
                let nodes = nodes.len();
                return Err(ModelError::NoCouplings { matrix, nodes });
            }
        }
    }
    Ok(())
}

/// Nodes of a body with entries for more than one component.
fn solid_nodes(model: &SectorModel, values: &SymmetricSparse, body: Body) -> HashSet<usize> {
    let diagonal = values.diagonal();
    let (mut seen, mut solid) = (HashSet::new(), HashSet::new());
    for (dof, value) in model.dofs.iter().zip(diagonal) {
        if dof.body == body && value != 0.0 && !seen.insert(dof.node) {
            solid.insert(dof.node);
        }
    }
    solid
}

fn couples(model: &SectorModel, values: &SymmetricSparse, nodes: &HashSet<usize>) -> bool {
    values.lower_entries().any(|(row, column, value)| {
        let (a, b) = (model.dofs[row].node, model.dofs[column].node);
        value != 0.0 && a != b && nodes.contains(&a)
    })
}
