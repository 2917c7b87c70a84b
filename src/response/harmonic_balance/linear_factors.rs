//! The linear part of one harmonic at one frequency, factored, and what it makes of forces at the contact rows.
//!
//! In [`ContactCoordinates`] by [`ComplexCholesky`]: with `S = Q L L^T Q^T`, `X = C Q L^-T` and `g = L^-1 Q^T f`
//!
//! ```text
//! R = X X^T,    C S^-1 f = X g,    S^-1 (f - C^T y) = Q L^-T (g - X^T y)
//! ```

use std::sync::Arc;

use super::HarmonicBlock;
use super::contact_coordinates::ContactCoordinates;
use super::pivoted_factors::{PivotedFactors, add_product};
use crate::linalg::{BlockVector, Complex64, ComplexCholesky, ComplexSymmetric, RowBlocks};

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

    /// The same without exchange of rows; false also if that is not to be relied on.
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
            self.excitation = self.coordinates.from_modes(&force);
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
        let mut turned = self
            .coordinates
            .from_modes(&BlockVector::of(real, imaginary));
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
        let modes = self.coordinates.to_modes(&right);
        let (real, imaginary) = x.split_at_mut(x.len() / self.parts);
        modes.add_to(factor, real, imaginary);
    }
}
