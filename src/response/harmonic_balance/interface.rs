//! The contact interface of one sector as the equation sees it, and what state its pairs are in.

use crate::model::cyclic::ContactGeometry;
use crate::response::friction::{ContactLaw, PairParameters};

/// Contact law and pair parameters of one sector.
#[derive(Debug, Clone)]
pub struct ContactInterface {
    /// Law of every pair.
    pub law: ContactLaw,
    /// Rows and weights of the pairs of one sector.
    pub geometry: ContactGeometry,
    /// Parameters of each pair of one sector.
    pub pairs: Vec<PairParameters>,
}

/// Share of contact pairs in a state at any sample.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactShares {
    /// Pairs slipping in any direction.
    pub slipping: f64,
    /// Pairs with no normal load.
    pub separated: f64,
}
