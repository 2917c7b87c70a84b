//! `patterns.parquet`: the deviation of every blade of every pattern.

use std::collections::BTreeMap;
use std::path::Path;

use super::column::{ColumnKind, ColumnSpec, Values, key};
use super::parquet::{TableReader, TableWriter};
use super::{TableError, TableHeader};
use crate::response::mistuning::PatternSource;

use ColumnKind::{Float64, Int32};

/// Columns of `patterns.parquet`.
pub const PATTERN_COLUMNS: &[ColumnSpec] = &[
    ColumnSpec::new(
        "standard_deviation",
        Float64,
        "1",
        "Standard deviation of the law, after truncation; null for patterns from a file",
    ),
    key::PATTERN,
    ColumnSpec::new("blade", Int32, "", "Blade, from 0"),
    ColumnSpec::new(
        "mode",
        Int32,
        "",
        "Blade-alone mode, from 0; null = all modes",
    ),
    ColumnSpec::new(
        "deviation",
        Float64,
        "1",
        "Relative deviation of the blade stiffness; per mode, of the eigenvalue",
    ),
];

/// Standard deviation, pattern, blade, mode, deviation.
type Row = (Option<f64>, u32, u32, Option<u32>, f64);

/// Rows that are gathered before a row group is written.
const ROW_GROUP: usize = 65_536;

/// Writes the patterns `ids` of `source` once for each standard deviation (none: as they stand).
///
/// # Errors
/// The file cannot be written.
pub fn write_patterns(
    path: &Path,
    (source, ids): (&PatternSource, &[u32]),
    standard_deviations: &[Option<f64>],
    header: &TableHeader,
) -> Result<(), TableError> {
    let mut writer = TableWriter::create(path, PATTERN_COLUMNS, header)?;
    let mut rows: Vec<Row> = Vec::new();
    for &standard_deviation in standard_deviations {
        for &id in ids {
            let Some(pattern) = source.pattern(id, standard_deviation) else {
                continue;
            };
            rows.extend(
                pattern
                    .entries()
                    .into_iter()
                    .map(|(blade, mode, deviation)| {
                        (standard_deviation, id, blade, mode, deviation)
                    }),
            );
            while rows.len() >= ROW_GROUP {
                let rest = rows.split_off(ROW_GROUP);
                writer.write(columns_of(&rows))?;
                rows = rest;
            }
        }
    }
    if !rows.is_empty() {
        writer.write(columns_of(&rows))?;
    }
    writer.finish()
}

/// Patterns as `patterns.parquet` holds them: `(blade, mode, bits of the deviation)` of every entry, by
/// the bits of the standard deviation and the id.
pub type StoredPatterns = BTreeMap<(Option<u64>, u32), Vec<(u32, Option<u32>, u64)>>;

/// Reads `patterns.parquet`.
///
/// # Errors
/// The file cannot be read or is damaged.
pub fn read_patterns(path: &Path) -> Result<StoredPatterns, TableError> {
    let reader = TableReader::open(path, PATTERN_COLUMNS)?;
    let mut patterns = StoredPatterns::new();
    let mut first = 0;
    while first < reader.rows() {
        let slice = reader.read(first, ROW_GROUP.min(reader.rows() - first))?;
        let standard_deviations = slice.float64("standard_deviation")?;
        let ids = slice.int32("pattern")?;
        let blades = slice.int32("blade")?;
        let modes = slice.int32("mode")?;
        let deviations = slice.float64("deviation")?;
        first += ids.len();
        for (place, id) in ids.into_iter().enumerate() {
            let (Some(id), Some(blade), Some(deviation)) = (id, blades[place], deviations[place])
            else {
                return Err(TableError::damaged(path, "an entry is null"));
            };
            let key = (standard_deviations[place].map(f64::to_bits), id as u32);
            let mode = modes[place].map(|mode| mode as u32);
            let entry = (blade as u32, mode, deviation.to_bits());
            patterns.entry(key).or_default().push(entry);
        }
    }
    Ok(patterns)
}

fn columns_of(rows: &[Row]) -> Vec<Values> {
    vec![
        Values::Float64(rows.iter().map(|row| row.0).collect()),
        Values::Int32(rows.iter().map(|row| Some(row.1 as i32)).collect()),
        Values::Int32(rows.iter().map(|row| Some(row.2 as i32)).collect()),
        Values::Int32(
            rows.iter()
                .map(|row| row.3.map(|mode| mode as i32))
                .collect(),
        ),
        Values::Float64(rows.iter().map(|row| Some(row.4)).collect()),
    ]
}
