//! Anderson's acceleration of the iteration for the contact (Anderson 1965; Walker & Ni 2011, SIAM J. Numer. Anal. 49(4)).
//!
//! With steps `f = f(x)`, the next iterate is `x + f - sum_j c_j (dx_j + df_j)`, where the shares c bring the sum of the
//! differences `df_j` nearest to f. They come from the scalar products of these differences, of which every step adds one
//! row: the differences are read twice a step, whatever their number. They are kept in single precision: what that takes from
//! a step is a share of it, and the next one sees it.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use crate::linalg::{Loops, vectorized};

/// Partial sums of a scalar product.
const LANES: usize = 8;
/// Columns that are taken at a time.
const TOGETHER: usize = 4;
/// Share of a difference, squared, that must be left of it beside the others; else it says nothing new.
const DEPENDENT: f64 = 1e-13;

/// Earlier steps of one iteration.
#[derive(Default)]
pub(super) struct Acceleration {
    unknowns: usize,
    last: Option<(Vec<f64>, Vec<f64>)>,
    begun: bool,
    /// `dx_j + df_j`, column after column, and `df_j`, each over its length.
    moves: Vec<f32>,
    changes: Vec<f32>,
    columns: usize,
    /// The last change over its length.
    latest: Vec<f64>,
    /// Scalar products of the changes, a row of growing length each.
    products: Vec<Vec<f64>>,
    /// What is added to the squares of the changes, each of length 1.
    damping: f64,
    /// Scalar products of the changes with the step.
    along: Vec<f64>,
    shares: Vec<f64>,
}

impl Acceleration {
    /// For vectors of another length.
    pub(super) fn resize(&mut self, unknowns: usize) {
        self.unknowns = unknowns;
        self.last = None;
        self.begin(0.0);
    }

    /// Forgets the steps: another function follows, whose shares are damped by so much of the square of a change. Without damping
    /// changes that are almost one another are combined with large shares, which a function with kinks does not follow.
    pub(super) fn begin(&mut self, damping: f64) {
        self.damping = damping;
        self.begun = false;
        self.forget();
    }

    fn forget(&mut self) {
        self.columns = 0;
        self.products.clear();
        self.along.clear();
    }

    /// The next iterate from `x` and `step = f(x)`, into `next`; combines `depth` steps at most and begins anew then.
    pub(super) fn next(&mut self, x: &[f64], step: &[f64], depth: usize, next: &mut [f64]) {
        if self.begun {
            if self.columns == depth {
                self.forget();
            }
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
        self.find_shares();
        vectorized(Combined {
            columns: &self.moves,
            shares: &self.shares,
            sum: next,
        });
    }

    fn learn(&mut self, x: &[f64], step: &[f64]) {
        let Some((last_x, last_step)) = &self.last else {
            return;
        };
        let (n, column) = (self.unknowns, self.columns);
        let used = n * (column + 1);
        if self.moves.len() < used {
            self.moves.resize(used, 0.0);
            self.changes.resize(used, 0.0);
        }
        let (known, change) = self.changes[..used].split_at_mut(n * column);
        self.latest.clear();
        let differences = step.iter().zip(last_step).map(|(f, last)| f - last);
        self.latest.extend(differences);
        let length = crate::linalg::dot(&self.latest, &self.latest).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let scale = 1.0 / length;
        for (change, latest) in change.iter_mut().zip(&mut self.latest) {
            *latest *= scale;
            *change = *latest as f32;
        }
        let moved = self.moves[n * column..][..n].iter_mut();
        let (points, steps) = (x.iter().zip(last_x), step.iter().zip(last_step));
        for (moved, ((x, last_x), (f, last_f))) in moved.zip(points.zip(steps)) {
            *moved = (((x - last_x) + (f - last_f)) * scale) as f32;
        }
        let mut row = vec![0.0; column];
        vectorized(Products {
            columns: known,
            vector: &self.latest,
            into: &mut row,
        });
        // The step is the last one and this change: products with earlier changes move on by those with the change.
        for (along, product) in self.along.iter_mut().zip(&row) {
            *along += length * product;
        }
        let mut square = [0.0];
        vectorized(Products {
            columns: change,
            vector: step,
            into: &mut square,
        });
        self.along.extend(square);
        row.push(1.0);
        self.products.push(row);
        self.columns += 1;
    }

    /// Solves the normal equations of the shares by Cholesky's method; what depends on earlier changes has none.
    fn find_shares(&mut self) {
        let count = self.columns;
        self.shares.clear();
        self.shares.resize(count, 0.0);
        self.shares.copy_from_slice(&self.along);
        // The latest change first: it is the one that must not be dropped.
        let at = |i: usize, j: usize| {
            let (i, j) = (count - 1 - i, count - 1 - j);
            self.products[i.max(j)][i.min(j)]
        };
        let mut factor = vec![0.0; count * count];
        let mut left = vec![0.0; count];
        for j in 0..count {
            for i in 0..=j {
                let known: f64 = (0..i)
                    .map(|k| factor[i * count + k] * factor[j * count + k])
                    .sum();
                let rest = at(i, j) + if i == j { self.damping } else { 0.0 } - known;
                factor[j * count + i] = if i < j {
                    let pivot = factor[i * count + i];
                    if pivot > 0.0 { rest / pivot } else { 0.0 }
                } else if rest > DEPENDENT {
                    rest.sqrt()
                } else {
                    0.0
                };
            }
            let known: f64 = (0..j).map(|k| factor[j * count + k] * left[k]).sum();
            let pivot = factor[j * count + j];
            let rest = self.shares[count - 1 - j] - known;
            left[j] = if pivot > 0.0 { rest / pivot } else { 0.0 };
        }
        for j in (0..count).rev() {
            let pivot = factor[j * count + j];
            let known: f64 = (j + 1..count)
                .map(|k| factor[k * count + j] * left[k])
                .sum();
            left[j] = if pivot > 0.0 {
                (left[j] - known) / pivot
            } else {
                0.0
            };
        }
        for (share, share_left) in self.shares.iter_mut().rev().zip(&left) {
            *share = *share_left;
        }
    }
}

/// Scalar products of columns with a vector.
struct Products<'a> {
    columns: &'a [f32],
    vector: &'a [f64],
    into: &'a mut [f64],
}

impl Loops for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.vector.len().max(1);
        let groups = self.columns.chunks(TOGETHER * n);
        for (columns, products) in groups.zip(self.into.chunks_mut(TOGETHER)) {
            if columns.len() == TOGETHER * n {
                let column = |k: usize| &columns[k * n..][..n];
                let sums = products_of([column(0), column(1), column(2), column(3)], self.vector);
                products.copy_from_slice(&sums);
            } else {
                for (column, product) in columns.chunks_exact(n).zip(products) {
                    [*product] = products_of([column], self.vector);
                }
            }
        }
    }
}

#[inline(always)]
fn products_of<const COUNT: usize>(columns: [&[f32]; COUNT], vector: &[f64]) -> [f64; COUNT] {
    let (vector, vector_rest) = vector.as_chunks::<LANES>();
    let columns = columns.map(|column| column.as_chunks::<LANES>());
    let mut sums = [[0.0; LANES]; COUNT];
    for (at, v) in vector.iter().enumerate() {
        for (sums, (column, _)) in sums.iter_mut().zip(columns) {
            let c = &column[at];
            for lane in 0..LANES {
                sums[lane] += f64::from(c[lane]) * v[lane];
            }
        }
    }
    std::array::from_fn(|k| {
        let rest = columns[k]
            .1
            .iter()
            .zip(vector_rest)
            .map(|(c, v)| f64::from(*c) * v);
        sums[k].into_iter().sum::<f64>() + rest.sum::<f64>()
    })
}

/// A vector less shares of columns.
struct Combined<'a> {
    columns: &'a [f32],
    shares: &'a [f64],
    sum: &'a mut [f64],
}

impl Loops for Combined<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let n = self.sum.len().max(1);
        let groups = self.columns.chunks(TOGETHER * n);
        for (columns, shares) in groups.zip(self.shares.chunks(TOGETHER)) {
            if let [p, q, r, s] = *shares {
                let column = |k: usize| columns[k * n..][..n].iter();
                let four = column(0).zip(column(1)).zip(column(2).zip(column(3)));
                for (sum, ((a, b), (c, d))) in self.sum.iter_mut().zip(four) {
                    let [a, b, c, d] = [a, b, c, d].map(|entry| f64::from(*entry));
                    *sum -= (p * a + q * b) + (r * c + s * d);
                }
            } else {
                for (column, share) in columns.chunks_exact(n).zip(shares) {
                    for (sum, entry) in self.sum.iter_mut().zip(column) {
                        *sum -= share * f64::from(*entry);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Acceleration;

    /// Iterates `x <- x + 1 - A x` with a diagonal A.
    fn iterate(diagonal: &[f64], depth: usize, steps: usize) -> Vec<f64> {
        let mut acceleration = Acceleration::default();
        acceleration.resize(diagonal.len());
        let mut x = vec![0.0; diagonal.len()];
        let mut next = x.clone();
        for _ in 0..steps {
            let step: Vec<f64> = x.iter().zip(diagonal).map(|(x, a)| 1.0 - a * x).collect();
            acceleration.next(&x, &step, depth, &mut next);
            std::mem::swap(&mut x, &mut next);
        }
        x
    }

    #[test]
    fn a_linear_iteration_that_diverges_by_itself_is_solved_in_as_many_steps_as_unknowns() {
        let a = [0.2, 1.5, 4.0, 2.2, 0.9, 3.1, 0.4, 2.8, 1.1];
        let x = iterate(&a, 20, 14);
        for (x, a) in x.iter().zip(a) {
            assert!((x - 1.0 / a).abs() < 1e-9, "{x} for {}", 1.0 / a);
        }
    }

    #[test]
    fn equal_differences_are_dropped_and_full_columns_begin_anew() {
        let x = iterate(&[0.3; 3], 2, 6);
        assert!(x.iter().all(|x| (x - 1.0 / 0.3).abs() < 1e-12), "{x:?}");
        let a = [0.5, 1.2, 0.9, 0.7, 1.4];
        let x = iterate(&a, 3, 30);
        for (x, a) in x.iter().zip(a) {
            assert!((x - 1.0 / a).abs() < 1e-8, "{x} for {}", 1.0 / a);
        }
    }
}
