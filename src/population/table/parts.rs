//! The rows that are already solved and stored, from which an interrupted run continues.
//!
//! They stand in parts, one finished file per block of patterns, and in finished tables of rows.
//!
//! A part is named `part-<first pattern>-<digest>.parquet`: its name is its checksum, and no part is
//! ever written over. Their header lists them. Every file of rows says in its metadata what the rows of each of its scenarios
//! are made from; a study takes the rows that are made from the same as its own, whatever else it
//! has besides.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::part_header::{PartHeader, part_files};
use super::places::PARTS;
use super::responses::ResponseWriter;
use super::row_file::{RowCursor, RowFile};
use super::{TableError, TableHeader};
use crate::identity::bytes_of;
use crate::population::monte_carlo::{PatternBlock, ResponseRow, RowSink, Scenario, StoredRows};

/// What the rows of a study are, for its files.
#[derive(Debug, Clone)]
pub struct RowSchema {
    /// The scenarios.
    pub scenarios: Vec<Scenario>,
    /// What the rows of each are made from.
    pub row_digests: Vec<String>,
    /// What each file says about the study.
    pub header: TableHeader,
}

/// The stored rows of a study.
#[derive(Debug)]
pub struct RowStore {
    schema: RowSchema,
    files: Vec<RowFile>,
}

impl RowStore {
    /// The rows in the parts of the results folder `results` and in the finished tables `tables`.
    ///
    /// # Errors
    /// The folder of the parts cannot be read.
    pub fn open(
        results: &Path,
        schema: RowSchema,
        tables: Vec<RowFile>,
    ) -> Result<Self, TableError> {
        let mut files = tables;
        files.extend(part_files(results)?);
        Ok(Self::of_files(schema, files))
    }

    /// The rows in the finished tables `files`.
    #[must_use]
    pub fn of_files(schema: RowSchema, mut files: Vec<RowFile>) -> Self {
        files.sort_by(|a, b| (a.from, &a.path).cmp(&(b.from, &b.path)));
        Self { schema, files }
    }

    /// Which rows are stored: a run solves the others.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn stored(&self) -> Result<StoredRows, TableError> {
        let mut stored = StoredRows::default();
        for file in &self.files {
            let Some(mut cursor) = self.cursor(file)? else {
                continue;
            };
            let mut patterns = Vec::new();
            while let Some(pattern) = cursor.pattern()? {
                cursor.take()?;
                patterns.push(pattern);
            }
            stored.add(patterns, &cursor.scenarios());
        }
        Ok(stored)
    }

    /// Hands every stored row to `visit`, ordered by pattern, then scenario, each once.
    ///
    /// # Errors
    /// A file cannot be read or is damaged, two files hold different values of a row, or `visit` fails.
    pub fn visit(
        &self,
        mut visit: impl FnMut(ResponseRow) -> Result<(), TableError>,
    ) -> Result<(), TableError> {
        let mut unopened = self.files.iter().peekable();
        let mut open: Vec<OpenFile> = Vec::new();
        let earliest = |open: &[OpenFile]| open.iter().map(|file| file.pattern).min();
        loop {
            // Files are opened when the patterns come to them, so that few are in memory.
            while let Some(file) = unopened
                .next_if(|file| earliest(&open).is_none_or(|earliest| file.from <= earliest))
            {
                if let Some(mut cursor) = self.cursor(file)?
                    && let Some(pattern) = cursor.pattern()?
                {
                    let path = &file.path;
                    open.push(OpenFile {
                        path,
                        cursor,
                        pattern,
                    });
                }
            }
            let Some(pattern) = earliest(&open) else {
                return Ok(());
            };
            let mut rows: BTreeMap<usize, ResponseRow> = BTreeMap::new();
            for mut file in std::mem::take(&mut open) {
                if file.pattern == pattern {
                    for row in file.cursor.take()? {
                        agrees(rows.get(&row.scenario), &row, file.path)?;
                        rows.insert(row.scenario, row);
                    }
                    let Some(next) = file.cursor.pattern()? else {
                        continue;
                    };
                    file.pattern = next;
                }
                open.push(file);
            }
            for row in rows.into_values() {
                visit(row)?;
            }
        }
    }

    /// Joins all rows to a `responses.parquet` at `path` that holds those of the patterns `ids`
    /// (ascending) in order, and asks `visit`, which gets every row on the way, whether its motion is stable.
    ///
    /// # Errors
    /// A file cannot be read or written, or a row is missing.
    pub fn assemble(
        &self,
        path: &Path,
        ids: &[u32],
        mut visit: impl FnMut(&ResponseRow) -> Option<bool>,
    ) -> Result<(), TableError> {
        let RowSchema {
            scenarios,
            row_digests,
            header,
        } = &self.schema;
        let mut writer = ResponseWriter::create(path, scenarios, header, row_digests)?;
        let mut expected = ids
            .iter()
            .flat_map(|&id| (0..scenarios.len()).map(move |scenario| (id, scenario)))
            .peekable();
        self.visit(|row| {
            // A longer study that was broken off may have left rows of more patterns.
            if ids.binary_search(&row.pattern).is_err() {
                return Ok(());
            }
            if expected.next_if_eq(&(row.pattern, row.scenario)).is_none() {
                let missing = expected.peek().map_or(row.pattern, |(pattern, _)| *pattern);
                let reason = format!("no file holds all rows of pattern {missing}");
                return Err(TableError::damaged(path, reason));
            }
            let stable = visit(&row);
            writer.write_judged(row, stable)
        })?;
        if let Some((pattern, _)) = expected.next() {
            let reason = format!("no file holds all rows of pattern {pattern}");
            return Err(TableError::damaged(path, reason));
        }
        writer.finish()
    }

    fn cursor(&self, file: &RowFile) -> Result<Option<RowCursor>, TableError> {
        RowCursor::open(file, &self.schema.row_digests)
    }
}

/// A file whose next rows are those of `pattern`.
struct OpenFile<'a> {
    path: &'a Path,
    cursor: RowCursor,
    pattern: u32,
}

/// A row that two files hold has to be the same in both.
fn agrees(known: Option<&ResponseRow>, row: &ResponseRow, path: &Path) -> Result<(), TableError> {
    match known {
        Some(known) if bytes_of(known) != bytes_of(row) => {
            let pattern = row.pattern;
            let reason = format!("another file has other values of pattern {pattern}");
            Err(TableError::damaged(path, reason))
        }
        _ => Ok(()),
    }
}

/// Removes the parts of the results folder `results`.
///
/// # Errors
/// The folder cannot be removed.
pub fn remove_parts(results: &Path) -> Result<(), TableError> {
    let folder = results.join(PARTS);
    match std::fs::remove_dir_all(&folder) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(TableError::io("remove", &folder)(error)),
    }
}

/// Stores the rows of each block as a part.
#[derive(Debug)]
pub struct PartSink<'a> {
    schema: &'a RowSchema,
    results: PathBuf,
    header: PartHeader,
}

impl<'a> PartSink<'a> {
    /// Stores into the results folder `results`, beside the parts that are there.
    ///
    /// # Errors
    /// The header of the parts that are there cannot be read or is damaged.
    pub fn new(results: &Path, schema: &'a RowSchema) -> Result<Self, TableError> {
        Ok(Self {
            schema,
            results: results.to_owned(),
            header: PartHeader::read(results)?.unwrap_or_default(),
        })
    }

    /// Lists the last part.
    ///
    /// # Errors
    /// The header cannot be written.
    pub fn close(mut self) -> Result<(), TableError> {
        self.header.close(&self.results)
    }
}

impl RowSink for PartSink<'_> {
    type Error = TableError;

    fn rows(&mut self, block: &PatternBlock, rows: Vec<ResponseRow>) -> Result<(), TableError> {
        let Some(first) = rows.first().map(|row| row.pattern) else {
            return Ok(());
        };
        let RowSchema {
            scenarios,
            row_digests,
            header,
        } = self.schema;
        let digests: Vec<String> = block
            .scenarios
            .iter()
            .map(|&scenario| row_digests[scenario].clone())
            .collect();
        let results = &self.results;
        let path = results
            .join(PARTS)
            .join(format!("part-{first:010}.parquet"));
        let mut writer = ResponseWriter::create(&path, scenarios, header, &digests)?;
        writer.write(rows)?;
        let header = &mut self.header;
        writer.finish_as(|digest| {
            let name = format!("part-{first:010}-{digest}.parquet");
            header.announce(results, &name)?;
            Ok(name)
        })
    }
}
