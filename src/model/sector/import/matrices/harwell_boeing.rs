//! Matrices in the Harwell-Boeing exchange format (Duff, Grimes and Lewis 1989), as Ansys' `HBMAT`
//! writes them: compressed columns in fixed fields whose Fortran formats stand in the header.

use std::path::Path;

use super::Rows;
use super::calculix::require_diagonal;
use super::symmetric::{from_full, from_triangle};
use crate::linalg::SymmetricSparse;
use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::{Source, real};
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::matrix_market::integer;

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
        (fields.per_line > 0 && fields.width > 0).then_some(fields)
    }

    /// The field `index` of a line, without blanks; empty where the line is shorter.
    pub fn field(self, line: &str, index: usize) -> &str {
        line.get(index * self.width..)
            .map_or("", |rest| rest.get(..self.width).unwrap_or(rest))
            .trim()
    }
}

/// A position in the lines of a file.
struct Lines<'a> {
    source: &'a Source,
    lines: Vec<&'a str>,
    at: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self, what: &str) -> Result<(usize, &'a str), ModelError> {
        let line = self.lines.get(self.at).copied();
        self.at += 1;
        line.map(|line| (self.at, line)).ok_or_else(|| {
            let what = what.to_owned();
            self.source.refuse_whole(ImportProblem::CutOff { what })
        })
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
            let (number, line) = self.next(&format!("{} of {count} {what}", values.len()))?;
            for index in 0..fields.per_line.min(count - values.len()) {
                let value = parse(fields.field(line, index))
                    .map_err(|problem| self.source.refuse(number, problem))?;
                values.push(value);
            }
        }
        Ok(values)
    }
}

/// The matrix whose rows are `rows`.
pub(super) fn matrix(path: &Path, rows: &Rows) -> Result<SymmetricSparse, ModelError> {
    let source = Source::read(path)?;
    source.require_last_line_end()?;
    let mut lines = Lines {
        source: &source,
        lines: source.text.lines().collect(),
        at: 0,
    };
    lines.next("there is no title")?;
    let (number, counts) = lines.next("there are no counts of lines")?;
    let header = Fields {
        per_line: 5,
        width: 14,
    };
    let right_hand_side = header.field(counts, 4);
    let has_right_hand_side = !right_hand_side.is_empty()
        && integer(
            "the number of lines of the right-hand side",
            right_hand_side,
        )
        .map_err(|problem| source.refuse(number, problem))?
            > 0;
    let (number, kind) = lines.next("there is no type of the matrix")?;
    let refuse = |problem: LineProblem| source.refuse(number, problem);
    let name = kind.get(..3).unwrap_or("").to_ascii_uppercase();
    let full = match name.as_str() {
        "RSA" => false,
        "RUA" => true,
        _ => {
            let problem = ImportProblem::MatrixKind {
                what: "the type of the matrix",
                found: name,
                accepted: "RSA (real, symmetric, assembled) or RUA, in ASCII form",
            };
            return Err(source.refuse(number, problem));
        }
    };
    let size = |index: usize, field: &'static str| integer(field, header.field(kind, index));
    let n = size(1, "the number of rows").map_err(refuse)?;
    let columns = size(2, "the number of columns").map_err(refuse)?;
    let stored = size(3, "the number of entries").map_err(refuse)?;
    if n != columns {
        return Err(refuse(LineProblem::NotSquare { rows: n, columns }));
    }
    if n != rows.len() {
        let (found, rows) = (n, rows.len());
        return Err(source.refuse(number, ImportProblem::RowOutside { found, rows }));
    }
    let (number, formats) = lines.next("there are no formats")?;
    let format = |start: usize, end: usize| {
        let text = formats
            .get(start..)
            .map_or("", |rest| rest.get(..end - start).unwrap_or(rest));
        Fields::of_format(text).ok_or_else(|| {
            let problem = ImportProblem::MatrixKind {
                what: "a Fortran format",
                found: text.trim().to_owned(),
                accepted: "one like (8I10) or (4E20.12)",
            };
            source.refuse(number, problem)
        })
    };
    let (pointer_format, index_format, value_format) =
        (format(0, 16)?, format(16, 32)?, format(32, 52)?);
    if has_right_hand_side {
        lines.next("there is no description of the right-hand side")?;
    }
    let pointers = lines.values("column pointers", pointer_format, n + 1, |word| {
        integer("a column pointer", word)
    })?;
    let first_line = lines.at;
    if pointers.first() != Some(&1)
        || pointers.last() != Some(&(stored + 1))
        || pointers.windows(2).any(|pair| pair[0] > pair[1])
    {
        let problem = ImportProblem::MatrixKind {
            what: "the list of column pointers",
            found: format!(
                "from {} to {}",
                pointers.first().unwrap_or(&0),
                pointers.last().unwrap_or(&0)
            ),
            accepted: "ascending from 1 to the number of entries plus 1",
        };
        return Err(source.refuse(first_line, problem));
    }
    let indices = lines.values("row indices", index_format, stored, |word| {
        integer("a row index", word)
    })?;
    let last_index_line = lines.at;
    let values = lines.values("values", value_format, stored, |word| real("a value", word))?;
    let mut entries = Vec::with_capacity(stored);
    for column in 0..n {
        for at in pointers[column] - 1..pointers[column + 1] - 1 {
            let row = indices[at];
            if row == 0 || row > n {
                let problem = LineProblem::EntryOutside {
                    row,
                    column: column + 1,
                    dimension: n,
                };
                return Err(source.refuse(last_index_line, problem));
            }
            entries.push((row - 1, column, values[at]));
        }
    }
    let checked = require_diagonal(&entries, rows).and_then(|()| {
        if full {
            from_full(n, &entries)
        } else {
            from_triangle(n, &entries)
        }
    });
    checked.map_err(|problem| source.refuse_whole(problem))
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
