//! One (scenario, pattern) -> one row, and the parallel driver over all of them.

mod basis_rows;
mod blocks;
mod harmonic_choice;
mod load_case_solvers;
mod operations;
mod parallel;
mod receptance_rows;
mod row;
mod row_points;
mod row_solver;
mod scenario;
mod sink;
mod stability;
mod stated_error;
mod surrogate;
mod time_domain;
mod wheel_state;

pub use blocks::{PatternBlock, StoredRows, block_size, plan_blocks};
pub use harmonic_choice::HarmonicChoice;
pub use load_case_solvers::{LoadCaseSolver, LoadCaseSolvers};
pub use operations::{RowWork, SystemSize, counted_time};
pub use parallel::{Interruption, solve_blocks};
pub use row::{ResponseRow, TunedReference, amplification_factor, harmonics_name};
pub use row_points::RowSettings;
pub use row_solver::{RowSolver, TUNED_RECEPTANCES};
pub use scenario::{LoadCaseName, Scenario};
pub use sink::{MemorySink, RowSink};
pub use stability::{is_row_stable, is_tuned_stable};
pub use stated_error::{
    ErrorTolerance, HARMONIC_SAFETY, HARMONIC_SAFETY_ON_RECEPTANCES, ScenarioError,
    sampling_tolerance, stated_error,
};
pub use surrogate::{Surrogate, SurrogatePeak};
pub use time_domain::compare_in_time;
pub use wheel_state::{CurveResult, CurveSettings, WheelState};
