//! A symmetric matrix from the entries of a file, whichever triangle they stand in.

use std::collections::HashMap;

use crate::linalg::SymmetricSparse;
use crate::model::sector::import::problem::ImportProblem;

/// One triangle, either, each entry once: `(row, column, value)` from 0.
pub(super) fn from_triangle(
    dimension: usize,
    entries: &[(usize, usize, f64)],
) -> Result<SymmetricSparse, ImportProblem> {
    let lower: Vec<(usize, usize, f64)> = entries
        .iter()
        .map(|&(row, column, value)| (row.max(column), row.min(column), value))
        .collect();
    let matrix = SymmetricSparse::from_lower_triplets(dimension, &lower);
    if matrix.stored_entries() < lower.len() {
        let mut seen = std::collections::HashSet::new();
        if let Some(&(row, column, _)) = lower
            .iter()
            .find(|&&(row, column, _)| !seen.insert((row, column)))
        {
            return Err(ImportProblem::Repeated {
                row: row + 1,
                column: column + 1,
            });
        }
    }
    Ok(matrix)
}

/// Both triangles, equal to the last bit, each entry once.
#[expect(
    clippy::float_cmp,
    reason = "matrices are never symmetrised: what is not symmetric is refused"
)]
pub(super) fn from_full(
    dimension: usize,
    entries: &[(usize, usize, f64)],
) -> Result<SymmetricSparse, ImportProblem> {
    let mut all: HashMap<(usize, usize), f64> = HashMap::new();
    for &(row, column, value) in entries {
        if all.insert((row, column), value).is_some() {
            return Err(ImportProblem::Repeated {
                row: row + 1,
                column: column + 1,
            });
        }
    }
    let apart = || entries.iter().filter(|&&(_, _, value)| value != 0.0);
    let above = apart().filter(|(row, column, _)| row < column).count();
    let below = apart().filter(|(row, column, _)| row > column).count();
    if above.min(below) == 0 && above.max(below) > 1 {
        let side = if above > 0 { "above" } else { "below" };
        let entries = above.max(below);
        return Err(ImportProblem::OneTriangle { entries, side });
    }
    for &(row, column, value) in entries {
        let mirror = all.get(&(column, row)).copied().unwrap_or(0.0);
        if value != mirror {
            return Err(ImportProblem::NotSymmetric {
                row: row + 1,
                column: column + 1,
                value,
                mirror,
            });
        }
    }
    let lower: Vec<(usize, usize, f64)> = entries
        .iter()
        .copied()
        .filter(|&(row, column, _)| row >= column)
        .collect();
    Ok(SymmetricSparse::from_lower_triplets(dimension, &lower))
}
