//! What the factors make of vectors, and the Schur complement.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::super::row_blocks::{LANES, add_times_lanes};
use super::super::{BlockVector, Loops};
use super::ComplexCholesky;
use super::elimination::{subtract, subtract_products, times};

/// `R = X X^T`, the Schur complement with its sign turned.
pub(super) struct SchurComplement<'a>(
    pub(super) &'a ComplexCholesky,
    pub(super) [&'a mut [f64]; 2],
);

impl Loops for SchurComplement<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, mut target) = self;
        let m = factors.rows;
        for (a, (first, left)) in factors.border_blocks().enumerate() {
            for (b, (other, right)) in factors.border_blocks().take(a + 1).enumerate() {
                let from = first.max(other);
                let mut tile = [[[0.0; LANES]; 2]; LANES];
                subtract_products(&mut tile, &left[from - first..], &right[from - other..]);
                for (q, column) in tile.iter().enumerate().take(m - b * LANES) {
                    for (target, entries) in target.iter_mut().zip(column) {
                        for (lane, entry) in entries.iter().enumerate().take(m - a * LANES) {
                            let (i, j) = (a * LANES + lane, b * LANES + q);
                            target[j * m + i] = -entry;
                            target[i * m + j] = -entry;
                        }
                    }
                }
            }
        }
    }
}

/// `L^-1 x`, in place.
pub(super) struct Forward<'a>(
    pub(super) &'a ComplexCholesky,
    pub(super) &'a mut BlockVector,
);

impl Loops for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, BlockVector(x)) = self;
        let columns = factors.columns();
        for (block, row) in factors
            .lower
            .chunks_exact(columns)
            .enumerate()
            .take(x.len())
        {
            let (done, rest) = x.split_at_mut(block);
            let unknowns = &mut rest[0];
            let (tiles, _) = row.as_chunks::<LANES>();
            for (tile, x) in tiles.iter().zip(&*done) {
                for (q, column) in tile.iter().enumerate() {
                    subtract(unknowns, column, [x[0][q], x[1][q]]);
                }
            }
            for (p, column) in tiles[block].iter().enumerate() {
                let inverse = factors.inverse[block * LANES + p];
                let x = times([unknowns[0][p], unknowns[1][p]], inverse);
                subtract(unknowns, column, x);
                [unknowns[0][p], unknowns[1][p]] = x;
            }
        }
    }
}

/// `L^-T x`, in place, with the rows of `L^T`.
pub(super) struct Backward<'a>(
    pub(super) &'a ComplexCholesky,
    pub(super) &'a mut BlockVector,
);

impl Loops for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, BlockVector(x)) = self;
        for block in (0..x.len()).rev() {
            let (rest, done) = x.split_at_mut(block + 1);
            let unknowns = &mut rest[block];
            let tiles = factors.across(block);
            for (tile, x) in tiles[block + 1..].iter().zip(&*done) {
                for (q, column) in tile.iter().enumerate() {
                    subtract(unknowns, column, [x[0][q], x[1][q]]);
                }
            }
            for (p, column) in tiles[block].iter().enumerate().rev() {
                let inverse = factors.inverse[block * LANES + p];
                let x = times([unknowns[0][p], unknowns[1][p]], inverse);
                subtract(unknowns, column, x);
                [unknowns[0][p], unknowns[1][p]] = x;
            }
        }
    }
}

/// `X x`, into zeros.
pub(super) struct BorderTimes<'a>(
    pub(super) &'a ComplexCholesky,
    pub(super) &'a BlockVector,
    pub(super) &'a mut BlockVector,
);

impl Loops for BorderTimes<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, BlockVector(x), BlockVector(product)) = self;
        for ((first, block), sum) in factors.border_blocks().zip(product) {
            let (tiles, _) = block.as_chunks::<LANES>();
            for (tile, x) in tiles.iter().zip(&x[first / LANES..]) {
                for (q, column) in tile.iter().enumerate() {
                    add_times_lanes(sum, column, [x[0][q], x[1][q]]);
                }
            }
        }
    }
}

/// `sum -= X^T forces`.
pub(super) struct BorderTransposed<'a>(
    pub(super) &'a ComplexCholesky,
    pub(super) &'a mut BlockVector,
    pub(super) &'a BlockVector,
);

impl Loops for BorderTransposed<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, BlockVector(sum), BlockVector(forces)) = self;
        let size = sum.len();
        for (block, sum) in sum.iter_mut().enumerate() {
            let border = factors.across(block)[size..].iter().zip(forces);
            for ((tile, forces), &first) in border.zip(&factors.first) {
                if first > block * LANES {
                    continue;
                }
                for (q, column) in tile.iter().enumerate() {
                    subtract(sum, column, [forces[0][q], forces[1][q]]);
                }
            }
        }
    }
}
