//! Harmonic balance: dynamic stiffness, alternating frequency/time, Newton, convergence, outcome.

mod damping;
mod pair_harmonics;
mod status;
mod transform;

pub use damping::Damping;
pub use pair_harmonics::{PairHarmonics, PairJacobian};
pub use status::Status;
pub use transform::{HarmonicTransform, TransformError, TransformScratch};
