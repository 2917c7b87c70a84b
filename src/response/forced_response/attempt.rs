//! The ways to a solution at one frequency.

/// Attempts at one point, in order.
#[derive(Debug, Clone, Copy)]
pub(super) enum Attempt {
    /// From what the converged points beside it lead one to expect, or from the stuck solution, with
    /// accelerated steps; those of all others are plain.
    Neighbours,
    /// From the line between the points beside it, or from the stuck solution if there is none.
    Line,
    /// From the stuck solution.
    Stuck,
    /// Arc-length continuation in frequency from the nearest converged point.
    Continuation,
    /// Homotopy in contact stiffness.
    StiffnessHomotopy,
    /// Homotopy in normal load.
    LoadHomotopy,
}

impl Attempt {
    /// In the order in which they are made.
    pub(super) const LADDER: [Self; 6] = [
        Self::Neighbours,
        Self::Line,
        Self::Stuck,
        Self::Continuation,
        Self::StiffnessHomotopy,
        Self::LoadHomotopy,
    ];
}
