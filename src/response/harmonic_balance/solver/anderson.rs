//! Anderson's acceleration of a fixed-point iteration (Anderson 1965; Walker & Ni 2011, SIAM J. Numer.
//! Anal. 49(4)).

use crate::linalg::{Columns, Dots, Orthogonalised, Subtracted, dot, vectorized};

/// A difference of steps that depends on the earlier ones up to this share of itself says nothing new.
const DEPENDENT: f64 = 1e-8;

/// Anderson's acceleration of `x <- x + f(x)`; allocates for as many iterates as it ever combined.
pub(super) struct Anderson {
    unknowns: usize,
    depth: usize,
    /// Last iterate and its step, once there is one.
    last: Option<(Vec<f64>, Vec<f64>)>,
    /// Whether `last` belongs to the present iteration.
    begun: bool,
    /// Differences of iterates plus those of steps, a column of `unknowns` each, of which `columns` are used.
    moves: Vec<f64>,
    /// Orthonormal columns Q of the differences of steps.
    directions: Vec<f64>,
    /// R of the differences of steps `Q R`, `depth x depth`, column after column.
    triangle: Vec<f64>,
    columns: usize,
    shares: Vec<f64>,
}

impl Anderson {
    /// An acceleration that combines at most `depth` earlier iterates of `unknowns` entries; it begins
    /// anew when they are full.
    pub(super) fn new(unknowns: usize, depth: usize) -> Self {
        Self {
            unknowns,
            depth,
            last: None,
            begun: false,
            moves: Vec::new(),
            directions: Vec::new(),
            triangle: vec![0.0; depth * depth],
            columns: 0,
            shares: vec![0.0; depth],
        }
    }

    /// The next iterate from `x` and `step = f(x)`, into `next`.
    pub(super) fn next(&mut self, x: &[f64], step: &[f64], next: &mut [f64]) {
        if self.begun {
            self.learn(x, step);
        }
        let (last_x, last_step) = self
            .last
            .get_or_insert_with(|| (vec![0.0; x.len()], vec![0.0; x.len()]));
        last_x.copy_from_slice(x);
        last_step.copy_from_slice(step);
        self.begun = true;
        for ((next, x), f) in next.iter_mut().zip(x).zip(step) {
            *next = x + f;
        }
        self.find_shares(step);
        let moves = Columns::of(&self.moves, self.unknowns);
        vectorized(Subtracted {
            columns: moves,
            shares: &self.shares[..self.columns],
            from: next,
        });
    }

    /// Takes in the differences to the last iterate.
    fn learn(&mut self, x: &[f64], step: &[f64]) {
        let Some((last_x, last_step)) = &self.last else {
            return;
        };
        if self.columns == self.depth {
            self.columns = 0;
        }
        let (n, column) = (self.unknowns, self.columns);
        let used = n * (column + 1);
        if self.moves.len() < used {
            self.moves.resize(used, 0.0);
            self.directions.resize(used, 0.0);
        }
        let (known, free) = self.directions.split_at_mut(n * column);
        let direction = &mut free[..n];
        for ((d, f), last) in direction.iter_mut().zip(step).zip(last_step) {
            *d = f - last;
        }
        let length = dot(direction, direction).sqrt();
        let triangle = &mut self.triangle[self.depth * column..][..self.depth];
        triangle.fill(0.0);
        // Twice: once leaves too much of the others where the columns are almost dependent.
        for _ in 0..2 {
            vectorized(Orthogonalised {
                columns: Columns::of(known, n),
                shares: &mut triangle[..column],
                vector: direction,
            });
        }
        let left = dot(direction, direction).sqrt();
        if left.is_nan() || left <= DEPENDENT * length {
            return;
        }
        triangle[column] = left;
        for d in direction.iter_mut() {
            *d /= left;
        }
        let moves = self.moves[n * column..][..n].iter_mut();
        let (x, step) = (x.iter().zip(last_x), step.iter().zip(last_step));
        for (moved, ((x, last_x), (f, last_f))) in moves.zip(x.zip(step)) {
            *moved = (x - last_x) + (f - last_f);
        }
        self.columns += 1;
    }

    /// Shares by which the differences of steps come nearest to `step`: `R shares = Q^T step`.
    fn find_shares(&mut self, step: &[f64]) {
        vectorized(Dots {
            columns: Columns::of(&self.directions, self.unknowns),
            vector: step,
            products: &mut self.shares[..self.columns],
        });
        for column in (0..self.columns).rev() {
            let known: f64 = (column + 1..self.columns)
                .map(|j| self.triangle[self.depth * j + column] * self.shares[j])
                .sum();
            self.shares[column] =
                (self.shares[column] - known) / self.triangle[self.depth * column + column];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Anderson;

    /// Iterates `x <- x + 1 - A x` with a diagonal A.
    fn iterate(acceleration: &mut Anderson, diagonal: &[f64], steps: usize) -> Vec<f64> {
        let mut x = vec![0.0; diagonal.len()];
        let mut next = x.clone();
        for _ in 0..steps {
            let step: Vec<f64> = x.iter().zip(diagonal).map(|(x, a)| 1.0 - a * x).collect();
            acceleration.next(&x, &step, &mut next);
            std::mem::swap(&mut x, &mut next);
        }
        x
    }

    #[test]
    fn a_linear_iteration_that_diverges_by_itself_is_solved_in_as_many_steps_as_unknowns() {
        let a = [0.2, 1.5, 4.0];
        let x = iterate(&mut Anderson::new(3, 6), &a, 5);
        for (x, a) in x.iter().zip(a) {
            assert!((x - 1.0 / a).abs() < 1e-9, "{x} for {}", 1.0 / a);
        }
    }

    /// From two iterates, `x + f - share (dx + df)` with the share by which `df` comes nearest to `f`.
    #[test]
    fn the_combination_is_that_of_the_least_step() {
        let (first, second) = ([0.0, 0.0], [1.0, 2.0]);
        let (step, next_step) = ([1.0, 2.0], [-3.0, 0.5]);
        let mut acceleration = Anderson::new(2, 4);
        let mut next = [0.0; 2];
        acceleration.next(&first, &step, &mut next);
        acceleration.next(&second, &next_step, &mut next);
        let change = [0, 1].map(|i| next_step[i] - step[i]);
        let dot = |a: [f64; 2], b: [f64; 2]| -> f64 { (0..2).map(|i| a[i] * b[i]).sum() };
        let share = dot(change, next_step) / dot(change, change);
        for i in 0..2 {
            let expected = second[i] + next_step[i] - share * (second[i] - first[i] + change[i]);
            assert!((next[i] - expected).abs() < 1e-12, "{next:?}");
        }
    }

    #[test]
    fn a_repeated_difference_is_left_out_and_full_columns_begin_anew() {
        // All entries alike: every difference after the first is a multiple of it.
        let mut acceleration = Anderson::new(3, 2);
        let x = iterate(&mut acceleration, &[0.3; 3], 6);
        assert!(x.iter().all(|x| (x - 1.0 / 0.3).abs() < 1e-12), "{x:?}");
        let a = [0.5, 1.2, 0.9, 0.7, 1.4];
        let x = iterate(&mut Anderson::new(5, 3), &a, 24);
        for (x, a) in x.iter().zip(a) {
            assert!((x - 1.0 / a).abs() < 1e-9, "{x} for {}", 1.0 / a);
        }
    }
}
