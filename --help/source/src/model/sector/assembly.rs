//! Assembly of a solid mesh into sector matrices in the cylindrical frame of each node.

use super::error::ModelError;
use super::hexahedron20::{self, Block, Material, NODES};
use super::sector_model::{Body, Component, Dof};
use crate::linalg::SymmetricSparse;

/// A node nearer to the axis than this fraction of the largest radius has no cylindrical frame.
const AXIS_FRACTION: f64 = 1e-9;

/// A 20-node brick of a [`SolidMesh`].
#[derive(Debug, Clone, PartialEq)]
pub struct SolidElement {
    /// Indices into [`SolidMesh::nodes_m`], in `C3D20` order.
    pub nodes: [usize; NODES],
    /// Index into [`SolidMesh::materials`].
    pub material: usize,
    /// Body the element belongs to.
    pub body: Body,
    /// Whether the element belongs to the blade, hence to `K_blade`.
    pub blade: bool,
}

/// A solid mesh of one cyclic sector.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SolidMesh {
    /// Cartesian positions, m; the axis of rotation is z. Nodes without element are left out.
    pub nodes_m: Vec<[f64; 3]>,
    /// Elements.
    pub elements: Vec<SolidElement>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Nodes held in all directions: their dofs are dropped.
    pub clamped_nodes: Vec<usize>,
}

/// Dofs and matrices of an assembled mesh, `n_dofs x n_dofs`.
#[derive(Debug, Clone, PartialEq)]
pub struct AssembledMesh {
    /// Degrees of freedom: by node, then r, theta, z.
    pub dofs: Vec<Dof>,
    /// Stiffness, N/m.
    pub stiffness: SymmetricSparse,
    /// Consistent mass, kg.
    pub mass: SymmetricSparse,
    /// Stiffness of the blade elements, N/m.
    pub blade_stiffness: SymmetricSparse,
}

impl SolidMesh {
    /// Assembles stiffness, mass and blade stiffness, each node's dofs turned to its own (r, theta, z).
    ///
    /// `K = sum_e T_e^T K_e T_e` with `u_cartesian = T u_cylindrical` and, per node,
    /// `T = [[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]]` at the node's angle.
    ///
    /// # Errors
    /// If an element refers to a node or material that is not there, is inverted, shares a node
    /// with the other body, or if a free node lies on the axis.
    pub fn assemble(&self) -> Result<AssembledMesh, ModelError> {
        let bodies = self.body_of_nodes()?;
        let turns = self.turns(&bodies)?;
        let mut first_dof = vec![None; self.nodes_m.len()];
        let mut dofs = Vec::new();
        for (node, body) in bodies.iter().enumerate() {
            let Some(body) = *body else { continue };
            if turns[node].is_none() {
                continue;
            }
            first_dof[node] = Some(dofs.len());
            for component in [Component::Radial, Component::Tangential, Component::Axial] {
                dofs.push(Dof {
                    node,
                    component,
                    position_m: self.nodes_m[node],
                    body,
                });
            }
        }
        let mut stiffness = Vec::new();
        let mut mass = Vec::new();
        let mut blade_stiffness = Vec::new();
        for (index, element) in self.elements.iter().enumerate() {
            let material = &self.materials[element.material];
            let positions = element.nodes.map(|node| self.nodes_m[node]);
            let matrices = hexahedron20::matrices(index, &positions, material)?;
            for (a, &node_a) in element.nodes.iter().enumerate() {
                for (b, &node_b) in element.nodes.iter().enumerate() {
                    let (Some(row), Some(column)) = (first_dof[node_a], first_dof[node_b]) else {
                        continue;
                    };
                    let (Some(turn_a), Some(turn_b)) = (turns[node_a], turns[node_b]) else {
                        continue;
                    };
                    let block = turned(turn_a, &matrices.stiffness[a][b], turn_b);
                    push_lower(&mut stiffness, row, column, &block);
                    if element.blade {
                        push_lower(&mut blade_stiffness, row, column, &block);
                    }
                    let m = matrices.mass[a][b];
                    let inertia = [[m, 0.0, 0.0], [0.0, m, 0.0], [0.0, 0.0, m]];
                    push_lower(&mut mass, row, column, &turned(turn_a, &inertia, turn_b));
                }
            }
        }
        let n = dofs.len();
        Ok(AssembledMesh {
            dofs,
            stiffness: SymmetricSparse::from_lower_triplets(n, &stiffness),
            mass: SymmetricSparse::from_lower_triplets(n, &mass),
            blade_stiffness: SymmetricSparse::from_lower_triplets(n, &blade_stiffness),
        })
    }

    /// Body of each node; `None` for a node without element.
    fn body_of_nodes(&self) -> Result<Vec<Option<Body>>, ModelError> {
        let count = self.nodes_m.len();
        let mut bodies = vec![None; count];
        for (index, element) in self.elements.iter().enumerate() {
            if element.material >= self.materials.len() {
                return Err(ModelError::ElementMaterial {
                    element: index,
                    material: element.material,
                    materials: self.materials.len(),
                });
            }
            for &node in &element.nodes {
                if node >= count {
                    return Err(ModelError::ElementNode {
                        element: index,
                        node,
                        nodes: count,
                    });
                }
                if bodies[node].is_some_and(|body| body != element.body) {
                    return Err(ModelError::ElementBody {
                        element: index,
                        node,
                    });
                }
                bodies[node] = Some(element.body);
            }
        }
        Ok(bodies)
    }

    /// Cosine and sine of the angle of each free node; `None` for clamped nodes and nodes without element.
    fn turns(&self, bodies: &[Option<Body>]) -> Result<Vec<Option<(f64, f64)>>, ModelError> {
        let count = self.nodes_m.len();
        let mut free: Vec<bool> = bodies.iter().map(Option::is_some).collect();
        for &node in &self.clamped_nodes {
            if node >= count {
                return Err(ModelError::ClampedNode { node, nodes: count });
            }
            free[node] = false;
        }
        let largest = self
            .nodes_m
            .iter()
            .map(|p| p[0].hypot(p[1]))
            .fold(0.0, f64::max);
        let mut turns = vec![None; count];
        for (node, &[x, y, _]) in self.nodes_m.iter().enumerate() {
            if !free[node] {
                continue;
            }
            let radius = x.hypot(y);
            if radius <= AXIS_FRACTION * largest {
                return Err(ModelError::NodeOnAxis {
                    node,
                    radius_m: radius,
                });
            }
            turns[node] = Some((x / radius, y / radius));
        }
        Ok(turns)
    }
}

/// `T_a^T B T_b` for the turns (cosine, sine) of two nodes.
pub(super) fn turned((ca, sa): (f64, f64), block: &Block, (cb, sb): (f64, f64)) -> Block {
    let half = block.map(|[x, y, z]| [x * cb + y * sb, y * cb - x * sb, z]);
    let mut result = [[0.0; 3]; 3];
    for j in 0..3 {
        result[0][j] = ca * half[0][j] + sa * half[1][j];
        result[1][j] = ca * half[1][j] - sa * half[0][j];
        result[2][j] = half[2][j];
    }
    result
}

/// Appends the part of a node block at (row, column) that lies in the lower triangle.
fn push_lower(triplets: &mut Vec<(usize, usize, f64)>, row: usize, column: usize, block: &Block) {
    for (i, values) in block.iter().enumerate() {
        for (j, &value) in values.iter().enumerate() {
            if row + i >= column + j {
                triplets.push((row + i, column + j, value));
            }
        }
    }
}
