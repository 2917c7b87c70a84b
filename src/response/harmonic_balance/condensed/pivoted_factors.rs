//! The linear part of one harmonic by an LU factorisation that exchanges rows, in modal coordinates.

use crate::linalg::{
    Complex64, ComplexProduct, LuWorkspace, Matrix, add_times, add_times_vector, vectorized,
};
use crate::response::harmonic_balance::equation::HarmonicBlock;

/// Factors of S and `A = S^-1 C^T`; real and imaginary parts column-major.
pub(super) struct PivotedFactors {
    factors: LuWorkspace<Complex64>,
    /// A, `n_modes x rows`.
    attachment: [Vec<f64>; 2],
    /// What the excitation does alone.
    response: Vec<f64>,
    right: Vec<Complex64>,
}

impl PivotedFactors {
    /// No factors yet.
    pub(super) fn new(block: &HarmonicBlock) -> Self {
        let contact = &block.structure.contact().real;
        let (m, n) = (contact.rows(), contact.columns());
        let parts = if block.harmonic == 0 { 1 } else { 2 };
        Self {
            factors: LuWorkspace::new(n),
            attachment: [vec![0.0; n * m], vec![0.0; n * m]],
            response: vec![0.0; parts * n],
            right: vec![Complex64::default(); n],
        }
    }

    /// False if S is singular; R into `receptance`, and the motion at the contact rows under `force`, which excites
    /// harmonic 1, into `motion`.
    pub(super) fn factor(
        &mut self,
        block: &HarmonicBlock,
        omega: f64,
        force: &[Complex64],
        receptance: &mut [Vec<f64>; 2],
        motion: &mut [f64],
    ) -> bool {
        let structure = &block.structure;
        let contact = &structure.contact().real;
        let (m, n) = (contact.rows(), contact.columns());
        let k_omega = f64::from(block.harmonic) * omega;
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
        for (part, (attached, receptance)) in parts
            .into_iter()
            .zip(self.attachment.iter_mut().zip(receptance))
        {
            for (entry, z) in attached.iter_mut().zip(attachment.as_slice()) {
                *entry = part(z);
            }
            receptance.fill(0.0);
            add_times(receptance, contact.as_slice(), attached, (m, m, n));
        }
        if block.harmonic == 1 {
            self.right.copy_from_slice(force);
            self.factors.solve(&mut self.right);
            for (mode, z) in self.right.iter().enumerate() {
                (self.response[mode], self.response[n + mode]) = (z.re, z.im);
            }
            motion.fill(0.0);
            let size = (m, 2, n);
            add_times(motion, contact.as_slice(), &self.response, size);
        }
        true
    }

    /// `x = S^-1 (f - C^T forces)`.
    pub(super) fn response(&self, forces: &[f64], x: &mut [f64]) {
        x.copy_from_slice(&self.response);
        self.add_attached(x, -1.0, forces);
    }

    /// `S^-1 right`, in place; real parts, then imaginary ones where it is not harmonic 0.
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

    /// Adds `factor A forces`; both real parts, then imaginary ones where it is not harmonic 0.
    pub(super) fn add_attached(&self, sum: &mut [f64], factor: f64, forces: &[f64]) {
        add_product(sum, factor, &self.attachment, forces);
    }
}

/// `sum += factor matrix x`; both real parts, then imaginary ones unless the vectors have as many numbers as the matrix
/// has rows and columns.
pub(super) fn add_product(sum: &mut [f64], factor: f64, matrix: &[Vec<f64>; 2], x: &[f64]) {
    if sum.len() * x.len() == matrix[0].len() {
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
