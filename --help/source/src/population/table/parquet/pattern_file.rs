//! Reader of patterns given as a Parquet file `pattern, blade, deviation`, optionally with `mode`.

use std::fs::File;
use std::path::Path;

use polars::prelude::{DataFrame, DataType, ParallelStrategy, ParquetReader, SerReader};

use crate::population::table::{PatternParquetError, TableError};
use crate::response::mistuning::{PatternFileError, PatternRecord, PatternRecords};

const ACCEPTED: &str = "a Parquet file with the columns pattern, blade (whole numbers), deviation \
                        (a number) and optionally mode (a whole number or null)";

/// Reads the patterns of a Parquet file; "line" in errors is the row counted from 1.
///
/// # Errors
/// An unreadable file, a missing column, an entry that is not accepted.
pub fn read_pattern_parquet(path: &Path) -> Result<PatternRecords, PatternParquetError> {
    let file = File::open(path).map_err(TableError::io("read", path))?;
    let frame = ParquetReader::new(file)
        .read_parallel(ParallelStrategy::None)
        .finish()
        .map_err(|error| TableError::damaged(path, error.to_string()))?;
    let form = |found: String| PatternFileError::Form {
        path: path.to_owned(),
        found,
        accepted: ACCEPTED,
    };
    let numbers = |name: &str, kind: &DataType| column(&frame, name, kind).map_err(form);
    let patterns = whole(&numbers("pattern", &DataType::Int64)?);
    let blades = whole(&numbers("blade", &DataType::Int64)?);
    let modes = match frame.get_column_index("mode") {
        Some(_) => whole(&numbers("mode", &DataType::Int64)?),
        None => vec![None; frame.height()],
    };
    let deviations: Vec<Option<f64>> = numbers("deviation", &DataType::Float64)?
        .f64()
        .map(|values| values.iter().collect())
        .unwrap_or_default();
    let records = (0..frame.height())
        .map(|row| {
            let id = |column: &'static str, value: Option<i64>| {
                value
                    .filter(|&value| (0..=i64::from(i32::MAX)).contains(&value))
                    .map(|value| value as u32)
                    .ok_or_else(|| PatternFileError::Entry {
                        path: path.to_owned(),
                        line: row + 1,
                        column,
                        value: value.map_or("null".to_owned(), |value| value.to_string()),
                        accepted: "a whole number from 0 to 2147483647".to_owned(),
                    })
            };
            Ok(PatternRecord {
                line: row + 1,
                pattern: id("pattern", patterns[row])?,
                blade: id("blade", blades[row])?,
                mode: modes[row].map(|mode| id("mode", Some(mode))).transpose()?,
                deviation: deviations[row].unwrap_or(f64::NAN),
            })
        })
        .collect::<Result<_, PatternFileError>>()?;
    Ok(PatternRecords::new(path, records)?)
}

fn column(
    frame: &DataFrame,
    name: &str,
    kind: &DataType,
) -> Result<polars::prelude::Column, String> {
    let found = frame
        .column(name)
        .map_err(|_| format!("no column {name}"))?;
    if !found.dtype().is_primitive_numeric() || (!kind.is_float() && found.dtype().is_float()) {
        return Err(format!("column {name} has the type {}", found.dtype()));
    }
    found.cast(kind).map_err(|error| error.to_string())
}

fn whole(column: &polars::prelude::Column) -> Vec<Option<i64>> {
    column
        .i64()
        .map(|values| values.iter().collect())
        .unwrap_or_default()
}
