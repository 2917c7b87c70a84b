//! The full-contact model of a wheel: every contact dof kept, condensed on the contact rows, slow and
//! independent of the fast path.
//!
//! With `Y_k = (Z(k omega) + C^H k_c C)^-1` of the Craig-Bampton model of the whole wheel, the relative
//! displacement `d_k` at the contact rows is the only unknown of harmonic balance,
//!
//! ```text
//! d_k = C Y_k f_k - C Y_k C^H g_k(d),      g = F(d) - k_c d
//! ```
//!
//! Shared with the fast path are the contact law of a pair and the search for the highest peak; the
//! coordinates (complex travelling waves), the linear algebra, the unknowns and Newton's method are not.

mod contact;
mod newton;
mod options;
mod peak;
mod receptance;
mod solver;
mod structure;

pub use options::ReferenceSettings;
pub use peak::{ReferencePeak, reference_peak};
pub use solver::{ReferencePoint, ReferenceSolver, ReferenceWork};
pub use structure::FullStructure;
