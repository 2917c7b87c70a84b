//! The exponential of a real matrix.

use super::Matrix;

/// `e^A` by scaling to a norm of at most 1/2, a Taylor polynomial of degree 16 and squaring.
#[must_use]
pub fn exponential(a: &Matrix<f64>) -> Matrix<f64> {
    const DEGREE: u32 = 16;
    let n = a.rows();
    let norm = (0..n)
        .map(|j| a.column(j).iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let squarings = (2.0 * norm).log2().ceil().max(0.0) as i32;
    let scaled = Matrix::from_fn(n, n, |i, j| 0.5_f64.powi(squarings) * a[(i, j)]);
    // Horner: I + A (I + A/2 (I + A/3 (...))).
    let mut sum = Matrix::<f64>::identity(n);
    for degree in (1..=DEGREE).rev() {
        let product = scaled.times(&sum);
        sum = Matrix::from_fn(n, n, |i, j| {
            f64::from(u8::from(i == j)) + product[(i, j)] / f64::from(degree)
        });
    }
    for _ in 0..squarings {
        sum = sum.times(&sum);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_of_a_rotation_is_a_rotation_and_of_a_nilpotent_matrix_a_polynomial() {
        let angle = 7.3_f64;
        let mut a = Matrix::<f64>::zeros(4, 4);
        a[(0, 1)] = -angle;
        a[(1, 0)] = angle;
        a[(2, 3)] = 5.0;
        let e = exponential(&a);
        assert!((e[(0, 0)] - angle.cos()).abs() < 1e-13 && (e[(1, 0)] - angle.sin()).abs() < 1e-13);
        assert!((e[(2, 3)] - 5.0).abs() < 1e-13 && (e[(2, 2)] - 1.0).abs() < 1e-13);
    }
}
