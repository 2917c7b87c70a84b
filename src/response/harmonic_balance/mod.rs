//! Harmonic balance: dynamic stiffness, alternating frequency/time, Newton, convergence, outcome.

mod damping;
mod status;

pub use damping::Damping;
pub use status::Status;
