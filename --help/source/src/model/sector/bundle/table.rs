//! The CSV tables of a bundle: a header line, commas, no quoting.

use std::fs;
use std::path::{Path, PathBuf};

use strsim::damerau_levenshtein;

use crate::model::sector::error::ModelError;
use crate::model::sector::line_problem::{LinePart, LineProblem};

/// A table in memory with the place it came from.
pub(super) struct Table {
    path: PathBuf,
    text: String,
    columns: &'static str,
}

impl Table {
    /// Reads a table whose header line must be `columns`.
    pub(super) fn read(path: PathBuf, columns: &'static str) -> Result<Self, ModelError> {
        Self::read_either(path, [columns, columns])
    }

    /// Reads a table whose header line must be one of two; a refusal names the one that is nearer to what stands there.
    pub(super) fn read_either(
        path: PathBuf,
        columns: [&'static str; 2],
    ) -> Result<Self, ModelError> {
        let text = read_text(&path)?;
        let header = text
            .lines()
            .next()
            .unwrap_or_default()
            .trim_end()
            .to_owned();
        let [one, other] = columns.map(|columns| damerau_levenshtein(columns, &header));
        let columns = columns[usize::from(other < one)];
        let table = Self {
            path,
            text,
            columns,
        };
        if columns != header {
            let problem = if header.is_empty() {
                LineProblem::Missing(LinePart::Columns(columns))
            } else {
                LineProblem::NotAWord {
                    field: "the header line",
                    found: header,
                    accepted: columns,
                }
            };
            return Err(table.refuse(1, problem));
        }
        Ok(table)
    }

    /// Its header line.
    pub(super) fn columns(&self) -> &'static str {
        self.columns
    }

    /// Applies `parse` to the fields of each row (its index first); refusals carry file and line.
    ///
    /// Blank lines are skipped.
    pub(super) fn rows<const FIELDS: usize, Row>(
        &self,
        mut parse: impl FnMut(usize, [&str; FIELDS]) -> Result<Row, LineProblem>,
    ) -> Result<Vec<Row>, ModelError> {
        let mut rows = Vec::new();
        for (index, line) in self.text.lines().enumerate().skip(1) {
            if line.trim().is_empty() {
                continue;
            }
            let fields: Vec<&str> = line.split(',').map(str::trim).collect();
            let found = fields.len();
            let row = <[&str; FIELDS]>::try_from(fields)
                .map_err(|_| LineProblem::FieldCount {
                    found,
                    expected: FIELDS,
                    what: LinePart::Columns(self.columns),
                })
                .and_then(|fields| parse(rows.len(), fields))
                .map_err(|problem| self.refuse(index + 1, problem))?;
            rows.push(row);
        }
        Ok(rows)
    }

    fn refuse(&self, line: usize, problem: LineProblem) -> ModelError {
        ModelError::Line {
            path: self.path.clone(),
            line,
            problem,
        }
    }
}

/// Text of a file.
pub(super) fn read_text(path: &Path) -> Result<String, ModelError> {
    fs::read_to_string(path).map_err(|source| ModelError::File {
        path: path.to_owned(),
        source,
    })
}
