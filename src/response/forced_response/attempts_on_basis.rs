//! What is tried where a point on a basis does not converge: the attempts at its solution, in their order.

use crate::response::harmonic_balance::Steps;

/// Attempts at one point, in order.
#[derive(Debug, Clone, Copy)]
pub(super) enum Attempt {
    /// From what the converged points, or a solution with fewer harmonics, lead one to expect, with a Jacobian that
    /// is renewed often, since it costs little.
    Renewed,
    /// From what a solution with fewer harmonics and the converged points lead one to expect, with the derivatives
    /// of harmonics by themselves.
    ByHarmonic,
    /// From what a solution with fewer harmonics and the converged points lead one to expect, with the whole
    /// Jacobian, found once.
    Once,
    /// From what the converged points beside it lead one to expect, or from the stuck solution, with
    /// accelerated steps; those of all that follow are plain.
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

/// In the order in which they are made.
const LADDER: [Attempt; 9] = [
    Attempt::Renewed,
    Attempt::ByHarmonic,
    Attempt::Once,
    Attempt::Neighbours,
    Attempt::Line,
    Attempt::Stuck,
    Attempt::Continuation,
    Attempt::StiffnessHomotopy,
    Attempt::LoadHomotopy,
];

impl Attempt {
    /// The attempts where Newton's steps are condensed or not, with or without a solution with fewer harmonics.
    pub(super) fn ladder(condenses: bool, refines: bool) -> impl Iterator<Item = Self> {
        let made = move |attempt: &Self| match attempt {
            Self::Renewed => condenses,
            Self::ByHarmonic | Self::Once => refines,
            _ => true,
        };
        LADDER.into_iter().filter(made)
    }

    /// How the steps of Newton's method are made.
    pub(super) fn steps(self) -> Steps {
        match self {
            Self::Renewed => Steps::Renewed,
            Self::ByHarmonic => Steps::ByHarmonic,
            Self::Once => Steps::Once,
            Self::Neighbours => Steps::Accelerated,
            _ => Steps::Plain,
        }
    }
}
