//! What a contact law is: the parts that the file of a law states.

use super::{ContactHistory, PairDisplacement, PairMemory, PairParameters};

/// Friction along the tangents of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentialFriction {
    /// A Jenkins element along each of the first `tangents`, by itself.
    Jenkins {
        /// 1 or 2.
        tangents: usize,
    },
    /// Both tangents on the friction circle.
    FrictionCircle,
}

/// A contact law.
pub(super) struct LawParts {
    /// Name in a study.
    pub(super) name: &'static str,
    /// Whether the normal load follows the normal displacement; else it is `N0` and the normal spring is bilateral.
    pub(super) has_variable_load: bool,
    pub(super) friction: TangentialFriction,
    /// Fills a history with the periodic response to a displacement.
    pub(super) respond: fn(&mut ContactHistory, &PairParameters, PairDisplacement<'_>),
    /// The pair after a step to a displacement along n, t1, t2, m, straight from where it was.
    pub(super) march: fn(&PairParameters, &PairMemory, [f64; 3]) -> PairMemory,
}
