//! One run: how many patterns, their rows, and the tables made of them.

mod goal;
mod run;
mod stability;
mod tables;

pub use goal::{can_be_cut, is_shard_of};
pub(super) use run::{Clock, RowCounts, RunScope, Stop, pool_of, run_in};
pub use run::{RunOutcome, RunRequest, run, run_shard};
pub(super) use tables::{Facts, TableWork};
