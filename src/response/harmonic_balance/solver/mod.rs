//! The equation solved at one frequency: damped Newton, Anderson's acceleration, kept Jacobians, and what finer numbers would change.

mod anderson;
mod contact_motions;
mod convergence;
mod enlarged;
mod kept_jacobian;
mod newton;
mod newton_iteration;
mod newton_workspace;
mod serves;

pub use convergence::NewtonBounds;
pub use enlarged::{Effects, Enlarged, EnlargedSet, enlarge};
pub use newton::solve;
pub(super) use newton_iteration::{Equation, NewtonBuffers, iterate, norm_of};
pub use newton_iteration::{NewtonOutcome, Settled, Steps};
pub use newton_workspace::NewtonWorkspace;
