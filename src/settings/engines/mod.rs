//! What solves the rows of a study: the seam that a campaign sees, and the engines behind it.

mod accurate_engine;
mod engine;
mod reduced_engine;

pub use engine::{Engine, EngineSource, SurrogateOf};
pub use reduced_engine::ReducedEngineSource;
