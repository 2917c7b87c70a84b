//! Broyden's rank-one updates of a kept Jacobian, by its inverse and the steps taken so far.
//!
//! With `B_0` the kept Jacobian, `t_0 .. t_n` the full steps taken since (`x <- x - t`) and
//! `w = B_0^-1 R(x)`, the next step is (Kelley 1995, Iterative Methods for Linear and Nonlinear
//! Equations, section 7.3)
//!
//! ```text
//! w <- w + t_{j+1} (t_j . w) / |t_j|^2,  j = 0 .. n-1;      t_{n+1} = w / (1 - t_n . w / |t_n|^2)
//! ```

/// The smallest denominator of an update that is used.
const SMALLEST_DENOMINATOR: f64 = 0.1;

/// Steps taken with one kept Jacobian; storage is reused.
#[derive(Debug)]
pub(super) struct Broyden {
    steps: Vec<Vec<f64>>,
    squared_norms: Vec<f64>,
    used: usize,
}

impl Broyden {
    /// Room for `steps` steps of `unknowns` numbers.
    pub(super) fn new(steps: usize, unknowns: usize) -> Self {
        Self {
            steps: vec![vec![0.0; unknowns]; steps],
            squared_norms: vec![0.0; steps],
            used: 0,
        }
    }

    /// Forgets every step: the Jacobian is a new one, or a step was damped.
    pub(super) fn clear(&mut self) {
        self.used = 0;
    }

    /// Remembers a full step; steps beyond the room are forgotten.
    pub(super) fn push(&mut self, step: &[f64]) {
        if self.used < self.steps.len() {
            self.steps[self.used].copy_from_slice(step);
            self.squared_norms[self.used] = dot(step, step);
            self.used += 1;
        }
    }

    /// Turns `B_0^-1 R` into the next step, in place.
    pub(super) fn update(&self, w: &mut [f64]) {
        let steps = &self.steps[..self.used];
        for (pair, squared) in steps.windows(2).zip(&self.squared_norms) {
            let share = dot(&pair[0], w) / squared;
            for (w, t) in w.iter_mut().zip(&pair[1]) {
                *w += share * t;
            }
        }
        if let Some(last) = steps.last() {
            let denominator = 1.0 - dot(last, w) / self.squared_norms[self.used - 1];
            if denominator > SMALLEST_DENOMINATOR {
                for w in w.iter_mut() {
                    *w /= denominator;
                }
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::Broyden;

    #[test]
    fn a_linear_system_is_solved_in_twice_its_dimension_from_a_wrong_jacobian() {
        // Broyden's method ends after at most 2 n steps on a linear system (Gay 1979).
        let a = [[4.0, 1.0, 0.0], [0.5, 3.0, 1.0], [0.0, -1.0, 5.0]];
        let b = [1.0, 2.0, 3.0];
        let residual = |x: &[f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| (0..3).map(|j| a[i][j] * x[j]).sum::<f64>() - b[i])
        };
        let mut broyden = Broyden::new(10, 3);
        let mut x = [0.0; 3];
        let mut step = residual(&x).map(|r| r / 4.0);
        for _ in 0..6 {
            for i in 0..3 {
                x[i] -= step[i];
            }
            broyden.push(&step);
            step = residual(&x).map(|r| r / 4.0);
            broyden.update(&mut step);
        }
        for r in residual(&x) {
            assert!(r.abs() < 1e-12, "{r}");
        }
    }
}
