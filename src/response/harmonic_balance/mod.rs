//! Harmonic balance: dynamic stiffness, alternating frequency/time, Newton, convergence, outcome.

mod anderson;
mod contact_interface;
mod contact_states;
mod continuation;
mod convergence;
mod coupled_derivative;
mod curve;
mod damping;
mod enlarged;
mod equivalent_contact;
mod frequency_derivative;
mod jacobian;
mod kept_jacobian;
mod linear;
mod newton;
mod other_contact;
mod pair_harmonics;
mod ring_drift;
mod status;
mod structure;
mod system;
mod transform;

pub use contact_interface::ContactInterface;
pub use contact_states::PairContact;
pub use continuation::{Continuation, ContinuationBounds, ContinuationWork, Fold, PathPoint};
pub use convergence::NewtonBounds;
pub use damping::Damping;
pub use enlarged::{Effects, Enlarged, EnlargedSet, enlarge};
pub use linear::linear_response;
pub use newton::{LARGEST_WHOLE_JACOBIAN, NewtonOutcome, NewtonWorkspace, Settled, Steps, solve};
pub use pair_harmonics::{PairHarmonics, PairJacobian};
pub use ring_drift::solve_creeping;
pub use status::Status;
pub use structure::{ContactStiffnessMatrix, Structure};
pub use system::{ContactShares, HarmonicBlock, HarmonicSystem, SystemWorkspace};
pub use transform::{HarmonicTransform, TransformError, TransformScratch};
