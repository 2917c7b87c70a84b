//! Relative motion at the contact pairs: one row per pair and direction.

use serde::{Deserialize, Serialize};

use crate::model::sector::{
    Body, Component, ContactPair, ContactSide, Dof, SectorModel, rigid_motion,
};

/// Direction of a relative motion at a pair, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Direction {
    /// Along the outward normal of the first side's surface; positive = pressed together.
    Normal,
    /// First tangent: the normalised projection of `e_theta` (of `e_z` if the normal is nearly `e_theta`).
    Tangent1,
    /// Second tangent `t2 = n x t1`.
    Tangent2,
}

impl Direction {
    /// All three, in the order of rows: normal, first tangent, second tangent.
    pub const ALL: [Self; 3] = [Self::Normal, Self::Tangent1, Self::Tangent2];
}

/// Relative displacement `d = u_first - u_second` of one pair along one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactRow {
    /// Index of the pair in the sector.
    pub pair: usize,
    /// Direction.
    pub direction: Direction,
    /// Entries of the row over the dofs of the sector and of the next one.
    pub entries: Vec<RowEntry>,
}

/// An entry of a contact row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowEntry {
    /// Dof of the sector model.
    pub dof: usize,
    /// Whether the dof is that of the next sector.
    pub is_next: bool,
    /// Factor on its displacement.
    pub factor: f64,
}

/// The contact interface of one sector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactGeometry {
    /// Weight of each pair: its share of the sector's stiffness.
    pub weights: Vec<f64>,
    /// Share of each pair of the sector's normal load.
    pub load_weights: Vec<f64>,
    /// For each pair, the row of its normal, first and second tangential motion; none where the
    /// nodes have no displacement that way.
    pub rows: Vec<[Option<usize>; 3]>,
    /// For each pair the displacement along t1 and t2 that a rigid motion of the ring brings:
    /// first its rotation, by unit displacement along theta at the mean contact radius (weighted
    /// like the pairs), then its axial motion, by unit displacement along z.
    pub ring_motion: Vec<[[f64; 2]; 2]>,
    /// Whether nothing but friction holds the ring along these two motions: no spring of its own,
    /// and no pair whose normal has a component along it.
    pub ring_free: [bool; 2],
}

impl ContactGeometry {
    /// Number of rows of a sector.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.rows.iter().flatten().flatten().count()
    }

    /// Contact springs of the rows, N/m, from per-sector totals `[normal, tangent1, tangent2]`.
    #[must_use]
    pub fn springs(&self, per_sector: [f64; 3]) -> Vec<f64> {
        let mut springs = vec![0.0; self.row_count()];
        for (rows, weight) in self.rows.iter().zip(&self.weights) {
            for (row, total) in rows.iter().zip(per_sector) {
                if let Some(row) = *row {
                    springs[row] = weight * total;
                }
            }
        }
        springs
    }
}

/// Whether the two sides of each pair move against each other along the first and the second tangent.
#[must_use]
pub fn pair_tangents(model: &SectorModel) -> Vec<[bool; 2]> {
    let (_, geometry) = contact_rows(model);
    let rows = geometry.rows.iter();
    rows.map(|[_, t1, t2]| [t1.is_some(), t2.is_some()])
        .collect()
}

/// Frame of a pair in (r, theta, z): normal, first and second tangent.
fn frame(pair: &ContactPair) -> [[f64; 3]; 3] {
    let n = pair.normal;
    let axis = if n[1].abs() > 0.9 { 2 } else { 1 };
    let mut t1 = [0.0; 3];
    t1[axis] = 1.0;
    for (component, normal) in t1.iter_mut().zip(n) {
        *component -= normal * n[axis];
    }
    let length = t1.iter().map(|c| c * c).sum::<f64>().sqrt();
    for component in &mut t1 {
        *component /= length;
    }
    let t2 = [
        n[1] * t1[2] - n[2] * t1[1],
        n[2] * t1[0] - n[0] * t1[2],
        n[0] * t1[1] - n[1] * t1[0],
    ];
    [n, t1, t2]
}

/// Tangential components of the ring's rigid motions at each pair, none where the second side is not on the ring.
fn ring_motion(model: &SectorModel) -> Vec<[[f64; 2]; 2]> {
    let radius = |pair: &ContactPair| {
        let node = pair.second.node()?;
        let (body, [x, y, _]) = model.place_of(node)?;
        (body == Body::Ring).then(|| x.hypot(y))
    };
    let pairs = &model.contact_pairs;
    let lever = |pair: &ContactPair| pair.weight * radius(pair).unwrap_or(0.0);
    let mean: f64 = pairs.iter().map(lever).sum();
    pairs
        .iter()
        .map(|pair| {
            let Some(radius) = radius(pair) else {
                return [[0.0; 2]; 2];
            };
            let [_, t1, t2] = frame(pair);
            let lever = if mean > 0.0 { radius / mean } else { 1.0 };
            [[lever * t1[1], lever * t2[1]], [t1[2], t2[2]]]
        })
        .collect()
}

/// Whether nothing but friction holds the ring against rotation, and against motion along z.
#[must_use]
pub fn ring_free(model: &SectorModel) -> [bool; 2] {
    const NEGLIGIBLE: f64 = 1e-6;
    [(Component::Tangential, 1), (Component::Axial, 2)].map(|(component, axis)| {
        let velocity = |dof: &Dof| match (component, dof.component) {
            _ if dof.body != Body::Ring => 0.0,
            (Component::Tangential, Component::Tangential) => {
                dof.position_m[0].hypot(dof.position_m[1])
            }
            (Component::Tangential, Component::RotationAxial)
            | (Component::Axial, Component::Axial) => 1.0,
            _ => 0.0,
        };
        let motion: Vec<f64> = model.dofs.iter().map(velocity).collect();
        // K v against |K| |v|: nothing but rounding is left where the motion is free.
        let mut force = vec![[0.0_f64; 2]; motion.len()];
        for (row, column, value) in model.stiffness.lower_entries() {
            let mut add = |to: usize, from: usize| {
                force[to][0] += value * motion[from];
                force[to][1] += (value * motion[from]).abs();
            };
            add(row, column);
            if row != column {
                add(column, row);
            }
        }
        let moves = motion.iter().any(|&v| v > 0.0);
        let largest = force.iter().map(|force| force[1]).fold(0.0, f64::max);
        let held = |force: &[f64; 2]| force[0].abs() > NEGLIGIBLE * largest;
        let pressed = |pair: &ContactPair| pair.normal[axis].abs() > NEGLIGIBLE;
        moves && !force.iter().any(held) && !model.contact_pairs.iter().any(pressed)
    })
}

/// Displacement of a node or of a point of a rigid body along `vector`, over the dofs of the sector.
fn displacement(model: &SectorModel, node: usize, vector: [f64; 3]) -> Vec<(usize, f64)> {
    let entry = |node: usize, component: Component, factor: f64| {
        let dof = model.dof_of(node, component).filter(|_| factor != 0.0)?;
        Some((dof, factor))
    };
    let point = model.rigid_point(node);
    let reference = point.and_then(|point| Some((point, model.place_of(point.reference)?)));
    match reference {
        Some((point, (_, reference_m))) => Component::RIGID
            .into_iter()
            .zip(rigid_motion(point.position_m, reference_m, vector))
            .filter_map(|(component, factor)| entry(point.reference, component, factor))
            .collect(),
        None => Component::DISPLACEMENTS
            .into_iter()
            .zip(vector)
            .filter_map(|(component, factor)| entry(node, component, factor))
            .collect(),
    }
}

/// Rows of relative motion of a sector, pair by pair in the order normal, t1, t2; directions
/// that no dof of the pair moves in have no row.
#[must_use]
pub fn contact_rows(model: &SectorModel) -> (Vec<ContactRow>, ContactGeometry) {
    let mut rows: Vec<ContactRow> = Vec::new();
    let mut geometry = ContactGeometry {
        weights: model.contact_pairs.iter().map(|pair| pair.weight).collect(),
        load_weights: model
            .contact_pairs
            .iter()
            .map(|pair| pair.load_weight.unwrap_or(pair.weight))
            .collect(),
        rows: Vec::new(),
        ring_motion: ring_motion(model),
        ring_free: ring_free(model),
    };
    for (index, pair) in model.contact_pairs.iter().enumerate() {
        let mut places = [None; 3];
        for ((direction, vector), place) in
            Direction::ALL.into_iter().zip(frame(pair)).zip(&mut places)
        {
            let mut entries = Vec::new();
            for (side, sign) in [(pair.first, 1.0), (pair.second, -1.0)] {
                let Some(node) = side.node() else { continue };
                for (dof, factor) in displacement(model, node, vector) {
                    entries.push(RowEntry {
                        dof,
                        is_next: matches!(side, ContactSide::NextSector(_)),
                        factor: sign * factor,
                    });
                }
            }
            if !entries.is_empty() {
                *place = Some(rows.len());
                rows.push(ContactRow {
                    pair: index,
                    direction,
                    entries,
                });
            }
        }
        geometry.rows.push(places);
    }
    (rows, geometry)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_of_a_ring_under_a_flange_is_theta_and_minus_z() {
        let pair = ContactPair {
            first: ContactSide::Node(0),
            second: ContactSide::Node(1),
            normal: [-1.0, 0.0, 0.0],
            weight: 1.0,
            load_weight: None,
        };
        assert_eq!(
            frame(&pair),
            [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]
        );
    }
}
