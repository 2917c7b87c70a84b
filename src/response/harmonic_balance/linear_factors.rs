//! The linear part of one harmonic at one frequency, factored, and what it makes of forces at the contact rows.

use super::HarmonicBlock;
use super::vector_sums::ComplexProduct;
use crate::linalg::{Complex64, LuWorkspace, Matrix, add_times, add_times_vector, vectorized};

/// `S_k`, `A_k` and `R_k` of one harmonic; real and imaginary parts column-major.
pub(super) struct LinearFactors {
    /// omega of the factors.
    pub(super) at: Option<f64>,
    factors: LuWorkspace<Complex64>,
    /// A, `n_modes x rows`.
    attachment: [Vec<f64>; 2],
    /// R, `rows x rows`.
    pub(super) receptance: [Vec<f64>; 2],
    /// What the excitation does alone, unknowns of the harmonic.
    pub(super) response: Vec<f64>,
    /// Its motion at the contact rows.
    pub(super) motion: Vec<f64>,
    /// Number of its first coefficient.
    pub(super) coefficient: usize,
    /// One for harmonic 0, else two.
    pub(super) parts: usize,
    right: Vec<Complex64>,
}

impl LinearFactors {
    /// No factors yet; `coefficient` is the first of the harmonic.
    pub(super) fn new(block: &HarmonicBlock, coefficient: usize) -> Self {
        let contact = &block.structure.contact().real;
        let (m, n) = (contact.rows(), contact.columns());
        let parts = if block.harmonic == 0 { 1 } else { 2 };
        Self {
            at: None,
            factors: LuWorkspace::new(n),
            attachment: [vec![0.0; n * m], vec![0.0; n * m]],
            receptance: [vec![0.0; m * m], vec![0.0; m * m]],
            response: vec![0.0; parts * n],
            motion: vec![0.0; parts * m],
            coefficient,
            parts,
            right: vec![Complex64::default(); n],
        }
    }

    /// False if `S_k` is singular; `force` excites harmonic 1.
    pub(super) fn factor(
        &mut self,
        block: &HarmonicBlock,
        omega: f64,
        force: &[Complex64],
    ) -> bool {
        let structure = &block.structure;
        let contact = &structure.contact().real;
        let (m, n) = (contact.rows(), contact.columns());
        let k_omega = f64::from(block.harmonic) * omega;
        self.at = None;
        let matrix = self.factors.matrix_mut();
        structure.dynamic_stiffness(k_omega, Some(&block.stuck), matrix);
        if block.harmonic == 0 {
            // Harmonic 0 has no damping.
            for entry in matrix {
                entry.im = 0.0;
            }
        }
        if !self.factors.factor() {
            return false;
        }
        let mut attachment = Matrix::from_fn(n, m, |i, j| Complex64::new(contact[(j, i)], 0.0));
        self.factors.solve_columns(&mut attachment);
        let parts: [fn(&Complex64) -> f64; 2] = [|z| z.re, |z| z.im];
        for (part, (own, receptance)) in parts
            .into_iter()
            .zip(self.attachment.iter_mut().zip(&mut self.receptance))
        {
            for (entry, z) in own.iter_mut().zip(attachment.as_slice()) {
                *entry = part(z);
            }
            receptance.fill(0.0);
            add_times(receptance, contact.as_slice(), own, (m, m, n));
        }
        if block.harmonic == 1 {
            // By itself, so that it is the linear response to the last bit.
            self.right.copy_from_slice(force);
            self.factors.solve(&mut self.right);
            for (mode, z) in self.right.iter().enumerate() {
                (self.response[mode], self.response[n + mode]) = (z.re, z.im);
            }
            self.motion.fill(0.0);
            let size = (m, 2, n);
            add_times(&mut self.motion, contact.as_slice(), &self.response, size);
        }
        self.at = Some(omega);
        true
    }

    /// `S_k^-1 right`, in place; real parts, then imaginary ones where it is not harmonic 0.
    pub(super) fn solve(&mut self, right: &mut [f64]) {
        let n = self.right.len();
        let imaginary = |i: usize| right.get(n + i).copied().unwrap_or(0.0);
        for (i, z) in self.right.iter_mut().enumerate() {
            *z = Complex64::new(right[i], imaginary(i));
        }
        self.factors.solve(&mut self.right);
        for (i, z) in self.right.iter().enumerate() {
            right[i] = z.re;
            if let Some(imaginary) = right.get_mut(n + i) {
                *imaginary = z.im;
            }
        }
    }

    /// Adds `factor A_k forces`; both real parts, then imaginary ones where it is not harmonic 0.
    pub(super) fn add_attached(&self, sum: &mut [f64], factor: f64, forces: &[f64]) {
        add_product(sum, factor, &self.attachment, forces, self.parts);
    }

    /// Adds `factor R_k forces`, as [`Self::add_attached`].
    pub(super) fn add_motion(&self, sum: &mut [f64], factor: f64, forces: &[f64]) {
        add_product(sum, factor, &self.receptance, forces, self.parts);
    }
}

fn add_product(sum: &mut [f64], factor: f64, matrix: &[Vec<f64>; 2], x: &[f64], parts: usize) {
    if parts == 1 {
        add_times_vector(sum, factor, &matrix[0], x);
        return;
    }
    let (half, rows) = (x.len() / 2, sum.len() / 2);
    let (sum_re, sum_im) = sum.split_at_mut(rows);
    vectorized(ComplexProduct {
        sum: [sum_re, sum_im],
        factor,
        matrix: [&matrix[0], &matrix[1]],
        x: [&x[..half], &x[half..]],
    });
}
