//! Factors of a complex symmetric matrix without exchange of rows, half the work of an LU factorisation.
//!
//! The matrix is that of a linear motion, `S = L L^T`, and stands above rows C that are eliminated with it:
//!
//! ```text
//! [S C^T; C 0] = [L; X] [L^T X^T] - [0 0; 0 R],    X = C L^-T,    R = X X^T = C S^-1 C^T
//! ```
//!
//! Nothing keeps a pivot from being small. As many digits are lost as the products `L_ip L_ip` are larger than what
//! their sum `S_ii` is made of, and a matrix that loses too many is not taken.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

mod elimination;
mod substitution;

use super::row_blocks::{ComplexLanes, LANES, Lanes};
use super::{BlockVector, Matrix, RowBlocks, vectorized};
use elimination::Elimination;
use substitution::{Backward, BorderTimes, BorderTransposed, Forward, SchurComplement};

/// Largest sum of the squares of a row of L, relative to the terms of the diagonal entry of S: four digits.
const LARGEST_GROWTH: f64 = 1e4;
/// Rows of a block in as many columns.
type Tile = [ComplexLanes; LANES];

/// `K - shift I + i (a A + b B ...)` with real symmetric matrices, of which the lower triangles are read.
pub struct ComplexSymmetric<'a> {
    /// K.
    pub real: &'a RowBlocks,
    /// What is taken off the diagonal.
    pub shift: f64,
    /// a and A, b and B, and so on.
    pub imaginary: &'a [(f64, &'a RowBlocks)],
}

/// Factors L and X of one matrix after the other; storage is reused.
pub struct ComplexCholesky {
    /// n.
    size: usize,
    /// m.
    rows: usize,
    /// C.
    border: RowBlocks,
    /// Number of the first column of every block of C that is not zero, rounded down to whole blocks.
    first: Vec<usize>,
    /// Blocks of rows of L, then of X.
    lower: Vec<ComplexLanes>,
    /// Blocks of rows of `[L^T X^T]`.
    upper: Vec<ComplexLanes>,
    /// `1 / L_pp`.
    inverse: Vec<[f64; 2]>,
    /// Sums of the squares of the rows of L, and the terms of the diagonal of S.
    squares: Vec<Lanes>,
    terms: Vec<Lanes>,
}

impl ComplexCholesky {
    /// Storage for matrices of as many unknowns as `border`, C, has columns.
    #[must_use]
    pub fn new(border: &Matrix<f64>) -> Self {
        let (rows, size) = (border.rows(), border.columns());
        let border = RowBlocks::of(border);
        let columns = border.columns();
        let first_of = |block: &[Lanes]| {
            let zero = |lanes: &&Lanes| lanes.iter().all(|&entry| entry == 0.0);
            block.iter().take_while(zero).count() / LANES * LANES
        };
        let first: Vec<usize> = border.lanes().chunks_exact(columns).map(first_of).collect();
        let blocks = columns / LANES;
        Self {
            size,
            rows,
            lower: vec![[[0.0; LANES]; 2]; (blocks + first.len()) * columns],
            upper: vec![[[0.0; LANES]; 2]; (blocks + first.len()) * columns],
            inverse: vec![[0.0; 2]; columns],
            squares: vec![[0.0; LANES]; blocks],
            terms: vec![[0.0; LANES]; blocks],
            border,
            first,
        }
    }

    /// Factors the matrix; false if that loses too many digits, as where a pivot is nearly zero.
    pub fn factor(&mut self, matrix: &ComplexSymmetric<'_>) -> bool {
        vectorized(Elimination(self, matrix));
        let mut rows = self
            .squares
            .iter()
            .flatten()
            .zip(self.terms.iter().flatten());
        // Not so for a sum that is no number either.
        rows.all(|(squares, terms)| *squares <= LARGEST_GROWTH * terms)
    }

    /// R, `m x m`, real and imaginary parts column-major.
    pub fn schur_complement(&self, [real, imaginary]: [&mut [f64]; 2]) {
        vectorized(SchurComplement(self, [real, imaginary]));
    }

    /// `L^-1 x`, in place.
    pub fn forward(&self, x: &mut BlockVector) {
        vectorized(Forward(self, x));
    }

    /// `L^-T x`, in place.
    pub fn backward(&self, x: &mut BlockVector) {
        vectorized(Backward(self, x));
    }

    /// `X x`.
    #[must_use]
    pub fn border_times(&self, x: &BlockVector) -> BlockVector {
        let mut product = BlockVector::zeros(self.rows);
        vectorized(BorderTimes(self, x, &mut product));
        product
    }

    /// `sum -= X^T forces`.
    pub fn subtract_border_transposed(&self, sum: &mut BlockVector, forces: &BlockVector) {
        vectorized(BorderTransposed(self, sum, forces));
    }

    /// Columns with those that fill up.
    fn columns(&self) -> usize {
        self.inverse.len()
    }

    /// Blocks of X from the first column that is not zero, and its number.
    #[inline(always)]
    fn border_blocks(&self) -> impl Iterator<Item = (usize, &[ComplexLanes])> {
        let columns = self.columns();
        let blocks = self.lower[columns / LANES * columns..].chunks_exact(columns);
        let first = self.first.iter();
        blocks
            .zip(first)
            .map(|(block, &first)| (first, &block[first..]))
    }

    /// Tiles of a block of rows of `[L^T X^T]`.
    #[inline(always)]
    fn across(&self, block: usize) -> &[Tile] {
        let height = self.upper.len() / (self.columns() / LANES);
        self.upper[block * height..][..height].as_chunks().0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{Complex64, LuWorkspace, RowBlocks};

    fn number(i: usize, j: usize, phase: f64) -> f64 {
        (phase + 1.3 * (i.min(j) * 7 + i.max(j) * 3) as f64).sin()
    }

    /// Stiffness with a leading diagonal, damping, and rows of which each reaches one column further to the left.
    fn sample(m: usize, n: usize) -> [Matrix<f64>; 3] {
        let leading = |i, j, size: f64| if i == j { size } else { 0.0 };
        let stiffness = Matrix::from_fn(n, n, |i, j| {
            number(i, j, 0.3) + leading(i, j, 0.5 * n as f64)
        });
        let damping = Matrix::from_fn(n, n, |i, j| 0.1 * number(i, j, 0.8) + leading(i, j, 0.2));
        let rows = Matrix::from_fn(m, n, |i, j| {
            if i + j + 1 >= n {
                number(i, j + 40, 0.1)
            } else {
                0.0
            }
        });
        [stiffness, damping, rows]
    }

    const SHIFT: f64 = 1.7;
    const FACTOR: f64 = 0.6;

    /// Factors of the matrix `stiffness - SHIFT I + i FACTOR damping` by [`LuWorkspace`], to compare with.
    fn dense(stiffness: &Matrix<f64>, damping: &Matrix<f64>) -> LuWorkspace<Complex64> {
        let n = stiffness.rows();
        let mut dense = LuWorkspace::new(n);
        let matrix = dense.matrix_mut();
        for j in 0..n {
            for i in 0..n {
                let shift = if i == j { SHIFT } else { 0.0 };
                let real = stiffness[(i, j)] - shift;
                matrix[j * n + i] = Complex64::new(real, FACTOR * damping[(i, j)]);
            }
        }
        assert!(dense.factor());
        dense
    }

    fn vector(x: &[Complex64]) -> BlockVector {
        let [real, imaginary] = [|z: &Complex64| z.re, |z: &Complex64| z.im]
            .map(|part| -> Vec<f64> { x.iter().map(part).collect() });
        BlockVector::of(&real, &imaginary)
    }

    fn assert_near(vector: &BlockVector, expected: &[Complex64], what: &str) {
        let mut parts = [vec![0.0; expected.len()], vec![0.0; expected.len()]];
        let [real, imaginary] = &mut parts;
        vector.add_to(1.0, real, imaginary);
        let largest = expected.iter().fold(0.0, |most: f64, z| most.max(z.norm()));
        for (i, expected) in expected.iter().enumerate() {
            let missed = Complex64::new(parts[0][i], parts[1][i]) - expected;
            assert!(missed.norm() <= 1e-12 * largest, "{what} {i}: {missed}");
        }
    }

    fn excitation(n: usize, phase: f64) -> Vec<Complex64> {
        (0..n)
            .map(|i| Complex64::new(number(i, 3, phase), number(i, 5, phase)))
            .collect()
    }

    #[test]
    fn factors_do_what_those_with_exchanged_rows_do_whatever_the_size() {
        for (m, n) in [
            (1, 1),
            (3, 2),
            (0, 5),
            (2, 8),
            (5, 13),
            (13, 13),
            (20, 9),
            (24, 72),
        ] {
            let [stiffness, damping, rows] = sample(m, n);
            let mut factors = ComplexCholesky::new(&rows);
            let [real, imaginary] = [&stiffness, &damping].map(RowBlocks::of);
            // Twice: nothing of the first one is left.
            for (shift, factor) in [(0.1, 3.0), (SHIFT, FACTOR)] {
                let imaginary = &[(0.25 * factor, &imaginary), (0.75 * factor, &imaginary)];
                let real = &real;
                assert!(factors.factor(&ComplexSymmetric {
                    real,
                    shift,
                    imaginary
                }));
            }
            let mut dense = dense(&stiffness, &damping);
            let (right, forces) = (excitation(n, 0.4), excitation(m, 0.9));
            let rows = rows.to_complex();

            let mut expected = right.clone();
            dense.solve(&mut expected);
            let mut forward = vector(&right);
            factors.forward(&mut forward);
            let mut found = forward.clone();
            factors.backward(&mut found);
            assert_near(&found, &expected, "solution");
            let motion = factors.border_times(&forward);
            assert_near(&motion, &rows.times_vector(&expected), "motion");

            let attached = rows.adjoint_times_vector(&forces);
            let mut expected: Vec<Complex64> =
                right.iter().zip(&attached).map(|(a, b)| a - b).collect();
            dense.solve(&mut expected);
            factors.subtract_border_transposed(&mut forward, &vector(&forces));
            factors.backward(&mut forward);
            assert_near(&forward, &expected, "solution under forces");

            let mut receptance = rows.adjoint();
            dense.solve_columns(&mut receptance);
            let expected = rows.times(&receptance);
            let mut found = [vec![f64::NAN; m * m], vec![f64::NAN; m * m]];
            let [real, imaginary] = &mut found;
            factors.schur_complement([real, imaginary]);
            let largest = expected.squared_norm().sqrt();
            for (at, expected) in expected.as_slice().iter().enumerate() {
                let missed = Complex64::new(found[0][at], found[1][at]) - expected;
                assert!(missed.norm() <= 1e-12 * largest, "{m} {n} {at}: {missed}");
            }
        }
    }

    #[test]
    fn a_matrix_with_a_pivot_that_is_nearly_zero_is_not_taken() {
        let [stiffness, damping, rows] = sample(3, 21);
        for (at, missing, taken) in [
            (0, 0.0, false),
            (0, 1e-6, false),
            (0, 1e-2, true),
            (9, 0.0, false),
            (0, f64::NAN, false),
            (20, f64::NAN, false),
        ] {
            let pivoted = |matrix: &Matrix<f64>, pivot| {
                let mut matrix = matrix.clone();
                // Nothing before it changes what is left of the diagonal entry.
                for before in 0..at {
                    (matrix[(at, before)], matrix[(before, at)]) = (0.0, 0.0);
                }
                matrix[(at, at)] = pivot;
                RowBlocks::of(&matrix)
            };
            let real = &pivoted(&stiffness, SHIFT + missing);
            let imaginary = &[(FACTOR, &pivoted(&damping, 0.0))];
            let mut factors = ComplexCholesky::new(&rows);
            let found = factors.factor(&ComplexSymmetric {
                real,
                shift: SHIFT,
                imaginary,
            });
            assert_eq!(found, taken, "{at} {missing:e}");
        }
    }
}
