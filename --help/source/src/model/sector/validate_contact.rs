//! Checks of the contact pairs of a sector model.

use std::collections::{HashMap, HashSet};

use super::contact_problem::ContactProblem;
use super::error::ModelError;
use super::error_place::Place;
use super::layout::{Layout, advanced, finite};
use super::sector_model::{Body, Component, ContactPair, ContactSide, SectorModel};

/// Tolerance on the angle of contact nodes, rad.
const ANGLE_TOLERANCE_RAD: f64 = 1e-6;
/// Tolerance on the length of normals and the sum of weights.
const UNIT_TOLERANCE: f64 = 1e-6;

/// Nodes, angles, normals and weights of the contact pairs, and that no damper body goes without.
pub(super) fn check_contact(model: &SectorModel, layout: &Layout) -> Result<(), ModelError> {
    let mut seen: HashMap<(ContactSide, ContactSide), usize> = HashMap::new();
    let mut sum = 0.0;
    for (pair, contact) in model.contact_pairs.iter().enumerate() {
        let refused = |problem| ModelError::Contact { pair, problem };
        check_sides(model, layout, pair, contact)?;
        let (first, second) = (contact.first, contact.second);
        let earlier = seen.get(&(first, second)).or(seen.get(&(second, first)));
        if let Some(&earlier) = earlier {
            return Err(ModelError::ContactDuplicate {
                first: earlier,
                second: pair,
            });
        }
        seen.insert((first, second), pair);
        let place = Place::ContactPair(pair);
        for value in contact.normal {
            finite(place, value)?;
        }
        let length = contact.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err(refused(ContactProblem::Normal { length }));
        }
        let weight = contact.weight;
        finite(place, weight)?;
        if weight <= 0.0 {
            return Err(refused(ContactProblem::Weight { weight }));
        }
        sum += weight;
    }
    if !model.contact_pairs.is_empty() && (sum - 1.0).abs() > UNIT_TOLERANCE {
        return Err(ModelError::ContactWeightSum { sum });
    }
    check_damper(model)
}

/// Refuses a damper body that nothing touches.
fn check_damper(model: &SectorModel) -> Result<(), ModelError> {
    let sides = |pair: &ContactPair| [pair.first.node(), pair.second.node()];
    let pairs = model.contact_pairs.iter();
    let touched: HashSet<usize> = pairs
        .flat_map(sides)
        .flatten()
        .map(|node| model.moved_by(node))
        .collect();
    let mut damper = model.dofs.iter().filter(|dof| dof.body == Body::Damper);
    match damper.clone().next() {
        Some(dof) if !damper.any(|dof| touched.contains(&dof.node)) => {
            Err(ModelError::DamperWithoutContact { node: dof.node })
        }
        _ => Ok(()),
    }
}

/// What the two sides of a contact pair are, and where.
fn check_sides(
    model: &SectorModel,
    layout: &Layout,
    pair: usize,
    contact: &ContactPair,
) -> Result<(), ModelError> {
    let refused = |problem| Err(ModelError::Contact { pair, problem });
    let (first, second) = (contact.first, contact.second);
    if first == second || first == ContactSide::Ground {
        return refused(ContactProblem::Sides { first, second });
    }
    let is_across = is_with_next_sector(contact);
    if is_across && model.sectors == 1 {
        return refused(ContactProblem::OneSector);
    }
    let mut ends = Vec::new();
    for side in [first, second] {
        let Some(node) = side.node() else { continue };
        let (components, own_m) = layout.contact_point(model, Place::ContactPair(pair), node)?;
        let position_m = match side {
            ContactSide::NextSector(_) => advanced(own_m, model.sectors),
            ContactSide::Node(_) | ContactSide::Ground => own_m,
        };
        ends.push((components, position_m));
    }
    let [(components, here_m), (other_components, there_m)] = ends.as_slice() else {
        return Ok(());
    };
    if components != other_components {
        return refused(ContactProblem::Components {
            first,
            second,
            first_has: named(components),
            second_has: named(other_components),
        });
    }
    // Masses that move along one line have no frame that could turn from sector to sector.
    if components.len() == 1 && is_across {
        return Ok(());
    }
    let difference_rad = angle_between(*here_m, *there_m);
    if difference_rad > ANGLE_TOLERANCE_RAD {
        return refused(ContactProblem::Angle {
            first,
            second,
            difference_rad,
            tolerance_rad: ANGLE_TOLERANCE_RAD,
        });
    }
    Ok(())
}

/// Components as a bundle names them.
fn named(components: &[Component]) -> String {
    let names: Vec<String> = components.iter().map(Component::to_string).collect();
    format!("({})", names.join(", "))
}

/// Whether a contact pair is with the next sector.
pub(super) fn is_with_next_sector(pair: &ContactPair) -> bool {
    [pair.first, pair.second]
        .iter()
        .any(|side| matches!(side, ContactSide::NextSector(_)))
}

/// Magnitude of the difference in theta, rad.
fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let cross = a[0] * b[1] - a[1] * b[0];
    let dot = a[0] * b[0] + a[1] * b[1];
    cross.atan2(dot).abs()
}
