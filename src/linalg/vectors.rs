//! Loops over contiguous numbers, compiled for the vector instructions of the machine that runs them.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use pulp::Arch;
pub use pulp::NullaryFnOnce as Loops;

/// Partial sums of a scalar product: enough to hide the latency of an addition.
const PARTIAL_SUMS: usize = 32;
/// Columns of a matrix that are taken together.
const COLUMNS: usize = 4;

/// Runs `loops` with the widest vectors of this machine: what is inlined into them (by `#[inline(always)]`, else it may
/// not be) is compiled once for each kind. No sum is taken in another order for it, so the numbers are the same with all.
#[inline]
pub fn vectorized<L: Loops>(loops: L) -> L::Output {
    Arch::new().dispatch(loops)
}

/// Scalar product, in partial sums.
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    vectorized(Dot { a, b })
}

struct Dot<'a> {
    a: &'a [f64],
    b: &'a [f64],
}

impl Loops for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let (a, a_rest) = self.a.as_chunks::<PARTIAL_SUMS>();
        let (b, b_rest) = self.b.as_chunks::<PARTIAL_SUMS>();
        let mut sums = [0.0; PARTIAL_SUMS];
        for (a, b) in a.iter().zip(b) {
            for lane in 0..PARTIAL_SUMS {
                sums[lane] += a[lane] * b[lane];
            }
        }
        let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
        let mut half = PARTIAL_SUMS / 2;
        while half > 0 {
            for lane in 0..half {
                sums[lane] += sums[lane + half];
            }
            half /= 2;
        }
        sums[0] + rest
    }
}

/// `y += factor A x` for a column-major `A` with `y.len()` rows.
pub fn add_times_vector(y: &mut [f64], factor: f64, a: &[f64], x: &[f64]) {
    if !y.is_empty() {
        vectorized(AddTimes { y, factor, a, x });
    }
}

struct AddTimes<'a> {
    y: &'a mut [f64],
    factor: f64,
    a: &'a [f64],
    x: &'a [f64],
}

impl Loops for AddTimes<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { y, factor, a, x } = self;
        let rows = y.len();
        let (whole, rest) = x.as_chunks::<COLUMNS>();
        let (columns, left) = a[..rows * x.len()].split_at(rows * COLUMNS * whole.len());
        for (columns, x) in columns.chunks_exact(COLUMNS * rows).zip(whole) {
            let [x0, x1, x2, x3] = x.map(|x| factor * x);
            let (a0, columns) = columns.split_at(rows);
            let (a1, columns) = columns.split_at(rows);
            let (a2, a3) = columns.split_at(rows);
            for i in 0..rows {
                y[i] += (x0 * a0[i] + x1 * a1[i]) + (x2 * a2[i] + x3 * a3[i]);
            }
        }
        for (column, x) in left.chunks_exact(rows).zip(rest) {
            let x = factor * x;
            for (y, a) in y.iter_mut().zip(column) {
                *y += x * a;
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Of every length around the blocks that the loops take at once.
    #[test]
    fn products_are_the_plain_sums() {
        let value = |i: usize| (1.3 * i as f64).sin();
        for rows in [0, 1, 3, 31, 32, 33, 70] {
            for columns in [0, 1, 3, 4, 5, 9] {
                let a: Vec<f64> = (0..rows * columns).map(value).collect();
                let x: Vec<f64> = (0..columns).map(|j| value(j + 5)).collect();
                let mut y: Vec<f64> = (0..rows).map(|i| value(i + 9)).collect();
                let expected: Vec<f64> = (0..rows)
                    .map(|i| y[i] - 0.7 * (0..columns).map(|j| a[j * rows + i] * x[j]).sum::<f64>())
                    .collect();
                add_times_vector(&mut y, -0.7, &a, &x);
                for (found, expected) in y.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-14, "{rows} {columns}");
                }
                let mut z = x.clone();
                add_transpose_times_vector(&mut z, 0.3, &a, &y);
                for (j, (found, before)) in z.iter().zip(&x).enumerate() {
                    let product: f64 = (0..rows).map(|i| a[j * rows + i] * y[i]).sum();
                    assert!(
                        (found - before - 0.3 * product).abs() < 1e-13,
                        "{rows} {columns}"
                    );
                }
            }
        }
    }
}
