//! The equation solved at one frequency: damped Newton, Anderson's acceleration, kept Jacobians, and what finer numbers would change.

mod anderson;
mod contact_motions;
mod enlarged;
mod kept_jacobian;
mod newton;
mod newton_iteration;
mod newton_verdict;
mod newton_workspace;
mod serves;

pub use enlarged::{Effects, Enlarged, EnlargedSet, enlarge};
pub use newton::solve;
pub(super) use newton_iteration::{Equation, NewtonBuffers, iterate, norm_of};
pub use newton_iteration::{NewtonOutcome, Settled, Steps};
pub use newton_verdict::NewtonBounds;
pub use newton_workspace::NewtonWorkspace;
