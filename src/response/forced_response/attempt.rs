//! The ways to a solution at one frequency.

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
    /// The same with derivatives of this very point: those of an earlier one serve most often, not always.
    ByHarmonicAfresh,
    /// The same with the whole Jacobian, found once.
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
const LADDER: [Attempt; 10] = [
    Attempt::Renewed,
    Attempt::ByHarmonic,
    Attempt::ByHarmonicAfresh,
    Attempt::Once,
    Attempt::Neighbours,
    Attempt::Line,
    Attempt::Stuck,
    Attempt::Continuation,
    Attempt::StiffnessHomotopy,
    Attempt::LoadHomotopy,
];

impl Attempt {
    /// The attempts where Newton's steps are condensed or not, with or without a solution with fewer harmonics; where
    /// the others are `waves` of the tuned wheel, the whole Jacobian is not to be had.
    pub(super) fn ladder(
        condenses: bool,
        refines: bool,
        waves: bool,
    ) -> impl Iterator<Item = Self> {
        let made = move |attempt: &Self| match attempt {
            Self::ByHarmonicAfresh => waves,
            Self::ByHarmonic => waves || refines,
            _ if waves => false,
            Self::Renewed => condenses,
            Self::Once => refines,
            _ => true,
        };
        LADDER.into_iter().filter(made)
    }

    /// How the steps of Newton's method are made.
    pub(super) fn steps(self) -> Steps {
        match self {
            Self::Renewed => Steps::Renewed,
            Self::ByHarmonic | Self::ByHarmonicAfresh => Steps::ByHarmonic,
            Self::Once => Steps::Once,
            Self::Neighbours => Steps::Accelerated,
            _ => Steps::Plain,
        }
    }
}
