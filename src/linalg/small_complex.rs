//! Gaussian elimination for small complex systems with several right-hand sides.
//!
//! A dozen unknowns take a general factorisation longer to prepare than to do; the receptances of a wheel's waves are
//! thousands of such systems a second.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::{Complex64, Loops, vectorized};

/// `A X = B`: the rows of A and B side by side, real and imaginary parts apart.
#[derive(Debug, Clone)]
pub struct SmallComplex {
    unknowns: usize,
    /// Columns of A and B together.
    width: usize,
    re: Vec<f64>,
    im: Vec<f64>,
}

impl SmallComplex {
    /// A system of `unknowns` with `right` right-hand sides, all entries zero.
    #[must_use]
    pub fn new(unknowns: usize, right: usize) -> Self {
        let width = unknowns + right;
        Self {
            unknowns,
            width,
            re: vec![0.0; unknowns * width],
            im: vec![0.0; unknowns * width],
        }
    }

    /// Sets an entry of A.
    pub fn set(&mut self, row: usize, column: usize, entry: Complex64) {
        let at = row * self.width + column;
        (self.re[at], self.im[at]) = (entry.re, entry.im);
    }

    /// Sets an entry of B.
    pub fn set_right(&mut self, row: usize, side: usize, entry: Complex64) {
        self.set(row, self.unknowns + side, entry);
    }

    /// An entry of X after [`Self::solve`].
    #[must_use]
    pub fn solution(&self, row: usize, side: usize) -> Complex64 {
        let at = row * self.width + self.unknowns + side;
        Complex64::new(self.re[at], self.im[at])
    }

    /// X in the place of B, by elimination above and below the pivots, of which each is the largest left in its column;
    /// false if a column has none.
    pub fn solve(&mut self) -> bool {
        vectorized(Elimination(self))
    }

    #[inline(always)]
    fn eliminate(&mut self) -> bool {
        for column in 0..self.unknowns {
            let size = |row: usize| {
                let at = row * self.width + column;
                self.re[at].abs() + self.im[at].abs()
            };
            let mut pivot = column;
            for row in column + 1..self.unknowns {
                if size(row) > size(pivot) {
                    pivot = row;
                }
            }
            let largest = size(pivot);
            if !(largest > 0.0 && largest.is_finite()) {
                return false;
            }
            self.exchange(column, pivot);
            self.take_off(column);
        }
        true
    }

    #[inline(always)]
    fn exchange(&mut self, row: usize, other: usize) {
        if row == other {
            return;
        }
        for part in [&mut self.re, &mut self.im] {
            let (above, below) = part.split_at_mut(other * self.width);
            above[row * self.width..][..self.width].swap_with_slice(&mut below[..self.width]);
        }
    }

    /// The row of the pivot becomes one with 1 there, and every other row one with 0.
    #[inline(always)]
    fn take_off(&mut self, pivot: usize) {
        let (width, own) = (self.width, pivot * self.width);
        let inverse = Complex64::new(self.re[own + pivot], self.im[own + pivot]).inv();
        // Columns before the pivot's are done with.
        for column in pivot..width {
            let entry = Complex64::new(self.re[own + column], self.im[own + column]) * inverse;
            (self.re[own + column], self.im[own + column]) = (entry.re, entry.im);
        }
        let (re_above, re_rest) = self.re.split_at_mut(own);
        let (im_above, im_rest) = self.im.split_at_mut(own);
        let (re_own, re_below) = re_rest.split_at_mut(width);
        let (im_own, im_below) = im_rest.split_at_mut(width);
        let pivot_row = [&re_own[pivot..], &im_own[pivot..]];
        subtract_from([re_above, im_above], pivot_row, width);
        subtract_from([re_below, im_below], pivot_row, width);
    }
}

/// Every row less the row of the pivot times the entry that is to become 0, the first one.
#[inline(always)]
fn subtract_from(rows: [&mut [f64]; 2], [re_own, im_own]: [&[f64]; 2], width: usize) {
    let [re, im] = rows.map(|part| part.chunks_exact_mut(width));
    for (re, im) in re.zip(im) {
        let (re, im) = (
            &mut re[width - re_own.len()..],
            &mut im[width - re_own.len()..],
        );
        let (a, b) = (re[0], im[0]);
        for ((re, im), (own_re, own_im)) in re.iter_mut().zip(im).zip(re_own.iter().zip(im_own)) {
            *re -= a * own_re - b * own_im;
            *im -= a * own_im + b * own_re;
        }
    }
}

struct Elimination<'a>(&'a mut SmallComplex);

impl Loops for Elimination<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.0.eliminate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(row: usize, column: usize) -> Complex64 {
        let angle = (1 + row * 7 + column * 3) as f64;
        Complex64::new((1.3 * angle).sin(), (0.7 * angle).cos())
    }

    #[test]
    fn the_solution_solves_the_equations_with_any_order_of_pivots() {
        for n in [1, 2, 5, 12] {
            // Zeros on the diagonal: without an exchange of rows there is no pivot.
            let a = |i: usize, j: usize| {
                if i == j && n > 1 {
                    Complex64::default()
                } else {
                    entry(i, j)
                }
            };
            let mut system = SmallComplex::new(n, 3);
            for i in 0..n {
                (0..n).for_each(|j| system.set(i, j, a(i, j)));
                (0..3).for_each(|side| system.set_right(i, side, entry(i + 20, side)));
            }
            assert!(system.solve());
            for i in 0..n {
                for side in 0..3 {
                    let product: Complex64 =
                        (0..n).map(|j| a(i, j) * system.solution(j, side)).sum();
                    assert!(
                        (product - entry(i + 20, side)).norm() < 1e-11,
                        "{n}: {product}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_singular_matrix_and_one_without_numbers_are_told() {
        let mut singular = SmallComplex::new(2, 1);
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            singular.set(i, j, Complex64::new(1.0, 1.0));
        }
        assert!(!singular.solve());
        let mut none = SmallComplex::new(1, 1);
        none.set(0, 0, Complex64::new(f64::NAN, 0.0));
        assert!(!none.solve());
    }
}
