//! Checks of a sector model before anything is computed with it: refused or untouched, never repaired.

use std::collections::HashMap;

use super::error::ModelError;
use super::error_place::{Item, Matrix, Place};
use super::layout::{Layout, advanced, distance, finite, position_tolerance_of};
use super::sector_model::{Dof, MAX_SECTORS, SectorModel};
use super::validate_contact::{check_contact, is_with_next_sector};
use super::validate_couplings::check_couplings;
use super::validate_rigid::check_rigid;
use crate::linalg::{Complex64, SymmetricSparse};

/// How much the blade's diagonal may exceed K's, relative: K of a rotating sector holds spin softening,
/// which the elastic stiffness of the blade does not.
const SOFTENING: f64 = 0.01;
/// Relative tolerance of entry-wise tests on matrices that were rounded when written.
const ROUNDING: f64 = 1e-9;

/// Checks a sector model as the rest of the library expects it.
///
/// The cyclic mass and stiffness of each nodal diameter are factored, hence checked, by the reduction.
///
/// # Errors
/// The first thing wrong, with its place, its value and what is accepted.
pub fn validate(model: &SectorModel) -> Result<(), ModelError> {
    if model.sectors == 0 {
        return Err(ModelError::NoSectors);
    }
    if model.sectors > MAX_SECTORS {
        return Err(ModelError::TooManySectors {
            sectors: model.sectors,
            most: MAX_SECTORS,
        });
    }
    if model.dofs.is_empty() {
        return Err(ModelError::NoDofs);
    }
    check_matrix(Matrix::Stiffness, &model.stiffness, model.dofs.len())?;
    check_matrix(Matrix::Mass, &model.mass, model.dofs.len())?;
    check_matrix(
        Matrix::BladeStiffness,
        &model.blade_stiffness,
        model.dofs.len(),
    )?;
    let node_dofs = check_dofs(&model.dofs)?;
    let high = check_cyclic(model)?;
    let layout = Layout { node_dofs, high };
    check_faces_complete(model, &layout)?;
    check_couplings(model)?;
    check_blade_stiffness(model, &layout)?;
    check_rigid(model, &layout)?;
    check_contact(model, &layout)?;
    for force in std::iter::once(&model.force).chain(&model.load_case_forces) {
        check_force(model, &layout, force)?;
    }
    check_observed(model, &layout)
}

/// Size, finite entries, and the signs that a positive semidefinite matrix has.
fn check_matrix(matrix: Matrix, values: &SymmetricSparse, dofs: usize) -> Result<(), ModelError> {
    if values.dimension() != dofs {
        return Err(ModelError::MatrixSize {
            matrix,
            found: values.dimension(),
            dofs,
        });
    }
    for (row, column, value) in values.lower_entries() {
        finite(Place::Entry(matrix, row, column), value)?;
    }
    let diagonal = values.diagonal();
    for (dof, &value) in diagonal.iter().enumerate() {
        if value < 0.0 {
            return Err(ModelError::NegativeDiagonal { matrix, dof, value });
        }
    }
    for (row, column, value) in values.lower_entries() {
        // The root of each: their product may overflow or vanish.
        let limit = diagonal[row].sqrt() * diagonal[column].sqrt();
        if row != column && value.abs() > limit * (1.0 + ROUNDING) {
            return Err(ModelError::Indefinite {
                matrix,
                row,
                column,
                value,
                limit,
            });
        }
    }
    Ok(())
}

/// Positions finite, components once, one position and body per node.
#[expect(
    clippy::float_cmp,
    reason = "the dofs of one node carry the very same numbers"
)]
fn check_dofs(dofs: &[Dof]) -> Result<HashMap<usize, Vec<usize>>, ModelError> {
    let mut node_dofs: HashMap<usize, Vec<usize>> = HashMap::new();
    for (index, dof) in dofs.iter().enumerate() {
        for (axis, &value) in dof.position_m.iter().enumerate() {
            finite(Place::Position(index, axis), value)?;
        }
        let same_node = node_dofs.entry(dof.node).or_default();
        for &first in same_node.iter() {
            if dofs[first].component == dof.component {
                return Err(ModelError::DuplicateDof {
                    first,
                    second: index,
                    node: dof.node,
                    component: dof.component,
                });
            }
            if dofs[first].position_m != dof.position_m || dofs[first].body != dof.body {
                return Err(ModelError::NodeInconsistent {
                    node: dof.node,
                    first,
                    second: index,
                });
            }
        }
        same_node.push(index);
    }
    Ok(node_dofs)
}

/// Range, uniqueness, components and geometry of the cyclic pairs; returns which dofs are high.
fn check_cyclic(model: &SectorModel) -> Result<Vec<bool>, ModelError> {
    let count = model.dofs.len();
    let mut pair_of = vec![None; count];
    let mut is_high = vec![false; count];
    let tolerance_m = position_tolerance_of(model.dofs.iter().map(|dof| dof.position_m));
    for (pair, &(low, high)) in model.cyclic_pairs.iter().enumerate() {
        for dof in [low, high] {
            in_range(Place::CyclicPair(pair), dof, count)?;
            if let Some(other) = pair_of[dof] {
                return Err(ModelError::CyclicDuplicate { pair, dof, other });
            }
            pair_of[dof] = Some(pair);
        }
        is_high[high] = true;
        let (a, b) = (&model.dofs[low], &model.dofs[high]);
        if a.component != b.component || a.body != b.body {
            return Err(ModelError::CyclicMismatch { pair, low, high });
        }
        let distance_m = distance(advanced(a.position_m, model.sectors), b.position_m);
        if distance_m > tolerance_m {
            return Err(ModelError::CyclicPosition {
                pair,
                low,
                high,
                distance_m,
                tolerance_m,
            });
        }
    }
    Ok(is_high)
}

/// Every dof of a face is paired: where a node and its image one sector on both exist, each
/// component of both must stand in a cyclic pair. Where sectors touch, what is free on both sides is in contact, not joined.
fn check_faces_complete(model: &SectorModel, layout: &Layout) -> Result<(), ModelError> {
    let mut paired = vec![false; model.dofs.len()];
    for &(low, high) in &model.cyclic_pairs {
        paired[low] = true;
        paired[high] = true;
    }
    let unpaired = |dof: usize| ModelError::CyclicUnpaired {
        dof,
        node: model.dofs[dof].node,
        component: model.dofs[dof].component,
    };
    for &(low, high) in &model.cyclic_pairs {
        for node in [model.dofs[low].node, model.dofs[high].node] {
            if let Some(&dof) = layout.node_dofs[&node].iter().find(|&&dof| !paired[dof]) {
                return Err(unpaired(dof));
            }
        }
    }
    if model.sectors == 1 {
        return Ok(());
    }
    // Nodes sorted by z, so that the image of a node is sought among those at its height.
    let tolerance_m = position_tolerance_of(model.dofs.iter().map(|dof| dof.position_m));
    let mut by_height: Vec<usize> = layout.node_dofs.values().map(|dofs| dofs[0]).collect();
    by_height.sort_by(|&a, &b| {
        model.dofs[a].position_m[2]
            .total_cmp(&model.dofs[b].position_m[2])
            .then(a.cmp(&b))
    });
    let sectors_touch = model.contact_pairs.iter().any(is_with_next_sector);
    for &dof in &by_height {
        let image = advanced(model.dofs[dof].position_m, model.sectors);
        let start = by_height
            .partition_point(|&other| model.dofs[other].position_m[2] < image[2] - tolerance_m);
        let found = by_height[start..]
            .iter()
            .take_while(|&&other| model.dofs[other].position_m[2] <= image[2] + tolerance_m)
            .find(|&&other| {
                model.dofs[other].body == model.dofs[dof].body
                    && model.dofs[other].node != model.dofs[dof].node
                    && distance(model.dofs[other].position_m, image) <= tolerance_m
            });
        if let Some(&other) = found {
            let touches = sectors_touch && !paired[dof] && !paired[other];
            if touches {
                continue;
            }
            for end in [dof, other] {
                if !paired[end] {
                    return Err(unpaired(end));
                }
            }
        }
    }
    Ok(())
}

/// `K_blade` is a share of K and stays off the high face.
fn check_blade_stiffness(model: &SectorModel, layout: &Layout) -> Result<(), ModelError> {
    let whole: HashMap<(usize, usize), f64> = model
        .stiffness
        .lower_entries()
        .map(|(row, column, value)| ((row, column), value))
        .collect();
    for (row, column, value) in model.blade_stiffness.lower_entries() {
        if value == 0.0 {
            continue;
        }
        for dof in [row, column] {
            if layout.high[dof] {
                let place = Place::Entry(Matrix::BladeStiffness, row, column);
                return Err(ModelError::OnHighFace {
                    place,
                    item: Item::Dof(dof),
                });
            }
        }
        let Some(&share) = whole.get(&(row, column)) else {
            return Err(ModelError::BladeEntryOutsideStiffness { row, column, value });
        };
        if row == column && value > share * (1.0 + SOFTENING) {
            return Err(ModelError::BladeShareExceedsStiffness {
                dof: row,
                blade: value,
                whole: share,
            });
        }
    }
    Ok(())
}

/// Checks a force vector that is to take the place of that of a valid model.
///
/// # Errors
/// The first entry that the model refuses, or a force that is zero.
pub fn validate_force(model: &SectorModel, force: &[(usize, Complex64)]) -> Result<(), ModelError> {
    let layout = Layout {
        node_dofs: check_dofs(&model.dofs)?,
        high: check_cyclic(model)?,
    };
    check_force(model, &layout, force)
}

/// Smallest and largest size of a force vector, N. With the factor of a study, which has the same range, forces are
/// 1e-60 to 1e60 N: powers of the displacements that they cause neither vanish nor overflow.
const FORCE_N: [f64; 2] = [1e-30, 1e30];

/// Range, faces and values of the force.
fn check_force(
    model: &SectorModel,
    layout: &Layout,
    force: &[(usize, Complex64)],
) -> Result<(), ModelError> {
    let mut seen: HashMap<usize, usize> = HashMap::new();
    for (entry, &(dof, value)) in force.iter().enumerate() {
        let place = Place::Force(entry);
        in_range(place, dof, model.dofs.len())?;
        if layout.high[dof] {
            return Err(ModelError::OnHighFace {
                place,
                item: Item::Dof(dof),
            });
        }
        finite(place, value.re)?;
        finite(place, value.im)?;
        if let Some(&first) = seen.get(&dof) {
            return Err(ModelError::ForceDuplicate {
                first,
                second: entry,
                dof,
            });
        }
        seen.insert(dof, entry);
    }
    if force.iter().all(|(_, force)| force.norm() == 0.0) {
        return Err(ModelError::NoForce);
    }
    let largest = force.iter().map(|(_, force)| force.norm());
    let largest_n = largest.fold(0.0, f64::max);
    if !(FORCE_N[0]..=FORCE_N[1]).contains(&largest_n) {
        return Err(ModelError::ForceOutOfRange { largest_n });
    }
    Ok(())
}

/// At least one observed node, each known, off the high face and with a name of its own.
fn check_observed(model: &SectorModel, layout: &Layout) -> Result<(), ModelError> {
    if model.observed.is_empty() {
        return Err(ModelError::NoObservedNode);
    }
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for (entry, observed) in model.observed.iter().enumerate() {
        layout.low_or_inner(Place::Observed(entry), observed.node)?;
        if let Some(&first) = seen.get(observed.name.as_str()) {
            let name = observed.name.clone();
            return Err(ModelError::ObservedDuplicate {
                first,
                second: entry,
                name,
            });
        }
        seen.insert(&observed.name, entry);
    }
    Ok(())
}

fn in_range(place: Place, dof: usize, dofs: usize) -> Result<(), ModelError> {
    if dof < dofs {
        Ok(())
    } else {
        Err(ModelError::DofOutOfRange { place, dof, dofs })
    }
}
