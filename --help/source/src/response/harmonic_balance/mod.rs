//! Harmonic balance: dynamic stiffness, alternating frequency/time, Newton, convergence, outcome.

mod condensed;
mod damping;
mod equation;
mod follow;
mod largest_norm;
mod pairs;
mod solver;
mod status;
mod transform;

pub use condensed::condensing_pays;
pub use damping::Damping;
pub use equation::{
    ContactStiffnessMatrix, HarmonicBlock, HarmonicSystem, LARGEST_WHOLE_JACOBIAN, MeanTangent,
    PairContact, Structure, SystemWorkspace, WheelContact, linear_response,
};
pub use follow::{
    Continuation, ContinuationBounds, ContinuationWork, Fold, PathPoint, solve_creeping,
};
pub use pairs::{ContactInterface, ContactShares, PairHarmonics, PairJacobian};
pub use solver::{
    Effects, Enlarged, EnlargedSet, NewtonBounds, NewtonOutcome, NewtonWorkspace, Settled, Steps,
    enlarge, solve,
};
pub use status::Status;
pub use transform::{HarmonicTransform, TransformError, TransformScratch};
