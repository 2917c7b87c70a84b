//! Solutions over frequency: curves through folds, and the drift of a free ring.

mod continuation;
mod curve;
mod ring_drift;

pub use continuation::{Continuation, ContinuationBounds, ContinuationWork, Fold, PathPoint};
pub use ring_drift::{DriftingRing, let_creep};
