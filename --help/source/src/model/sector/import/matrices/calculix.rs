//! `.dof`, `.sti` and `.mas` of `CalculiX` (`*FREQUENCY, SOLVER=MATRIXSTORAGE`).
//!
//! `.dof`: line i is `node.direction` of row i. `.sti`, `.mas`: `row column value`, from 1, upper triangle.

use std::path::Path;

use super::Rows;
use super::symmetric::from_triangle;
use crate::linalg::SymmetricSparse;
use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::{Source, real};
use crate::model::sector::line_problem::{LinePart, LineProblem};
use crate::model::sector::matrix_market::integer;

/// Node and direction of each row.
pub(super) fn rows(path: &Path) -> Result<Rows, ModelError> {
    let source = Source::read(path)?;
    source.require_last_line_end()?;
    let mut rows = Vec::new();
    for (number, line) in source.lines() {
        let words = line.trim().split_once('.').and_then(|(node, direction)| {
            let direction: usize = direction.parse().ok()?;
            Some((node.parse().ok()?, direction))
        });
        let Some((node, direction @ 1..=3)) = words else {
            let problem = ImportProblem::Line {
                what: "row of a dof table",
                found: line.to_owned(),
                accepted: "node.direction with direction 1, 2 or 3",
            };
            return Err(source.refuse(number, problem));
        };
        rows.push((node, direction - 1));
    }
    Ok(rows)
}

/// The matrix whose rows are `rows`.
pub(super) fn matrix(path: &Path, rows: &Rows) -> Result<SymmetricSparse, ModelError> {
    let source = Source::read(path)?;
    source.require_last_line_end()?;
    let n = rows.len();
    let mut entries = Vec::new();
    for (number, line) in source.lines() {
        let entry = entry(line).map_err(|problem| source.refuse(number, problem))?;
        let (row, column, _) = entry;
        if row == 0 || column == 0 || row > n || column > n {
            let found = row.max(column);
            return Err(source.refuse(number, ImportProblem::RowOutside { found, rows: n }));
        }
        entries.push((row - 1, column - 1, entry.2));
    }
    require_diagonal(&entries, rows).map_err(|problem| source.refuse_whole(problem))?;
    from_triangle(n, &entries).map_err(|problem| source.refuse_whole(problem))
}

fn entry(line: &str) -> Result<(usize, usize, f64), LineProblem> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let &[row, column, value] = words.as_slice() else {
        return Err(LineProblem::FieldCount {
            found: words.len(),
            expected: 3,
            what: LinePart::Entry,
        });
    };
    Ok((
        integer("row", row)?,
        integer("column", column)?,
        real("value", value)?,
    ))
}

/// Every row has an entry on the diagonal: a file that was cut off between two lines has not.
pub(super) fn require_diagonal(
    entries: &[(usize, usize, f64)],
    rows: &Rows,
) -> Result<(), ImportProblem> {
    let mut present = vec![false; rows.len()];
    for &(row, column, _) in entries {
        if row == column {
            present[row] = true;
        }
    }
    match present.iter().position(|&present| !present) {
        None => Ok(()),
        Some(row) => Err(no_diagonal(row, rows)),
    }
}

/// The refusal of a row (from 0) that has nothing on the diagonal.
pub(super) fn no_diagonal(row: usize, rows: &Rows) -> ImportProblem {
    ImportProblem::NoDiagonal {
        row: row + 1,
        node: rows[row].0,
        direction: rows[row].1 + 1,
    }
}
