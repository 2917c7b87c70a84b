//! Matrices in Nastran's OUTPUT4 format, ASCII: dense columns, or strings of nonzero values (sparse
//! and `BIGMAT` form). Fields are 8 wide, or 16 where the header ends with `|I16`.

use std::path::Path;

use super::calculix::require_diagonal;
use super::harwell_boeing::Fields;
use super::symmetric::from_full;
use super::{Rows, Triplets};
use crate::linalg::SymmetricSparse;
use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::{Problem, Source, real};
use crate::model::sector::line_problem::LineProblem;

/// One matrix of the file as it goes by.
struct Header {
    name: String,
    columns: usize,
    rows: usize,
    kind: usize,
    big: bool,
    /// Width of the whole numbers.
    width: usize,
    numbers: Fields,
}

struct Reader<'a> {
    source: &'a Source,
    lines: Vec<&'a str>,
    at: usize,
}

/// The matrix `name` (the only one if none is named) whose rows are `rows`.
pub(super) fn matrix(
    path: &Path,
    name: Option<&str>,
    rows: &Rows,
) -> Result<SymmetricSparse, ModelError> {
    let source = Source::read(path)?;
    source.require_last_line_end()?;
    let mut reader = Reader {
        source: &source,
        lines: source.text.lines().collect(),
        at: 0,
    };
    let mut found: Vec<(String, Triplets)> = Vec::new();
    while let Some(header) = reader.header()? {
        let wanted = name.is_none_or(|name| name.eq_ignore_ascii_case(&header.name));
        let start = reader.at;
        let entries = reader.columns(&header)?;
        if wanted {
            if header.kind > 2 {
                let problem = ImportProblem::MatrixKind {
                    what: "the type of the matrix",
                    found: format!("{} (complex)", header.kind),
                    accepted: "1 or 2 (real)",
                };
                return Err(source.refuse(start, problem));
            }
            for count in [header.rows, header.columns] {
                if count != rows.len() {
                    let (found, rows) = (count, rows.len());
                    return Err(source.refuse(start, ImportProblem::RowOutside { found, rows }));
                }
            }
            found.push((header.name, entries));
        } else {
            found.push((header.name, Vec::new()));
        }
    }
    let names = || {
        let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
        names.join(", ")
    };
    let chosen: Vec<&(String, Triplets)> = found
        .iter()
        .filter(|(matrix_name, _)| name.is_none_or(|name| name.eq_ignore_ascii_case(matrix_name)))
        .collect();
    let [(_, entries)] = chosen.as_slice() else {
        let problem = ImportProblem::MatrixUnknown {
            name: name.unwrap_or("(no name given)").to_owned(),
            accepted: names(),
        };
        return Err(source.refuse_whole(problem));
    };
    require_diagonal(entries, rows)
        .and_then(|()| from_full(rows.len(), entries))
        .map_err(|problem| source.refuse_whole(problem))
}

impl<'a> Reader<'a> {
    fn next(&mut self) -> Result<&'a str, ModelError> {
        let line = self.lines.get(self.at).copied();
        self.at += 1;
        line.ok_or_else(|| {
            let what = "a matrix has no end".to_owned();
            self.source.refuse_whole(ImportProblem::CutOff { what })
        })
    }

    fn refuse(&self, problem: impl Into<Problem>) -> ModelError {
        self.source.refuse(self.at, problem)
    }

    /// A whole number of a line, by its place among fields of `width`.
    fn integer(&self, line: &str, index: usize, width: usize) -> Result<i64, ModelError> {
        let fields = Fields { per_line: 5, width };
        let word = fields.field(line, index);
        word.parse().map_err(|_| {
            self.refuse(LineProblem::NotAnInteger {
                field: "a count of the OUTPUT4 record",
                found: word.to_owned(),
            })
        })
    }

    fn count(&self, line: &str, index: usize, width: usize) -> Result<usize, ModelError> {
        let value = self.integer(line, index, width)?;
        usize::try_from(value).map_err(|_| {
            self.refuse(LineProblem::NotAnInteger {
                field: "a count of the OUTPUT4 record",
                found: value.to_string(),
            })
        })
    }

    fn header(&mut self) -> Result<Option<Header>, ModelError> {
        while self
            .lines
            .get(self.at)
            .is_some_and(|line| line.trim().is_empty())
        {
            self.at += 1;
        }
        if self.at >= self.lines.len() {
            return Ok(None);
        }
        let whole = self.next()?.trim_end();
        let (line, width) = match whole.strip_suffix("|I16") {
            Some(line) => (line, 16),
            None => (whole, 8),
        };
        let rows = self.integer(line, 1, width)?;
        let tail = line.get(2 * width..).unwrap_or("");
        let numbers = match tail.get(24..).map(str::trim) {
            None | Some("") => Some(Fields {
                per_line: 5,
                width: 16,
            }),
            Some(format) => Fields::of_format(format),
        };
        let Some(numbers) = numbers else {
            return Err(self.refuse(ImportProblem::MatrixKind {
                what: "the format of the numbers",
                found: tail.get(24..).unwrap_or("").to_owned(),
                accepted: "one like 1P,5E16.9",
            }));
        };
        Ok(Some(Header {
            name: tail.get(16..24).unwrap_or("").trim().to_owned(),
            columns: self.count(line, 0, width)?,
            rows: rows.unsigned_abs() as usize,
            kind: self.count(tail, 1, 8)?,
            big: rows < 0,
            width,
            numbers,
        }))
    }

    /// All columns of a matrix, and the record after the last one.
    fn columns(&mut self, header: &Header) -> Result<Triplets, ModelError> {
        let mut entries = Vec::new();
        let words_of_value = if header.kind % 2 == 1 { 1 } else { 2 };
        let width = header.width;
        loop {
            let line = self.next()?;
            let column = self.count(line, 0, width)?;
            let row = self.count(line, 1, width)?;
            let words = self.count(line, 2, width)?;
            if column > header.columns {
                // The column after the last one: one value that means nothing.
                self.next()?;
                return Ok(entries);
            }
            if row > 0 {
                self.string(header, row, column, words, &mut entries)?;
                continue;
            }
            let mut left = words;
            while left > 0 {
                let line = self.next()?;
                let (length, row) = if header.big {
                    (self.count(line, 0, width)?, self.count(line, 1, width)?)
                } else {
                    let packed = self.count(line, 0, line.len().max(1))?;
                    (packed >> 16, packed & 0xFFFF)
                };
                let taken = length + usize::from(header.big);
                if length == 0 || taken > left {
                    let found = line.trim().to_owned();
                    return Err(self.refuse(ImportProblem::Line {
                        what: "head of a string",
                        found,
                        accepted: "a length that fits into the words of the column",
                    }));
                }
                left -= taken;
                let values = (length - 1) / words_of_value;
                self.string(header, row, column, values, &mut entries)?;
            }
        }
    }

    /// `count` values down a column from `row`.
    fn string(
        &mut self,
        header: &Header,
        row: usize,
        column: usize,
        count: usize,
        entries: &mut Triplets,
    ) -> Result<(), ModelError> {
        let end = row
            .checked_add(count)
            .filter(|&end| row > 0 && end <= header.rows + 1);
        if column == 0 || row == 0 || end.is_none() && header.kind <= 2 {
            return Err(self.refuse(LineProblem::EntryOutside {
                row,
                column,
                dimension: header.rows,
            }));
        }
        let mut read = 0;
        while read < count {
            let line = self.next()?;
            for index in 0..header.numbers.per_line.min(count - read) {
                let value = real("a value", header.numbers.field(line, index))
                    .map_err(|problem| self.refuse(problem))?;
                if value != 0.0 {
                    entries.push((row + read - 1, column - 1, value));
                }
                read += 1;
            }
        }
        Ok(())
    }
}
