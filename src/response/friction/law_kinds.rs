//! Kinds of contact laws: by their friction along the tangents, and by how all pairs of a wheel are evaluated at once.

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
