//! What a run tells whoever watches it, and is told by it.

use std::sync::atomic::{AtomicUsize, Ordering};

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
    /// What the stage is at, with its place among what it goes through: `tuned wheel: load 2 of 5 (10 N)`. Called from several threads.
    fn step(&self, _words: &str) {}
    /// So many rows are solved at the same time: those of a pattern, on every thread. Said before [`Self::begin_rows`].
    fn rows_at_a_time(&self, _rows: u64) {}
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

/// Counts what is done of some things at the same time, and says so after each.
pub(crate) struct Steps<'a> {
    progress: &'a dyn Progress,
    what: &'static str,
    things: &'static str,
    count: usize,
    done: AtomicUsize,
}

impl<'a> Steps<'a> {
    /// Says that none of the `count` things of `what` is done.
    pub(crate) fn new(
        progress: &'a dyn Progress,
        what: &'static str,
        things: &'static str,
        count: usize,
    ) -> Self {
        let steps = Self {
            progress,
            what,
            things,
            count,
            done: AtomicUsize::new(0),
        };
        steps.say(0);
        steps
    }

    /// One more is done.
    pub(crate) fn done(&self) {
        self.say(self.done.fetch_add(1, Ordering::Relaxed) + 1);
    }

    fn say(&self, done: usize) {
        if self.count > 0 {
            let Self {
                what,
                things,
                count,
                ..
            } = self;
            self.progress
                .step(&format!("{what}: {done} of {count} {things} done"));
        }
    }
}
