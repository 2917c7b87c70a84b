//! Linear limits, sweep, peak search, and the one definition of the amplification factor.

mod options;

pub use options::{AmplitudeMeasure, ContactCondition, FrequencyBand, Harmonics, SolverOptions};
