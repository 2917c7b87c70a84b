//! Where rows go: the driver hands over finished rows and knows no file format.

use std::convert::Infallible;

use super::{PatternBlock, ResponseRow};

/// Receiver of finished rows.
pub trait RowSink {
    /// What can go wrong while rows are received.
    type Error;

    /// Receives rows of `block`, ordered by pattern, then scenario: those of all its patterns, or of
    /// some where the solution was interrupted.
    ///
    /// Blocks may arrive in any order.
    ///
    /// # Errors
    /// The rows could not be kept.
    fn rows(&mut self, block: &PatternBlock, rows: Vec<ResponseRow>) -> Result<(), Self::Error>;
}

/// Keeps all rows in memory.
#[derive(Debug, Default)]
pub struct MemorySink {
    rows: Vec<ResponseRow>,
}

impl MemorySink {
    /// All rows, ordered by pattern, then scenario.
    #[must_use]
    pub fn into_rows(mut self) -> Vec<ResponseRow> {
        self.rows.sort_by_key(|row| (row.pattern, row.scenario));
        self.rows
    }
}

impl RowSink for MemorySink {
    type Error = Infallible;

    fn rows(&mut self, _block: &PatternBlock, rows: Vec<ResponseRow>) -> Result<(), Infallible> {
        self.rows.extend(rows);
        Ok(())
    }
}
