//! Matrices of the contact rows for every wave, and the loops over them.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use super::structure::Structure;
use crate::linalg::{Complex64, Loops};

/// Waves, or contact rows, whose sums are taken at a time.
const LANES: usize = 8;
const HALF: usize = 4;

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
    pub(super) into: &'a mut [Complex64],
}

impl Loops for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let width = self.parts[0].len();
        let rows = self.into.chunks_exact_mut(self.sectors);
        let table = [&self.table.re, &self.table.im].map(|part| part.chunks_exact(width));
        let [table_re, table_im] = table;
        for (product, row) in rows.zip(table_re.zip(table_im)) {
            let (blocks, rest) = product.as_chunks_mut::<LANES>();
            let done = LANES * blocks.len();
            for (block, product) in blocks.iter_mut().enumerate() {
                *product = waves_from(LANES * block, row.into(), self.parts, self.sectors);
            }
            for (wave, product) in rest.iter_mut().enumerate() {
                [*product] = waves_from(done + wave, row.into(), self.parts, self.sectors);
            }
        }
    }
}

/// Products of one row of a table in `COUNT` waves from `first` on.
#[inline(always)]
fn waves_from<const COUNT: usize>(
    first: usize,
    [row_re, row_im]: [&[f64]; 2],
    [re, im]: [&[f64]; 2],
    sectors: usize,
) -> [Complex64; COUNT] {
    let (mut sum_re, mut sum_im) = ([0.0; COUNT], [0.0; COUNT]);
    for from in (first..row_re.len()).step_by(sectors) {
        let own = [row_re, row_im, re, im].map(|part| &part[from..from + COUNT]);
        let [row_re, row_im, re, im] = own;
        for wave in 0..COUNT {
            sum_re[wave] += row_re[wave] * re[wave] - row_im[wave] * im[wave];
            sum_im[wave] += row_re[wave] * im[wave] + row_im[wave] * re[wave];
        }
    }
    std::array::from_fn(|wave| Complex64::new(sum_re[wave], sum_im[wave]))
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
        let contact = self.wave.contact();
        let n = contact.real.rows();
        let re = contact.real.as_slice();
        let none = vec![0.0; re.len()];
        let imaginary = contact.imaginary.as_ref();
        let im = imaginary.map_or(&*none, |imaginary| imaginary.as_slice());
        let modal = |(mode, lambda): (usize, &f64)| {
            let damping = self.wave.damping_diagonal(mode, self.k_omega);
            Complex64::new(lambda - self.k_omega * self.k_omega, damping).inv()
        };
        let modal: Vec<Complex64> = self
            .wave
            .eigenvalues()
            .iter()
            .enumerate()
            .map(modal)
            .collect();
        let mut weights = vec![Complex64::default(); modal.len()];
        let [sum_re, sum_im] = self.sums;
        for j in 0..n {
            for (mode, (weight, modal)) in weights.iter_mut().zip(&modal).enumerate() {
                let at = mode * n + j;
                *weight = Complex64::new(re[at], -im[at]) * modal;
            }
            let column = [&mut sum_re[j * n..][..n], &mut sum_im[j * n..][..n]];
            weighted_rows([re, im], &weights, column);
        }
    }
}

/// Sums over modes of `c_m w_m` for all rows, in blocks whose sums stay in registers.
#[inline(always)]
fn weighted_rows([re, im]: [&[f64]; 2], weights: &[Complex64], [sum_re, sum_im]: [&mut [f64]; 2]) {
    let n = sum_re.len();
    let mut row = 0;
    while row < n {
        let sums = [&mut sum_re[row..], &mut sum_im[row..]];
        row += match n - row {
            LANES.. => weighted::<LANES>(row, n, [re, im], weights, sums),
            HALF..LANES => weighted::<HALF>(row, n, [re, im], weights, sums),
            _ => weighted::<1>(row, n, [re, im], weights, sums),
        };
    }
}

/// The same for `COUNT` rows from `first` on; returns how many that are.
#[inline(always)]
fn weighted<const COUNT: usize>(
    first: usize,
    n: usize,
    [re, im]: [&[f64]; 2],
    weights: &[Complex64],
    [to_re, to_im]: [&mut [f64]; 2],
) -> usize {
    let (mut sum_re, mut sum_im) = ([0.0; COUNT], [0.0; COUNT]);
    for (mode, w) in weights.iter().enumerate() {
        let [re, im] = [re, im].map(|part| &part[mode * n + first..][..COUNT]);
        for row in 0..COUNT {
            sum_re[row] += re[row] * w.re - im[row] * w.im;
            sum_im[row] += re[row] * w.im + im[row] * w.re;
        }
    }
    to_re[..COUNT].copy_from_slice(&sum_re);
    to_im[..COUNT].copy_from_slice(&sum_im);
    COUNT
}
