//! Loops over contiguous numbers, compiled for the vector instructions of the machine that runs them.

use pulp::Arch;
pub use pulp::NullaryFnOnce as Loops;

/// Runs `loops` with the widest vectors of this machine: what is inlined into them (by `#[inline(always)]`, else it may
/// not be) is compiled once for each kind. No sum is taken in another order for it, so the numbers are the same with all.
#[inline]
pub fn vectorized<L: Loops>(loops: L) -> L::Output {
    Arch::new().dispatch(loops)
}
