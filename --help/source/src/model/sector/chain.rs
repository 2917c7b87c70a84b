//! Sectors of masses that move along one line, joined by springs and contacts: to each other, to the ground, to the next sector.

use std::f64::consts::TAU;

use super::error::ModelError;
use super::sector_model::{
    Body, Component, ContactPair, ContactSide, Dof, ObservedNode, SectorModel,
};
use super::validate::validate;
use crate::linalg::{Complex64, SymmetricSparse};

/// Masses and springs of one sector, all names resolved.
pub(super) struct Chain {
    /// Number of sectors N.
    pub sectors: usize,
    pub masses: Vec<Mass>,
    pub springs: Vec<Spring>,
    pub contacts: Vec<Contact>,
    /// Mass on which 1 N acts.
    pub forced: usize,
    /// Names and masses that are observed; the first has the amplitude.
    pub observed: Vec<(String, usize)>,
}

/// A mass of the sector.
pub(super) struct Mass {
    pub kg: f64,
    pub body: Body,
    /// Radius and height at which it stands, m: only for pictures and the check of the faces.
    pub place_m: [f64; 2],
}

/// What a spring or a contact ends at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// A mass of the sector, by its place in the list.
    Mass(usize),
    /// A mass of the next sector.
    Next(usize),
    Ground,
}

/// A spring between two ends.
pub(super) struct Spring {
    pub ends: [End; 2],
    pub stiffness_n_per_m: f64,
    /// Whether it belongs to `K_blade`.
    pub is_mistuned: bool,
}

/// A contact between two ends; its friction acts along the line of motion.
pub(super) struct Contact {
    pub ends: [End; 2],
    /// Share of the sector's contact stiffness and normal load.
    pub weight: f64,
}

/// Lower triplets `(row, column, value)` of a symmetric matrix.
type Triplets = Vec<(usize, usize, f64)>;

/// Builds the sector: a dof for each mass in their order, then the high face of each mass that a spring reaches in the next
/// sector.
///
/// # Errors
/// If the model is refused as any other is.
pub(super) fn build(chain: &Chain) -> Result<SectorModel, ModelError> {
    let mut dofs: Vec<Dof> = Vec::new();
    let mut mass = Triplets::new();
    for (index, part) in chain.masses.iter().enumerate() {
        dofs.push(dof(index, part, 0.0));
        mass.push((index, index, part.kg));
    }
    let alpha = TAU / chain.sectors as f64;
    let mut cyclic_pairs: Vec<(usize, usize)> = Vec::new();
    let (mut stiffness, mut blade_stiffness) = (Triplets::new(), Triplets::new());
    for spring in &chain.springs {
        let ends = spring.ends.map(|end| match end {
            End::Mass(index) => Some(index),
            End::Next(index) => {
                let known = cyclic_pairs.iter().find(|pair| pair.0 == index);
                if let Some(&(_, high)) = known {
                    return Some(high);
                }
                let high = dofs.len();
                dofs.push(dof(high, &chain.masses[index], alpha));
                cyclic_pairs.push((index, high));
                Some(high)
            }
            End::Ground => None,
        });
        push_spring(&mut stiffness, ends, spring.stiffness_n_per_m);
        if spring.is_mistuned {
            push_spring(&mut blade_stiffness, ends, spring.stiffness_n_per_m);
        }
    }
    let n = dofs.len();
    let matrix = |triplets: &Triplets| SymmetricSparse::from_lower_triplets(n, triplets);
    let model = SectorModel {
        name: "lumped".to_owned(),
        sectors: chain.sectors,
        stiffness: matrix(&stiffness),
        mass: matrix(&mass),
        blade_stiffness: matrix(&blade_stiffness),
        dofs,
        cyclic_pairs,
        contact_pairs: chain.contacts.iter().map(contact_pair).collect(),
        force: vec![(chain.forced, Complex64::new(1.0, 0.0))],
        rigid_points: Vec::new(),
        load_case_forces: Vec::new(),
        observed: chain
            .observed
            .iter()
            .map(|(name, node)| ObservedNode {
                name: name.clone(),
                node: *node,
            })
            .collect(),
    };
    validate(&model)?;
    Ok(model)
}

/// The tangential displacement of a mass, or of its copy on the high face.
fn dof(node: usize, mass: &Mass, theta: f64) -> Dof {
    let [radius_m, height_m] = mass.place_m;
    Dof {
        node,
        component: Component::Tangential,
        position_m: [radius_m * theta.cos(), radius_m * theta.sin(), height_m],
        body: mass.body,
    }
}

/// A pair whose only row of relative motion is tangential.
fn contact_pair(contact: &Contact) -> ContactPair {
    let [first, second] = contact.ends.map(|end| match end {
        End::Mass(index) => ContactSide::Node(index),
        End::Next(index) => ContactSide::NextSector(index),
        End::Ground => ContactSide::Ground,
    });
    ContactPair {
        first,
        second,
        normal: [-1.0, 0.0, 0.0],
        weight: contact.weight,
        load_weight: None,
    }
}

/// A spring between two dofs, or a dof and the ground.
fn push_spring(triplets: &mut Triplets, ends: [Option<usize>; 2], stiffness: f64) {
    for end in ends.into_iter().flatten() {
        triplets.push((end, end, stiffness));
    }
    if let [Some(from), Some(to)] = ends {
        triplets.push((from.max(to), from.min(to), -stiffness));
    }
}
