//! Matrices in the Harwell-Boeing exchange format (Duff, Grimes and Lewis 1989), as Ansys' `HBMAT`
//! writes them: compressed columns in fixed fields whose Fortran formats stand in the header.

use std::path::Path;

use super::Rows;
use super::calculix::require_diagonal;
use super::symmetric::{from_full, from_triangle};
use crate::linalg::SymmetricSparse;
use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::{Problem, Source, real};
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::matrix_market::integer;

/// Largest width and repetition in a Fortran format: no line is longer than their product.
const MOST_IN_FORMAT: usize = 1000;

/// Fields a line holds and their width, as a Fortran format says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fields {
    pub per_line: usize,
    pub width: usize,
}

impl Fields {
    /// `(8I10)`, `(1P,3E26.18)`, `(4D20.12)`: repetition and width of the one descriptor.
    pub fn of_format(format: &str) -> Option<Self> {
        let upper = format.to_ascii_uppercase();
        let inner = upper.trim().trim_start_matches('(');
        let end = inner.find(')').unwrap_or(inner.len());
        let mut inner = inner[..end].trim();
        if let Some(at) = inner.find('P') {
            // The scale factor changes what is printed, not what it means when it is read with an
            // exponent, as all of these are.
            inner = inner[at + 1..].trim_start_matches(',').trim();
        }
        let letter = inner.find(|c: char| "IEDFG".contains(c))?;
        let repeat = inner[..letter].trim();
        let width: String = inner[letter + 1..]
            .chars()
            .take_while(char::is_ascii_digit)
            .collect();
        let fields = Self {
            per_line: if repeat.is_empty() {
                1
            } else {
                repeat.parse().ok()?
            },
            width: width.parse().ok()?,
        };
        let possible = 1..=MOST_IN_FORMAT;
        (possible.contains(&fields.per_line) && possible.contains(&fields.width)).then_some(fields)
    }

    /// The field `index` of a line, without blanks; empty where the line is shorter.
    pub fn field(self, line: &str, index: usize) -> &str {
        line.get(index * self.width..)
            .map_or("", |rest| rest.get(..self.width).unwrap_or(rest))
            .trim()
    }
}

/// The lines of a file as they are read.
struct Lines<'a> {
    source: &'a Source,
    all: Vec<&'a str>,
    at: usize,
}

/// What the header says of the matrix.
struct Header {
    /// Both triangles are given.
    full: bool,
    dimension: usize,
    stored: usize,
    pointers: Fields,
    indices: Fields,
    values: Fields,
}

impl<'a> Lines<'a> {
    fn next(&mut self, what: &str) -> Result<&'a str, ModelError> {
        let line = self.all.get(self.at).copied();
        self.at += 1;
        line.ok_or_else(|| {
            let what = what.to_owned();
            self.source.refuse_whole(ImportProblem::CutOff { what })
        })
    }

    /// Refuses the line read last.
    fn refuse(&self, problem: impl Into<Problem>) -> ModelError {
        self.source.refuse(self.at, problem)
    }

    /// `count` values in `fields`.
    fn values<T>(
        &mut self,
        what: &'static str,
        fields: Fields,
        count: usize,
        parse: impl Fn(&str) -> Result<T, LineProblem>,
    ) -> Result<Vec<T>, ModelError> {
        let mut values = Vec::new();
        while values.len() < count {
            let line = self.next(&format!("{} of {count} {what}", values.len()))?;
            let expected = fields.per_line.min(count - values.len());
            // Some writers (SciPy) keep to the number of fields but not to their width; where blanks
            // separate as many words as there are fields, the two ways of reading are one.
            let words: Vec<&str> = line.split_whitespace().collect();
            for index in 0..expected {
                let word = if words.len() == expected {
                    words[index]
                } else {
                    fields.field(line, index)
                };
                values.push(parse(word).map_err(|problem| self.refuse(problem))?);
            }
        }
        Ok(values)
    }

    /// Title, counts of lines, type and size, formats, and a line on the right-hand side if there is one.
    fn header(&mut self) -> Result<Header, ModelError> {
        const COUNTS: Fields = Fields {
            per_line: 5,
            width: 14,
        };
        self.next("there is no title")?;
        let right_hand_side = COUNTS.field(self.next("there are no counts of lines")?, 4);
        let has_right_hand_side = !right_hand_side.is_empty()
            && integer(
                "the number of lines of the right-hand side",
                right_hand_side,
            )
            .map_err(|problem| self.refuse(problem))?
                > 0;
        let kind = self.next("there is no type of the matrix")?;
        let name = kind.get(..3).unwrap_or("").to_ascii_uppercase();
        let full = match name.as_str() {
            "RSA" => false,
            "RUA" => true,
            _ => {
                return Err(self.refuse(ImportProblem::MatrixKind {
                    what: "the type of the matrix",
                    found: name,
                    accepted: "RSA (real, symmetric, assembled) or RUA, in ASCII form",
                }));
            }
        };
        let size = |index: usize, field: &'static str| {
            integer(field, COUNTS.field(kind, index)).map_err(|problem| self.refuse(problem))
        };
        let dimension = size(1, "the number of rows")?;
        let columns = size(2, "the number of columns")?;
        let stored = size(3, "the number of entries")?;
        if dimension != columns {
            let rows = dimension;
            return Err(self.refuse(LineProblem::NotSquare { rows, columns }));
        }
        let formats = self.next("there are no formats")?;
        let format = |start: usize, width: usize| {
            let rest = formats.get(start..).unwrap_or("");
            let text = rest.get(..width).unwrap_or(rest);
            Fields::of_format(text).ok_or_else(|| {
                self.refuse(ImportProblem::MatrixKind {
                    what: "a Fortran format",
                    found: text.trim().to_owned(),
                    accepted: "one like (8I10) or (4E20.12)",
                })
            })
        };
        let header = Header {
            full,
            dimension,
            stored,
            pointers: format(0, 16)?,
            indices: format(16, 16)?,
            values: format(32, 20)?,
        };
        if has_right_hand_side {
            self.next("there is no description of the right-hand side")?;
        }
        Ok(header)
    }
}

/// The matrix whose rows are `rows`.
pub(super) fn matrix(path: &Path, rows: &Rows) -> Result<SymmetricSparse, ModelError> {
    let source = Source::read(path)?;
    source.require_last_line_end()?;
    let mut lines = Lines {
        source: &source,
        all: source.text.lines().collect(),
        at: 0,
    };
    let header = lines.header()?;
    let (n, stored) = (header.dimension, header.stored);
    if n != rows.len() {
        let (found, rows) = (n, rows.len());
        return Err(source.refuse(3, ImportProblem::RowOutside { found, rows }));
    }
    let pointers = lines.values("column pointers", header.pointers, n + 1, |word| {
        integer("a column pointer", word)
    })?;
    if pointers.first() != Some(&1)
        || pointers.last() != Some(&(stored + 1))
        || pointers.windows(2).any(|pair| pair[0] > pair[1])
    {
        return Err(lines.refuse(ImportProblem::MatrixKind {
            what: "the list of column pointers",
            found: format!(
                "from {} to {}",
                pointers.first().unwrap_or(&0),
                pointers.last().unwrap_or(&0)
            ),
            accepted: "ascending from 1 to the number of entries plus 1",
        }));
    }
    let indices = lines.values("row indices", header.indices, stored, |word| {
        integer("a row index", word).and_then(|row| {
            if (1..=n).contains(&row) {
                Ok(row)
            } else {
                let (column, dimension) = (0, n);
                Err(LineProblem::EntryOutside {
                    row,
                    column,
                    dimension,
                })
            }
        })
    })?;
    let values = lines.values("values", header.values, stored, |word| {
        real("a value", word)
    })?;
    let mut entries = Vec::with_capacity(stored);
    for column in 0..n {
        for at in pointers[column] - 1..pointers[column + 1] - 1 {
            entries.push((indices[at] - 1, column, values[at]));
        }
    }
    let build = if header.full {
        from_full
    } else {
        from_triangle
    };
    require_diagonal(&entries, rows)
        .and_then(|()| build(n, &entries))
        .map_err(|problem| source.refuse_whole(problem))
}

#[cfg(test)]
mod tests {
    use super::Fields;

    #[test]
    fn fortran_formats_give_repetition_and_width() {
        for (format, per_line, width) in [
            ("(8I10)", 8, 10),
            ("(I14)", 1, 14),
            ("(1P,3E26.18)  ", 3, 26),
            ("(1P4D20.12)", 4, 20),
            (" ( 5e16.8 )", 5, 16),
        ] {
            assert_eq!(
                Fields::of_format(format),
                Some(Fields { per_line, width }),
                "{format}"
            );
        }
        for format in ["", "()", "(I)", "(0I5)", "(5X)", "(8A10)"] {
            assert_eq!(Fields::of_format(format), None, "{format}");
        }
    }
}
