//! Solves blocks of patterns on all threads and hands each finished block to a sink.

use std::sync::Mutex;

use rayon::prelude::*;

use super::{PatternBlock, ResponseRow, RowSink};

/// Solves every pattern of `blocks` with `solve` and stores the rows of each block in `sink`.
///
/// Rows depend on their pattern alone, so neither the number of threads nor the order in which
/// blocks finish can change one. Memory is bounded by the blocks in work, about one per thread.
///
/// # Errors
/// The first error of the sink; blocks in work are finished, no further ones begun.
pub fn solve_blocks<S>(
    blocks: &[PatternBlock],
    solve: impl Fn(u32) -> Vec<ResponseRow> + Sync,
    sink: S,
) -> Result<(), S::Error>
where
    S: RowSink + Send,
    S::Error: Send,
{
    let sink = Mutex::new(sink);
    (0..blocks.len())
        .into_par_iter()
        .with_max_len(1)
        .try_for_each(|index| {
            let rows: Vec<ResponseRow> = blocks[index]
                .patterns
                .par_iter()
                .with_max_len(1)
                .map(|&pattern| solve(pattern))
                .collect::<Vec<_>>()
                .into_iter()
                .flatten()
                .collect();
            // A sink that panicked in another thread has lost its rows; ours go on to the same end.
            sink.lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner)
                .block(index, rows)
        })
}
