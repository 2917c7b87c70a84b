//! Wall-clock times, and what the machine does with dense matrices.

use std::time::{Duration, Instant};

use blisk::linalg::{LuWorkspace, Matrix};

/// The smallest time of a few repetitions, and the last result.
pub fn smallest<T>(repetitions: usize, mut work: impl FnMut() -> T) -> (Duration, T) {
    let mut time = Duration::MAX;
    let mut result = None;
    for _ in 0..repetitions {
        let start = Instant::now();
        result = Some(work());
        time = time.min(start.elapsed());
    }
    (time, result.expect("at least one repetition"))
}

/// What dense algebra takes for a Newton step of `n` unknowns.
pub struct Floor {
    /// LU factors of `n x n`.
    pub factor: Duration,
    /// Product of the contact rows with the derivatives of the forces on them, `2 c n^2` operations at the rate of a
    /// square product.
    pub product: Duration,
    /// Operations per second of the LU and of the square product.
    pub rates: [f64; 2],
}

impl Floor {
    /// As the machine does it now.
    pub fn measured(n: usize, contact_rows: usize, repetitions: usize) -> Self {
        let matrix = diagonally_dominant(n);
        let mut lu = LuWorkspace::<f64>::new(n);
        let (factor, _) = smallest(repetitions, || {
            lu.matrix_mut().copy_from_slice(matrix.as_slice());
            lu.factor()
        });
        let (square, _) = smallest(repetitions, || matrix.times(&matrix));
        let cube = (n as f64).powi(3);
        Self {
            factor,
            product: square.mul_f64(contact_rows as f64 / n as f64),
            rates: [
                2.0 / 3.0 * cube / factor.as_secs_f64(),
                2.0 * cube / square.as_secs_f64(),
            ],
        }
    }

    /// Both together.
    pub fn step(&self) -> Duration {
        self.factor + self.product
    }
}

/// A matrix that any elimination serves.
pub fn diagonally_dominant(n: usize) -> Matrix<f64> {
    let noise = |i: usize, j: usize| ((7 * i + 13 * j + i * j) % 101) as f64 / 101.0;
    Matrix::from_fn(n, n, |i, j| {
        noise(i, j) + if i == j { n as f64 } else { 0.0 }
    })
}
