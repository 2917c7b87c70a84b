//! Checks of a sector model before anything is computed with it: refused or untouched, never repaired.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::error::ModelError;
use super::error_place::{Item, Matrix, Place};
use super::sector_model::{Component, Dof, MAX_SECTORS, SectorModel};
use super::validate_couplings::check_couplings;
use crate::linalg::{Complex64, SymmetricSparse};

/// Tolerance on positions, as a fraction of the largest distance from the origin.
const POSITION_TOLERANCE: f64 = 1e-6;
/// Tolerance on the angle of contact nodes, rad.
const ANGLE_TOLERANCE_RAD: f64 = 1e-6;
/// Tolerance on the length of normals and the sum of weights.
const UNIT_TOLERANCE: f64 = 1e-6;
/// How much the blade's diagonal may exceed K's, relative: K of a rotating sector holds spin softening,
/// which the elastic stiffness of the blade does not.
const SOFTENING: f64 = 0.01;
/// Relative tolerance of entry-wise tests on matrices that were rounded when written.
const ROUNDING: f64 = 1e-9;

/// Where the dofs of a node begin, and what the faces hold.
struct Layout {
    /// Dofs of each node, by component.
    node_dofs: HashMap<usize, Vec<usize>>,
    /// Whether a dof lies on the high face.
    high: Vec<bool>,
}

impl Layout {
    /// Components of a node, sorted.
    fn components(&self, dofs: &[Dof], node: usize) -> Vec<Component> {
        let mut components: Vec<Component> = self
            .node_dofs
            .get(&node)
            .into_iter()
            .flatten()
            .map(|&dof| dofs[dof].component)
            .collect();
        components.sort_unstable();
        components
    }

    /// The first dof of a node that must exist and lie off the high face.
    fn low_or_inner(&self, place: Place, node: usize) -> Result<usize, ModelError> {
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
    let tolerance_m = position_tolerance_m(&model.dofs);
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
/// component of both must stand in a cyclic pair.
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
    let tolerance_m = position_tolerance_m(&model.dofs);
    let mut by_height: Vec<usize> = layout.node_dofs.values().map(|dofs| dofs[0]).collect();
    by_height.sort_by(|&a, &b| {
        model.dofs[a].position_m[2]
            .total_cmp(&model.dofs[b].position_m[2])
            .then(a.cmp(&b))
    });
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

/// Nodes, bodies, angles, normals and weights of the contact pairs.
fn check_contact(model: &SectorModel, layout: &Layout) -> Result<(), ModelError> {
    let mut seen: HashMap<(usize, usize), usize> = HashMap::new();
    let mut sum = 0.0;
    for (pair, contact) in model.contact_pairs.iter().enumerate() {
        let place = Place::ContactPair(pair);
        let (blisk_node, ring_node) = (contact.blisk_node, contact.ring_node);
        let blisk = &model.dofs[layout.low_or_inner(place, blisk_node)?];
        let ring = &model.dofs[layout.low_or_inner(place, ring_node)?];
        for (dof, body) in [(blisk, super::Body::Blisk), (ring, super::Body::Ring)] {
            if dof.body != body {
                return Err(ModelError::ContactBody {
                    pair,
                    node: dof.node,
                });
            }
        }
        if let Some(&first) = seen.get(&(blisk_node, ring_node)) {
            return Err(ModelError::ContactDuplicate {
                first,
                second: pair,
            });
        }
        seen.insert((blisk_node, ring_node), pair);
        if layout.components(&model.dofs, blisk_node) != layout.components(&model.dofs, ring_node) {
            return Err(ModelError::ContactComponents {
                pair,
                blisk_node,
                ring_node,
            });
        }
        let difference_rad = angle_between(blisk.position_m, ring.position_m);
        if difference_rad > ANGLE_TOLERANCE_RAD {
            return Err(ModelError::ContactAngle {
                pair,
                blisk_node,
                ring_node,
                difference_rad,
                tolerance_rad: ANGLE_TOLERANCE_RAD,
            });
        }
        for value in contact.normal {
            finite(place, value)?;
        }
        let length = contact.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err(ModelError::ContactNormal { pair, length });
        }
        finite(place, contact.weight)?;
        if contact.weight <= 0.0 {
            return Err(ModelError::ContactWeight {
                pair,
                weight: contact.weight,
            });
        }
        sum += contact.weight;
    }
    if !model.contact_pairs.is_empty() && (sum - 1.0).abs() > UNIT_TOLERANCE {
        return Err(ModelError::ContactWeightSum { sum });
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

fn finite(place: Place, value: f64) -> Result<(), ModelError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(ModelError::NotFinite { place, value })
    }
}

fn in_range(place: Place, dof: usize, dofs: usize) -> Result<(), ModelError> {
    if dof < dofs {
        Ok(())
    } else {
        Err(ModelError::DofOutOfRange { place, dof, dofs })
    }
}

fn position_tolerance_m(dofs: &[Dof]) -> f64 {
    position_tolerance_of(dofs.iter().map(|dof| dof.position_m))
}

/// The tolerance on the positions of a model, m.
pub(super) fn position_tolerance_of(positions_m: impl Iterator<Item = [f64; 3]>) -> f64 {
    let largest = positions_m
        .map(|position| distance(position, [0.0; 3]))
        .fold(0.0, f64::max);
    POSITION_TOLERANCE * largest
}

/// A position turned by one sector in +theta.
fn advanced([x, y, z]: [f64; 3], sectors: usize) -> [f64; 3] {
    let (sin, cos) = (TAU / sectors as f64).sin_cos();
    [x * cos - y * sin, x * sin + y * cos, z]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Magnitude of the difference in theta, rad.
fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let cross = a[0] * b[1] - a[1] * b[0];
    let dot = a[0] * b[0] + a[1] * b[1];
    cross.atan2(dot).abs()
}
