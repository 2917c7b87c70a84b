//! A dense column-major matrix whose numbers lie in a plain, fully initialised vector.

use faer::linalg::matmul::matmul;
use faer::traits::ComplexField;
use faer::{Accum, MatMut, MatRef, Par};
use serde::{Deserialize, Serialize};

use super::Complex64;

/// Scalars of the project: `f64` and `Complex64`.
pub trait Scalar: ComplexField + Copy + PartialEq + Default + std::fmt::Debug {
    /// From a real number.
    fn from_real(real: f64) -> Self;
    /// Complex conjugate.
    #[must_use]
    fn conjugate(self) -> Self;
    /// Real part.
    fn real_part(self) -> f64;
    /// As a complex number.
    fn to_complex(self) -> Complex64;
    /// Appends the real numbers that store the value.
    fn store(self, parts: &mut Vec<f64>);
    /// Number of real numbers that store a value.
    const PARTS: usize;
    /// From its stored real numbers, of which there are [`Self::PARTS`].
    fn load(parts: &[f64]) -> Self;
}

impl Scalar for f64 {
    fn from_real(real: f64) -> Self {
        real
    }
    fn conjugate(self) -> Self {
        self
    }
    fn real_part(self) -> f64 {
        self
    }
    fn to_complex(self) -> Complex64 {
        Complex64::new(self, 0.0)
    }
    fn store(self, parts: &mut Vec<f64>) {
        parts.push(self);
    }
    const PARTS: usize = 1;
    fn load(parts: &[f64]) -> Self {
        parts[0]
    }
}

impl Scalar for Complex64 {
    fn from_real(real: f64) -> Self {
        Self::new(real, 0.0)
    }
    fn conjugate(self) -> Self {
        self.conj()
    }
    fn real_part(self) -> f64 {
        self.re
    }
    fn to_complex(self) -> Complex64 {
        self
    }
    fn store(self, parts: &mut Vec<f64>) {
        parts.extend([self.re, self.im]);
    }
    const PARTS: usize = 2;
    fn load(parts: &[f64]) -> Self {
        Self::new(parts[0], parts[1])
    }
}

/// Dense `rows x columns` matrix, column-major without padding.
///
/// faer's own matrix pads its columns with uninitialised memory, and arithmetic on subnormal
/// leftovers there is up to a hundred times slower; hence a plain vector viewed by faer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "StoredMatrix", try_from = "StoredMatrix")]
#[serde(bound = "T: Scalar")]
pub struct Matrix<T> {
    rows: usize,
    columns: usize,
    data: Vec<T>,
}

/// A matrix as it is written to disk: its size and the real numbers of its entries.
#[derive(Serialize, Deserialize)]
struct StoredMatrix {
    rows: usize,
    columns: usize,
    parts: Vec<f64>,
}

impl<T: Scalar> From<Matrix<T>> for StoredMatrix {
    fn from(matrix: Matrix<T>) -> Self {
        let mut parts = Vec::with_capacity(matrix.data.len() * T::PARTS);
        for &entry in &matrix.data {
            entry.store(&mut parts);
        }
        Self {
            rows: matrix.rows,
            columns: matrix.columns,
            parts,
        }
    }
}

impl<T: Scalar> TryFrom<StoredMatrix> for Matrix<T> {
    type Error = String;
    fn try_from(stored: StoredMatrix) -> Result<Self, String> {
        let data: Vec<T> = stored.parts.chunks_exact(T::PARTS).map(T::load).collect();
        if stored.rows.checked_mul(stored.columns) != Some(data.len()) {
            return Err(format!(
                "a {} x {} matrix holds {} numbers",
                stored.rows,
                stored.columns,
                data.len()
            ));
        }
        Ok(Self {
            rows: stored.rows,
            columns: stored.columns,
            data,
        })
    }
}

impl<T: Scalar> Matrix<T> {
    /// All zero.
    #[must_use]
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            data: vec![T::default(); rows * columns],
        }
    }

    /// Entry by entry.
    #[must_use]
    pub fn from_fn(rows: usize, columns: usize, mut entry: impl FnMut(usize, usize) -> T) -> Self {
        let mut data = Vec::with_capacity(rows * columns);
        for column in 0..columns {
            for row in 0..rows {
                data.push(entry(row, column));
            }
        }
        Self {
            rows,
            columns,
            data,
        }
    }

    /// Identity.
    #[must_use]
    pub fn identity(n: usize) -> Self {
        Self::from_fn(n, n, |i, j| T::from_real(f64::from(u8::from(i == j))))
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// One column.
    #[must_use]
    pub fn column(&self, column: usize) -> &[T] {
        &self.data[column * self.rows..(column + 1) * self.rows]
    }

    /// One column, mutable.
    pub fn column_mut(&mut self, column: usize) -> &mut [T] {
        &mut self.data[column * self.rows..(column + 1) * self.rows]
    }

    /// All entries, column by column.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        &self.data
    }

    /// All entries, column by column, mutable.
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// Sets every entry to `value`.
    pub fn fill(&mut self, value: T) {
        self.data.fill(value);
    }

    /// Conjugate transpose.
    #[must_use]
    pub fn adjoint(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |i, j| self[(j, i)].conjugate())
    }

    /// Complex conjugate, entry by entry.
    #[must_use]
    pub fn conjugate(&self) -> Self {
        Self::from_fn(self.rows, self.columns, |i, j| self[(i, j)].conjugate())
    }

    /// Sub-matrix of the given rows, in the given order.
    #[must_use]
    pub fn select_rows(&self, rows: &[usize]) -> Self {
        Self::from_fn(rows.len(), self.columns, |i, j| self[(rows[i], j)])
    }

    /// The columns `start..end`.
    #[must_use]
    pub fn column_range(&self, start: usize, end: usize) -> Self {
        Self {
            rows: self.rows,
            columns: end - start,
            data: self.data[start * self.rows..end * self.rows].to_vec(),
        }
    }

    /// `[self, other]`, side by side.
    ///
    /// # Panics
    /// If the numbers of rows differ, a defect of the caller.
    #[must_use]
    pub fn beside(&self, other: &Self) -> Self {
        let mut both = self.clone();
        both.append(other);
        both
    }

    /// Appends the columns of another matrix.
    ///
    /// # Panics
    /// If the numbers of rows differ, a defect of the caller.
    pub fn append(&mut self, other: &Self) {
        assert_eq!(
            self.rows, other.rows,
            "matrices side by side need equal row counts"
        );
        self.data.extend_from_slice(&other.data);
        self.columns += other.columns;
    }

    /// Sum of absolute squares.
    #[must_use]
    pub fn squared_norm(&self) -> f64 {
        self.data
            .iter()
            .map(|&entry| (entry * entry.conjugate()).real_part())
            .sum()
    }

    /// Product `self * other`.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.rows, other.columns);
        multiply(product.view_mut(), self.view(), other.view());
        product
    }

    /// Product `self * other^H`.
    #[must_use]
    pub fn times_adjoint(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.rows, other.rows);
        matmul(
            product.view_mut(),
            Accum::Replace,
            self.view(),
            other.view().adjoint(),
            T::from_real(1.0),
            Par::Seq,
        );
        product
    }

    /// Product `self^H * other`.
    #[must_use]
    pub fn adjoint_times(&self, other: &Self) -> Self {
        let mut product = Self::zeros(self.columns, other.columns);
        matmul(
            product.view_mut(),
            Accum::Replace,
            self.view().adjoint(),
            other.view(),
            T::from_real(1.0),
            Par::Seq,
        );
        product
    }

    /// Product `self * x` with a vector of length `columns`.
    #[must_use]
    pub fn times_vector(&self, x: &[T]) -> Vec<T> {
        let mut y = vec![T::default(); self.rows];
        for (column, &factor) in x.iter().enumerate() {
            for (sum, &entry) in y.iter_mut().zip(self.column(column)) {
                *sum += entry * factor;
            }
        }
        y
    }

    /// Product `self^H * x` with a vector of length `rows`.
    #[must_use]
    pub fn adjoint_times_vector(&self, x: &[T]) -> Vec<T> {
        (0..self.columns)
            .map(|column| {
                self.column(column)
                    .iter()
                    .zip(x)
                    .fold(T::default(), |sum, (&entry, &factor)| {
                        sum + entry.conjugate() * factor
                    })
            })
            .collect()
    }

    /// Entries as complex numbers.
    #[must_use]
    pub fn to_complex(&self) -> Matrix<Complex64> {
        Matrix::from_fn(self.rows, self.columns, |i, j| self[(i, j)].to_complex())
    }

    pub(super) fn view(&self) -> MatRef<'_, T> {
        MatRef::from_column_major_slice(&self.data, self.rows, self.columns)
    }

    pub(super) fn view_mut(&mut self) -> MatMut<'_, T> {
        MatMut::from_column_major_slice_mut(&mut self.data, self.rows, self.columns)
    }

    pub(super) fn from_view(view: MatRef<'_, T>) -> Self {
        Self::from_fn(view.nrows(), view.ncols(), |i, j| view[(i, j)])
    }
}

impl Matrix<Complex64> {
    /// Real parts.
    #[must_use]
    pub fn real(&self) -> Matrix<f64> {
        Matrix::from_fn(self.rows, self.columns, |i, j| self[(i, j)].re)
    }

    /// Imaginary parts.
    #[must_use]
    pub fn imaginary(&self) -> Matrix<f64> {
        Matrix::from_fn(self.rows, self.columns, |i, j| self[(i, j)].im)
    }
}

impl<T> std::ops::Index<(usize, usize)> for Matrix<T> {
    type Output = T;
    fn index(&self, (row, column): (usize, usize)) -> &T {
        &self.data[column * self.rows + row]
    }
}

impl<T> std::ops::IndexMut<(usize, usize)> for Matrix<T> {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut T {
        &mut self.data[column * self.rows + row]
    }
}

fn multiply<T: Scalar>(product: MatMut<'_, T>, left: MatRef<'_, T>, right: MatRef<'_, T>) {
    matmul(
        product,
        Accum::Replace,
        left,
        right,
        T::from_real(1.0),
        Par::Seq,
    );
}

/// `product = left right`, as [`add_times`].
pub fn set_times(
    product: &mut [f64],
    left: &[f64],
    right: &[f64],
    (m, n, k): (usize, usize, usize),
) {
    matmul(
        MatMut::from_column_major_slice_mut(product, m, n),
        Accum::Replace,
        MatRef::from_column_major_slice(left, m, k),
        MatRef::from_column_major_slice(right, k, n),
        1.0,
        Par::Seq,
    );
}

/// `product += left right`, all column-major and contiguous: `left` is `m x k`, `right` is `k x n`. Nothing
/// is allocated.
pub fn add_times(
    product: &mut [f64],
    left: &[f64],
    right: &[f64],
    (m, n, k): (usize, usize, usize),
) {
    matmul(
        MatMut::from_column_major_slice_mut(product, m, n),
        Accum::Add,
        MatRef::from_column_major_slice(left, m, k),
        MatRef::from_column_major_slice(right, k, n),
        1.0,
        Par::Seq,
    );
}

/// `product += factor left^T right` into a block of a larger column-major matrix: `product` starts
/// at the block's first entry and has `stride` rows, the block is `m x n`, `left` is `k x m`,
/// `right` is `k x n`. Nothing is allocated.
pub fn add_transpose_times(
    product: &mut [f64],
    stride: usize,
    factor: f64,
    left: &[f64],
    right: &[f64],
    (m, n, k): (usize, usize, usize),
) {
    matmul(
        MatMut::from_column_major_slice_with_stride_mut(product, m, n, stride),
        Accum::Add,
        MatRef::from_column_major_slice(left, k, m).transpose(),
        MatRef::from_column_major_slice(right, k, n),
        factor,
        Par::Seq,
    );
}

/// `y += factor A x` for a column-major `A` with `y.len()` rows.
pub fn add_times_vector(y: &mut [f64], factor: f64, a: &[f64], x: &[f64]) {
    let rows = y.len();
    if rows == 0 {
        return;
    }
    for (column, &x) in a.chunks_exact(rows).zip(x) {
        let scale = factor * x;
        for (sum, &entry) in y.iter_mut().zip(column) {
            *sum += scale * entry;
        }
    }
}

/// `y += factor A^T x` for a column-major `A` with `x.len()` rows.
pub fn add_transpose_times_vector(y: &mut [f64], factor: f64, a: &[f64], x: &[f64]) {
    let rows = x.len();
    if rows == 0 {
        return;
    }
    for (sum, column) in y.iter_mut().zip(a.chunks_exact(rows)) {
        *sum += factor * dot(column, x);
    }
}

/// Sum of `a_j b_j` in eight partial sums, which a compiler can vectorise; the order of summation
/// is fixed.
#[inline]
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.into_iter().sum::<f64>() + rest
}
