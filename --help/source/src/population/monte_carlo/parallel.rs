//! Solves blocks of patterns on all threads and hands finished blocks to a sink.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use rayon::prelude::*;

use super::{PatternBlock, ResponseRow, RowSink};

/// Solved patterns that may wait for the sink before the solution of others does.
const WAITING: usize = 1024;
/// Time between looks at whether to stop.
const LOOK: Duration = Duration::from_millis(50);
/// Time that patterns in work have to finish once the solution is to stop.
const GRACE: Duration = Duration::from_secs(3);

/// Says when the solution is to stop, and hears when it is safe to end the process.
pub trait Interruption: Sync {
    /// Whether no further pattern is to be begun.
    fn requested(&self) -> bool;
    /// Patterns in work are not finished in time: all others are stored, and the process may end.
    fn saved(&self);
}

/// Solves every pattern of `blocks` with `solve` on the threads of `pool`, and stores the rows of
/// each block in `sink`, which is called by this thread alone. Gives the number of rows stored, less
/// than all if `interruption` came before.
///
/// Rows depend on their pattern alone, so neither the number of threads nor the order in which
/// patterns finish can change one. Memory is bounded by the blocks in work, about one per thread.
///
/// # Errors
/// The first error of the sink; patterns in work are finished, no further ones begun.
pub fn solve_blocks<S: RowSink>(
    pool: &ThreadPool,
    blocks: &[PatternBlock],
    solve: impl Fn(&PatternBlock, u32) -> Vec<ResponseRow> + Sync,
    sink: &mut S,
    interruption: &dyn Interruption,
) -> Result<u64, S::Error> {
    let patterns: Vec<(usize, u32)> = blocks
        .iter()
        .enumerate()
        .flat_map(|(index, block)| block.patterns.iter().map(move |&pattern| (index, pattern)))
        .collect();
    let refused = AtomicBool::new(false);
    let stops = || refused.load(Ordering::Relaxed) || interruption.requested();
    let (sender, receiver) = sync_channel(WAITING);
    std::thread::scope(|scope| {
        let solve_all = || {
            pool.install(|| {
                patterns.par_iter().with_max_len(1).for_each_with(
                    sender,
                    |sender, &(index, pattern)| {
                        if !stops() {
                            // Without a receiver the sink has failed, and its error is on its way.
                            let _ = sender.send((index, solve(&blocks[index], pattern)));
                        }
                    },
                );
            });
        };
        scope.spawn(solve_all);
        let mut desk = Desk {
            blocks,
            open: BTreeMap::new(),
            stored: 0,
            sink,
        };
        let mut deadline: Option<Instant> = None;
        loop {
            let filed = match receiver.recv_timeout(LOOK) {
                Ok((index, rows)) => desk.file(index, rows),
                Err(RecvTimeoutError::Timeout) => Ok(()),
                Err(RecvTimeoutError::Disconnected) => break,
            };
            let overdue = match deadline {
                None => {
                    deadline = interruption.requested().then(|| Instant::now() + GRACE);
                    false
                }
                Some(deadline) => Instant::now() > deadline,
            };
            let ended = filed.and_then(|()| if overdue { desk.clear() } else { Ok(()) });
            if let Err(error) = ended {
                refused.store(true, Ordering::Relaxed);
                drop(receiver);
                return Err(error);
            }
            if overdue {
                interruption.saved();
            }
        }
        desk.clear()?;
        Ok(desk.stored)
    })
}

/// Gathers solved patterns until their block is complete.
struct Desk<'a, S> {
    blocks: &'a [PatternBlock],
    open: BTreeMap<usize, Vec<Vec<ResponseRow>>>,
    /// Rows stored.
    stored: u64,
    sink: &'a mut S,
}

impl<S: RowSink> Desk<'_, S> {
    /// Takes the rows of one pattern of a block.
    fn file(&mut self, index: usize, rows: Vec<ResponseRow>) -> Result<(), S::Error> {
        let block = self.open.entry(index).or_default();
        block.push(rows);
        if block.len() == self.blocks[index].patterns.len() {
            let whole = std::mem::take(block);
            self.open.remove(&index);
            self.store(index, whole)?;
        }
        Ok(())
    }

    /// Stores what is there of incomplete blocks.
    fn clear(&mut self) -> Result<(), S::Error> {
        for (index, patterns) in std::mem::take(&mut self.open) {
            self.store(index, patterns)?;
        }
        Ok(())
    }

    fn store(&mut self, index: usize, patterns: Vec<Vec<ResponseRow>>) -> Result<(), S::Error> {
        let mut rows: Vec<ResponseRow> = patterns.into_iter().flatten().collect();
        self.stored += rows.len() as u64;
        rows.sort_by_key(|row| (row.pattern, row.scenario));
        self.sink.rows(&self.blocks[index], rows)
    }
}
