//! The harmonic balance equation of a wheel, `R(x) = 0`, its derivatives, and what a solution says of the contact.

mod contact_coordinates;
mod contact_states;
mod equivalent_contact;
mod frequency_derivative;
mod harmonic_block;
mod jacobian;
mod linear;
mod linear_part;
mod other_contact;
mod structure;
mod system;
mod wheel_contact;

pub(super) use contact_coordinates::ContactCoordinates;
pub use contact_states::PairContact;
pub use harmonic_block::HarmonicBlock;
pub use jacobian::LARGEST_WHOLE_JACOBIAN;
pub use linear::linear_response;
pub use structure::{ContactStiffnessMatrix, Structure};
pub use system::{HarmonicSystem, SystemWorkspace};
pub use wheel_contact::{MeanTangent, WheelContact};
