//! Solutions over frequency: their slope, curves through folds, and the drift of a free ring.

mod continuation;
mod curve;
mod response_slope;
mod ring_drift;

pub use continuation::{Continuation, ContinuationBounds, ContinuationWork, Fold, PathPoint};
pub use response_slope::response_slope;
pub use ring_drift::solve_creeping;
