//! Harmonic balance: dynamic stiffness, alternating frequency/time, Newton, convergence, outcome.

mod damping;
mod equation;
mod follow;
mod largest_norm;
mod pairs;
mod solver;
mod status;
mod transform;

pub use damping::Damping;
pub use equation::{
    ContactStiffnessMatrix, HarmonicBlock, HarmonicSystem, Structure, SystemWorkspace,
    linear_response,
};
pub use follow::{
    Continuation, ContinuationBounds, ContinuationWork, DriftingRing, Fold, PathPoint, let_creep,
};
pub use pairs::{
    ContactInterface, ContactShares, MeanTangent, PairContact, PairHarmonics, PairJacobian,
    WheelContact,
};
pub use solver::{
    Effects, Enlarged, EnlargedSet, NewtonBounds, NewtonOutcome, NewtonWorkspace, Settled, enlarge,
    solve,
};
pub use status::Status;
pub use transform::{HarmonicTransform, TransformError, TransformScratch};
