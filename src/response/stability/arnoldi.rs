//! The largest eigenvalues of a linear map that is known by what it makes of vectors: Arnoldi's method.
//!
//! ```text
//! M V_m = V_m H_m + h_{m+1,m} v_{m+1} e_m^T,    H_m s = theta s,    |M V s - theta V s| = h_{m+1,m} |s_m|
//! ```
//!
//! (Saad 2011, Numerical Methods for Large Eigenvalue Problems, section 6.2).

use crate::linalg::{Complex64, LuWorkspace, Matrix, dot, eigenvalues};

/// Steps of inverse iteration for an eigenvector of the small matrix.
const INVERSE_STEPS: usize = 3;
/// Shift of its matrix, relative, that keeps it regular.
const SHIFT: f64 = 1e-10;
/// What is left of a vector, relative to what it was, at which the space is closed under the map.
const CLOSED: f64 = 1e-12;

/// An eigenvalue of the map on the space so far, and how far its vector is from being one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RitzValue {
    pub(super) value: Complex64,
    pub(super) residual: f64,
}

/// The space and the map on it.
pub(super) struct Arnoldi {
    vectors: Vec<Vec<f64>>,
    /// Columns of H, each one longer than the one before.
    columns: Vec<Vec<f64>>,
    closed: bool,
}

impl Arnoldi {
    /// From a first vector, not zero.
    pub(super) fn new(first: Vec<f64>) -> Self {
        let norm = dot(&first, &first).sqrt();
        Self {
            vectors: vec![first.into_iter().map(|x| x / norm).collect()],
            columns: Vec::new(),
            closed: false,
        }
    }

    /// Whether the space holds all that the map makes of it.
    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    /// Takes in what the map makes of the last vector, by `map`; none where it fails.
    pub(super) fn extend(&mut self, map: impl FnOnce(&[f64]) -> Option<Vec<f64>>) -> Option<()> {
        let mut next = map(self.vectors.last()?)?;
        let size = dot(&next, &next).sqrt();
        if !size.is_finite() {
            return None;
        }
        let mut column = vec![0.0; self.vectors.len() + 1];
        // Twice is enough (Kahan & Parlett).
        for _ in 0..2 {
            for (vector, sum) in self.vectors.iter().zip(&mut column) {
                let share = dot(vector, &next);
                *sum += share;
                next.iter_mut()
                    .zip(vector)
                    .for_each(|(x, v)| *x -= share * v);
            }
        }
        let left = dot(&next, &next).sqrt();
        if let Some(last) = column.last_mut() {
            *last = left;
        }
        self.columns.push(column);
        self.closed = left <= CLOSED * size;
        for x in &mut next {
            *x /= left;
        }
        self.vectors.push(next);
        Some(())
    }

    /// Eigenvalues on the space, the `count` largest with their residuals; none where they are not found.
    pub(super) fn largest(&self, count: usize) -> Option<Vec<RitzValue>> {
        let m = self.columns.len();
        let small = Matrix::from_fn(m, m, |i, j| self.columns[j].get(i).copied().unwrap_or(0.0));
        let beyond = if self.closed {
            0.0
        } else {
            *self.columns.last()?.last()?
        };
        let values = eigenvalues(&small).into_iter().take(count);
        values
            .map(|value| {
                let last = last_of_vector(&small, value)?;
                Some(RitzValue {
                    value,
                    residual: beyond * last,
                })
            })
            .collect()
    }
}

/// Modulus of the last component of the unit eigenvector.
fn last_of_vector(small: &Matrix<f64>, value: Complex64) -> Option<f64> {
    let m = small.rows();
    let shift = value + SHIFT * value.norm().max(f64::MIN_POSITIVE);
    let mut factors = LuWorkspace::<Complex64>::new(m);
    for j in 0..m {
        for i in 0..m {
            let diagonal = if i == j { shift } else { Complex64::default() };
            factors.matrix_mut()[j * m + i] = Complex64::from(small[(i, j)]) - diagonal;
        }
    }
    if !factors.factor() {
        return None;
    }
    let mut vector: Vec<Complex64> = (0..m).map(|i| Complex64::from(1.0 + i as f64)).collect();
    for _ in 0..INVERSE_STEPS {
        factors.solve(&mut vector);
        let norm = vector.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        for x in &mut vector {
            *x /= norm;
        }
    }
    vector.last().map(|x| x.norm()).filter(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turns that grow or shrink: eigenvalues `r e^{+-i a}`.
    #[test]
    fn the_largest_of_many_turns_is_found_and_its_residual_tells_when() {
        let turns: Vec<(f64, f64)> = (0..40)
            .map(|i| (0.98 - 0.004 * f64::from(i), 0.07 * f64::from(i)))
            .chain([(1.01, 0.9)])
            .collect();
        let map = |x: &[f64]| {
            let pairs = x.chunks_exact(2).zip(&turns);
            let turned = pairs.flat_map(|(x, (r, a))| {
                let (sine, cosine) = a.sin_cos();
                [
                    r * (cosine * x[0] - sine * x[1]),
                    r * (sine * x[0] + cosine * x[1]),
                ]
            });
            Some(turned.collect())
        };
        let mut arnoldi = Arnoldi::new((0..82).map(|i| 1.0 + f64::from(i % 7)).collect());
        let error = |found: &[RitzValue]| {
            let apart = |ritz: &RitzValue| (ritz.value - Complex64::from_polar(1.01, 0.9)).norm();
            found.iter().map(apart).fold(f64::INFINITY, f64::min)
        };
        // Of a normal map an eigenvalue lies within the residual (Bauer & Fike 1960).
        for (steps, residual) in [(60, 0.1), (82, 1e-8)] {
            while arnoldi.columns.len() < steps {
                arnoldi.extend(map).unwrap_or(());
            }
            let found = arnoldi.largest(2).unwrap_or_default();
            assert_eq!(found.len(), 2);
            let bound = found[0].residual;
            assert!(bound < residual, "{found:?}");
            assert!(error(&found) <= bound.max(1e-8), "{found:?}");
        }
    }
}
