//! The dynamic stiffness of one nodal diameter at one frequency, factorised by what its contact springs add.
//!
//! With `Z = D + C^H k C`, D diagonal, and the receptance `R = C D^-1 C^H` of the contact without its springs k,
//!
//! ```text
//! Z^-1 b = D^-1 (b - C^H t),      t = k (I + R k)^-1 C D^-1 b
//! Z^-H b = D^-H (b - C^H t'),     t' = (I + R k)^-H k C D^-H b
//! ```
//!
//! so that one factorisation, as small as the contact, serves Z, its adjoint and the receptances.

use crate::linalg::{Complex64, LuWorkspace, Matrix};

/// `Z(s)` of a nodal diameter, factorised.
pub(super) struct FactoredStiffness<'a> {
    /// Contact rows C, `c x n`; no row where there are no springs.
    contact: &'a Matrix<Complex64>,
    /// Springs k of the contact rows, N/m.
    springs: &'a [f64],
    factors: Factors,
}

enum Factors {
    /// The diagonal of `D^-1`, and `I + R k`.
    Sprung(Vec<Complex64>, LuWorkspace<Complex64>),
    /// The whole matrix, where D itself may be singular.
    Whole(LuWorkspace<Complex64>),
}

impl<'a> FactoredStiffness<'a> {
    /// From the diagonal of `D^-1` and a matrix that begins with the `c x c` block R; none if Z is singular.
    fn new(
        (contact, springs): (&'a Matrix<Complex64>, &'a [f64]),
        inverse: Vec<Complex64>,
        receptance: &Matrix<Complex64>,
    ) -> Option<Self> {
        let count = springs.len();
        let mut factors = LuWorkspace::<Complex64>::new(count);
        for j in 0..count {
            for i in 0..count {
                let one = if i == j { 1.0 } else { 0.0 };
                factors.matrix_mut()[j * count + i] = receptance[(i, j)] * springs[j] + one;
            }
        }
        factors.factor().then_some(Self {
            contact,
            springs,
            factors: Factors::Sprung(inverse, factors),
        })
    }

    /// From the diagonal of D; none if Z is singular.
    pub(super) fn of_diagonal(
        (contact, springs): (&'a Matrix<Complex64>, &'a [f64]),
        diagonal: &[Complex64],
    ) -> Option<Self> {
        let inverse: Vec<Complex64> = diagonal.iter().map(Complex64::inv).collect();
        let receptance = scaled_columns(contact, &inverse).times_adjoint(contact);
        Self::new((contact, springs), inverse, &receptance)
    }

    /// From the diagonal of a D that may be singular; none if Z is.
    pub(super) fn of_whole(
        (contact, springs): (&'a Matrix<Complex64>, &'a [f64]),
        diagonal: &[f64],
    ) -> Option<Self> {
        let n = diagonal.len();
        let stiffness = contact.adjoint_times(&scaled_rows(contact.clone(), springs));
        let mut factors = LuWorkspace::<Complex64>::new(n);
        factors.matrix_mut().copy_from_slice(stiffness.as_slice());
        for (mode, entry) in diagonal.iter().enumerate() {
            factors.matrix_mut()[mode * n + mode] += entry;
        }
        factors.factor().then_some(Self {
            contact,
            springs,
            factors: Factors::Whole(factors),
        })
    }

    /// `E Z^-1 F^H` with the motions E, a row each, of which the first are the contact rows where there are springs, and the first
    /// `inputs` of them, F; beside the factors by which it was found. D is given by its diagonal. None if Z is singular.
    pub(super) fn with_receptance(
        (contact, springs): (&'a Matrix<Complex64>, &'a [f64]),
        diagonal: &[Complex64],
        motions: &Matrix<Complex64>,
        inputs: usize,
    ) -> Option<(Self, Matrix<Complex64>)> {
        let inverse: Vec<Complex64> = diagonal.iter().map(Complex64::inv).collect();
        let leading: Vec<usize> = (0..inputs).collect();
        let forces = motions.select_rows(&leading);
        let mut receptance = scaled_columns(motions, &inverse).times_adjoint(&forces);
        let factored = Self::new((contact, springs), inverse, &receptance)?;
        let count = springs.len();
        let (Factors::Sprung(_, factors), 1..) = (&factored.factors, count) else {
            return Some((factored, receptance));
        };
        // (I + R k) d = R b: the relative motion with the springs, which pull by -k d.
        let mut motion = Matrix::from_fn(count, inputs, |i, j| receptance[(i, j)]);
        factors.solve_columns(&mut motion);
        let pull = Matrix::from_fn(count, inputs, |i, j| motion[(i, j)] * -springs[i]);
        let others = motions.rows() - count;
        let of_others = Matrix::from_fn(others, count, |i, j| receptance[(count + i, j)]);
        let pulled = of_others.times(&pull);
        for column in 0..inputs {
            // Where springs are stiff, the difference of two large motions is not what they leave.
            let (contact_rows, rest) = receptance.column_mut(column).split_at_mut(count);
            contact_rows.copy_from_slice(motion.column(column));
            for (entry, change) in rest.iter_mut().zip(pulled.column(column)) {
                *entry += change;
            }
        }
        Some((factored, receptance))
    }

    /// `Z^-1` times the columns of `right`, `n x m`.
    pub(super) fn solve(&self, mut right: Matrix<Complex64>) -> Matrix<Complex64> {
        match &self.factors {
            Factors::Whole(factors) => factors.solve_columns(&mut right),
            Factors::Sprung(inverse, factors) => {
                right = scaled_rows(right, inverse);
                if !self.springs.is_empty() {
                    let mut pull = self.contact.times(&right);
                    factors.solve_columns(&mut pull);
                    let pull = scaled_rows(pull, self.springs);
                    self.take_off(&mut right, &pull, inverse);
                }
            }
        }
        right
    }

    /// `Z^-H` times the columns of `right`, `n x m`.
    pub(super) fn solve_adjoint(&self, mut right: Matrix<Complex64>) -> Matrix<Complex64> {
        match &self.factors {
            Factors::Whole(factors) => factors.solve_adjoint_columns(&mut right),
            Factors::Sprung(inverse, factors) => {
                let conjugate: Vec<Complex64> = inverse.iter().map(Complex64::conj).collect();
                right = scaled_rows(right, &conjugate);
                if !self.springs.is_empty() {
                    let mut pull = scaled_rows(self.contact.times(&right), self.springs);
                    factors.solve_adjoint_columns(&mut pull);
                    self.take_off(&mut right, &pull, &conjugate);
                }
            }
        }
        right
    }

    /// `motions -= inverse C^H pull`, with the diagonal `inverse`.
    fn take_off(
        &self,
        motions: &mut Matrix<Complex64>,
        pull: &Matrix<Complex64>,
        inverse: &[Complex64],
    ) {
        let spread = scaled_rows(self.contact.adjoint_times(pull), inverse);
        let entries = motions.as_mut_slice().iter_mut();
        entries
            .zip(spread.as_slice())
            .for_each(|(entry, change)| *entry -= change);
    }
}

/// Column j of a matrix times `factors[j]`.
fn scaled_columns(matrix: &Matrix<Complex64>, factors: &[Complex64]) -> Matrix<Complex64> {
    let mut scaled = matrix.clone();
    let rows = matrix.rows().max(1);
    for (column, factor) in scaled.as_mut_slice().chunks_exact_mut(rows).zip(factors) {
        for entry in column {
            *entry *= factor;
        }
    }
    scaled
}

/// Row i of a matrix times `factors[i]`.
fn scaled_rows<F: Copy>(mut matrix: Matrix<Complex64>, factors: &[F]) -> Matrix<Complex64>
where
    Complex64: std::ops::MulAssign<F>,
{
    let rows = matrix.rows().max(1);
    for column in matrix.as_mut_slice().chunks_exact_mut(rows) {
        for (entry, &factor) in column.iter_mut().zip(factors) {
            *entry *= factor;
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(place: usize) -> Complex64 {
        let turn = 0.3 + 1.7 * place as f64 + 0.01 * (place * place) as f64;
        Complex64::new(turn.sin(), (1.3 * turn).cos())
    }

    fn filled(rows: usize, columns: usize, first: usize) -> Matrix<Complex64> {
        Matrix::from_fn(rows, columns, |i, j| number(first + 10 * i + j))
    }

    /// `Z` or its adjoint, entry by entry, times the columns of a matrix.
    fn product(z: &Matrix<Complex64>, adjoint: bool, x: &Matrix<Complex64>) -> Matrix<Complex64> {
        Matrix::from_fn(x.rows(), x.columns(), |i, j| {
            let entry = |k: usize| if adjoint { z[(k, i)].conj() } else { z[(i, k)] };
            (0..x.rows()).map(|k| entry(k) * x[(k, j)]).sum()
        })
    }

    fn largest_difference(a: &Matrix<Complex64>, b: &Matrix<Complex64>) -> f64 {
        let both = a.as_slice().iter().zip(b.as_slice());
        both.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    }

    #[test]
    fn solutions_of_the_matrix_and_of_its_adjoint_and_receptances_are_those_of_all_entries() {
        let (modes, real) = (7, [1.0, 4.0, 7.0, 10.0, 13.0, 16.0, 19.0]);
        let diagonal = real.map(|lambda| Complex64::new(lambda - 3.3, 0.02 * lambda));
        // Springs that act, one that does not, and none.
        for springs in [vec![0.7, 0.2, 0.0], Vec::new()] {
            let contact = filled(springs.len(), modes, 0);
            let whole = |diagonal: &dyn Fn(usize) -> Complex64| {
                Matrix::from_fn(modes, modes, |i, j| {
                    let rows = springs.iter().enumerate();
                    let sprung = rows.map(|(r, k)| contact[(r, i)].conj() * k * contact[(r, j)]);
                    let own = if i == j { diagonal(i) } else { 0.0.into() };
                    sprung.sum::<Complex64>() + own
                })
            };
            let right = filled(modes, 2, 500);
            let of_contact = (&contact, &*springs);
            let sprung = FactoredStiffness::of_diagonal(of_contact, &diagonal).expect("regular");
            let dense = FactoredStiffness::of_whole(of_contact, &real).expect("regular");
            let z = whole(&|mode| diagonal[mode]);
            let undamped = whole(&|mode| real[mode].into());
            for (factored, z) in [(&sprung, &z), (&dense, &undamped)] {
                let solved = product(z, false, &factored.solve(right.clone()));
                assert!(largest_difference(&solved, &right) < 1e-12);
                let solved = product(z, true, &factored.solve_adjoint(right.clone()));
                assert!(largest_difference(&solved, &right) < 1e-12);
            }
            let others = filled(3, modes, 100);
            let motions = Matrix::from_fn(springs.len() + 3, modes, |i, j| {
                if i < springs.len() {
                    contact[(i, j)]
                } else {
                    others[(i - springs.len(), j)]
                }
            });
            let inputs = springs.len() + 2;
            let (_, receptance) =
                FactoredStiffness::with_receptance(of_contact, &diagonal, &motions, inputs)
                    .expect("regular");
            let forces = motions.select_rows(&(0..inputs).collect::<Vec<_>>());
            let direct = motions.times(&sprung.solve(forces.adjoint()));
            assert!(largest_difference(&receptance, &direct) < 1e-12);
        }
    }

    #[test]
    fn a_singular_matrix_has_no_factors() {
        let contact = Matrix::zeros(0, 2);
        let singular = FactoredStiffness::of_whole((&contact, &[]), &[1.0, 0.0]);
        assert!(singular.is_none());
    }
}
