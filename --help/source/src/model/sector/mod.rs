//! The sector model, its validation, and everything that makes one.

mod assembly;
pub mod bundle;
mod chain;
mod chain_problem;
mod contact_problem;
mod error;
mod error_place;
pub mod hexahedron20;
pub mod import;
mod layout;
mod line_problem;
pub mod lumped;
pub mod matrix_market;
pub mod parametric;
mod parametric_axis;
mod parametric_cylinder;
mod parametric_mesh;
mod parametric_options;
mod parametric_shelf;
mod rigid;
mod rigid_problem;
mod sector_model;
mod validate;
mod validate_contact;
mod validate_couplings;
mod validate_rigid;

pub use assembly::{AssembledMesh, SolidElement, SolidMesh};
pub use chain_problem::ChainProblem;
pub use contact_problem::ContactProblem;
pub use error::ModelError;
pub use error_place::{Accepted, Item, Matrix, Place, StiffnessKind};
pub use hexahedron20::Material;
pub use line_problem::{LinePart, LineProblem};
pub use lumped::{LumpedOptions, NamedContact, NamedMass, NamedSpring};
pub use parametric_options::{Damper, DamperBody, DamperShape, ParametricOptions};
pub use rigid::rigid_motion;
pub use rigid_problem::RigidProblem;
pub use sector_model::{
    Body, Component, ContactPair, ContactSide, Dof, ObservedNode, RigidPoint, SectorModel,
};
pub use validate::{validate, validate_force};
