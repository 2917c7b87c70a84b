//! Sectors of masses and springs: blade, blade and disk, or blade, disk and ring.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::error::ModelError;
use super::error_place::Accepted;
use super::sector_model::{
    Body, Component, ContactPair, Dof, MAX_SECTORS, ObservedNode, SectorModel,
};
use super::validate::validate;
use crate::linalg::{Complex64, SymmetricSparse};

/// Masses and springs of one sector; an absent key is 0, and a mass of 0 means no such mass.
///
/// With `x_b, x_d, x_r` the tangential displacements of blade, disk and ring of sector n:
/// blade spring `k_b (x_b - x_d)` (to ground without a disk), blade coupling, disk coupling and ring
/// coupling `k (2 x_n - x_{n-1} - x_{n+1})`, disk and ring to ground, and a spring that locates the
/// ring on the disk. For N = 1 a coupling has no effect; for N = 2 two springs join the sectors.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LumpedOptions {
    /// Number of sectors N, at least 1.
    pub sectors: usize,
    /// Mass of the blade, kg; above 0.
    pub blade_mass_kg: f64,
    /// Mass of the disk's sector, kg.
    pub disk_mass_kg: f64,
    /// Mass of the ring's sector, kg; needs a disk.
    pub ring_mass_kg: f64,
    /// Spring of the blade to the disk, or to ground without one, N/m; above 0. It is `K_blade`.
    pub blade_stiffness_n_per_m: f64,
    /// Spring from blade to next blade, N/m.
    pub blade_coupling_stiffness_n_per_m: f64,
    /// Spring from disk to ground, N/m.
    pub disk_ground_stiffness_n_per_m: f64,
    /// Spring from disk to next disk, N/m.
    pub disk_coupling_stiffness_n_per_m: f64,
    /// Spring from ring to ground, N/m.
    pub ring_ground_stiffness_n_per_m: f64,
    /// Spring from ring to next ring, N/m.
    pub ring_coupling_stiffness_n_per_m: f64,
    /// Spring that locates the ring on the disk, N/m; not the contact stiffness.
    pub ring_disk_stiffness_n_per_m: f64,
}

/// Radii at which the masses are placed, m: only for pictures and the check of the faces.
const RADIUS_M: [f64; 3] = [1.5, 1.0, 0.9];

/// One kind of mass with the springs that need no other mass.
struct Mass {
    kg: f64,
    ground: f64,
    coupling: f64,
    radius_m: f64,
    body: Body,
}

impl LumpedOptions {
    fn check(&self) -> Result<(), ModelError> {
        if self.sectors == 0 || self.sectors > MAX_SECTORS {
            return Err(refused(
                "sectors",
                self.sectors as f64,
                Accepted::Count(1, MAX_SECTORS),
            ));
        }
        for (key, value) in [
            ("blade_mass_kg", self.blade_mass_kg),
            ("blade_stiffness_n_per_m", self.blade_stiffness_n_per_m),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(refused(key, value, Accepted::Positive));
            }
        }
        for (key, value) in [
            ("disk_mass_kg", self.disk_mass_kg),
            ("ring_mass_kg", self.ring_mass_kg),
            (
                "blade_coupling_stiffness_n_per_m",
                self.blade_coupling_stiffness_n_per_m,
            ),
            (
                "disk_ground_stiffness_n_per_m",
                self.disk_ground_stiffness_n_per_m,
            ),
            (
                "disk_coupling_stiffness_n_per_m",
                self.disk_coupling_stiffness_n_per_m,
            ),
            (
                "ring_ground_stiffness_n_per_m",
                self.ring_ground_stiffness_n_per_m,
            ),
            (
                "ring_coupling_stiffness_n_per_m",
                self.ring_coupling_stiffness_n_per_m,
            ),
            (
                "ring_disk_stiffness_n_per_m",
                self.ring_disk_stiffness_n_per_m,
            ),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(refused(key, value, Accepted::NonNegative));
            }
        }
        let disk = ("disk_mass_kg", self.disk_mass_kg);
        let ring = ("ring_mass_kg", self.ring_mass_kg);
        for (key, value, (mass_key, mass)) in [
            ("ring_mass_kg", self.ring_mass_kg, disk),
            (
                "disk_ground_stiffness_n_per_m",
                self.disk_ground_stiffness_n_per_m,
                disk,
            ),
            (
                "disk_coupling_stiffness_n_per_m",
                self.disk_coupling_stiffness_n_per_m,
                disk,
            ),
            (
                "ring_ground_stiffness_n_per_m",
                self.ring_ground_stiffness_n_per_m,
                ring,
            ),
            (
                "ring_coupling_stiffness_n_per_m",
                self.ring_coupling_stiffness_n_per_m,
                ring,
            ),
            (
                "ring_disk_stiffness_n_per_m",
                self.ring_disk_stiffness_n_per_m,
                ring,
            ),
        ] {
            if value > 0.0 && mass == 0.0 {
                return Err(ModelError::NeedsMass {
                    key: full_key(key),
                    value,
                    mass_key: full_key(mass_key),
                });
            }
        }
        Ok(())
    }

    /// The masses present: blade, disk, ring.
    fn masses(&self) -> Vec<Mass> {
        let blade_ground = if self.disk_mass_kg == 0.0 {
            self.blade_stiffness_n_per_m
        } else {
            0.0
        };
        [
            (
                self.blade_mass_kg,
                blade_ground,
                self.blade_coupling_stiffness_n_per_m,
                Body::Blisk,
            ),
            (
                self.disk_mass_kg,
                self.disk_ground_stiffness_n_per_m,
                self.disk_coupling_stiffness_n_per_m,
                Body::Blisk,
            ),
            (
                self.ring_mass_kg,
                self.ring_ground_stiffness_n_per_m,
                self.ring_coupling_stiffness_n_per_m,
                Body::Ring,
            ),
        ]
        .into_iter()
        .zip(RADIUS_M)
        .filter(|((mass_kg, ..), _)| *mass_kg > 0.0)
        .map(|((mass_kg, ground, coupling, body), radius_m)| Mass {
            kg: mass_kg,
            ground,
            coupling,
            radius_m,
            body,
        })
        .collect()
    }
}

/// Builds the sector: dof 0 the blade, then disk and ring, then the high face of each coupled mass.
///
/// Every node has the tangential component alone. 1 N acts on the blade, which is the observed node;
/// with a ring, disk and ring form one contact pair with normal (-1, 0, 0) and weight 1.
///
/// # Errors
/// If an option is out of range, or a spring or the ring lacks the mass it hangs on.
pub fn build(options: &LumpedOptions) -> Result<SectorModel, ModelError> {
    options.check()?;
    let masses = options.masses();
    let alpha = TAU / options.sectors as f64;
    let mut dofs = Vec::new();
    let mut stiffness = Vec::new();
    let mut mass = Vec::new();
    for (index, part) in masses.iter().enumerate() {
        dofs.push(dof(index, part.radius_m, 0.0, part.body));
        mass.push((index, index, part.kg));
        push_spring(&mut stiffness, index, None, part.ground);
    }
    let mut blade_stiffness = Vec::new();
    let disk = (masses.len() > 1).then_some(1);
    push_spring(
        &mut blade_stiffness,
        0,
        disk,
        options.blade_stiffness_n_per_m,
    );
    if disk.is_some() {
        stiffness.extend_from_slice(&blade_stiffness);
    }
    let has_ring = masses.len() > 2;
    if has_ring {
        push_spring(
            &mut stiffness,
            2,
            Some(1),
            options.ring_disk_stiffness_n_per_m,
        );
    }
    let mut cyclic_pairs = Vec::new();
    for (low, part) in masses
        .iter()
        .enumerate()
        .filter(|(_, part)| part.coupling > 0.0)
    {
        let high = dofs.len();
        dofs.push(dof(high, part.radius_m, alpha, part.body));
        push_spring(&mut stiffness, high, Some(low), part.coupling);
        cyclic_pairs.push((low, high));
    }
    let contact_pairs = has_ring
        .then_some(ContactPair {
            blisk_node: 1,
            ring_node: 2,
            normal: [-1.0, 0.0, 0.0],
            weight: 1.0,
            load_weight: None,
        })
        .into_iter()
        .collect();
    let n = dofs.len();
    let model = SectorModel {
        name: "lumped".to_owned(),
        sectors: options.sectors,
        stiffness: SymmetricSparse::from_lower_triplets(n, &stiffness),
        mass: SymmetricSparse::from_lower_triplets(n, &mass),
        blade_stiffness: SymmetricSparse::from_lower_triplets(n, &blade_stiffness),
        dofs,
        cyclic_pairs,
        contact_pairs,
        force: vec![(0, Complex64::new(1.0, 0.0))],
        load_case_forces: Vec::new(),
        observed: vec![ObservedNode {
            name: "blade".to_owned(),
            node: 0,
        }],
    };
    validate(&model)?;
    Ok(model)
}

fn dof(node: usize, radius_m: f64, theta: f64, body: Body) -> Dof {
    let position_m = [radius_m * theta.cos(), radius_m * theta.sin(), 0.0];
    Dof {
        node,
        component: Component::Tangential,
        position_m,
        body,
    }
}

/// A spring between two dofs, or to ground; `to < from`, or `from < to`, as it comes.
fn push_spring(
    triplets: &mut Vec<(usize, usize, f64)>,
    from: usize,
    to: Option<usize>,
    stiffness: f64,
) {
    if stiffness == 0.0 {
        return;
    }
    triplets.push((from, from, stiffness));
    if let Some(to) = to {
        triplets.push((to, to, stiffness));
        triplets.push((from.max(to), from.min(to), -stiffness));
    }
}

fn full_key(key: &str) -> String {
    format!("model.lumped.{key}")
}

fn refused(key: &str, value: f64, accepted: Accepted) -> ModelError {
    ModelError::Option {
        key: full_key(key),
        value,
        accepted,
    }
}
