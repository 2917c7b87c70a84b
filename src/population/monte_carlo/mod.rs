//! One (scenario, pattern) -> one row, and the parallel driver over all of them.

mod row;
mod scenario;

pub use row::{ResponseRow, TunedReference};
pub use scenario::Scenario;
