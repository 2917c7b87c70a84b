//! Linear limits, sweep, peak search, and the errors of a peak.

mod a_posteriori;
mod attempts_on_basis;
mod branch;
mod climb;
mod corrected_peak;
mod dense_sweep;
mod error_settings;
mod excited;
mod folded_peak;
mod homotopy;
mod initial_guess;
mod linear_peaks;
mod observed_amplitude;
mod options;
mod peak;
mod point;
mod point_settings;
mod point_solver;
mod point_source;
mod receptance_errors;
mod receptance_peak;
mod receptance_points;
mod row_equation;
mod search;
mod softer_contact;
mod top_beside;
mod tops;

pub use a_posteriori::{ErrorEstimate, Screening, estimate_errors, screen};
pub use branch::{BranchPlace, BranchPoint, ResponseTrace};
pub use dense_sweep::{DensePeak, dense_peak};
pub use error_settings::ErrorSettings;
pub use excited::{Excited, LimitsWanted, LinearStructure, Wheel, wheel_force};
pub use observed_amplitude::{ObservedAmplitude, ObservedBlock};
pub use options::{
    AmplitudeMeasure, ContactCondition, FEWER_HARMONICS, FrequencyBand, Harmonics,
    RowsBeyondTolerance, SearchHarmonics, SolverOptions, samples_per_period,
};
pub use peak::{
    Peak, SearchPlan, Window, mistuned_window, peak, search_plan, tuned_span, tuned_span_of,
};
pub use point::{Point, Work};
pub use point_settings::PointSettings;
pub use point_solver::PointSolver;
pub use receptance_errors::receptance_errors;
pub use receptance_peak::{ReceptancePeak, receptance_peak};
pub use receptance_points::{
    ContactMotion, EngineRow, receptance_contact_motion, receptance_curve, receptance_plan,
    receptance_state,
};
pub use search::{Envelope, SearchEnd, SearchResult, SearchSettings, find_peak};
pub use top_beside::{TopBeside, receptance_top_beside, receptance_top_m};
