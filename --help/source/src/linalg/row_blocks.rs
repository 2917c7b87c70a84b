//! Real matrices and complex vectors in blocks of rows, each as long as a few vector registers.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::{Loops, Matrix, vectorized};

/// Rows of a block.
pub(super) const LANES: usize = 8;
/// One real number for each row of a block.
pub(super) type Lanes = [f64; LANES];
/// One complex number for each row of a block: real parts, then imaginary ones.
pub(super) type ComplexLanes = [Lanes; 2];

/// A real matrix in blocks of rows, filled up with zeros to whole blocks of rows and of columns.
#[derive(Debug, Clone)]
pub struct RowBlocks {
    columns: usize,
    /// Block after block, in each column after column.
    lanes: Vec<Lanes>,
}

impl RowBlocks {
    /// The numbers of `matrix` in blocks of rows.
    #[must_use]
    pub fn of(matrix: &Matrix<f64>) -> Self {
        let columns = matrix.columns().next_multiple_of(LANES);
        let mut lanes = vec![[0.0; LANES]; matrix.rows().div_ceil(LANES) * columns];
        for column in 0..matrix.columns() {
            for (block, rows) in matrix.column(column).chunks(LANES).enumerate() {
                lanes[block * columns + column][..rows.len()].copy_from_slice(rows);
            }
        }
        Self { columns, lanes }
    }

    /// Adds to one entry.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.lanes[row / LANES * self.columns + column][row % LANES] += value;
    }

    /// Columns with those that fill up.
    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    /// All blocks, one after the other.
    pub(super) fn lanes(&self) -> &[Lanes] {
        &self.lanes
    }

    /// Product with a vector of as many numbers as there are columns.
    #[must_use]
    pub fn times(&self, x: &BlockVector) -> BlockVector {
        let mut product = BlockVector::zeros(self.lanes.len() / self.columns * LANES);
        vectorized(Times(self, x, &mut product));
        product
    }
}

/// A complex vector, filled up with zeros to whole blocks.
#[derive(Debug, Clone)]
pub struct BlockVector(pub(super) Vec<ComplexLanes>);

impl BlockVector {
    /// `length` zeros.
    #[must_use]
    pub fn zeros(length: usize) -> Self {
        Self(vec![[[0.0; LANES]; 2]; length.div_ceil(LANES)])
    }

    /// From real and imaginary parts; parts that are not given are zero.
    #[must_use]
    pub fn of(real: &[f64], imaginary: &[f64]) -> Self {
        let mut vector = Self::zeros(real.len());
        for (part, numbers) in [real, imaginary].into_iter().enumerate() {
            for (lanes, numbers) in vector.0.iter_mut().zip(numbers.chunks(LANES)) {
                lanes[part][..numbers.len()].copy_from_slice(numbers);
            }
        }
        vector
    }

    /// Adds `factor` times the vector to real and imaginary parts, as far as there is room for either.
    pub fn add_to(&self, factor: f64, real: &mut [f64], imaginary: &mut [f64]) {
        for (part, sums) in [real, imaginary].into_iter().enumerate() {
            for (lanes, sums) in self.0.iter().zip(sums.chunks_mut(LANES)) {
                for (sum, x) in sums.iter_mut().zip(lanes[part]) {
                    *sum += factor * x;
                }
            }
        }
    }
}

/// `sum += column x`, a complex column.
#[inline(always)]
pub(super) fn add_times_lanes(sum: &mut ComplexLanes, column: &ComplexLanes, x: [f64; 2]) {
    for lane in 0..LANES {
        sum[0][lane] += column[0][lane] * x[0] - column[1][lane] * x[1];
        sum[1][lane] += column[0][lane] * x[1] + column[1][lane] * x[0];
    }
}

struct Times<'a>(&'a RowBlocks, &'a BlockVector, &'a mut BlockVector);

impl Loops for Times<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(matrix, x, product) = self;
        let blocks = matrix.lanes.chunks_exact(matrix.columns);
        for (block, product) in blocks.zip(&mut product.0) {
            let mut sum = [[0.0; LANES]; 2];
            for (columns, x) in block.as_chunks::<LANES>().0.iter().zip(&x.0) {
                for (q, column) in columns.iter().enumerate() {
                    for lane in 0..LANES {
                        sum[0][lane] += column[lane] * x[0][q];
                        sum[1][lane] += column[lane] * x[1][q];
                    }
                }
            }
            *product = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_plain_loops_whatever_the_size() {
        for (m, n) in [(1, 1), (3, 8), (8, 5), (13, 17), (24, 72)] {
            let matrix = Matrix::from_fn(m, n, |i, j| ((3 * i + 7 * j) as f64).sin());
            let parts = [0.3, 0.7].map(|phase| -> Vec<f64> {
                (0..n).map(|j| (phase + 1.7 * j as f64).cos()).collect()
            });
            let product = RowBlocks::of(&matrix).times(&BlockVector::of(&parts[0], &parts[1]));
            let mut sums = [vec![1.0; m], vec![2.0; m]];
            let [real, imaginary] = &mut sums;
            product.add_to(-2.0, real, imaginary);
            for (part, start) in [1.0, 2.0].into_iter().enumerate() {
                let plain = matrix.times_vector(&parts[part]);
                for (sum, plain) in sums[part].iter().zip(plain) {
                    assert!((sum - (start - 2.0 * plain)).abs() < 1e-13);
                }
            }
        }
    }
}
