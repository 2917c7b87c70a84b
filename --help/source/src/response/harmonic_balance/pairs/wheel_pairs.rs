//! What the laws of all pairs of a wheel read and write, and what they say of their states.

use super::{ContactInterface, PairHarmonics, PairJacobian};

/// The contact pairs of a wheel, sector after sector, with their vectors of one evaluation.
pub(in crate::response::harmonic_balance) struct WheelPairs<'a> {
    pub(in crate::response::harmonic_balance) interface: &'a ContactInterface,
    /// Number of contact rows over all sectors.
    pub(in crate::response::harmonic_balance) rows: usize,
    /// Displacement, m, and correction of the force, N, at the contact rows, coefficient after coefficient
    /// (`n_coefficients x rows`); corrections are zero at first.
    pub(in crate::response::harmonic_balance) displacement: &'a [f64],
    pub(in crate::response::harmonic_balance) correction: &'a mut [f64],
    /// The law of one pair, for derivatives.
    pub(in crate::response::harmonic_balance) one: &'a mut PairHarmonics,
    /// Whether a pair slips or separates.
    pub(in crate::response::harmonic_balance) active: &'a mut [bool],
    /// Of every pair where derivatives are wanted.
    pub(in crate::response::harmonic_balance) jacobians: &'a mut [PairJacobian],
}

/// Share of contact pairs in a state at any sample.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactShares {
    /// Pairs slipping in any direction.
    pub slipping: f64,
    /// Pairs with no normal load.
    pub separated: f64,
    /// Pairs whose periodic state was not found; a solution with such pairs is none.
    pub unclosed: f64,
}
