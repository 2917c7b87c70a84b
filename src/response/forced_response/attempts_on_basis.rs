//! What is tried where a point on a basis does not converge: the attempts at its solution, in their order.

/// Attempts at one point.
#[derive(Debug, Clone, Copy)]
pub(super) enum Attempt {
    /// From what the converged points beside it lead one to expect, or from the stuck solution.
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
    /// All of them, in the order in which they are made.
    pub(super) const ALL: [Self; 6] = [
        Self::Neighbours,
        Self::Line,
        Self::Stuck,
        Self::Continuation,
        Self::StiffnessHomotopy,
        Self::LoadHomotopy,
    ];
}
