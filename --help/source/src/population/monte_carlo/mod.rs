//! One (scenario, pattern) -> one row, and the parallel driver over all of them.

mod blocks;
mod curves;
mod engine_rows;
mod harmonic_choice;
mod load_cases;
mod mistuned_peak;
mod operations;
mod parallel;
mod row;
mod row_engine;
mod row_solver;
mod scenario;
mod sink;
mod solved_again;
mod stability;
mod stated_error;
mod surrogate;
mod time_domain;
mod wheel_state;

pub use blocks::{PatternBlock, StoredRows, block_size, plan_blocks};
pub use curves::CurveResult;
pub use engine_rows::TUNED_RECEPTANCES;
pub use harmonic_choice::HarmonicChoice;
pub use operations::{RowWork, SystemSize};
pub use parallel::{Interruption, solve_blocks};
pub use row::{ResponseRow, TunedReference, amplification_factor, harmonics_name};
pub use row_solver::{RowSettings, RowSolver};
pub use scenario::{LoadCaseName, Scenario};
pub use sink::{MemorySink, RowSink};
pub use stated_error::{
    ErrorTolerance, HARMONIC_SAFETY, HARMONIC_SAFETY_ON_RECEPTANCES, ScenarioError, stated_error,
};
pub use surrogate::{Surrogate, SurrogatePeak};
pub use wheel_state::WheelState;
