//! The sector model, its validation, and everything that makes one.

mod assembly;
pub mod bundle;
mod error;
mod error_place;
pub mod hexahedron20;
pub mod import;
mod line_problem;
pub mod lumped;
pub mod matrix_market;
pub mod parametric;
mod parametric_mesh;
mod parametric_options;
mod sector_model;
mod validate;
mod validate_couplings;

pub use assembly::{AssembledMesh, SolidElement, SolidMesh};
pub use error::ModelError;
pub use error_place::{Accepted, Item, Matrix, Place, StiffnessKind};
pub use hexahedron20::Material;
pub use line_problem::{LinePart, LineProblem};
pub use lumped::LumpedOptions;
pub use parametric_options::ParametricOptions;
pub use sector_model::{Body, Component, ContactPair, Dof, ObservedNode, SectorModel};
pub use validate::{validate, validate_force};
