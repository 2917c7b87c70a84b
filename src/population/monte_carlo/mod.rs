//! One (scenario, pattern) -> one row, and the parallel driver over all of them.

mod blocks;
mod parallel;
mod row;
mod scenario;
mod sink;

pub use blocks::{PatternBlock, block_size, plan_blocks};
pub use parallel::solve_blocks;
pub use row::{ResponseRow, TunedReference};
pub use scenario::Scenario;
pub use sink::{MemorySink, RowSink};
