//! When a Jacobian that was factored before serves for another step.

/// When a Jacobian serves on: by the length of a simplified step over that of an earlier one.
#[derive(Clone, Copy)]
pub(super) struct Serves {
    /// At most, over the step before,
    pub(super) one_step: f64,
    /// or over the one before that: accelerated steps do not shrink evenly.
    pub(super) two_steps: f64,
    /// The step before is taken up to this.
    pub(super) longer: f64,
    /// Steps after which it is renewed anyway.
    pub(super) steps: usize,
}

/// Of simplified steps by themselves.
pub(super) const PLAIN: Serves = Serves {
    one_step: 0.6,
    two_steps: 0.0,
    longer: 0.75,
    steps: usize::MAX,
};
/// Of accelerated ones, which cost a small part of what a new Jacobian does.
pub(super) const ACCELERATED: Serves = Serves {
    one_step: 0.9,
    two_steps: 0.8,
    longer: 2.0,
    steps: usize::MAX,
};
/// Of accelerated ones with a Jacobian that leaves out much: what is left out is learned from the steps, all of
/// them, so that a new Jacobian would throw away more than it brings.
pub(super) const ONCE: Serves = Serves {
    one_step: 1e3,
    two_steps: 1e3,
    longer: 1e3,
    steps: 130,
};

/// Where a new Jacobian costs no more than a few steps.
pub(super) const RENEWED: Serves = Serves {
    one_step: 0.3,
    two_steps: 0.0,
    longer: 0.9,
    steps: usize::MAX,
};
