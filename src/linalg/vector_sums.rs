//! Sums over long vectors with several columns of a matrix at a time, compiled for vectors.
//!
//! Every scalar product is summed in the order of [`crate::linalg::dot`], and every entry takes its columns one after
//! the other: the numbers are those of plain loops, column by column.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use crate::linalg::Loops;

/// Partial sums of a scalar product.
const LANES: usize = 8;
/// Columns that are taken at a time.
const TOGETHER: usize = 4;

/// Columns of one length, one after the other.
#[derive(Clone, Copy)]
pub(crate) struct Columns<'a> {
    entries: &'a [f64],
    length: usize,
}

impl<'a> Columns<'a> {
    pub(crate) fn of(entries: &'a [f64], length: usize) -> Self {
        Self { entries, length }
    }

    #[inline(always)]
    fn column(self, at: usize) -> &'a [f64] {
        &self.entries[at * self.length..][..self.length]
    }
}

/// Scalar products of the first columns with a vector, as many as there is room for.
pub(crate) struct Dots<'a> {
    pub(crate) columns: Columns<'a>,
    pub(crate) vector: &'a [f64],
    pub(crate) products: &'a mut [f64],
}

impl Loops for Dots<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (together, rest) = self.products.as_chunks_mut::<TOGETHER>();
        let done = TOGETHER * together.len();
        for (group, products) in together.iter_mut().enumerate() {
            let first = TOGETHER * group;
            *products = dots(
                std::array::from_fn(|k| self.columns.column(first + k)),
                self.vector,
            );
        }
        for (at, product) in rest.iter_mut().enumerate() {
            [*product] = dots([self.columns.column(done + at)], self.vector);
        }
    }
}

#[inline(always)]
fn dots<const COUNT: usize>(columns: [&[f64]; COUNT], vector: &[f64]) -> [f64; COUNT] {
    let (vector, vector_rest) = vector.as_chunks::<LANES>();
    let columns = columns.map(|column| column.as_chunks::<LANES>());
    let mut sums = [[0.0; LANES]; COUNT];
    for (at, v) in vector.iter().enumerate() {
        for (sums, (column, _)) in sums.iter_mut().zip(columns) {
            let c = &column[at];
            for lane in 0..LANES {
                sums[lane] += c[lane] * v[lane];
            }
        }
    }
    std::array::from_fn(|k| {
        let rest = columns[k].1.iter().zip(vector_rest).map(|(c, v)| c * v);
        sums[k].into_iter().sum::<f64>() + rest.sum::<f64>()
    })
}

/// A vector less shares of the first columns.
pub(crate) struct Subtracted<'a> {
    pub(crate) columns: Columns<'a>,
    pub(crate) shares: &'a [f64],
    pub(crate) from: &'a mut [f64],
}

impl Loops for Subtracted<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (together, rest) = self.shares.as_chunks::<TOGETHER>();
        for (group, shares) in together.iter().enumerate() {
            let [a, b, c, d] = std::array::from_fn(|k| self.columns.column(TOGETHER * group + k));
            let columns = a.iter().zip(b).zip(c.iter().zip(d));
            for (from, ((a, b), (c, d))) in self.from.iter_mut().zip(columns) {
                *from = *from - shares[0] * a - shares[1] * b - shares[2] * c - shares[3] * d;
            }
        }
        for (at, share) in rest.iter().enumerate() {
            let column = self.columns.column(TOGETHER * together.len() + at);
            for (from, c) in self.from.iter_mut().zip(column) {
                *from -= share * c;
            }
        }
    }
}

/// A vector less its parts along the first, orthonormal columns, by modified Gram-Schmidt; the parts are added to `shares`.
pub(crate) struct Orthogonalised<'a> {
    pub(crate) columns: Columns<'a>,
    pub(crate) shares: &'a mut [f64],
    pub(crate) vector: &'a mut [f64],
}

impl Loops for Orthogonalised<'_> {
    type Output = ();

    /// A column is taken off while the product with the next one is summed: the vector passes once a column.
    #[inline(always)]
    fn call(self) {
        let Some(last) = self.shares.len().checked_sub(1) else {
            return;
        };
        let [mut share] = dots([self.columns.column(0)], self.vector);
        for at in 0..=last {
            self.shares[at] += share;
            let column = self.columns.column(at);
            if at == last {
                for (v, o) in self.vector.iter_mut().zip(column) {
                    *v -= share * o;
                }
                return;
            }
            share = take_off(self.vector, share, column, self.columns.column(at + 1));
        }
    }
}

/// `vector -= share column`, and its product with `next`.
#[inline(always)]
fn take_off(vector: &mut [f64], share: f64, column: &[f64], next: &[f64]) -> f64 {
    let (vector, vector_rest) = vector.as_chunks_mut::<LANES>();
    let (column, column_rest) = column.as_chunks::<LANES>();
    let (next, next_rest) = next.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for ((v, c), n) in vector.iter_mut().zip(column).zip(next) {
        for lane in 0..LANES {
            v[lane] -= share * c[lane];
            sums[lane] += n[lane] * v[lane];
        }
    }
    let mut rest = 0.0;
    for ((v, c), n) in vector_rest.iter_mut().zip(column_rest).zip(next_rest) {
        *v -= share * c;
        rest += n * *v;
    }
    sums.into_iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{dot, vectorized};

    /// Of no round length, so that every remainder occurs.
    const LENGTH: usize = 29;
    const COLUMNS: usize = 7;

    fn numbers(count: usize, phase: f64) -> Vec<f64> {
        (0..count).map(|i| (phase + 1.7 * i as f64).sin()).collect()
    }

    #[test]
    fn the_numbers_are_those_of_plain_loops_to_the_last_bit() {
        let entries = numbers(LENGTH * COLUMNS, 0.3);
        let columns = Columns::of(&entries, LENGTH);
        let vector = numbers(LENGTH, 0.9);
        let mut products = [0.0; COLUMNS];
        vectorized(Dots {
            columns,
            vector: &vector,
            products: &mut products,
        });
        let plain: Vec<f64> = (0..COLUMNS)
            .map(|at| dot(columns.column(at), &vector))
            .collect();
        assert_eq!(products.to_vec(), plain);

        let (mut from, mut plain) = (vector.clone(), vector.clone());
        vectorized(Subtracted {
            columns,
            shares: &products,
            from: &mut from,
        });
        for (at, share) in products.iter().enumerate() {
            let column = columns.column(at).iter();
            plain
                .iter_mut()
                .zip(column)
                .for_each(|(p, c)| *p -= share * c);
        }
        assert_eq!(from, plain);

        let (mut left, mut plain) = (vector.clone(), vector);
        let mut shares = [0.5; COLUMNS];
        vectorized(Orthogonalised {
            columns,
            shares: &mut shares,
            vector: &mut left,
        });
        for (at, share) in shares.iter().enumerate() {
            let column = columns.column(at);
            let product = dot(column, &plain);
            assert!(share.total_cmp(&(0.5 + product)).is_eq());
            plain
                .iter_mut()
                .zip(column)
                .for_each(|(p, c)| *p -= product * c);
        }
        assert_eq!(left, plain);
    }
}
