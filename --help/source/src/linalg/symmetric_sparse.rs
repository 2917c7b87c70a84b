//! A real symmetric sparse matrix stored by its lower triangle, assembled from triplets.

use serde::{Deserialize, Serialize};

/// Real symmetric `n x n` matrix: lower triangle, diagonal included, compressed by columns.
///
/// Rows are ascending within a column and each entry stands once. Explicit zeros are kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SymmetricSparse {
    dimension: usize,
    column_start: Vec<usize>,
    row: Vec<usize>,
    value: Vec<f64>,
}

impl SymmetricSparse {
    /// Sums triplets `(row, column, value)` of the lower triangle (`row >= column`).
    ///
    /// # Panics
    /// If a triplet lies above the diagonal or outside the matrix: callers validate their input.
    #[must_use]
    pub fn from_lower_triplets(dimension: usize, triplets: &[(usize, usize, f64)]) -> Self {
        let mut order: Vec<(usize, usize, f64)> = triplets.to_vec();
        for &(row, column, _) in &order {
            assert!(
                row < dimension && column <= row,
                "entry ({row}, {column}) is outside the lower triangle of a {dimension} x {dimension} matrix"
            );
        }
        // A stable sort keeps the order of summation of equal entries, hence the bits of the sum.
        order.sort_by_key(|&(row, column, _)| (column, row));
        let mut matrix = Self {
            dimension,
            column_start: vec![0; dimension + 1],
            row: Vec::with_capacity(order.len()),
            value: Vec::with_capacity(order.len()),
        };
        let mut last = None;
        for (row, column, value) in order {
            if last == Some((row, column)) {
                if let Some(sum) = matrix.value.last_mut() {
                    *sum += value;
                }
            } else {
                matrix.row.push(row);
                matrix.value.push(value);
                matrix.column_start[column + 1] += 1;
                last = Some((row, column));
            }
        }
        for column in 0..dimension {
            matrix.column_start[column + 1] += matrix.column_start[column];
        }
        matrix
    }

    /// Number of rows, equal to the number of columns.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of stored entries of the lower triangle.
    #[must_use]
    pub fn stored_entries(&self) -> usize {
        self.value.len()
    }

    /// Stored entries `(row, column, value)` with `row >= column`, by column, then row.
    pub fn lower_entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.dimension).flat_map(move |column| {
            (self.column_start[column]..self.column_start[column + 1])
                .map(move |at| (self.row[at], column, self.value[at]))
        })
    }

    /// All entries of the full matrix: every stored entry, and its mirror image off the diagonal.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.lower_entries().flat_map(|(row, column, value)| {
            let mirror = (row != column).then_some((column, row, value));
            std::iter::once((row, column, value)).chain(mirror)
        })
    }

    /// Diagonal, length `n`; zero where nothing is stored.
    #[must_use]
    pub fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.dimension];
        for (row, column, value) in self.lower_entries() {
            if row == column {
                diagonal[row] = value;
            }
        }
        diagonal
    }

    /// Product `y = A x` with a real vector of length `n`.
    #[must_use]
    pub fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.dimension];
        for (row, column, value) in self.entries() {
            y[row] += value * x[column];
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::SymmetricSparse;

    #[test]
    fn sums_repeated_triplets_and_mirrors_the_lower_triangle() {
        let matrix =
            SymmetricSparse::from_lower_triplets(2, &[(1, 0, 1.0), (0, 0, 2.0), (1, 0, 0.5)]);
        assert_eq!(matrix.stored_entries(), 2);
        assert_eq!(matrix.multiply(&[1.0, 2.0]), vec![5.0, 1.5]);
        assert_eq!(matrix.diagonal(), vec![2.0, 0.0]);
    }
}
