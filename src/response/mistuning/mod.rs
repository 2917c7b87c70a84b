//! Patterns of blade deviations: distributions, random streams, tables, and their application.

mod modes;
mod options;
mod wheel_basis;

pub use modes::{ModalRows, StructuralModes};
pub use options::{Distribution, Projection};
pub use wheel_basis::WheelBasis;
