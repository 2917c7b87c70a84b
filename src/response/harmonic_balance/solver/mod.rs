//! The equation solved at one frequency by damped Newton, and what finer numbers would change.

mod anderson;
mod enlarged;
mod newton;
mod newton_iteration;
mod newton_verdict;
mod newton_workspace;

pub use enlarged::{Effects, Enlarged, EnlargedSet, enlarge};
pub use newton::solve;
pub(super) use newton_iteration::{Equation, NewtonBuffers, iterate, norm_of};
pub use newton_iteration::{NewtonOutcome, Settled};
pub use newton_verdict::NewtonBounds;
pub use newton_workspace::NewtonWorkspace;
