//! Craig-Bampton reduction, stick and slide basis, component mode mistuning.

mod basis;
mod blade;
mod craig_bampton;
mod error;
mod nodal_diameter_damping;
mod options;
mod reduce;

pub use super::reduced_model::{BasisChoice, CantileverModes, ContactSprings};
pub use craig_bampton::{CraigBampton, WHOLE_SPACE_DOFS};
pub use error::wanted_reach_hz;
pub use nodal_diameter_damping::{DampedModes, NodalDiameterDamping};
pub use options::{Basis, ReductionOptions};
pub use reduce::{ContactStiffness, Reduction};
