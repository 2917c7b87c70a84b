//! What a contact law is: the parts that the file of a law states.

use super::{
    ContactHistory, PairDisplacement, PairMemory, PairParameters, PairState, SideBySide,
    TangentialFriction,
};

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
