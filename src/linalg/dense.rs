//! Dense Hermitian eigenproblems and bases orthonormal in the metric of a mass matrix.

use std::sync::Once;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{
    ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch,
};
use faer::{Auto, Par, Side, Spec};

use super::Complex64;
use super::matrix::{Matrix, Scalar};

/// The mass matrix of a pencil is not positive definite, or a decomposition broke down on
/// values that are not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite")]
pub struct NotPositiveDefinite;

/// Keeps faer sequential: the parallelism of this project is over patterns and nodal diameters.
pub(super) fn sequential() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| faer::set_global_parallelism(Par::Seq));
}

/// Eigenvalues, ascending, and orthonormal eigenvectors (columns) of a Hermitian matrix, whose
/// lower triangle is read.
///
/// # Errors
/// If the matrix holds values that are not finite.
pub fn hermitian_eigen<T: Scalar>(
    a: &Matrix<T>,
) -> Result<(Vec<f64>, Matrix<T>), NotPositiveDefinite> {
    let mut vectors = Matrix::<T>::zeros(a.rows(), a.rows());
    let values = decompose(a, Some(&mut vectors))?;
    Ok((values, vectors))
}

/// Eigenvalues, ascending, of a Hermitian matrix, whose lower triangle is read.
///
/// # Errors
/// If the matrix holds values that are not finite.
pub fn hermitian_eigenvalues<T: Scalar>(a: &Matrix<T>) -> Result<Vec<f64>, NotPositiveDefinite> {
    decompose(a, None)
}

/// Eigenvalues, and the eigenvectors where there is room for them.
fn decompose<T: Scalar>(
    a: &Matrix<T>,
    vectors: Option<&mut Matrix<T>>,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let n = a.rows();
    // faer's divide and conquer (0.24) returns vectors with residuals up to 1e-5 of the norm on
    // mistuned wheels, whose eigenvalues come in clusters; its QR algorithm is backward stable.
    let params: Spec<SelfAdjointEvdParams, T> = Spec::new(SelfAdjointEvdParams {
        recursion_threshold: usize::MAX,
        ..<SelfAdjointEvdParams as Auto<T>>::auto()
    });
    let wanted = if vectors.is_some() {
        ComputeEigenvectors::Yes
    } else {
        ComputeEigenvectors::No
    };
    let mut values = Matrix::<T>::zeros(n, 1);
    let need = self_adjoint_evd_scratch::<T>(n, wanted, Par::Seq, params);
    self_adjoint_evd(
        a.view(),
        values.view_mut().col_mut(0).as_diagonal_mut(),
        vectors.map(Matrix::view_mut),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(need)),
        params,
    )
    .map_err(|_| NotPositiveDefinite)?;
    let values = values.column(0).iter();
    let values: Vec<f64> = values.map(|value| value.real_part()).collect();
    let is_finite = values.iter().all(|value| value.is_finite());
    is_finite.then_some(values).ok_or(NotPositiveDefinite)
}

/// Eigenvalues, ascending, and M-orthonormal eigenvectors of `K x = lambda M x`; K Hermitian,
/// M Hermitian positive definite.
///
/// # Errors
/// If M is not positive definite.
pub fn hermitian_pencil<T: Scalar>(
    k: &Matrix<T>,
    m: &Matrix<T>,
) -> Result<(Vec<f64>, Matrix<T>), NotPositiveDefinite> {
    sequential();
    let factor = m.view().llt(Side::Lower).map_err(|_| NotPositiveDefinite)?;
    // L^-1 K L^-H, by two triangular solves.
    let mut half = k.clone();
    factor.L().solve_lower_triangular_in_place(half.view_mut());
    let mut reduced = half.adjoint();
    factor
        .L()
        .solve_lower_triangular_in_place(reduced.view_mut());
    let (values, mut vectors) = hermitian_eigen(&reduced)?;
    factor
        .L()
        .adjoint()
        .solve_upper_triangular_in_place(vectors.view_mut());
    Ok((values, vectors))
}

/// An M-orthonormal basis with the singular values it was cut by.
#[derive(Debug, Clone)]
pub struct OrthonormalBasis<T> {
    /// Columns span the retained part of the input, `V^H M V = I`.
    pub vectors: Matrix<T>,
    /// All singular values of the input columns (scaled to unit M-norm) in the metric of M, descending.
    pub singular_values: Vec<f64>,
}

impl<T: Scalar> OrthonormalBasis<T> {
    /// Retained number of columns.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.vectors.columns()
    }

    /// Ratio of the largest to the smallest retained singular value.
    #[must_use]
    pub fn condition(&self) -> f64 {
        match self.rank() {
            0 => 1.0,
            rank => self.singular_values[0] / self.singular_values[rank - 1],
        }
    }
}

/// Basis of the span of `columns`, orthonormal in the metric of M: columns scaled to unit
/// M-norm, singular value decomposition of `L^H V` with `M = L L^H`, singular values below
/// `drop_below` times the largest left out.
///
/// # Errors
/// If M is not positive definite.
pub fn orthonormal_basis<T: Scalar>(
    columns: &Matrix<T>,
    m: &Matrix<T>,
    drop_below: f64,
) -> Result<OrthonormalBasis<T>, NotPositiveDefinite> {
    sequential();
    let factor = m.view().llt(Side::Lower).map_err(|_| NotPositiveDefinite)?;
    let lower = Matrix::from_view(factor.L());
    let mut scaled = lower.adjoint_times(columns);
    for column in 0..scaled.columns() {
        let norm: f64 = scaled
            .column(column)
            .iter()
            .map(|&x| (x * x.conjugate()).real_part())
            .sum::<f64>()
            .sqrt();
        if norm > 0.0 {
            for entry in scaled.column_mut(column) {
                *entry *= T::from_real(1.0 / norm);
            }
        }
    }
    let (left, singular_values) = left_singular_vectors(&scaled)?;
    let largest = singular_values.first().copied().unwrap_or(0.0);
    let rank = singular_values
        .iter()
        .take_while(|&&s| s > drop_below * largest)
        .count();
    let mut vectors = left.column_range(0, rank);
    factor
        .L()
        .adjoint()
        .solve_upper_triangular_in_place(vectors.view_mut());
    Ok(OrthonormalBasis {
        vectors,
        singular_values,
    })
}

/// Left singular vectors and singular values, descending.
///
/// The decomposition of faer (0.24) may end without a result where many singular values are the same. Those of `A` are then the
/// roots of the eigenvalues of `A A^H`, as long as none is so small that its square says little.
fn left_singular_vectors<T: Scalar>(
    a: &Matrix<T>,
) -> Result<(Matrix<T>, Vec<f64>), NotPositiveDefinite> {
    let count = a.rows().min(a.columns());
    if let Ok(found) = a.view().thin_svd() {
        let values = found.S().column_vector();
        let values = (0..count).map(|i| values[i].real_part()).collect();
        return Ok((Matrix::from_view(found.U()), values));
    }
    roots_of_squares(a, count)
}

/// The first `count` left singular vectors and values by `A A^H`.
fn roots_of_squares<T: Scalar>(
    a: &Matrix<T>,
    count: usize,
) -> Result<(Matrix<T>, Vec<f64>), NotPositiveDefinite> {
    const LEAST_SQUARE: f64 = 1e-8;
    let (squares, vectors) = hermitian_eigen(&a.times_adjoint(a))?;
    let last = squares.len().saturating_sub(1);
    let values: Vec<f64> = (0..count).map(|i| squares[last - i].sqrt()).collect();
    let [Some(first), Some(least)] = [values.first(), values.last()] else {
        return Err(NotPositiveDefinite);
    };
    let is_clear = least * least > LEAST_SQUARE * first * first;
    let vectors = Matrix::from_fn(a.rows(), count, |i, j| vectors[(i, last - j)]);
    is_clear
        .then_some((vectors, values))
        .ok_or(NotPositiveDefinite)
}

/// Eigenvalues of a real square matrix, the largest modulus first; none for one with values that are
/// not finite.
#[must_use]
pub fn eigenvalues(a: &Matrix<f64>) -> Vec<Complex64> {
    sequential();
    if !a.as_slice().iter().all(|x| x.is_finite()) {
        return Vec::new();
    }
    let mut values: Vec<Complex64> = a.view().eigenvalues().unwrap_or_default();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(n: usize) -> (Matrix<Complex64>, Matrix<Complex64>) {
        let raw = Matrix::from_fn(n, n, |i, j| {
            Complex64::new(
                ((3 * i + 7 * j) as f64).sin(),
                ((5 * i + 2 * j) as f64).cos(),
            )
        });
        let mut k = raw.adjoint_times(&raw);
        let mut m = raw.times(&raw.adjoint());
        for i in 0..n {
            k[(i, i)] += 0.1;
            m[(i, i)] += n as f64;
        }
        (k, m)
    }

    /// Forty directions, one of them twice: singular values of 1, and one of the root of 2.
    #[test]
    fn singular_values_are_the_roots_of_the_squares_where_these_are_clear() {
        let n = 40;
        let turn = |i: usize, j: usize| std::f64::consts::TAU * (i * j) as f64 / n as f64;
        let unitary = Matrix::from_fn(n, n + 1, |i, j| {
            Complex64::from_polar((n as f64).sqrt().recip(), turn(i, j % n))
        });
        let (vectors, values) = roots_of_squares(&unitary, n).expect("clear");
        assert!((values[0] - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!(values[1..].iter().all(|value| (value - 1.0).abs() < 1e-12));
        let (of_faer, _) = left_singular_vectors(&unitary).expect("converges");
        let same = vectors
            .column_range(0, 1)
            .adjoint_times(&of_faer.column_range(0, 1));
        assert!((same[(0, 0)].norm() - 1.0).abs() < 1e-12);
        // Two columns that are nearly one: the square of the smaller value is rounding.
        let twins = Matrix::from_fn(3, 2, |i, j| {
            let part = if i == 2 { 1e-9 * j as f64 } else { 1.0 };
            Complex64::new(part, 0.0)
        });
        assert!(roots_of_squares(&twins, 2).is_err());
    }

    #[test]
    fn a_pencil_gives_mass_normalised_vectors_that_diagonalise_the_stiffness() {
        let (k, m) = sample(9);
        let (values, vectors) = hermitian_pencil(&k, &m).expect("positive definite");
        let kk = vectors.adjoint_times(&k.times(&vectors));
        let mm = vectors.adjoint_times(&m.times(&vectors));
        for i in 0..9 {
            for j in 0..9 {
                let unit = f64::from(u8::from(i == j));
                assert!((mm[(i, j)] - unit).norm() < 1e-12);
                assert!((kk[(i, j)] - unit * values[i]).norm() < 1e-11);
            }
        }
    }

    #[test]
    fn a_repeated_column_is_dropped_and_the_rank_reported() {
        let (k, m) = sample(6);
        let columns = k.column_range(0, 3).beside(&k.column_range(1, 2));
        let basis = orthonormal_basis(&columns, &m, 1e-8).expect("positive definite");
        assert_eq!(basis.rank(), 3);
        assert!(basis.condition() < 1e8);
        let gram = basis.vectors.adjoint_times(&m.times(&basis.vectors));
        assert!((gram[(2, 2)].re - 1.0).abs() < 1e-12 && gram[(2, 0)].norm() < 1e-12);
    }

    /// `Q diag(values) Q^H` with `Q` a product of reflections.
    fn with_spectrum<T: Scalar>(values: &[f64], mut entry: impl FnMut() -> T) -> Matrix<T> {
        let n = values.len();
        let mut a = Matrix::from_fn(n, n, |i, j| {
            T::from_real(if i == j { values[i] } else { 0.0 })
        });
        for _ in 0..3 {
            let v = Matrix::from_fn(n, 1, |_, _| entry());
            let factor = T::from_real(-2.0 / v.squared_norm());
            let reflect = |a: &Matrix<T>| {
                let share = v.adjoint_times(a);
                Matrix::from_fn(n, n, |i, j| a[(i, j)] + factor * v[(i, 0)] * share[(0, j)])
            };
            a = reflect(&reflect(&a).adjoint());
        }
        // Rounding apart, the matrix is Hermitian; only the lower triangle is read.
        let lower = |i: usize, j: usize| {
            if i >= j {
                a[(i, j)]
            } else {
                a[(j, i)].conjugate()
            }
        };
        Matrix::from_fn(n, n, lower)
    }

    fn worst_residual<T: Scalar>(a: &Matrix<T>) -> f64 {
        let (values, vectors) = hermitian_eigen(a).expect("finite");
        let largest = values.iter().fold(0.0_f64, |s, value| s.max(value.abs()));
        let product = a.times(&vectors);
        let gram = vectors.adjoint_times(&vectors);
        let mut worst = 0.0_f64;
        for (j, &value) in values.iter().enumerate() {
            let mut square = 0.0;
            for i in 0..values.len() {
                let off = product[(i, j)] - vectors[(i, j)] * T::from_real(value);
                square += (off * off.conjugate()).real_part();
                let unit = T::from_real(f64::from(u8::from(i == j)));
                let skew = gram[(i, j)] - unit;
                worst = worst.max((skew * skew.conjugate()).real_part().sqrt());
            }
            worst = worst.max(square.sqrt() / largest);
        }
        worst
    }

    #[test]
    fn clustered_and_graded_eigenvalues_keep_small_residuals() {
        // As of a mistuned wheel: families over seven decades, each a narrow cluster.
        let values: Vec<f64> = (0..320)
            .map(|i| {
                let (family, blade) = (i / 32, i % 32);
                10.0_f64.powf(3.0 + 0.75 * f64::from(family))
                    * (1.0 + 1e-9 * f64::from(blade * blade))
            })
            .collect();
        let mut phase = 0.0_f64;
        let mut number = || {
            phase += 1.0;
            (phase * phase * 0.618).sin()
        };
        let real = with_spectrum(&values, &mut number);
        assert!(worst_residual(&real) < 1e-13, "{:e}", worst_residual(&real));
        let complex = with_spectrum(&values, || Complex64::new(number(), number()));
        assert!(
            worst_residual(&complex) < 1e-13,
            "{:e}",
            worst_residual(&complex)
        );
    }

    #[test]
    fn an_indefinite_mass_is_refused() {
        let k = Matrix::<f64>::identity(2);
        let mut m = Matrix::<f64>::identity(2);
        m[(1, 1)] = -1.0;
        assert_eq!(hermitian_pencil(&k, &m).err(), Some(NotPositiveDefinite));
    }
}
