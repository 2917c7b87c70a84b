//! Reader and writer of symmetric sparse matrices in the Matrix Market coordinate format.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::error::ModelError;
use super::line_problem::{LinePart, LineProblem};
use crate::linalg::SymmetricSparse;

/// Reads a `coordinate real|integer symmetric|general` file.
///
/// A `symmetric` file holds the lower triangle; a `general` one must be symmetric to the last bit.
///
/// # Errors
/// [`ModelError::File`] if it cannot be read, [`ModelError::Line`] for the first line refused.
pub fn read(path: &Path) -> Result<SymmetricSparse, ModelError> {
    let text = fs::read_to_string(path).map_err(|source| ModelError::File {
        path: path.to_owned(),
        source,
    })?;
    parse(&text).map_err(|(line, problem)| ModelError::Line {
        path: path.to_owned(),
        line,
        problem,
    })
}

/// Writes the lower triangle as `coordinate real symmetric`; numbers survive reading bit for bit.
///
/// # Errors
/// [`ModelError::File`] if the file cannot be written.
pub fn write(matrix: &SymmetricSparse, comment: &str, path: &Path) -> Result<(), ModelError> {
    let n = matrix.dimension();
    let mut text = format!(
        "%%MatrixMarket matrix coordinate real symmetric\n% {comment}\n{n} {n} {}\n",
        matrix.stored_entries()
    );
    for (row, column, value) in matrix.lower_entries() {
        // Rust prints the shortest digits that read back as the same number. Writing to a string
        // cannot fail.
        let _ = writeln!(text, "{} {} {value:e}", row + 1, column + 1);
    }
    fs::write(path, text).map_err(|source| ModelError::File {
        path: path.to_owned(),
        source,
    })
}

/// Largest dimension accepted: memory is reserved for what a file says of itself.
const MAX_DIMENSION: usize = 10_000_000;

/// An entry: value and the line it stands on.
struct Entry {
    value: f64,
    line: usize,
}

/// Parses the text; an error carries its line.
#[expect(
    clippy::float_cmp,
    reason = "symmetry to the last bit is what the format asks for"
)]
fn parse(text: &str) -> Result<SymmetricSparse, (usize, LineProblem)> {
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(index, line)| (index + 1, line));
    let Some((line, banner)) = lines.next() else {
        return Err((1, LineProblem::Missing(LinePart::Banner)));
    };
    let general = is_general(banner).ok_or_else(|| {
        (
            line,
            LineProblem::Banner {
                found: banner.to_owned(),
            },
        )
    })?;
    let mut lines = lines
        .filter(|(_, line)| !line.starts_with('%') && !line.trim().is_empty())
        .peekable();
    let last_line = text.lines().count();
    let Some((line, size)) = lines.next() else {
        return Err((last_line, LineProblem::Missing(LinePart::Size)));
    };
    let (dimension, expected) = parse_size(size).map_err(|problem| (line, problem))?;
    let mut entries: HashMap<(usize, usize), Entry> = HashMap::new();
    let mut order = Vec::new();
    for (line, words) in lines {
        let at = |problem| (line, problem);
        if order.len() == expected {
            return Err(at(LineProblem::Surplus { expected }));
        }
        let (row, column, value) = parse_entry(words).map_err(at)?;
        if row == 0 || row > dimension || column == 0 || column > dimension {
            return Err(at(LineProblem::EntryOutside {
                row,
                column,
                dimension,
            }));
        }
        if !general && row < column {
            return Err(at(LineProblem::AboveDiagonal { row, column }));
        }
        if let Some(first) = entries.insert((row, column), Entry { value, line }) {
            return Err(at(LineProblem::Repeated {
                row,
                column,
                first: first.line,
            }));
        }
        order.push((row, column));
    }
    if order.len() < expected {
        return Err((
            last_line,
            LineProblem::Truncated {
                found: order.len(),
                expected,
            },
        ));
    }
    if general {
        one_triangle(&entries).map_err(|problem| (line, problem))?;
    }
    let mut triplets = Vec::with_capacity(order.len());
    for (row, column) in order {
        let Entry { value, line } = entries[&(row, column)];
        let mirror = entries.get(&(column, row)).map_or(0.0, |entry| entry.value);
        if general && value != mirror {
            return Err((
                line,
                LineProblem::NotSymmetric {
                    row,
                    column,
                    value,
                    mirror,
                },
            ));
        }
        if row >= column {
            triplets.push((row - 1, column - 1, value));
        } else if !entries.contains_key(&(column, row)) {
            // An explicit zero above the diagonal without its mirror image.
            triplets.push((column - 1, row - 1, value));
        }
    }
    Ok(SymmetricSparse::from_lower_triplets(dimension, &triplets))
}

/// Refuses a matrix whose entries off the diagonal stand on one side of it.
fn one_triangle(entries: &HashMap<(usize, usize), Entry>) -> Result<(), LineProblem> {
    let apart = || entries.iter().filter(|(_, entry)| entry.value != 0.0);
    let above = apart().filter(|((row, column), _)| row < column).count();
    let below = apart().filter(|((row, column), _)| row > column).count();
    if above.min(below) > 0 || above.max(below) < 2 {
        return Ok(());
    }
    let side = if above > 0 { "above" } else { "below" };
    let entries = above.max(below);
    Err(LineProblem::OneTriangle { entries, side })
}

/// `Some(true)` for a general, `Some(false)` for a symmetric file, `None` for any other banner.
fn is_general(banner: &str) -> Option<bool> {
    let words: Vec<String> = banner
        .split_whitespace()
        .map(str::to_ascii_lowercase)
        .collect();
    let [head, object, format, field, symmetry] = words.as_slice() else {
        return None;
    };
    if head != "%%matrixmarket" || object != "matrix" || format != "coordinate" {
        return None;
    }
    if field != "real" && field != "integer" {
        return None;
    }
    match symmetry.as_str() {
        "general" => Some(true),
        "symmetric" => Some(false),
        _ => None,
    }
}

/// Dimension and number of entries.
fn parse_size(line: &str) -> Result<(usize, usize), LineProblem> {
    let [rows, columns, entries] = words(line, LinePart::Size)?;
    let rows = integer("the number of rows", rows)?;
    let columns = integer("the number of columns", columns)?;
    if rows != columns {
        return Err(LineProblem::NotSquare { rows, columns });
    }
    if rows > MAX_DIMENSION {
        return Err(LineProblem::TooLarge {
            dimension: rows,
            most: MAX_DIMENSION,
        });
    }
    Ok((rows, integer("the number of entries", entries)?))
}

fn parse_entry(line: &str) -> Result<(usize, usize, f64), LineProblem> {
    let [row, column, value] = words(line, LinePart::Entry)?;
    Ok((
        integer("row", row)?,
        integer("column", column)?,
        number("value", value)?,
    ))
}

fn words(line: &str, what: LinePart) -> Result<[&str; 3], LineProblem> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let found = words.len();
    words.try_into().map_err(|_| LineProblem::FieldCount {
        found,
        expected: 3,
        what,
    })
}

/// A whole number of 0 or more.
pub(super) fn integer(field: &'static str, word: &str) -> Result<usize, LineProblem> {
    word.parse().map_err(|_| LineProblem::NotAnInteger {
        field,
        found: word.to_owned(),
    })
}

/// A finite number.
pub(super) fn number(field: &'static str, word: &str) -> Result<f64, LineProblem> {
    word.parse()
        .ok()
        .filter(|value: &f64| value.is_finite())
        .ok_or_else(|| LineProblem::NotANumber {
            field,
            found: word.to_owned(),
        })
}
