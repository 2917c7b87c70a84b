//! The load of each contact pair under rotation: how hard a ring or an underplatform damper (wedge or cylinder) presses it.
//!
//! It is that of the static equilibrium of damper and blisk.
//!
//! In nodal diameter 0, per square of the angular velocity Omega, with x the radius of every node along r,
//!
//! ```text
//! (K + C_n^T diag(kn_i, pressed pairs) C_n) u = M x,    N_i / Omega^2 = kn_i C_n,i u >= 0
//! ```
//!
//! Pairs carry pressure alone and no friction; those that would pull are let go, those that close taken
//! back. No gap and no interference at rest, so the pairs that press are the same at every speed.
//!
//! `x` is the position vector itself, which isoparametric elements interpolate exactly: `M x` is the
//! consistent centrifugal load. A ring split at one place carries no hoop force far from the gap: its faces may part
//! by a rotation `gamma` about the axis, `u_theta,high = u_theta,low + gamma r`, with no moment on it.
//!
//! A rigid body has the load of its mass at its centre of mass, where `M x` is `m r`, and a moment about it: that of
//! `s x (s_r, s_theta, 0)` over the body, by its products of inertia `(J_theta,z, -J_r,z, 0)`.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::contact_rows::{Direction, contact_rows};
use crate::linalg::{Complex64, HermitianSparse, Matrix, SymmetricSparse};
use crate::model::sector::{Body, Component, Dof, SectorModel};

/// Springs of mass times this hold what nothing else holds, (rad/s)^2: 1 Hz.
const HOLD: f64 = TAU * TAU;
/// Changes of the set of pressed pairs after which it counts as not settled.
const ROUNDS: usize = 100;

/// Whether the ring can carry hoop force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hoop {
    /// A whole ring: hoop force takes a part of the centrifugal load.
    #[default]
    Closed,
    /// Split at one place with a free gap: the contact takes all of it.
    Split,
}

/// Why the contact load under rotation cannot be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum CentrifugalError {
    /// The model has no contact pairs, so that there is nothing to press on.
    #[error("the model has no contact pairs")]
    NoContact,
    /// No body that is pressed by its own mass moves along r, as in wheels of masses and springs.
    #[error("the model has no ring or damper body with a radial degree of freedom")]
    NoRadialMotion,
    /// The stiffness of nodal diameter 0 is not positive definite.
    #[error("the stiffness of nodal diameter 0 is not positive definite")]
    Indefinite,
    /// The set of pressed pairs does not settle.
    #[error("the pairs that are pressed do not settle")]
    NotSettled,
}

/// Ring or damper body of a sector under rotation.
#[derive(Debug, Clone, PartialEq)]
pub struct CentrifugalContact {
    /// Normal load of each pair over the square of the angular velocity, kg m (N s^2).
    pub pair_loads_kg_m: Vec<f64>,
    /// Mass of the ring's sector, kg.
    pub ring_mass_kg: f64,
    /// Centrifugal load of the ring's sector over the square of the angular velocity, `sum of m r`, kg m.
    pub ring_load_kg_m: f64,
}

impl CentrifugalContact {
    /// Normal load of the sector over the square of the angular velocity, kg m.
    #[must_use]
    pub fn sector_load_kg_m(&self) -> f64 {
        self.pair_loads_kg_m.iter().sum()
    }

    /// Radius at which the mass of the ring would have its centrifugal load, m.
    #[must_use]
    pub fn ring_radius_m(&self) -> f64 {
        self.ring_load_kg_m / self.ring_mass_kg
    }
}

/// Contact load of a sector under rotation; `normal_stiffness_n_per_m` is that of the sector's contact,
/// shared out over the pairs by weight.
///
/// # Errors
/// The model has no contact or no radial motion of the ring, or there is no equilibrium.
pub fn centrifugal_contact(
    model: &SectorModel,
    normal_stiffness_n_per_m: f64,
    hoop: Hoop,
) -> Result<CentrifugalContact, CentrifugalError> {
    if model.contact_pairs.is_empty() {
        return Err(CentrifugalError::NoContact);
    }
    let on_damper = |component| {
        move |dof: &Dof| f64::from(dof.body != Body::Blisk && dof.component == component)
    };
    let radius = |dof: &Dof| match dof.component {
        Component::Radial => dof.position_m[0].hypot(dof.position_m[1]),
        _ => 0.0,
    };
    let of = |value: &dyn Fn(&Dof) -> f64| -> Vec<f64> { model.dofs.iter().map(value).collect() };
    let radial = of(&on_damper(Component::Radial));
    if radial.iter().all(|&value| value == 0.0) {
        return Err(CentrifugalError::NoRadialMotion);
    }
    let mut load = model.mass.multiply(&of(&radius));
    add_moments(model, &mut load);
    let axial = of(&on_damper(Component::Axial));
    let motion = if axial.iter().any(|&value| value > 0.0) {
        &axial
    } else {
        &radial
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let equilibrium = Equilibrium::new(model, hoop);
    Ok(CentrifugalContact {
        pair_loads_kg_m: equilibrium.pair_loads(model, &load, normal_stiffness_n_per_m)?,
        ring_mass_kg: dot(motion, &model.mass.multiply(motion)),
        ring_load_kg_m: dot(&radial, &load),
    })
}

/// Adds the moments of the centrifugal load about the centres of mass of rigid bodies.
fn add_moments(model: &SectorModel, load: &mut [f64]) {
    let points = model.rigid_points.iter();
    let references: BTreeSet<usize> = points.map(|point| point.reference).collect();
    for reference in references {
        let dofs = Component::ROTATIONS.map(|component| model.dof_of(reference, component));
        let [Some(about_r), Some(about_theta), Some(about_z)] = dofs else {
            continue;
        };
        let mut inertia = vec![0.0; model.dofs.len()];
        inertia[about_z] = 1.0;
        let inertia = model.mass.multiply(&inertia);
        load[about_r] += inertia[about_theta];
        load[about_theta] -= inertia[about_r];
    }
}

/// The coordinates of nodal diameter 0, and of the parting of a split ring.
struct Equilibrium {
    /// For each dof of the sector its coordinates with their factors.
    coordinates: Vec<Vec<(usize, f64)>>,
    size: usize,
}

impl Equilibrium {
    fn new(model: &SectorModel, hoop: Hoop) -> Self {
        let mut low_of_high = vec![None; model.dofs.len()];
        for &(low, high) in &model.cyclic_pairs {
            low_of_high[high] = Some(low);
        }
        let mut place_of_dof = vec![0; model.dofs.len()];
        let mut size = 0;
        for (dof, low) in low_of_high.iter().enumerate() {
            if low.is_none() {
                place_of_dof[dof] = size;
                size += 1;
            }
        }
        let parting = size;
        let mut parts = false;
        let coordinates = low_of_high
            .iter()
            .zip(&model.dofs)
            .enumerate()
            .map(|(index, (low, dof))| {
                let mut places = vec![(place_of_dof[low.unwrap_or(index)], 1.0)];
                let by_parting = match dof.component {
                    Component::Tangential => dof.position_m[0].hypot(dof.position_m[1]),
                    Component::RotationAxial => 1.0,
                    _ => 0.0,
                };
                let along = dof.body == Body::Ring && by_parting > 0.0;
                if low.is_some() && along && hoop == Hoop::Split {
                    places.push((parting, by_parting));
                    parts = true;
                }
                places
            })
            .collect();
        Self {
            coordinates,
            size: size + usize::from(parts),
        }
    }

    fn matrix(&self, sector: &SymmetricSparse) -> HermitianSparse {
        let entries = sector.entries().flat_map(|(row, column, value)| {
            self.coordinates[row].iter().flat_map(move |&(i, a)| {
                self.coordinates[column]
                    .iter()
                    .map(move |&(j, b)| (i, j, Complex64::from(a * b * value)))
            })
        });
        HermitianSparse::from_triplets(self.size, entries)
    }

    /// Loads of the pairs under `load` on the dofs of the sector.
    fn pair_loads(
        &self,
        model: &SectorModel,
        load: &[f64],
        normal_stiffness_n_per_m: f64,
    ) -> Result<Vec<f64>, CentrifugalError> {
        let mut right = Matrix::<Complex64>::zeros(self.size, 1);
        for (places, value) in self.coordinates.iter().zip(load) {
            for &(place, factor) in places {
                right[(place, 0)] += factor * value;
            }
        }
        let mass = self.matrix(&model.mass);
        let held = self.matrix(&model.stiffness).plus(HOLD, &mass);
        let rows = self.normal_rows(model);
        let springs: Vec<f64> = model
            .contact_pairs
            .iter()
            .map(|pair| pair.weight * normal_stiffness_n_per_m)
            .collect();
        let mut pressed = vec![true; rows.len()];
        for _ in 0..ROUNDS {
            let contact = self.contact(&rows, &springs, &pressed);
            let factor = held
                .plus(1.0, &contact)
                .factor()
                .map_err(|_| CentrifugalError::Indefinite)?;
            let displacement = factor.solve(&right);
            let closing: Vec<f64> = rows
                .iter()
                .map(|row| row.iter().map(|&(i, a)| a * displacement[(i, 0)].re).sum())
                .collect();
            let next: Vec<bool> = closing.iter().map(|&closing: &f64| closing > 0.0).collect();
            if next == pressed {
                let loads = closing.iter().zip(&springs).zip(&pressed);
                let load = |((closing, spring), pressed): ((&f64, &f64), &bool)| {
                    if *pressed { spring * closing } else { 0.0 }
                };
                return Ok(loads.map(load).collect());
            }
            pressed = next;
        }
        Err(CentrifugalError::NotSettled)
    }

    /// `C_n^T diag(springs) C_n` over the pairs that are pressed.
    fn contact(
        &self,
        rows: &[Vec<(usize, f64)>],
        springs: &[f64],
        pressed: &[bool],
    ) -> HermitianSparse {
        let pairs = rows.iter().zip(springs).zip(pressed);
        let entries = pairs
            .filter(|(_, pressed)| **pressed)
            .flat_map(|((row, &spring), _)| {
                row.iter().flat_map(move |&(i, a)| {
                    row.iter()
                        .map(move |&(j, b)| (i, j, Complex64::from(spring * a * b)))
                })
            });
        HermitianSparse::from_triplets(self.size, entries)
    }

    /// Relative motion of each pair along its normal, in these coordinates.
    fn normal_rows(&self, model: &SectorModel) -> Vec<Vec<(usize, f64)>> {
        let mut rows = vec![Vec::new(); model.contact_pairs.len()];
        let normal = |row: &super::ContactRow| row.direction == Direction::Normal;
        for row in contact_rows(model).0.into_iter().filter(normal) {
            rows[row.pair] = row
                .entries
                .iter()
                .flat_map(|entry| {
                    // In nodal diameter 0 the next sector moves as this one.
                    let places = self.coordinates[entry.dof].iter();
                    places.map(move |&(place, weight)| (place, weight * entry.factor))
                })
                .collect();
        }
        rows
    }
}
