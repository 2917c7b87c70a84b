//! The ways to a solution at one frequency.

use crate::response::harmonic_balance::Steps;

/// Attempts at one point, in order.
#[derive(Debug, Clone, Copy)]
pub(super) enum Attempt {
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

/// Where the whole Jacobian is not to be had: harmonics other than 1 in the tuned wheel.
const OF_WAVES: [Attempt; 2] = [Attempt::ByHarmonic, Attempt::ByHarmonicAfresh];

/// In the order in which they are made; the first two only beside a solution with fewer harmonics.
const LADDER: [Attempt; 8] = [
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
    /// The attempts, with or without a solution with fewer harmonics; where the others are taken in the tuned wheel,
    /// the whole Jacobian is not to be had.
    pub(super) fn ladder(refines: bool, waves: bool) -> &'static [Self] {
        match (refines, waves) {
            (_, true) => &OF_WAVES,
            (true, false) => &LADDER,
            (false, false) => &LADDER[2..],
        }
    }

    /// How the steps of Newton's method are made.
    pub(super) fn steps(self) -> Steps {
        match self {
            Self::ByHarmonic | Self::ByHarmonicAfresh => Steps::ByHarmonic,
            Self::Once => Steps::Once,
            Self::Neighbours => Steps::Accelerated,
            _ => Steps::Plain,
        }
    }
}
