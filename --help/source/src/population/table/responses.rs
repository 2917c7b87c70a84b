//! `responses.parquet`: one row per (scenario, pattern), ordered by pattern, then scenario.

use std::path::Path;

use super::column::{Column, values_of};
use super::header::ROW_DIGESTS_KEY;
use super::parquet::TableReader;
use super::parquet::TableWriter;
use super::response_columns::{COLUMNS, RESPONSE_COLUMNS, WrittenRow};
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{ResponseRow, Scenario};
use crate::response::harmonic_balance::Status;
use crate::response::mistuning::PairFactors;

/// Rows per row group and per batch in memory.
const ROW_GROUP: usize = 65_536;

/// The columns that a row is read back from: all but `stable`.
const READ_BACK: &[Column<WrittenRow, ResponseRow>] = COLUMNS.split_at(COLUMNS.len() - 1).0;

/// Writer of `responses.parquet` and of its parts; holds one row group in memory.
///
/// Row groups have a fixed number of rows, so the file does not show how the rows arrived.
pub struct ResponseWriter {
    scenarios: Vec<Scenario>,
    writer: TableWriter,
    waiting: Vec<WrittenRow>,
}

impl ResponseWriter {
    /// Begins the file `path`; `scenarios` are those of the study, in order. `row_digests` says what
    /// the rows are made from, a digest for each scenario that has rows in the file.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(
        path: &Path,
        scenarios: &[Scenario],
        header: &TableHeader,
        row_digests: &[String],
    ) -> Result<Self, TableError> {
        let digests = [(ROW_DIGESTS_KEY, row_digests.join(","))];
        Ok(Self {
            scenarios: scenarios.to_vec(),
            writer: TableWriter::create_with(path, RESPONSE_COLUMNS, header, &digests)?,
            waiting: Vec::new(),
        })
    }

    /// Appends rows in their order.
    ///
    /// # Errors
    /// The file cannot be written, or a row belongs to no scenario.
    pub fn write(&mut self, rows: impl IntoIterator<Item = ResponseRow>) -> Result<(), TableError> {
        for row in rows {
            self.write_judged(row, None)?;
        }
        Ok(())
    }

    /// Appends a row with what is known of the stability of its motion.
    ///
    /// # Errors
    /// The file cannot be written, or the row belongs to no scenario.
    pub fn write_judged(
        &mut self,
        row: ResponseRow,
        stable: Option<bool>,
    ) -> Result<(), TableError> {
        let scenario = *self.scenarios.get(row.scenario).ok_or_else(|| {
            let reason = format!(
                "a row names scenario {}, which does not exist",
                row.scenario
            );
            TableError::encoding(Path::new("responses.parquet"), reason)
        })?;
        self.waiting.push(WrittenRow {
            row,
            scenario,
            stable,
        });
        if self.waiting.len() == ROW_GROUP {
            self.flush()?;
        }
        Ok(())
    }

    /// Completes the file and puts it in its place.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), TableError> {
        self.flush()?;
        self.writer.finish()
    }

    /// Completes the file and puts it in its folder under a name made from its digest.
    pub(super) fn finish_as(
        mut self,
        name: impl FnOnce(&str) -> Result<String, TableError>,
    ) -> Result<(), TableError> {
        self.flush()?;
        self.writer.finish_as(name)
    }

    fn flush(&mut self) -> Result<(), TableError> {
        let rows = std::mem::take(&mut self.waiting);
        if rows.is_empty() {
            return Ok(());
        }
        self.writer.write(values_of(COLUMNS, &rows))
    }
}

/// Reader of `responses.parquet` and of its parts, batch by batch.
#[derive(Debug)]
pub struct ResponseReader {
    table: TableReader,
    next: usize,
}

impl ResponseReader {
    /// Opens the file `path` and checks its columns.
    ///
    /// # Errors
    /// The file cannot be read or is no such table.
    pub fn open(path: &Path) -> Result<Self, TableError> {
        Ok(Self {
            // Stability is no part of a row, and tables of before have none.
            table: TableReader::open(path, &RESPONSE_COLUMNS[..READ_BACK.len()])?,
            next: 0,
        })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.table.rows()
    }

    /// Digest of the study that the file belongs to.
    #[must_use]
    pub fn study_digest(&self) -> Option<&str> {
        self.table.study_digest()
    }

    /// Digests of what the rows of each scenario of the file are made from.
    #[must_use]
    pub fn row_digests(&self) -> &[String] {
        self.table.row_digests()
    }

    /// The next rows, at most one row group; empty at the end.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn next_batch(&mut self) -> Result<Vec<ResponseRow>, TableError> {
        let count = ROW_GROUP.min(self.rows() - self.next);
        if count == 0 {
            return Ok(Vec::new());
        }
        let rows = self.read(self.next, count)?;
        self.next += count;
        Ok(rows)
    }

    /// The row group of row `place`: where it begins, and its rows; without rows beyond the end.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn group_of(&self, place: usize) -> Result<(usize, Vec<ResponseRow>), TableError> {
        let first = place - place % ROW_GROUP;
        let count = ROW_GROUP.min(self.rows().saturating_sub(first));
        Ok((first, self.read(first, count)?))
    }

    fn read(&self, first: usize, count: usize) -> Result<Vec<ResponseRow>, TableError> {
        let slice = self.table.read(first, count)?;
        let blank = ResponseRow {
            // What the columns of the factors set, unless one of them is null.
            contact_factors: Some(PairFactors::default()),
            ..ResponseRow::without_result(0, 0, Status::Ok)
        };
        let mut rows = vec![blank; count];
        for column in READ_BACK {
            slice.read_back(column, &mut rows)?;
        }
        Ok(rows)
    }
}
