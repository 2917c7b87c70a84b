//! Matrices in Cartesian directions turned to the cylindrical frame of each node.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use super::problem::ImportProblem;
use super::source::refuse;
use crate::linalg::SymmetricSparse;
use crate::model::sector::assembly::turned;
use crate::model::sector::error::ModelError;
use crate::model::sector::hexahedron20::Block;
use crate::model::sector::sector_model::{Body, Component, Dof};

/// Components in the order of the directions they replace: x and y together become r and theta.
pub(super) const COMPONENTS: [Component; 3] =
    [Component::Radial, Component::Tangential, Component::Axial];

/// A node nearer to the axis than this fraction of the largest radius has no cylindrical frame.
const AXIS_FRACTION: f64 = 1e-9;

/// A node of the wheel: position with the axis of rotation along z, m, and body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub position_m: [f64; 3],
    pub body: Body,
}

/// The free dofs of the wheel's sector and the frames of its nodes.
#[derive(Debug)]
pub(super) struct Frames {
    pub dofs: Vec<Dof>,
    /// Dof of node and direction or component (0, 1, 2).
    place: HashMap<(usize, usize), usize>,
    /// Cosine and sine of each node's angle.
    turns: HashMap<usize, (f64, f64)>,
}

impl Frames {
    /// Frames of the nodes that `rows` (node, direction) name; `path` stands in refusals.
    pub fn new(
        rows: impl Iterator<Item = (usize, usize)>,
        nodes: &BTreeMap<usize, Node>,
        path: &Path,
    ) -> Result<Self, ModelError> {
        let mut free: BTreeMap<usize, [bool; 3]> = BTreeMap::new();
        for (node, direction) in rows {
            free.entry(node).or_default()[direction] = true;
        }
        let largest = nodes
            .values()
            .map(|node| node.position_m[0].hypot(node.position_m[1]))
            .fold(0.0, f64::max);
        let mut frames = Self {
            dofs: Vec::new(),
            place: HashMap::new(),
            turns: HashMap::new(),
        };
        for (node, directions) in free {
            let Node { position_m, body } = nodes[&node];
            if directions[0] != directions[1] {
                let (has, lacks) = if directions[0] {
                    ("x", "y")
                } else {
                    ("y", "x")
                };
                return Err(refuse(path, ImportProblem::HalfHeld { node, has, lacks }));
            }
            let [x, y, _] = position_m;
            let radius_m = x.hypot(y);
            let turn = if radius_m > AXIS_FRACTION * largest {
                (x / radius_m, y / radius_m)
            } else if directions[0] {
                return Err(ModelError::NodeOnAxis { node, radius_m });
            } else {
                (1.0, 0.0)
            };
            frames.turns.insert(node, turn);
            for (direction, component) in COMPONENTS.into_iter().enumerate() {
                if directions[direction] {
                    frames.place.insert((node, direction), frames.dofs.len());
                    frames.dofs.push(Dof {
                        node,
                        component,
                        position_m,
                        body,
                    });
                }
            }
        }
        Ok(frames)
    }

    pub fn dof(&self, node: usize, component: usize) -> Option<usize> {
        self.place.get(&(node, component)).copied()
    }

    /// Whether the node is free in any direction.
    pub fn is_free(&self, node: usize) -> bool {
        self.turns.contains_key(&node)
    }

    /// A Cartesian vector in the frame of a node.
    pub fn components(&self, node: usize, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let (cos, sin) = self.turns.get(&node).copied().unwrap_or((1.0, 0.0));
        [cos * x + sin * y, cos * y - sin * x, z]
    }

    /// `factor T^T A T` as triplets of the lower triangle, `u_cartesian = T u_cylindrical`; `rows`
    /// gives node and direction of each row of `A`, all of which have a dof.
    pub fn turn(
        &self,
        rows: &[(usize, usize)],
        matrix: &SymmetricSparse,
        factor: f64,
    ) -> Vec<(usize, usize, f64)> {
        let mut blocks: BTreeMap<(usize, usize), Block> = BTreeMap::new();
        for (row, column, value) in matrix.entries() {
            let ((a, i), (b, j)) = (rows[row], rows[column]);
            if a >= b {
                blocks.entry((a, b)).or_default()[i][j] = factor * value;
            }
        }
        let mut triplets = Vec::new();
        for ((a, b), block) in blocks {
            let block = turned(self.turns[&a], &block, self.turns[&b]);
            for (i, values) in block.iter().enumerate() {
                for (j, &value) in values.iter().enumerate() {
                    if let (Some(row), Some(column)) = (self.dof(a, i), self.dof(b, j))
                        && row >= column
                    {
                        triplets.push((row, column, value));
                    }
                }
            }
        }
        triplets
    }
}
