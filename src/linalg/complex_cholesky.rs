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

use super::row_blocks::{ComplexLanes, LANES, Lanes, add_times_lanes};
use super::{BlockVector, Loops, Matrix, RowBlocks, vectorized};

/// Largest sum of the squares of a row of L, relative to the terms of the diagonal entry of S: four digits.
const LARGEST_GROWTH: f64 = 1e4;
/// Columns of a tile whose sums are kept in vector registers at a time.
const TOGETHER: usize = 2;
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
        vectorized(BorderTimes(self, x))
    }

    /// `sum += factor X^T forces`.
    pub fn add_border_transposed(&self, sum: &mut BlockVector, factor: f64, forces: &BlockVector) {
        vectorized(BorderTransposed(self, sum, factor, forces));
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

    #[inline(always)]
    fn assemble(&mut self, matrix: &ComplexSymmetric<'_>) {
        let columns = self.columns();
        let count = columns / LANES;
        let (own, border) = self.lower.split_at_mut(count * columns);
        for (block, entries) in own.chunks_exact_mut(columns).enumerate() {
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
                let (own, shift) = if column < self.size {
                    (real[lane], matrix.shift)
                } else {
                    (1.0, 0.0)
                };
                real[lane] = own - shift;
                self.terms[block][lane] = own.abs() + shift.abs() + imaginary[lane].abs();
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
        for (block, squares) in self.squares.iter_mut().enumerate() {
            *squares = [0.0; LANES];
            let start = block * LANES;
            let (above, below) = self.lower.split_at_mut((block + 1) * columns);
            let (own, rest) = above[block * columns..].split_at_mut(start);
            let own = &*own;
            let Some(diagonal) = rest.first_chunk_mut::<LANES>() else {
                return;
            };
            subtract_products(diagonal, own, own);
            let inverse = &mut self.inverse[start..start + LANES];
            factor_diagonal(diagonal, inverse);
            let first = std::iter::repeat_n(0, columns / LANES - block - 1);
            let first = first.chain(self.first.iter().copied());
            for (row, first) in below.chunks_exact_mut(columns).zip(first) {
                let (done, rest) = row.split_at_mut(start);
                if let Some(tile) = rest.first_chunk_mut::<LANES>()
                    && first <= start
                {
                    subtract_products(tile, &done[first..], &own[first..]);
                    divide(tile, diagonal, inverse);
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
fn subtract_products(tile: &mut Tile, left: &[ComplexLanes], right: &[ComplexLanes]) {
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
fn subtract(sum: &mut ComplexLanes, column: &ComplexLanes, x: [f64; 2]) {
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
fn scale(column: &mut ComplexLanes, factor: [f64; 2]) {
    let mut product = [[0.0; LANES]; 2];
    add_times_lanes(&mut product, column, factor);
    *column = product;
}

#[inline(always)]
fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
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

/// Sum of the products of two columns of complex numbers.
#[inline(always)]
fn sum_of_products(sums: ComplexLanes) -> [f64; 2] {
    sums.map(|part| part.into_iter().sum())
}

/// `sum += a b`, lane by lane.
#[inline(always)]
fn add_products(sum: &mut ComplexLanes, a: &ComplexLanes, b: &ComplexLanes) {
    for lane in 0..LANES {
        sum[0][lane] += a[0][lane] * b[0][lane] - a[1][lane] * b[1][lane];
        sum[1][lane] += a[0][lane] * b[1][lane] + a[1][lane] * b[0][lane];
    }
}

struct Elimination<'a>(&'a mut ComplexCholesky, &'a ComplexSymmetric<'a>);

impl Loops for Elimination<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.assemble(self.1);
        self.0.eliminate();
    }
}

struct SchurComplement<'a>(&'a ComplexCholesky, [&'a mut [f64]; 2]);

impl Loops for SchurComplement<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, target) = self;
        let m = factors.rows;
        for (a, (first, left)) in factors.border_blocks().enumerate() {
            for (b, (other, right)) in factors.border_blocks().take(a + 1).enumerate() {
                let from = first.max(other);
                let mut tile = [[[0.0; LANES]; 2]; LANES];
                subtract_products(&mut tile, &left[from - first..], &right[from - other..]);
                for (q, column) in tile.iter().enumerate().take(m - b * LANES) {
                    for lane in 0..LANES.min(m - a * LANES) {
                        let (i, j) = (a * LANES + lane, b * LANES + q);
                        for part in 0..2 {
                            target[part][j * m + i] = -column[part][lane];
                            target[part][i * m + j] = -column[part][lane];
                        }
                    }
                }
            }
        }
    }
}

struct Forward<'a>(&'a ComplexCholesky, &'a mut BlockVector);

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
            let own = &mut rest[0];
            let (tiles, _) = row.as_chunks::<LANES>();
            for (tile, x) in tiles.iter().zip(&*done) {
                for (q, column) in tile.iter().enumerate() {
                    subtract(own, column, [x[0][q], x[1][q]]);
                }
            }
            for (p, column) in tiles[block].iter().enumerate() {
                let inverse = factors.inverse[block * LANES + p];
                let x = times([own[0][p], own[1][p]], inverse);
                subtract(own, column, x);
                [own[0][p], own[1][p]] = x;
            }
        }
    }
}

struct Backward<'a>(&'a ComplexCholesky, &'a mut BlockVector);

impl Loops for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, BlockVector(x)) = self;
        let columns = factors.columns();
        for block in (0..x.len()).rev() {
            let start = block * LANES;
            let (rest, done) = x.split_at_mut(block + 1);
            let own = &mut rest[block];
            let below = factors.lower[(block + 1) * columns..].chunks_exact(columns);
            for first in (0..LANES).step_by(TOGETHER) {
                let mut sums = [[[0.0; LANES]; 2]; TOGETHER];
                for (row, x) in below.clone().zip(&*done) {
                    for (k, sum) in sums.iter_mut().enumerate() {
                        add_products(sum, &row[start + first + k], x);
                    }
                }
                for (k, sum) in sums.into_iter().enumerate() {
                    let sum = sum_of_products(sum);
                    own[0][first + k] -= sum[0];
                    own[1][first + k] -= sum[1];
                }
            }
            let diagonal = &factors.lower[block * columns + start..][..LANES];
            for p in (0..LANES).rev() {
                let x = times([own[0][p], own[1][p]], factors.inverse[start + p]);
                [own[0][p], own[1][p]] = x;
                for (q, column) in diagonal[..p].iter().enumerate() {
                    let product = times([column[0][p], column[1][p]], x);
                    own[0][q] -= product[0];
                    own[1][q] -= product[1];
                }
            }
        }
    }
}

struct BorderTimes<'a>(&'a ComplexCholesky, &'a BlockVector);

impl Loops for BorderTimes<'_> {
    type Output = BlockVector;

    #[inline(always)]
    fn call(self) -> BlockVector {
        let Self(factors, BlockVector(x)) = self;
        let products = factors.border_blocks().map(|(first, block)| {
            let mut sum = [[0.0; LANES]; 2];
            let (tiles, _) = block.as_chunks::<LANES>();
            for (tile, x) in tiles.iter().zip(&x[first / LANES..]) {
                for (q, column) in tile.iter().enumerate() {
                    add_times_lanes(&mut sum, column, [x[0][q], x[1][q]]);
                }
            }
            sum
        });
        BlockVector(products.collect())
    }
}

struct BorderTransposed<'a>(
    &'a ComplexCholesky,
    &'a mut BlockVector,
    f64,
    &'a BlockVector,
);

impl Loops for BorderTransposed<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(factors, BlockVector(sum), factor, BlockVector(forces)) = self;
        for ((first, block), forces) in factors.border_blocks().zip(forces) {
            let (tiles, _) = block.as_chunks::<LANES>();
            for (tile, sum) in tiles.iter().zip(&mut sum[first / LANES..]) {
                for (q, column) in tile.iter().enumerate() {
                    let mut products = [[0.0; LANES]; 2];
                    add_products(&mut products, column, forces);
                    let [re, im] = sum_of_products(products);
                    sum[0][q] += factor * re;
                    sum[1][q] += factor * im;
                }
            }
        }
    }
}
