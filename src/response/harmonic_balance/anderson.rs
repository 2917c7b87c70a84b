//! Anderson's acceleration of a fixed-point iteration (Anderson 1965; Walker & Ni 2011, SIAM J. Numer.
//! Anal. 49(4)).

use super::transform::dot;

/// Anderson's acceleration of `x <- x + f(x)`.
pub(super) struct Anderson {
    depth: usize,
    /// Last iterate and its step.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Differences of iterates and of steps.
    differences: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Anderson {
    pub(super) fn new(depth: usize) -> Self {
        Self {
            depth,
            last: None,
            differences: Vec::new(),
        }
    }

    /// The next iterate from `x` and `step = f(x)`.
    pub(super) fn next(&mut self, x: &[f64], step: &[f64]) -> Vec<f64> {
        let minus = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        if let Some((last_x, last_step)) = &self.last {
            self.differences
                .push((minus(x, last_x), minus(step, last_step)));
            if self.differences.len() > self.depth {
                self.differences.remove(0);
            }
        }
        self.last = Some((x.to_vec(), step.to_vec()));
        let columns: Vec<&[f64]> = self.differences.iter().map(|(_, f)| f.as_slice()).collect();
        let shares = least_squares(&columns, step);
        let mut next: Vec<f64> = x.iter().zip(step).map(|(x, f)| x + f).collect();
        for (share, (dx, df)) in shares.iter().zip(&self.differences) {
            for ((next, dx), df) in next.iter_mut().zip(dx).zip(df) {
                *next -= share * (dx + df);
            }
        }
        next
    }
}

/// Shares by which the columns come nearest to `target`; a column that depends on those after it,
/// the more recent ones, has none.
fn least_squares(columns: &[&[f64]], target: &[f64]) -> Vec<f64> {
    const DEPENDENT: f64 = 1e-8;
    let n = columns.len();
    // Modified Gram-Schmidt from the last column on: A = Q R, R gathered by columns.
    let mut orthonormal: Vec<Option<Vec<f64>>> = vec![None; n];
    let mut triangle = vec![vec![0.0; n]; n];
    for j in (0..n).rev() {
        let mut q = columns[j].to_vec();
        let length = dot(&q, &q).sqrt();
        for i in (j + 1..n).rev() {
            if let Some(other) = &orthonormal[i] {
                let share = dot(other, &q);
                triangle[i][j] = share;
                q.iter_mut().zip(other).for_each(|(q, o)| *q -= share * o);
            }
        }
        let left = dot(&q, &q).sqrt();
        if left > DEPENDENT * length {
            for q in &mut q {
                *q /= left;
            }
            triangle[j][j] = left;
            orthonormal[j] = Some(q);
        }
    }
    let mut shares = vec![0.0; n];
    for i in 0..n {
        if let Some(q) = &orthonormal[i] {
            let known: f64 = (0..i).map(|j| triangle[i][j] * shares[j]).sum();
            shares[i] = (dot(q, target) - known) / triangle[i][i];
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::{Anderson, least_squares};

    #[test]
    fn least_squares_meet_a_target_in_the_span_and_drop_a_repeated_column() {
        let (a, b) = ([1.0, 2.0, 0.0, 1.0], [0.0, 1.0, 1.0, -1.0]);
        let target: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 3.0 * a - 2.0 * b).collect();
        let shares = least_squares(&[&a, &b], &target);
        assert!((shares[0] - 3.0).abs() < 1e-12 && (shares[1] + 2.0).abs() < 1e-12);
        let shares = least_squares(&[&b, &a, &b], &target);
        assert!(shares[0] == 0.0 && (shares[1] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_linear_iteration_that_diverges_by_itself_is_solved_in_as_many_steps_as_unknowns() {
        // f(x) = b - A x with eigenvalues 0.2, 1.5 and 4.
        let a = [0.2, 1.5, 4.0];
        let step = |x: &[f64]| -> Vec<f64> { x.iter().zip(a).map(|(x, a)| 1.0 - a * x).collect() };
        let mut acceleration = Anderson::new(6);
        let mut x = vec![0.0; 3];
        for _ in 0..5 {
            x = acceleration.next(&x, &step(&x));
        }
        for (x, a) in x.iter().zip(a) {
            assert!((x - 1.0 / a).abs() < 1e-9, "{x} for {}", 1.0 / a);
        }
    }
}
