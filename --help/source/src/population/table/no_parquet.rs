//! In the place of Parquet files where the feature `parquet` is off: none can be opened, so that nothing behind an open one is reached.

use std::convert::Infallible;
use std::path::Path;

use super::column::{Column, Values};
use super::{ColumnSpec, PatternParquetError, TableError, TableHeader};
use crate::response::mistuning::PatternRecords;

/// Refuses the Parquet file.
///
/// # Errors
/// Always.
pub fn read_pattern_parquet(path: &Path) -> Result<PatternRecords, PatternParquetError> {
    Err(refused(path).into())
}

fn refused(path: &Path) -> TableError {
    TableError::NoParquet {
        path: path.to_owned(),
    }
}

/// A file that cannot be made.
pub(super) struct TableWriter(Infallible);

impl TableWriter {
    pub(super) fn create(
        path: &Path,
        columns: &'static [ColumnSpec],
        header: &TableHeader,
    ) -> Result<Self, TableError> {
        Self::create_with(path, columns, header, &[])
    }

    pub(super) fn create_with(
        path: &Path,
        _columns: &'static [ColumnSpec],
        _header: &TableHeader,
        _more: &[(&str, String)],
    ) -> Result<Self, TableError> {
        Err(refused(path))
    }

    pub(super) fn write(&mut self, _values: Vec<Values>) -> Result<(), TableError> {
        match self.0 {}
    }

    pub(super) fn finish(self) -> Result<(), TableError> {
        match self.0 {}
    }

    pub(super) fn finish_as(
        self,
        _name: impl FnOnce(&str) -> Result<String, TableError>,
    ) -> Result<(), TableError> {
        match self.0 {}
    }
}

/// A file that cannot be opened.
#[derive(Debug)]
pub(super) struct TableReader(Infallible);

impl TableReader {
    pub(super) fn open(path: &Path, _columns: &'static [ColumnSpec]) -> Result<Self, TableError> {
        Err(refused(path))
    }

    pub(super) fn rows(&self) -> usize {
        match self.0 {}
    }

    pub(super) fn study_digest(&self) -> Option<&str> {
        match self.0 {}
    }

    pub(super) fn row_digests(&self) -> &[String] {
        match self.0 {}
    }

    pub(super) fn read(&self, _first: usize, _count: usize) -> Result<Slice, TableError> {
        match self.0 {}
    }
}

/// Rows of no file.
pub(super) struct Slice(Infallible);

impl Slice {
    pub(super) fn read_back<Row, Back>(
        &self,
        _column: &Column<Row, Back>,
        _rows: &mut [Back],
    ) -> Result<(), TableError> {
        match self.0 {}
    }

    pub(super) fn int32(&self, _name: &str) -> Result<Vec<Option<i32>>, TableError> {
        match self.0 {}
    }

    pub(super) fn float64(&self, _name: &str) -> Result<Vec<Option<f64>>, TableError> {
        match self.0 {}
    }

    pub(super) fn boolean(&self, _name: &str) -> Result<Vec<Option<bool>>, TableError> {
        match self.0 {}
    }

    pub(super) fn string(&self, _name: &str) -> Result<Vec<Option<String>>, TableError> {
        match self.0 {}
    }
}
