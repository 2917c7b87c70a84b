//! Elimination tile by tile, each taken up and left once.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::super::Loops;
use super::super::row_blocks::{ComplexLanes, LANES, add_times_lanes};
use super::{ComplexCholesky, ComplexSymmetric, Tile};
use crate::linalg::RowBlocks;

/// Columns of a tile whose sums are kept in vector registers at a time.
const TOGETHER: usize = 2;

/// Factors of a matrix.
pub(super) struct Elimination<'a>(
    pub(super) &'a mut ComplexCholesky,
    pub(super) &'a ComplexSymmetric<'a>,
);

impl Loops for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.assemble(self.1);
        self.0.eliminate();
    }
}

impl ComplexCholesky {
    #[inline(always)]
    fn assemble(&mut self, matrix: &ComplexSymmetric<'_>) {
        let columns = self.columns();
        let count = columns / LANES;
        let (blocks, border) = self.lower.split_at_mut(count * columns);
        for (block, entries) in blocks.chunks_exact_mut(columns).enumerate() {
            let width = (block + 1) * LANES;
            let part = |of: &'_ RowBlocks| block * of.columns()..block * of.columns() + width;
            let real = &matrix.real.lanes()[part(matrix.real)];
            for (entry, &real) in entries.iter_mut().zip(real) {
                *entry = [real, [0.0; LANES]];
            }
            for (factor, imaginary) in matrix.imaginary {
                let imaginary = &imaginary.lanes()[part(imaginary)];
                for ([_, sum], imaginary) in entries.iter_mut().zip(imaginary) {
                    for (sum, entry) in sum.iter_mut().zip(imaginary) {
                        *sum += factor * entry;
                    }
                }
            }
            for lane in 0..LANES {
                let column = block * LANES + lane;
                let [real, imaginary] = &mut entries[column];
                // What fills up are unknowns by themselves.
                let (diagonal, shift) = if column < self.size {
                    (real[lane], matrix.shift)
                } else {
                    (1.0, 0.0)
                };
                real[lane] = diagonal - shift;
                self.terms[block][lane] = diagonal.abs() + shift.abs() + imaginary[lane].abs();
            }
        }
        for (entry, &real) in border.iter_mut().zip(self.border.lanes()) {
            *entry = [real, [0.0; LANES]];
        }
    }

    /// Tile by tile: what the columns before take off, then the columns of the tile itself.
    #[inline(always)]
    fn eliminate(&mut self) {
        let columns = self.columns();
        let height = self.upper.len() / (columns / LANES);
        for (block, squares) in self.squares.iter_mut().enumerate() {
            *squares = [0.0; LANES];
            let start = block * LANES;
            let (above, below) = self.lower.split_at_mut((block + 1) * columns);
            let (before, rest) = above[block * columns..].split_at_mut(start);
            let before = &*before;
            let Some(diagonal) = rest.first_chunk_mut::<LANES>() else {
                return;
            };
            subtract_products(diagonal, before, before);
            let inverse = &mut self.inverse[start..start + LANES];
            factor_diagonal(diagonal, inverse);
            let (across, _) = self.upper[block * height..][..height].as_chunks_mut();
            transpose(diagonal, &mut across[block]);
            let first = std::iter::repeat_n(0, columns / LANES - block - 1);
            let first = first.chain(self.first.iter().copied());
            let across = across[block + 1..].iter_mut();
            for ((row, first), across) in below.chunks_exact_mut(columns).zip(first).zip(across) {
                let (done, rest) = row.split_at_mut(start);
                if let Some(tile) = rest.first_chunk_mut::<LANES>()
                    && first <= start
                {
                    subtract_products(tile, &done[first..], &before[first..]);
                    divide(tile, diagonal, inverse);
                    transpose(tile, across);
                }
            }
            for [real, imaginary] in &self.lower[block * columns..][..start + LANES] {
                for lane in 0..LANES {
                    squares[lane] += real[lane] * real[lane] + imaginary[lane] * imaginary[lane];
                }
            }
        }
    }
}

/// `tile -= left right^T`, with the rows of one block by the columns before the tile, and those of another.
#[inline(always)]
pub(super) fn subtract_products(tile: &mut Tile, left: &[ComplexLanes], right: &[ComplexLanes]) {
    for group in 0..LANES / TOGETHER {
        let first = group * TOGETHER;
        let mut sums: [ComplexLanes; TOGETHER] = std::array::from_fn(|k| tile[first + k]);
        for (left, right) in left.iter().zip(right) {
            for (k, sum) in sums.iter_mut().enumerate() {
                subtract(sum, left, [right[0][first + k], right[1][first + k]]);
            }
        }
        tile[first..first + TOGETHER].copy_from_slice(&sums);
    }
}

/// `sum -= column x`.
#[inline(always)]
pub(super) fn subtract(sum: &mut ComplexLanes, column: &ComplexLanes, x: [f64; 2]) {
    for lane in 0..LANES {
        sum[0][lane] -= column[0][lane] * x[0] - column[1][lane] * x[1];
        sum[1][lane] -= column[0][lane] * x[1] + column[1][lane] * x[0];
    }
}

/// L of a tile on the diagonal, and the inverses of its pivots.
#[inline(always)]
fn factor_diagonal(tile: &mut Tile, inverse: &mut [[f64; 2]]) {
    for p in 0..LANES {
        inverse[p] = inverse_root([tile[p][0][p], tile[p][1][p]]);
        scale(&mut tile[p], inverse[p]);
        for part in &mut tile[p] {
            part[..p].fill(0.0);
        }
        let column = tile[p];
        for q in p + 1..LANES {
            subtract(&mut tile[q], &column, [column[0][q], column[1][q]]);
        }
    }
}

/// `tile L^-T` with the factors of the tile on the diagonal above it.
#[inline(always)]
fn divide(tile: &mut Tile, diagonal: &Tile, inverse: &[[f64; 2]]) {
    for p in 0..LANES {
        scale(&mut tile[p], inverse[p]);
        let column = tile[p];
        for q in p + 1..LANES {
            subtract(
                &mut tile[q],
                &column,
                [diagonal[p][0][q], diagonal[p][1][q]],
            );
        }
    }
}

#[inline(always)]
fn transpose(tile: &Tile, transposed: &mut Tile) {
    for (row, target) in transposed.iter_mut().enumerate() {
        for part in 0..2 {
            for (entry, column) in target[part].iter_mut().zip(tile) {
                *entry = column[part][row];
            }
        }
    }
}

#[inline(always)]
fn scale(column: &mut ComplexLanes, factor: [f64; 2]) {
    let mut product = [[0.0; LANES]; 2];
    add_times_lanes(&mut product, column, factor);
    *column = product;
}

#[inline(always)]
pub(super) fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// `1 / sqrt(z)`, by square roots of real numbers, which are the same on every machine.
#[inline(always)]
fn inverse_root([re, im]: [f64; 2]) -> [f64; 2] {
    let size = (re * re + im * im).sqrt();
    let larger = (0.5 * (size + re.abs())).sqrt();
    let smaller = 0.5 * im / larger;
    let (re, im) = if re >= 0.0 {
        (larger, smaller)
    } else {
        (smaller, larger)
    };
    [re / size, -im / size]
}
