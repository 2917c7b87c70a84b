//! Sparse Hermitian matrices: factor once, solve many, and the lowest modes by shift-invert.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use std::cmp::Ordering;

use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Side, prelude::Solve};

use super::Complex64;
use super::dense::{NotPositiveDefinite, hermitian_eigen, hermitian_eigenvalues, sequential};
use super::matrix::Matrix;
use super::vectors::{Loops, vectorized};

/// Complex Hermitian sparse matrix, both triangles stored.
#[derive(Debug, Clone)]
pub struct HermitianSparse {
    matrix: SparseColMat<usize, Complex64>,
}

/// Cholesky factor of a [`HermitianSparse`] matrix.
#[derive(Debug, Clone)]
pub struct SparseFactor {
    factor: Llt<usize, Complex64>,
}

impl HermitianSparse {
    /// Sums triplets `(row, column, value)` of the whole matrix.
    ///
    /// # Panics
    /// If an index is out of range, a defect of the caller.
    #[must_use]
    pub fn from_triplets(
        dimension: usize,
        entries: impl IntoIterator<Item = (usize, usize, Complex64)>,
    ) -> Self {
        let triplets: Vec<Triplet<usize, usize, Complex64>> = entries
            .into_iter()
            .map(|(row, column, value)| Triplet::new(row, column, value))
            .collect();
        let matrix = SparseColMat::try_new_from_triplets(dimension, dimension, &triplets);
        Self {
            matrix: matrix.expect("indices lie inside the matrix"),
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.matrix.nrows()
    }

    /// Stored entries `(row, column, value)`.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, Complex64)> + '_ {
        self.matrix
            .triplet_iter()
            .map(|entry| (entry.row, entry.col, *entry.val))
    }

    /// `self + factor * other`.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        Self::from_triplets(
            self.dimension(),
            self.entries()
                .chain(other.entries().map(|(i, j, value)| (i, j, value * factor))),
        )
    }

    /// Sub-matrix of the given rows and columns as sparse (square) matrix.
    #[must_use]
    pub fn principal(&self, kept: &[usize]) -> Self {
        let place = places(self.dimension(), kept);
        Self::from_triplets(
            kept.len(),
            self.entries()
                .filter_map(|(i, j, value)| Some((place[i]?, place[j]?, value))),
        )
    }

    /// Sub-matrix of the given rows and columns as dense matrix.
    #[must_use]
    pub fn block(&self, rows: &[usize], columns: &[usize]) -> Matrix<Complex64> {
        let row_place = places(self.dimension(), rows);
        let column_place = places(self.dimension(), columns);
        let mut block = Matrix::zeros(rows.len(), columns.len());
        for (i, j, value) in self.entries() {
            if let (Some(row), Some(column)) = (row_place[i], column_place[j]) {
                block[(row, column)] += value;
            }
        }
        block
    }

    /// Product with a dense matrix.
    #[must_use]
    pub fn times(&self, x: &Matrix<Complex64>) -> Matrix<Complex64> {
        let mut y = Matrix::zeros(self.dimension(), x.columns());
        if x.columns() <= 4 {
            self.product_by::<4>(x, &mut y);
        } else {
            self.product_by::<8>(x, &mut y);
        }
        y
    }

    /// `y = self x`, so many columns at once, side by side, so that every entry of the matrix is read once for all of them.
    fn product_by<const LANES: usize>(&self, x: &Matrix<Complex64>, y: &mut Matrix<Complex64>) {
        let n = self.dimension();
        let mut source = vec![Lanes::<LANES>::default(); n];
        let mut target = vec![Lanes::<LANES>::default(); n];
        for first in (0..x.columns()).step_by(LANES) {
            let lanes = LANES.min(x.columns() - first);
            for lane in 0..lanes {
                for (source, value) in source.iter_mut().zip(x.column(first + lane)) {
                    (source.re[lane], source.im[lane]) = (value.re, value.im);
                }
            }
            target.fill(Lanes::default());
            vectorized(LanesProduct {
                matrix: &self.matrix,
                source: &source,
                target: &mut target,
            });
            for lane in 0..lanes {
                let column = y.column_mut(first + lane);
                for (value, target) in column.iter_mut().zip(&target) {
                    *value = Complex64::new(target.re[lane], target.im[lane]);
                }
            }
        }
    }

    /// Cholesky factorisation.
    ///
    /// # Errors
    /// If the matrix is not positive definite.
    pub fn factor(&self) -> Result<SparseFactor, NotPositiveDefinite> {
        sequential();
        let symbolic = SymbolicLlt::try_new(self.matrix.symbolic(), Side::Lower)
            .map_err(|_| NotPositiveDefinite)?;
        let factor = Llt::try_new_with_symbolic(symbolic, self.matrix.as_ref(), Side::Lower)
            .map_err(|_| NotPositiveDefinite)?;
        Ok(SparseFactor { factor })
    }
}

/// One row of the columns of a dense matrix that a product takes at once.
#[derive(Clone, Copy)]
struct Lanes<const LANES: usize> {
    re: [f64; LANES],
    im: [f64; LANES],
}

impl<const LANES: usize> Default for Lanes<LANES> {
    fn default() -> Self {
        Self {
            re: [0.0; LANES],
            im: [0.0; LANES],
        }
    }
}

/// `target += matrix source`.
struct LanesProduct<'a, const LANES: usize> {
    matrix: &'a SparseColMat<usize, Complex64>,
    source: &'a [Lanes<LANES>],
    target: &'a mut [Lanes<LANES>],
}

impl<const LANES: usize> Loops for LanesProduct<'_, LANES> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let pattern = self.matrix.as_ref();
        for (j, source) in self.source.iter().enumerate() {
            let rows = pattern.symbolic().row_idx_of_col_raw(j);
            for (&row, &value) in rows.iter().zip(pattern.val_of_col(j)) {
                self.target[row].add_product(value, source);
            }
        }
    }
}

impl<const LANES: usize> Lanes<LANES> {
    #[inline(always)]
    fn add_product(&mut self, factor: Complex64, x: &Self) {
        // Only what couples a sector to its neighbour is complex.
        if factor.im == 0.0 {
            for lane in 0..LANES {
                self.re[lane] += factor.re * x.re[lane];
                self.im[lane] += factor.re * x.im[lane];
            }
            return;
        }
        for lane in 0..LANES {
            self.re[lane] += factor.re * x.re[lane] - factor.im * x.im[lane];
            self.im[lane] += factor.re * x.im[lane] + factor.im * x.re[lane];
        }
    }
}

fn places(dimension: usize, kept: &[usize]) -> Vec<Option<usize>> {
    let mut place = vec![None; dimension];
    for (at, &index) in kept.iter().enumerate() {
        place[index] = Some(at);
    }
    place
}

impl SparseFactor {
    /// Solves `A X = B`.
    #[must_use]
    pub fn solve(&self, right: &Matrix<Complex64>) -> Matrix<Complex64> {
        let mut solution = right.clone();
        self.factor.solve_in_place(solution.view_mut());
        solution
    }
}

/// The `count` lowest eigenvalues above `shift` and M-orthonormal eigenvectors of
/// `K x = lambda M x`, given the factor of `K - shift M` (positive definite).
///
/// Block shift-invert Lanczos in the M inner product with full reorthogonalisation: the block
/// finds multiple eigenvalues, which bladed disks always have; the M inner product keeps the
/// operator Hermitian. Starting vectors are fixed and real, so that the answer is reproducible
/// and a real pencil keeps real vectors.
///
/// # Errors
/// If the projected problem breaks down on values that are not finite.
pub fn lowest_modes(
    factor: &SparseFactor,
    m: &HermitianSparse,
    shift: f64,
    count: usize,
) -> Result<(Vec<f64>, Matrix<Complex64>), NotPositiveDefinite> {
    const BLOCK: usize = 4;
    const TOLERANCE: f64 = 1e-12;
    /// Growth of the basis, over its size, between two looks at the values.
    const GROWTH: f64 = 1.0 / 16.0;
    let n = m.dimension();
    let count = count.min(n);
    let mut block = Matrix::from_fn(n, BLOCK.min(n), |i, j| {
        Complex64::new(start_value(i * BLOCK + j), 0.0)
    });
    // Basis Q and M Q; columns of the projection T = Q^H M (K - shift M)^-1 M Q, down to the block of its diagonal.
    let mut q = Matrix::zeros(n, 0);
    let mut mq = Matrix::zeros(n, 0);
    let mut columns: Vec<Vec<Complex64>> = Vec::new();
    let mut previous: Vec<f64> = Vec::new();
    let mut next_look = (count + 2 * BLOCK).min(n);
    loop {
        let fresh = orthonormalise_against(&q, &mq, &block, m);
        let exhausted = fresh.columns() == 0;
        if !exhausted {
            let m_fresh = m.times(&fresh);
            block = factor.solve(&m_fresh);
            q.append(&fresh);
            mq.append(&m_fresh);
            let above = mq.adjoint_times(&block);
            columns.extend((0..above.columns()).map(|column| above.column(column).to_vec()));
            if q.columns() < next_look {
                continue;
            }
        }
        // The largest values of T are wanted.
        let projected = hermitian_of(&columns);
        let theta = hermitian_eigenvalues(&projected)?;
        let values = theta.iter().rev().take(count);
        let values: Vec<f64> = values.map(|theta| shift + 1.0 / theta).collect();
        let settled = previous.len() == values.len()
            && previous
                .iter()
                .zip(&values)
                .all(|(old, new)| (old - new).abs() <= TOLERANCE * (new - shift).abs());
        if settled || exhausted || q.columns() >= n {
            let (theta, vectors) = hermitian_eigen(&projected)?;
            let size = theta.len();
            let wanted = size - count.min(size)..size;
            let values = theta[wanted.clone()].iter().rev();
            let values = values.map(|theta| shift + 1.0 / theta).collect();
            let chosen = Matrix::from_fn(size, wanted.len(), |i, j| vectors[(i, size - 1 - j)]);
            return Ok((values, q.times(&chosen)));
        }
        previous = values;
        let growth = (GROWTH * q.columns() as f64) as usize;
        next_look = (q.columns() + growth.max(BLOCK)).min(n);
    }
}

/// The Hermitian matrix with these columns, of which each is known down to its diagonal at least.
fn hermitian_of(columns: &[Vec<Complex64>]) -> Matrix<Complex64> {
    let size = columns.len();
    Matrix::from_fn(size, size, |i, j| match i.cmp(&j) {
        Ordering::Less => columns[j][i],
        Ordering::Equal => Complex64::new(columns[j][j].re, 0.0),
        Ordering::Greater => columns[i][j].conj(),
    })
}

/// Fixed, irregular numbers in (-1, 1): golden-ratio multiples modulo 1.
fn start_value(i: usize) -> f64 {
    2.0 * ((i as f64 + 1.0) * 0.618_033_988_749_894_9).fract() - 1.0
}

/// The part of `block` that is M-orthogonal to Q, M-orthonormalised; columns that vanish are left out. What rounding leaves of Q is
/// taken off a second time, and again while that still takes off much.
fn orthonormalise_against(
    q: &Matrix<Complex64>,
    mq: &Matrix<Complex64>,
    block: &Matrix<Complex64>,
    m: &HermitianSparse,
) -> Matrix<Complex64> {
    const TURNS: usize = 4;
    const MUCH: f64 = 0.5;
    let (mut block, _) = orthonormalise_once(q, mq, block, m);
    for _ in 1..TURNS {
        let (next, least) = orthonormalise_once(q, mq, &block, m);
        block = next;
        if least > 1.0 - MUCH {
            break;
        }
    }
    block
}

/// One turn of [`orthonormalise_against`], and the smallest norm of a column before it is scaled to 1.
fn orthonormalise_once(
    q: &Matrix<Complex64>,
    mq: &Matrix<Complex64>,
    block: &Matrix<Complex64>,
    m: &HermitianSparse,
) -> (Matrix<Complex64>, f64) {
    let mut block = block.clone();
    let outside = mq.adjoint_times(&block);
    subtract(&mut block, q, &outside);
    // A candidate and its product with M are changed alike, so that M is multiplied once for the whole block, and again only for
    // a candidate of which little is left.
    let m_block = m.times(&block);
    let mut kept = Matrix::zeros(block.rows(), 0);
    let mut m_kept = Matrix::zeros(block.rows(), 0);
    let mut least = f64::INFINITY;
    for column in 0..block.columns() {
        let mut candidate = block.column_range(column, column + 1);
        let mut m_candidate = m_block.column_range(column, column + 1);
        let before = norm(&candidate, &m_candidate);
        for _ in 0..2 {
            let inside = m_kept.adjoint_times(&candidate);
            subtract(&mut candidate, &kept, &inside);
            subtract(&mut m_candidate, &m_kept, &inside);
        }
        if norm(&candidate, &m_candidate) < LITTLE * before {
            m_candidate = m.times(&candidate);
        }
        let norm = norm(&candidate, &m_candidate);
        if norm > 1e-10 * before && norm > 0.0 {
            least = least.min(norm);
            for vector in [&mut candidate, &mut m_candidate] {
                for entry in vector.as_mut_slice() {
                    *entry /= norm;
                }
            }
            m_kept.append(&m_candidate);
            kept.append(&candidate);
        }
    }
    (kept, least)
}

/// Share of a vector's norm below which its product with M is made anew.
const LITTLE: f64 = 1e-3;

/// `x -= basis parts`.
fn subtract(x: &mut Matrix<Complex64>, basis: &Matrix<Complex64>, parts: &Matrix<Complex64>) {
    if basis.columns() == 0 {
        return;
    }
    let part = basis.times(parts);
    for (entry, &part) in x.as_mut_slice().iter_mut().zip(part.as_slice()) {
        *entry -= part;
    }
}

/// Norm of a vector in the inner product of M, given its product with M.
fn norm(x: &Matrix<Complex64>, mx: &Matrix<Complex64>) -> f64 {
    x.adjoint_times(mx)[(0, 0)].re.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense::hermitian_pencil;

    /// A ring of masses: every eigenvalue but the first and last is double.
    fn ring(n: usize) -> (HermitianSparse, HermitianSparse) {
        let one = Complex64::new(1.0, 0.0);
        let k = (0..n).flat_map(|i| {
            let next = (i + 1) % n;
            [(i, i, one * 2.1), (i, next, -one), (next, i, -one)]
        });
        let m = (0..n).map(|i| (i, i, one * 2.0));
        (
            HermitianSparse::from_triplets(n, k),
            HermitianSparse::from_triplets(n, m),
        )
    }

    #[test]
    fn lowest_modes_finds_every_double_eigenvalue_and_stays_real() {
        let n = 200;
        let (k, m) = ring(n);
        let all: Vec<usize> = (0..n).collect();
        let dense = hermitian_pencil(&k.block(&all, &all), &m.block(&all, &all)).expect("definite");
        let (values, vectors) =
            lowest_modes(&k.factor().expect("definite"), &m, 0.0, 12).expect("finite");
        for (value, exact) in values.iter().zip(&dense.0) {
            assert!((value - exact).abs() < 1e-11 * exact, "{value} {exact}");
        }
        assert!(vectors.as_slice().iter().all(|x| x.im == 0.0));
        let residual = k.times(&vectors);
        let mx = m.times(&vectors);
        for j in 0..12 {
            for i in 0..n {
                assert!((residual[(i, j)] - mx[(i, j)] * values[j]).norm() < 1e-6);
            }
        }
    }

    /// So many that the basis grows by more than a block between two looks.
    #[test]
    fn half_of_all_modes_are_those_of_the_dense_pencil_and_orthonormal() {
        let (n, count) = (240, 120);
        let (k, m) = ring(n);
        let all: Vec<usize> = (0..n).collect();
        let dense = hermitian_pencil(&k.block(&all, &all), &m.block(&all, &all)).expect("definite");
        let factor = k.factor().expect("definite");
        let (values, vectors) = lowest_modes(&factor, &m, 0.0, count).expect("finite");
        assert_eq!(values.len(), count);
        for (value, exact) in values.iter().zip(&dense.0) {
            assert!((value - exact).abs() < 1e-11 * exact, "{value} {exact}");
        }
        let gram = vectors.adjoint_times(&m.times(&vectors));
        for i in 0..count {
            for j in 0..count {
                let wanted = f64::from(u8::from(i == j));
                assert!((gram[(i, j)] - wanted).norm() < 1e-11, "{i} {j}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_no_cholesky_factor() {
        let one = Complex64::new(1.0, 0.0);
        let matrix = HermitianSparse::from_triplets(
            2,
            [(0, 0, one), (0, 1, one), (1, 0, one), (1, 1, one * 0.5)],
        );
        assert!(matrix.factor().is_err());
    }
}
