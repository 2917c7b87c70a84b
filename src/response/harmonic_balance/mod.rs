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

pub use damping::Damping;
pub use equation::{
    ContactStiffnessMatrix, HarmonicBlock, HarmonicSystem, LARGEST_WHOLE_JACOBIAN, Structure,
    SystemWorkspace, condensing_pays, linear_response,
};
pub use follow::{
    Continuation, ContinuationBounds, ContinuationWork, Fold, PathPoint, response_slope,
    solve_creeping,
};
pub use pairs::{
    ContactInterface, ContactShares, MeanTangent, PairContact, PairHarmonics, PairJacobian,
    WheelContact,
};
pub use solver::{
    Effects, Enlarged, EnlargedSet, NewtonBounds, NewtonOutcome, NewtonWorkspace, Settled, Steps,
    enlarge, solve,
};
pub use status::Status;
pub use transform::{HarmonicTransform, TransformError, TransformScratch};
