//! What a contact law is: the parts that the file of a law states.

use super::{ContactHistory, PairDisplacement, PairMemory, PairParameters, PairState};

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

/// The evaluation of all pairs of a wheel at once, a lane of a vector each, that a law has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SideBySide {
    /// None: one pair after the other, as its `respond` has it.
    No,
    /// Of Jenkins elements with the limit `mu N0`.
    ConstantLimit,
    /// Of two Jenkins elements with the limit `mu N(t)`.
    VariableLimit,
}

/// A contact law.
pub(super) struct LawParts {
    /// Name in a study.
    pub(super) name: &'static str,
    /// Whether the normal load follows the normal displacement; else it is `N0` and the normal spring is bilateral.
    pub(super) has_variable_load: bool,
    pub(super) friction: TangentialFriction,
    pub(super) side_by_side: SideBySide,
    /// The periodic response to a displacement: fills the normal load and correction of a history and its sliders, of Jenkins elements
    /// or of the friction circle.
    pub(super) respond: fn(&mut ContactHistory, &PairParameters, PairDisplacement<'_>) -> PairState,
    /// The pair after a step to a displacement along n, t1, t2, m, straight from where it was.
    pub(super) march: fn(&PairParameters, &PairMemory, [f64; 3]) -> PairMemory,
}
