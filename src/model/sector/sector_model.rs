//! One cyclic sector of a bladed disk with its dampers, in physical degrees of freedom.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::linalg::{Complex64, SymmetricSparse};

/// Sine of the least angle between a component and a normal at which the component is a direction of friction.
const LEAST_TANGENT: f64 = 1e-6;

/// Largest number of sectors accepted.
pub(super) const MAX_SECTORS: usize = 10_000;

/// Component of a displacement or of a rotation in the cylindrical frame at the node's own angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub enum Component {
    /// Radial, `r`.
    Radial,
    /// Tangential, `t` (theta).
    Tangential,
    /// Axial, `z`.
    Axial,
    /// Rotation about the radial axis, `rr`, rad.
    RotationRadial,
    /// Rotation about the tangential axis, `rt`, rad.
    RotationTangential,
    /// Rotation about the axial axis, `rz`, rad.
    RotationAxial,
}

impl Component {
    /// Displacements along r, theta and z.
    pub const DISPLACEMENTS: [Self; 3] = [Self::Radial, Self::Tangential, Self::Axial];
    /// Rotations about the same axes.
    pub const ROTATIONS: [Self; 3] = [
        Self::RotationRadial,
        Self::RotationTangential,
        Self::RotationAxial,
    ];
    /// The six of a rigid body.
    pub const RIGID: [Self; 6] = [
        Self::Radial,
        Self::Tangential,
        Self::Axial,
        Self::RotationRadial,
        Self::RotationTangential,
        Self::RotationAxial,
    ];

    /// Whether it is a rotation.
    #[must_use]
    pub fn is_rotation(self) -> bool {
        Self::ROTATIONS.contains(&self)
    }
}

/// The body a node belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// Disk and blade.
    Blisk,
    /// Ring damper.
    Ring,
    /// Damper body of one sector, for instance a wedge between the platforms of neighbouring blades.
    Damper,
}

/// A degree of freedom: one component of one node.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Dof {
    /// Node id, from 0.
    pub node: usize,
    /// Component of its motion.
    pub component: Component,
    /// Cartesian position of the node in the frame of sector 0, m; the axis of rotation is z.
    pub position_m: [f64; 3],
    /// Body of the node.
    pub body: Body,
}

/// A point of a rigid body: it has no dofs of its own but moves with the six of another node.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RigidPoint {
    /// Number of the point, as contact pairs name it; no node of the dofs has it.
    pub node: usize,
    /// Node of the body's six dofs, at its centre of mass.
    pub reference: usize,
    /// Cartesian position in the frame of sector 0, m.
    pub position_m: [f64; 3],
}

/// One of the two sides that meet in a contact pair of sector n.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub enum ContactSide {
    /// A node of sector n.
    Node(usize),
    /// The copy of a node in the next sector, n + 1.
    NextSector(usize),
    /// What does not move.
    Ground,
}

impl ContactSide {
    /// The node of the sector model, none for the ground.
    #[must_use]
    pub fn node(self) -> Option<usize> {
        match self {
            Self::Node(node) | Self::NextSector(node) => Some(node),
            Self::Ground => None,
        }
    }
}

/// A pair of facing points in contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactPair {
    /// Side whose surface has the normal: the blisk of a ring damper.
    pub first: ContactSide,
    /// Side that it presses on: the ring of a ring damper. Only this one may be the ground.
    pub second: ContactSide,
    /// Unit outward normal of the first side's surface (pointing into the second), in (r, theta, z).
    pub normal: [f64; 3],
    /// Share of the sector's contact stiffness; the shares of a sector sum to 1.
    pub weight: f64,
    /// Share of the sector's normal load, likewise; none = that of the stiffness.
    pub load_weight: Option<f64>,
}

/// A node whose displacement is reported; the first of a model carries the peak metric.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ObservedNode {
    /// Name shown to the user.
    pub name: String,
    /// Node id.
    pub node: usize,
}

impl ObservedNode {
    /// Whether a bundle can hold the name: its CSV files have no quotes.
    pub(super) fn is_name(name: &str) -> bool {
        !name.is_empty() && name.trim() == name && !name.contains([',', '"', '\n', '\r'])
    }
}

/// One cyclic sector, structure only: no contact springs, boundary conditions already applied.
///
/// Both cyclic faces are present; the high face of sector n is the low face of sector n + 1.
/// Conventions of frame, signs and faces: `docs/sector-bundle.md` and the head of `src/model/cyclic/mod.rs`.
/// Checked by `validate` before use.
#[derive(Debug, Clone, PartialEq)]
pub struct SectorModel {
    /// Name of the model.
    pub name: String,
    /// Number of sectors N of the wheel.
    pub sectors: usize,
    /// Stiffness, N/m, `n_dofs x n_dofs`.
    pub stiffness: SymmetricSparse,
    /// Mass, kg, `n_dofs x n_dofs`; positive semidefinite (a lumped high face has none).
    pub mass: SymmetricSparse,
    /// Share of the stiffness that belongs to the blade, N/m: mistuned sector n has `K + delta_n K_blade`.
    pub blade_stiffness: SymmetricSparse,
    /// Degrees of freedom, in the order of the matrices.
    pub dofs: Vec<Dof>,
    /// `(low_dof, high_dof)`: the same component on the two cyclic faces.
    pub cyclic_pairs: Vec<(usize, usize)>,
    /// Points of rigid bodies, which contact pairs name as they name nodes. Empty for a model without rigid bodies.
    pub rigid_points: Vec<RigidPoint>,
    /// Contact pairs; no node on the high face. Empty for a model without contact.
    pub contact_pairs: Vec<ContactPair>,
    /// Complex force amplitude on sector 0 as `(dof, newton)`.
    pub force: Vec<(usize, Complex64)>,
    /// Force vectors of load cases, each as `force`, which they take the place of; empty: that one alone.
    pub load_case_forces: Vec<Vec<(usize, Complex64)>>,
    /// Observed nodes, at least one.
    pub observed: Vec<ObservedNode>,
}

impl SectorModel {
    /// The dof of `node` in direction `component`, if the node has it.
    #[must_use]
    pub fn dof_of(&self, node: usize, component: Component) -> Option<usize> {
        self.dofs
            .iter()
            .position(|dof| dof.node == node && dof.component == component)
    }

    /// The point of a rigid body that has the number `node`.
    #[must_use]
    pub fn rigid_point(&self, node: usize) -> Option<&RigidPoint> {
        self.rigid_points.iter().find(|point| point.node == node)
    }

    /// The node whose dofs move `node`: itself, or the reference of a point of a rigid body.
    #[must_use]
    pub fn moved_by(&self, node: usize) -> usize {
        self.rigid_point(node).map_or(node, |point| point.reference)
    }

    /// Contact pairs that have no displacement across their normal, so that nothing in them can rub.
    #[must_use]
    pub fn pairs_without_friction(&self) -> usize {
        let mut of_node: HashMap<usize, Vec<Component>> = HashMap::new();
        for dof in &self.dofs {
            of_node.entry(dof.node).or_default().push(dof.component);
        }
        let rubs = |node: usize, normal: [f64; 3]| {
            // A rigid body turns as well: its points move in any direction.
            let Some(components) = of_node.get(&node) else {
                return true;
            };
            let along = Component::DISPLACEMENTS.iter().zip(normal);
            along
                .filter(|(component, _)| components.contains(component))
                .any(|(_, cosine)| 1.0 - cosine * cosine > LEAST_TANGENT * LEAST_TANGENT)
        };
        let sides = |pair: &ContactPair| [pair.first.node(), pair.second.node()];
        let pairs = self.contact_pairs.iter();
        pairs
            .filter(|pair| {
                !sides(pair)
                    .into_iter()
                    .flatten()
                    .any(|node| rubs(node, pair.normal))
            })
            .count()
    }

    /// Body and position, m, of a node or of a point of a rigid body.
    #[must_use]
    pub fn place_of(&self, node: usize) -> Option<(Body, [f64; 3])> {
        let reference = self.moved_by(node);
        let dof = self.dofs.iter().find(|dof| dof.node == reference)?;
        let position_m = self
            .rigid_point(node)
            .map_or(dof.position_m, |point| point.position_m);
        Some((dof.body, position_m))
    }
}
