//! What can be wrong with a point of a rigid body.

use thiserror::Error;

use super::sector_model::Component;

/// A refused point of a rigid body: the value found and what is accepted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RigidProblem {
    /// Its number is that of a node with dofs.
    #[error("node {node} has dofs of its own; accepted: a number that no node of the dofs has")]
    HasDofs {
        /// The number.
        node: usize,
    },
    /// Its number is that of an earlier point.
    #[error("node {node} is rigid point {earlier} too; accepted: each number once")]
    Duplicate {
        /// The number.
        node: usize,
        /// The earlier point.
        earlier: usize,
    },
    /// Its reference lacks a dof.
    #[error(
        "its reference, node {reference}, has no component {missing}; accepted: a node with r, t, z, rr, rt and rz"
    )]
    Components {
        /// The reference.
        reference: usize,
        /// First component that it lacks.
        missing: Component,
    },
    /// The mass of its reference couples displacement and rotation.
    #[error(
        "its reference, node {reference}, has a mass of {value:e} between {displacement} and {rotation}; accepted: the centre of mass, where that is at most {limit:e}"
    )]
    NotCentre {
        /// The reference.
        reference: usize,
        /// The displacement.
        displacement: Component,
        /// The rotation.
        rotation: Component,
        /// Entry of M, kg m.
        value: f64,
        /// Largest size accepted, kg m.
        limit: f64,
    },
}
