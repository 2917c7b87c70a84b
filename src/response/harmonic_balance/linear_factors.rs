//! The linear part of one harmonic at one frequency, factored, and what it makes of forces at the contact rows.

use super::HarmonicBlock;
use crate::linalg::{Complex64, LuWorkspace, Matrix, add_times};

/// `S_k`, `A_k` and `R_k` of one harmonic; real and imaginary parts column-major.
pub(super) struct LinearFactors {
    /// omega of the factors.
    pub(super) at: Option<f64>,
    factors: LuWorkspace<Complex64>,
    /// A, `n_modes x rows`.
    attachment: [Vec<f64>; 2],
    /// R, `rows x rows`.
    pub(super) receptance: [Vec<f64>; 2],
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
        Self {
            at: None,
            factors: LuWorkspace::new(n),
            attachment: [vec![0.0; n * m], vec![0.0; n * m]],
            receptance: [vec![0.0; m * m], vec![0.0; m * m]],
            coefficient,
            parts: if block.harmonic == 0 { 1 } else { 2 },
            right: vec![Complex64::default(); n],
        }
    }

    /// False if `S_k` is singular.
    pub(super) fn factor(&mut self, block: &HarmonicBlock, omega: f64) -> bool {
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

    /// Adds `A_k forces`; both real parts, then imaginary ones where it is not harmonic 0.
    pub(super) fn add_attached(&self, sum: &mut [f64], forces: &[f64], spread: &mut Vec<f64>) {
        let n = self.right.len();
        let m = forces.len() / self.parts;
        let size = (n, self.parts, m);
        add_times(sum, &self.attachment[0], forces, size);
        if let ([sum_re, sum_im], 2) = (split(sum, n), self.parts) {
            spread.clear();
            spread.resize(2 * n, 0.0);
            add_times(spread, &self.attachment[1], forces, size);
            let (by_re, by_im) = spread.split_at(n);
            for i in 0..n {
                sum_re[i] -= by_im[i];
                sum_im[i] += by_re[i];
            }
        }
    }
}

/// `values` before and from `n` on.
fn split(values: &mut [f64], n: usize) -> [&mut [f64]; 2] {
    let (first, second) = values.split_at_mut(n);
    [first, second]
}
