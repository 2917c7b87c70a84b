//! Sliders of several pairs side by side, a lane of a vector each.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

/// Pairs that are marched in one block.
pub(super) const LANES: usize = 8;

/// The lanes of one block.
#[inline(always)]
pub(super) fn lanes_at(values: &[f64], block: usize) -> [f64; LANES] {
    std::array::from_fn(|lane| values[block + lane])
}

/// The offset `y` confined to `[-limit - elastic, limit - elastic]`; plain comparisons, each of which is one machine
/// instruction.
#[inline(always)]
pub(super) fn clip(y: f64, limit: f64, elastic: f64) -> f64 {
    smaller(limit - elastic, larger(-limit - elastic, y))
}

#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
pub(super) fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
