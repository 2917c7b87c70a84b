//! The harmonic balance equation of a wheel, `R(x) = 0`, its derivatives, and what a solution says of the contact.

mod active_rows;
mod equivalent_contact;
mod harmonic_blocks;
mod jacobian;
mod linear;
mod linear_part;
mod structure;
mod system;

pub use harmonic_blocks::HarmonicBlock;
pub use linear::linear_response;
pub use structure::{ContactStiffnessMatrix, Structure};
#[cfg(test)]
pub(super) use system::tests as system_for_tests;
pub use system::{HarmonicSystem, SystemWorkspace};
