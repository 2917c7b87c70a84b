//! What a run tells whoever watches it, and is told by it.

use crate::report::ExpectedCost;
use crate::response::harmonic_balance::Status;

/// A stage of a run, for progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Loading and validating the model.
    LoadModel,
    /// Reducing it, or reading the reduced model from the cache.
    Reduce,
    /// Solving the tuned wheel of every scenario.
    Tuned,
    /// Finding the surrogate of every pattern.
    Surrogates,
    /// Solving the patterns.
    Rows,
    /// Joining parts and writing tables.
    Tables,
}

/// Listener to a run, which also says when it is to stop; called from several threads.
pub trait Progress: Sync {
    /// A stage begins.
    fn stage(&self, _stage: Stage) {}
    /// Rows are about to be solved: `planned` in all, of which `done` are stored already.
    fn begin_rows(&self, _planned: u64, _done: u64) {}
    /// Of the rows that are about to be solved, `rows` are stored, but for other settings than the study now has: `why`.
    fn solves_anew(&self, _rows: u64, _why: &str) {}
    /// A row has been solved.
    fn row(&self, _status: Status) {}
    /// Mean processor time of a surrogate and of a row of an estimate, as measured so far, s.
    fn surrogate_times(&self, _surrogate_s: f64, _row_s: f64) {}
    /// What the command is about to solve, and how long that takes; said before the long part.
    fn cost(&self, _cost: &ExpectedCost) {}
    /// The folder is taken over from a process that ended without letting go of it.
    fn taken_over(&self, _holder: &str) {}
    /// Whether the run is to store what it has and stop.
    fn stop_requested(&self) -> bool {
        false
    }
    /// After a stop was requested, rows in work take long: all others are stored, and the process may
    /// end. The run waits for them otherwise.
    fn saved(&self) {}
}

/// For work that nobody watches, like a choice of settings that is a part of the reduction.
impl Progress for () {}
