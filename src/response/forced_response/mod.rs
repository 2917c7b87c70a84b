//! Linear limits, sweep, peak search, and the one definition of the amplification factor.

mod a_posteriori;
mod excited;
mod linear_peaks;
mod observed_amplitude;
mod options;
mod peak;
mod peak_search;
mod point_solver;

pub use a_posteriori::{ErrorEstimate, ErrorSettings, Screening, estimate_errors, screen};
pub use excited::{Excited, LimitsWanted, LinearStructure, Wheel, wheel_force};
pub use linear_peaks::LinearPeak;
pub use observed_amplitude::ObservedAmplitude;
pub use options::{
    AmplitudeMeasure, ContactCondition, FrequencyBand, Harmonics, RowsBeyondTolerance,
    SolverOptions,
};
pub use peak::{Peak, Window, mistuned_window, peak, tuned_span};
pub use point_solver::{Point, PointSettings, PointSolver, Work};
