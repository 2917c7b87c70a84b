//! The linear part of one harmonic at one frequency, factored, and what it makes of forces at the contact rows.
//!
//! In [`ContactCoordinates`] by [`ComplexCholesky`]: with `S = Q L L^T Q^T`, `X = C Q L^-T` and `g = L^-1 Q^T f`
//!
//! ```text
//! R = X X^T,    C S^-1 f = X g,    S^-1 (f - C^T y) = Q L^-T (g - X^T y)
//! ```

use std::sync::Arc;

use super::pivoted_factors::{PivotedFactors, add_product};
use crate::linalg::{BlockVector, Complex64, ComplexCholesky, ComplexSymmetric, RowBlocks};
use crate::response::harmonic_balance::equation::{ContactCoordinates, HarmonicBlock};

/// `S_k` and `R_k` of one harmonic; real and imaginary parts column-major.
pub(super) struct LinearFactors {
    /// omega of the factors.
    pub(super) at: Option<f64>,
    coordinates: Arc<ContactCoordinates>,
    /// `Q^T (diag(lambda) + C^T k C) Q`.
    stuck: Arc<RowBlocks>,
    symmetric: ComplexCholesky,
    /// g.
    excitation: BlockVector,
    /// Where the symmetric factors are none to rely on, and whether it is so.
    pivoted: Option<PivotedFactors>,
    is_pivoted: bool,
    /// R, `rows x rows`.
    pub(super) receptance: [Vec<f64>; 2],
    /// Motion at the contact rows under the excitation alone.
    pub(super) motion: Vec<f64>,
    /// Number of its first coefficient.
    pub(super) coefficient: usize,
    /// One for harmonic 0, else two.
    pub(super) parts: usize,
}

impl LinearFactors {
    /// No factors yet; `stuck` is the stiffness with contact springs in the coordinates of the structure, `coefficient` the
    /// first of the harmonic.
    pub(super) fn new(block: &HarmonicBlock, stuck: Arc<RowBlocks>, coefficient: usize) -> Self {
        let coordinates = Arc::clone(block.structure.contact_coordinates());
        let (m, n) = (coordinates.rows().rows(), coordinates.rows().columns());
        let parts = if block.harmonic == 0 { 1 } else { 2 };
        Self {
            at: None,
            symmetric: ComplexCholesky::new(coordinates.rows()),
            coordinates,
            stuck,
            excitation: BlockVector::zeros(n),
            pivoted: None,
            is_pivoted: false,
            receptance: [vec![0.0; m * m], vec![0.0; m * m]],
            motion: vec![0.0; parts * m],
            coefficient,
            parts,
        }
    }

    /// Contact rows.
    pub(super) fn rows(&self) -> usize {
        self.motion.len() / self.parts
    }

    /// False if `S_k` is singular; `force` excites harmonic 1.
    pub(super) fn factor(
        &mut self,
        block: &HarmonicBlock,
        omega: f64,
        force: &[Complex64],
    ) -> bool {
        self.is_pivoted = !self.factor_symmetric(block, omega, force);
        let regular = !self.is_pivoted || {
            let pivoted = self
                .pivoted
                .get_or_insert_with(|| PivotedFactors::new(block));
            pivoted.factor(block, omega, force, &mut self.receptance, &mut self.motion)
        };
        self.at = regular.then_some(omega);
        regular
    }

    /// Factors `S_k` without exchange of rows; false if it is singular or the factors are not to be relied on.
    fn factor_symmetric(&mut self, block: &HarmonicBlock, omega: f64, force: &[Complex64]) -> bool {
        let k_omega = f64::from(block.harmonic) * omega;
        let damping = match block.harmonic {
            // Harmonic 0 has no damping.
            0 => Vec::new(),
            _ => self.coordinates.damping(k_omega),
        };
        let reliable = self.symmetric.factor(&ComplexSymmetric {
            real: &self.stuck,
            shift: k_omega * k_omega,
            imaginary: &damping,
        });
        if !reliable {
            return false;
        }
        let [real, imaginary] = &mut self.receptance;
        self.symmetric.schur_complement([real, imaginary]);
        if block.harmonic == 1 {
            let [real, imaginary] = [|z: &Complex64| z.re, |z: &Complex64| z.im]
                .map(|part| -> Vec<f64> { force.iter().map(part).collect() });
            let force = BlockVector::of(&real, &imaginary);
            self.excitation = self.coordinates.turned(&force);
            self.symmetric.forward(&mut self.excitation);
            let motion = self.symmetric.border_times(&self.excitation);
            self.motion.fill(0.0);
            let rows = self.motion.len() / 2;
            let (real, imaginary) = self.motion.split_at_mut(rows);
            motion.add_to(1.0, real, imaginary);
        }
        true
    }

    /// `S_k^-1 (f - C^T forces)`.
    pub(super) fn response(&self, forces: &[f64], x: &mut [f64]) {
        if let Some(pivoted) = self.pivoted_at_hand() {
            return pivoted.response(forces, x);
        }
        let mut right = self.excitation.clone();
        self.subtract_reduced(&mut right, forces);
        x.fill(0.0);
        self.add_substituted(x, 1.0, right);
    }

    /// `S_k^-1 right`, in place; real parts, then imaginary ones where it is not harmonic 0.
    pub(super) fn solve(&mut self, right: &mut [f64]) {
        if self.is_pivoted
            && let Some(pivoted) = &mut self.pivoted
        {
            return pivoted.solve(right);
        }
        let (real, imaginary) = right.split_at(right.len() / self.parts);
        let mut turned = self.coordinates.turned(&BlockVector::of(real, imaginary));
        self.symmetric.forward(&mut turned);
        right.fill(0.0);
        self.add_substituted(right, 1.0, turned);
    }

    /// Adds `factor S_k^-1 C^T forces`; both real parts, then imaginary ones where it is not harmonic 0.
    pub(super) fn add_attached(&self, sum: &mut [f64], factor: f64, forces: &[f64]) {
        if let Some(pivoted) = self.pivoted_at_hand() {
            return pivoted.add_attached(sum, factor, forces);
        }
        let mut right = BlockVector::zeros(sum.len() / self.parts);
        self.subtract_reduced(&mut right, forces);
        self.add_substituted(sum, -factor, right);
    }

    /// Adds `factor R_k forces`, as [`Self::add_attached`].
    pub(super) fn add_motion(&self, sum: &mut [f64], factor: f64, forces: &[f64]) {
        add_product(sum, factor, &self.receptance, forces);
    }

    fn pivoted_at_hand(&self) -> Option<&PivotedFactors> {
        self.pivoted.as_ref().filter(|_| self.is_pivoted)
    }

    /// `sum -= X^T forces`.
    fn subtract_reduced(&self, sum: &mut BlockVector, forces: &[f64]) {
        let (real, imaginary) = forces.split_at(forces.len() / self.parts);
        let forces = BlockVector::of(real, imaginary);
        self.symmetric.subtract_border_transposed(sum, &forces);
    }

    /// `x += factor Q L^-T right`.
    fn add_substituted(&self, x: &mut [f64], factor: f64, mut right: BlockVector) {
        self.symmetric.backward(&mut right);
        let modes = self.coordinates.modes_of(&right);
        let (real, imaginary) = x.split_at_mut(x.len() / self.parts);
        modes.add_to(factor, real, imaginary);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Matrix;
    use crate::response::harmonic_balance::Damping;
    use crate::response::harmonic_balance::equation::Structure;
    use crate::response::mistuning::{ModalRows, StructuralModes};

    const UNDAMPED: Damping = Damping::StructuralLossFactor(0.0);

    /// `n` modes and `m` contact rows, of which the last is the first again.
    fn block(harmonic: u32, (m, n): (usize, usize), damping: Damping) -> HarmonicBlock {
        let rows = |count: usize, phase: f64| ModalRows {
            real: Matrix::from_fn(count, n, |i, j| {
                (phase + 1.3 * (i % (count - 1)) as f64 + 2.9 * (j * (j + i % (count - 1))) as f64)
                    .sin()
            }),
            imaginary: None,
        };
        let eigenvalues: Vec<f64> = (0..n).map(|j| 1.0 + 0.3 * (j * j) as f64).collect();
        let structure = Structure::new(
            StructuralModes {
                tuned_eigenvalues: eigenvalues.iter().map(|lambda| 1.1 * lambda).collect(),
                rotation: Some(Matrix::from_fn(n, n, |i, j| {
                    f64::from(u8::from(i == j)) + 0.1 * ((3 * i + j) as f64).cos()
                })),
                added_damping_per_s: vec![0.0; n],
                contact: rows(m, 0.2),
                observed: rows(3, 0.4),
                sectors: 1,
                eigenvalues,
            },
            damping,
        );
        let springs: Vec<f64> = (0..m).map(|i| 0.5 + 0.1 * i as f64).collect();
        let stuck = Arc::new(structure.contact_stiffness(&springs));
        HarmonicBlock {
            harmonic,
            structure: Arc::new(structure),
            stuck,
        }
    }

    fn linear(block: &HarmonicBlock) -> LinearFactors {
        let coordinates = block.structure.contact_coordinates();
        LinearFactors::new(block, Arc::new(coordinates.stuck(&block.stuck.springs)), 0)
    }

    fn numbers(count: usize, phase: f64) -> Vec<f64> {
        (0..count).map(|i| (phase + 1.7 * i as f64).sin()).collect()
    }

    /// Both kinds of factors at `omega`, and how far they are from each other in all that they do, relative to the largest.
    fn difference(block: &HarmonicBlock, omega: f64) -> (LinearFactors, f64) {
        let contact = &block.structure.contact().real;
        let (m, n) = (contact.rows(), contact.columns());
        let force: Vec<Complex64> = numbers(n, 0.6)
            .into_iter()
            .map(|re| Complex64::new(re, 0.3))
            .collect();
        let mut found = linear(block);
        assert!(found.factor(block, omega, &force));
        let parts = found.parts;
        let mut pivoted = PivotedFactors::new(block);
        let mut receptance = [vec![0.0; m * m], vec![0.0; m * m]];
        let mut motion = vec![0.0; parts * m];
        assert!(pivoted.factor(block, omega, &force, &mut receptance, &mut motion));
        let (forces, right) = (numbers(parts * m, 0.1), numbers(parts * n, 0.8));

        let mut pairs = vec![(found.motion.clone(), motion)];
        pairs.extend(found.receptance.iter().cloned().zip(receptance));
        let (mut actual, mut other) = (right.clone(), right.clone());
        found.response(&forces, &mut actual);
        pivoted.response(&forces, &mut other);
        pairs.push((actual, other));
        let (mut actual, mut other) = (right.clone(), right.clone());
        found.solve(&mut actual);
        pivoted.solve(&mut other);
        pairs.push((actual, other));
        let (mut actual, mut other) = (right.clone(), right);
        found.add_attached(&mut actual, -0.7, &forces);
        pivoted.add_attached(&mut other, -0.7, &forces);
        pairs.push((actual, other));
        let far = pairs.iter().map(|(actual, other)| {
            let largest = other
                .iter()
                .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
            let missed = actual
                .iter()
                .zip(other)
                .map(|(actual, other)| (actual - other).abs());
            missed.fold(0.0, f64::max) / largest
        });
        let far = far.fold(0.0, f64::max);
        (found, far)
    }

    #[test]
    fn factors_do_what_those_with_exchanged_rows_do_under_every_damping() {
        let rayleigh = Damping::Rayleigh {
            mass_per_s: 0.02,
            stiffness_s: 0.01,
        };
        for damping in [
            UNDAMPED,
            Damping::StructuralLossFactor(0.02),
            Damping::ModalRatio(0.01),
            rayleigh,
        ] {
            for size in [(24, 72), (5, 17), (7, 7), (9, 4)] {
                for harmonic in [0, 1, 3] {
                    let (found, far) = difference(&block(harmonic, size, damping), 1.37);
                    assert!(!found.is_pivoted);
                    assert!(far < 1e-10, "{damping:?} {size:?} {harmonic}: {far:e}");
                }
            }
        }
    }

    #[test]
    fn rows_are_exchanged_where_a_pivot_is_nearly_zero() {
        let block = block(1, (5, 17), UNDAMPED);
        // The motion of the first coordinate alone is in resonance there.
        let coordinates = block.structure.contact_coordinates();
        let (mut shape, mut none) = ([0.0; 17], [0.0; 17]);
        let mut first = shape;
        first[0] = 1.0;
        let modes = coordinates.modes_of(&BlockVector::of(&first, &none));
        modes.add_to(1.0, &mut shape, &mut none);
        let lambda = block.structure.eigenvalues().iter();
        let square: f64 = lambda.zip(shape).map(|(lambda, x)| lambda * x * x).sum();
        for (factor, pivoted) in [(1.0, true), (1.0 + 1e-9, true), (1.1, false)] {
            let (found, far) = difference(&block, factor * square.sqrt());
            assert_eq!(found.is_pivoted, pivoted, "{factor}");
            assert!(
                if pivoted { far == 0.0 } else { far < 1e-10 },
                "{factor}: {far:e}"
            );
        }
    }
}
