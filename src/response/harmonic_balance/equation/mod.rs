//! The harmonic balance equation of a wheel, `R(x) = 0`, its derivatives, and what a solution says of the contact.

mod active_rows;
mod contact_coordinates;
mod equivalent_contact;
mod harmonic_blocks;
mod jacobian;
mod linear;
mod linear_part;
mod step_cost;
mod structure;
mod system;

pub(super) use contact_coordinates::ContactCoordinates;
pub use harmonic_blocks::HarmonicBlock;
pub use linear::linear_response;
pub use step_cost::{LARGEST_WHOLE_JACOBIAN, condensing_pays};
pub use structure::{ContactStiffnessMatrix, Structure};
pub use system::{HarmonicSystem, SystemWorkspace};
