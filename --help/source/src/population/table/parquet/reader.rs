//! Reader of one Parquet file: schema check, metadata, and columns of a slice of rows.

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use polars::prelude::{
    DataFrame, DataType, ParallelStrategy, ParquetReader, PolarsError, SerReader,
};

use super::columns::polars_type;
use crate::population::table::column::{Cells, Column};
use crate::population::table::header::{ROW_DIGESTS_KEY, STUDY_DIGEST_KEY};
use crate::population::table::{ColumnSpec, TableError};

/// An open Parquet file whose columns have been checked.
#[derive(Debug)]
pub(in crate::population::table) struct TableReader {
    path: PathBuf,
    columns: &'static [ColumnSpec],
    rows: usize,
    study_digest: Option<String>,
    row_digests: Vec<String>,
}

impl TableReader {
    /// Opens `path` and checks that it has `columns` with their types (others may follow).
    pub(in crate::population::table) fn open(
        path: &Path,
        columns: &'static [ColumnSpec],
    ) -> Result<Self, TableError> {
        guarded(path, || Self::open_unguarded(path, columns))
    }

    fn open_unguarded(path: &Path, columns: &'static [ColumnSpec]) -> Result<Self, TableError> {
        let mut reader = parquet(path)?;
        let damaged = |error: PolarsError| TableError::damaged(path, error.to_string());
        let metadata = reader.get_metadata().map_err(damaged)?.clone();
        let schema = reader.schema().map_err(damaged)?;
        for column in columns {
            let expected = polars_type(column.kind);
            let found = schema.get(column.name).map(DataType::from_arrow_field);
            if found.as_ref() != Some(&expected) {
                let found = found.map_or("missing".to_owned(), |kind| kind.to_string());
                return Err(TableError::damaged(
                    path,
                    format!(
                        "column {} should be {expected}, and is {found}",
                        column.name
                    ),
                ));
            }
        }
        let value_of = |key: &str| {
            metadata
                .key_value_metadata()
                .iter()
                .flatten()
                .find(|pair| pair.key == key)
                .and_then(|pair| pair.value.clone())
        };
        let row_digests = value_of(ROW_DIGESTS_KEY).unwrap_or_default();
        Ok(Self {
            path: path.to_owned(),
            columns,
            rows: metadata.num_rows,
            study_digest: value_of(STUDY_DIGEST_KEY),
            row_digests: row_digests.split(',').map(str::to_owned).collect(),
        })
    }

    pub(in crate::population::table) fn rows(&self) -> usize {
        self.rows
    }

    pub(in crate::population::table) fn study_digest(&self) -> Option<&str> {
        self.study_digest.as_deref()
    }

    /// Digests of what the rows of each scenario are made from; one empty text where there are none.
    pub(in crate::population::table) fn row_digests(&self) -> &[String] {
        &self.row_digests
    }

    /// `count` rows from row `first` on.
    pub(in crate::population::table) fn read(
        &self,
        first: usize,
        count: usize,
    ) -> Result<Slice<'_>, TableError> {
        let frame = guarded(&self.path, || self.read_unguarded(first, count))?;
        let whole = frame.columns().iter().all(|column| column.len() == count);
        if !whole || frame.width() != self.columns.len() {
            let reason = format!("fewer than {count} rows from row {first} on");
            return Err(TableError::damaged(&self.path, reason));
        }
        Ok(Slice {
            path: &self.path,
            first,
            frame,
        })
    }

    fn read_unguarded(&self, first: usize, count: usize) -> Result<DataFrame, TableError> {
        let names = self
            .columns
            .iter()
            .map(|column| column.name.to_owned())
            .collect();
        parquet(&self.path)?
            .with_columns(Some(names))
            .with_slice(Some((first, count)))
            .read_parallel(ParallelStrategy::None)
            .set_rechunk(true)
            .finish()
            .map_err(|error| TableError::damaged(&self.path, error.to_string()))
    }
}

/// The Parquet decoder panics on some damaged files; that is the file's fault and said so.
fn guarded<T>(path: &Path, read: impl FnOnce() -> Result<T, TableError>) -> Result<T, TableError> {
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(TableError::damaged(path, "the decoder gave up")))
}

fn parquet(path: &Path) -> Result<ParquetReader<File>, TableError> {
    let file = File::open(path).map_err(TableError::io("read", path))?;
    Ok(ParquetReader::new(file))
}

/// Rows in memory, column by column.
pub(in crate::population::table) struct Slice<'a> {
    path: &'a Path,
    /// Place of its first row in the file.
    first: usize,
    frame: DataFrame,
}

impl Slice<'_> {
    /// Sets `column` in the rows that are read back, one for each of these.
    pub(in crate::population::table) fn read_back<Row, Back>(
        &self,
        column: &Column<Row, Back>,
        rows: &mut [Back],
    ) -> Result<(), TableError> {
        let name = column.spec.name;
        let refused = match &column.cells {
            Cells::Int32(access) => {
                let whole = |value: i32| u32::try_from(value).ok();
                let cells = self.int32(name)?.into_iter();
                access.set(cells.map(|cell| cell.and_then(whole)), rows)
            }
            Cells::Int64(access) => {
                let whole = |value: i64| u64::try_from(value).ok();
                let cells = self.int64(name)?.into_iter();
                access.set(cells.map(|cell| cell.and_then(whole)), rows)
            }
            Cells::Float64(access) => access.set(self.float64(name)?, rows),
            Cells::Boolean(access) => access.set(self.boolean(name)?, rows),
            Cells::String(access) => access.set(self.string(name)?, rows),
        };
        refused.map_or(Ok(()), |row| Err(self.no_valid_value(row, name)))
    }

    /// Row `row` of these has no value in `column` that it may have.
    fn no_valid_value(&self, row: usize, column: &str) -> TableError {
        let place = self.first + row;
        TableError::damaged(
            self.path,
            format!("row {place}: no valid value in column {column}"),
        )
    }

    fn column(&self, name: &str) -> Result<&polars::prelude::Column, TableError> {
        self.frame
            .column(name)
            .map_err(|error| TableError::damaged(self.path, error.to_string()))
    }

    pub(in crate::population::table) fn int32(
        &self,
        name: &str,
    ) -> Result<Vec<Option<i32>>, TableError> {
        let column = self.column(name)?;
        let values = column
            .i32()
            .map_err(|error| TableError::damaged(self.path, error.to_string()))?;
        Ok(values.iter().collect())
    }

    pub(in crate::population::table) fn int64(
        &self,
        name: &str,
    ) -> Result<Vec<Option<i64>>, TableError> {
        let column = self.column(name)?;
        let values = column
            .i64()
            .map_err(|error| TableError::damaged(self.path, error.to_string()))?;
        Ok(values.iter().collect())
    }

    pub(in crate::population::table) fn float64(
        &self,
        name: &str,
    ) -> Result<Vec<Option<f64>>, TableError> {
        let column = self.column(name)?;
        let values = column
            .f64()
            .map_err(|error| TableError::damaged(self.path, error.to_string()))?;
        Ok(values.iter().collect())
    }

    pub(in crate::population::table) fn boolean(
        &self,
        name: &str,
    ) -> Result<Vec<Option<bool>>, TableError> {
        let column = self.column(name)?;
        let values = column
            .bool()
            .map_err(|error| TableError::damaged(self.path, error.to_string()))?;
        Ok(values.iter().collect())
    }

    pub(in crate::population::table) fn string(
        &self,
        name: &str,
    ) -> Result<Vec<Option<String>>, TableError> {
        let column = self.column(name)?;
        let values = column
            .str()
            .map_err(|error| TableError::damaged(self.path, error.to_string()))?;
        Ok(values
            .iter()
            .map(|value| value.map(str::to_owned))
            .collect())
    }
}
