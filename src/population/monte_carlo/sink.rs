//! Where rows go: the driver hands over blocks of finished rows and knows no file format.

use std::collections::BTreeMap;
use std::convert::Infallible;

use super::ResponseRow;

/// Receiver of finished rows.
pub trait RowSink {
    /// What can go wrong while rows are received.
    type Error;

    /// Receives every row of a block of patterns, ordered by pattern, then scenario.
    ///
    /// Each block arrives once; blocks may arrive in any order.
    ///
    /// # Errors
    /// The rows could not be kept.
    fn block(&mut self, block: usize, rows: Vec<ResponseRow>) -> Result<(), Self::Error>;
}

/// Keeps all rows in memory.
#[derive(Debug, Default)]
pub struct MemorySink {
    blocks: BTreeMap<usize, Vec<ResponseRow>>,
}

impl MemorySink {
    /// All rows in the order of the blocks.
    #[must_use]
    pub fn into_rows(self) -> Vec<ResponseRow> {
        self.blocks.into_values().flatten().collect()
    }
}

impl RowSink for MemorySink {
    type Error = Infallible;

    fn block(&mut self, block: usize, rows: Vec<ResponseRow>) -> Result<(), Infallible> {
        self.blocks.insert(block, rows);
        Ok(())
    }
}
