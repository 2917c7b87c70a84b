//! Dense LU factorisation in caller-owned storage, for loops that must not allocate.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Conj, MatMut, MatRef, Par};

use super::matrix::{Matrix, Scalar};

/// LU factorisation with partial pivoting of an `n x n` matrix; storage is reused.
pub struct LuWorkspace<T> {
    dimension: usize,
    matrix: Vec<T>,
    permutation: Vec<usize>,
    inverse: Vec<usize>,
    memory: MemBuffer,
}

impl<T: Scalar> LuWorkspace<T> {
    /// Storage for matrices of dimension `n`.
    #[must_use]
    pub fn new(dimension: usize) -> Self {
        let factor_need = factor::lu_in_place_scratch::<usize, T>(
            dimension,
            dimension,
            Par::Seq,
            faer::prelude::default(),
        );
        let solve_need = solve::solve_in_place_scratch::<usize, T>(dimension, 1, Par::Seq);
        Self {
            dimension,
            matrix: vec![T::default(); dimension * dimension],
            permutation: vec![0; dimension],
            inverse: vec![0; dimension],
            memory: MemBuffer::new(factor_need.or(solve_need)),
        }
    }

    /// Dimension n.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The matrix to fill, column-major, before [`Self::factor`] overwrites it.
    pub fn matrix_mut(&mut self) -> &mut [T] {
        &mut self.matrix
    }

    /// Factors the matrix in place; false if a pivot is zero or not finite.
    pub fn factor(&mut self) -> bool {
        let n = self.dimension;
        factor::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut self.matrix, n, n),
            &mut self.permutation,
            &mut self.inverse,
            Par::Seq,
            MemStack::new(&mut self.memory),
            faer::prelude::default(),
        );
        (0..n).all(|i| {
            let pivot = self.matrix[i * n + i];
            let size = (pivot * pivot.conjugate()).real_part();
            size.is_finite() && size > 0.0
        })
    }

    /// Solves with the factors, in place.
    pub fn solve(&mut self, right: &mut [T]) {
        let n = self.dimension;
        let factors = MatRef::from_column_major_slice(&self.matrix, n, n);
        solve::solve_in_place(
            factors,
            factors,
            PermRef::new_checked(&self.permutation, &self.inverse, n),
            MatMut::from_column_major_slice_mut(right, n, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }

    /// Solves with the factors for every column of `right`, in place.
    pub fn solve_columns(&self, right: &mut Matrix<T>) {
        let n = self.dimension;
        let need = solve::solve_in_place_scratch::<usize, T>(n, right.columns(), Par::Seq);
        let factors = MatRef::from_column_major_slice(&self.matrix, n, n);
        solve::solve_in_place(
            factors,
            factors,
            PermRef::new_checked(&self.permutation, &self.inverse, n),
            right.view_mut(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(need)),
        );
    }

    /// [`Self::solve_columns`] with the adjoint of the matrix.
    pub fn solve_adjoint_columns(&self, right: &mut Matrix<T>) {
        let n = self.dimension;
        let need =
            solve::solve_transpose_in_place_scratch::<usize, T>(n, right.columns(), Par::Seq);
        let factors = MatRef::from_column_major_slice(&self.matrix, n, n);
        solve::solve_transpose_in_place_with_conj(
            factors,
            factors,
            PermRef::new_checked(&self.permutation, &self.inverse, n),
            Conj::Yes,
            right.view_mut(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(need)),
        );
    }
}

impl LuWorkspace<f64> {
    /// Sign of the determinant of the factored matrix, 1 or -1.
    #[must_use]
    pub fn determinant_sign(&self) -> f64 {
        let n = self.dimension;
        let negative = (0..n).filter(|&i| self.matrix[i * n + i] < 0.0).count();
        let swaps = n - cycles(&self.permutation);
        if (negative + swaps).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        }
    }
}

/// Number of cycles of a permutation, fixed points included.
fn cycles(permutation: &[usize]) -> usize {
    let mut seen = vec![false; permutation.len()];
    let mut count = 0;
    for first in 0..permutation.len() {
        let mut at = first;
        count += usize::from(!seen[first]);
        while !seen[at] {
            seen[at] = true;
            at = permutation[at];
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::{LuWorkspace, Matrix};

    #[test]
    fn solves_what_it_factored_and_reports_a_singular_matrix() {
        let mut lu = LuWorkspace::<f64>::new(3);
        let a = [4.0, 1.0, 0.5, 2.0, 5.0, 0.25, 1.0, 2.0, 6.0];
        lu.matrix_mut().copy_from_slice(&a);
        assert!(lu.factor());
        let mut x = [1.0, 2.0, 3.0];
        lu.solve(&mut x);
        for row in 0..3 {
            let product: f64 = (0..3).map(|column| a[3 * column + row] * x[column]).sum();
            assert!((product - (row as f64 + 1.0)).abs() < 1e-14);
        }
        let mut columns = Matrix::from_fn(3, 2, |i, j| (i + 1) as f64 * (1.0 - 3.0 * j as f64));
        lu.solve_columns(&mut columns);
        for row in 0..3 {
            assert!((columns[(row, 0)] - x[row]).abs() < 1e-14);
            assert!((columns[(row, 1)] + 2.0 * x[row]).abs() < 1e-14);
        }
        lu.matrix_mut().fill(1.0);
        assert!(!lu.factor());
    }

    #[test]
    fn the_sign_of_the_determinant_counts_the_row_swaps() {
        // Column by column; by hand: 4, -18, and the cyclic shift of three rows.
        for (columns, sign) in [
            ([4.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], 1.0),
            ([1.0, 2.0, 0.0, 5.0, 1.0, 0.0, 0.0, 3.0, 2.0], -1.0),
            ([0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0], 1.0),
            ([0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0], -1.0),
        ] {
            let mut lu = LuWorkspace::<f64>::new(3);
            lu.matrix_mut().copy_from_slice(&columns);
            assert!(lu.factor());
            assert!((lu.determinant_sign() - sign).abs() < 1e-15, "{columns:?}");
        }
    }
}
