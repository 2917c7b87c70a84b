//! Patterns of blade deviations: distributions, random streams, tables, and their application.

mod options;

pub use options::{Distribution, Projection};
