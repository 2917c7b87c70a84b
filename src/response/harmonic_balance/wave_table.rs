//! Matrices of the contact rows for every wave, and the loops over them.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::structure::Structure;
use crate::linalg::{Complex64, Loops};

/// A matrix of the contact rows of a sector for every wave: entry (i, j) of wave h at `(i rows + j) N + h`.
#[derive(Debug, Clone, Default)]
pub(super) struct WaveTable {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl WaveTable {
    /// A table with the same number everywhere.
    pub(super) fn filled(number: f64, entries: usize) -> Self {
        Self {
            re: vec![number; entries],
            im: vec![number; entries],
        }
    }

    pub(super) fn set(&mut self, at: usize, entry: Complex64) {
        (self.re[at], self.im[at]) = (entry.re, entry.im);
    }

    pub(super) fn at(&self, at: usize) -> Complex64 {
        Complex64::new(self.re[at], self.im[at])
    }
}

/// The product of a table with one value per row and wave.
pub(super) struct Products<'a> {
    pub(super) table: &'a WaveTable,
    pub(super) sectors: usize,
    /// The values, real and imaginary parts.
    pub(super) parts: [&'a [f64]; 2],
    /// Room for one row of the product.
    pub(super) row: [&'a mut [f64]; 2],
    pub(super) into: &'a mut [Complex64],
}

impl Loops for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            table,
            sectors,
            parts: [re, im],
            row: [row_re, row_im],
            into,
        } = self;
        let width = re.len();
        let rows = into
            .chunks_exact_mut(sectors)
            .zip(table.re.chunks_exact(width))
            .zip(table.im.chunks_exact(width));
        for ((product, table_re), table_im) in rows {
            row_re.fill(0.0);
            row_im.fill(0.0);
            let table = table_re
                .chunks_exact(sectors)
                .zip(table_im.chunks_exact(sectors));
            let values = re.chunks_exact(sectors).zip(im.chunks_exact(sectors));
            for ((r_re, r_im), (v_re, v_im)) in table.zip(values) {
                for h in 0..sectors {
                    row_re[h] += r_re[h] * v_re[h] - r_im[h] * v_im[h];
                    row_im[h] += r_re[h] * v_im[h] + r_im[h] * v_re[h];
                }
            }
            for (product, (re, im)) in product.iter_mut().zip(row_re.iter().zip(&*row_im)) {
                *product = Complex64::new(*re, *im);
            }
        }
    }
}

/// `sum_m c_m c_m^H / (lambda_m - (k omega)^2 + i D_m)`, real and imaginary parts, column-major.
pub(super) struct ModalSums<'a> {
    pub(super) wave: &'a Structure,
    pub(super) k_omega: f64,
    pub(super) sums: [&'a mut [f64]; 2],
}

impl Loops for ModalSums<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            wave,
            k_omega,
            sums: [sum_re, sum_im],
        } = self;
        let contact = wave.contact();
        let n = contact.real.rows();
        let none = vec![0.0; n];
        for (mode, lambda) in wave.eigenvalues().iter().enumerate() {
            let damping = wave.damping_diagonal(mode, k_omega);
            let modal = Complex64::new(lambda - k_omega * k_omega, damping).inv();
            let re = contact.real.column(mode);
            let imaginary = contact.imaginary.as_ref();
            let im = imaginary.map_or(&*none, |imaginary| imaginary.column(mode));
            for j in 0..n {
                let w = Complex64::new(re[j], -im[j]) * modal;
                let to_re = &mut sum_re[j * n..][..n];
                let to_im = &mut sum_im[j * n..][..n];
                for i in 0..n {
                    to_re[i] += re[i] * w.re - im[i] * w.im;
                    to_im[i] += re[i] * w.im + im[i] * w.re;
                }
            }
        }
    }
}
