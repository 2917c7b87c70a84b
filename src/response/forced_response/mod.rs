//! Linear limits, sweep, peak search, and the one definition of the amplification factor.

mod branch;
mod excited;
mod homotopy;
mod linear_peaks;
mod options;
mod peak;
mod peak_search;
mod point_settings;
mod point_solver;

pub use branch::{BranchPlace, BranchPoint, ResponseTrace};
pub use excited::{Excited, LimitsWanted, LinearStructure, Wheel, wheel_force};
pub use linear_peaks::LinearPeak;
pub use options::{AmplitudeMeasure, ContactCondition, FrequencyBand, Harmonics, SolverOptions};
pub use peak::{Peak, Window, mistuned_window, peak, tuned_span};
pub use point_settings::PointSettings;
pub use point_solver::{Point, PointSolver, Work};
