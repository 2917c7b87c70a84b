//! What solves the rows of a study: the seam that a campaign sees, and the engines behind it.

mod accurate_engine;
mod engine;
mod reduced_engine;
mod row_work;

pub use engine::{Engine, EngineSource, SurrogateOf};
pub use reduced_engine::ReducedEngineSource;
pub(crate) use row_work::{RowWork, rows_of, tuned_references};
