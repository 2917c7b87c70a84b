//! Transform between the harmonics of a periodic signal and its samples.
//!
//! ```text
//! x(t) = X_0 + sum_k Re(X_k e^{i k w t})
//! samples at w t_j = tau_j = 2 pi j / n,    j = 0 .. n-1
//! ```
//!
//! In real form, with one *coefficient* for harmonic 0 and two (`Re X_k`, `Im X_k`) for every other
//! harmonic:
//!
//! ```text
//! x_j = sum_c phi_c(tau_j) X_c,    phi = 1, cos(k tau), -sin(k tau)
//! X_c = sum_j psi_c(tau_j) x_j,    psi = phi / n for harmonic 0, 2 phi / n otherwise
//! ```
//!
//! A batch of channels is transformed by these sums (few harmonics) or by an FFT of two real
//! channels at a time (many harmonics); the two agree to rounding.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use thiserror::Error;

use crate::linalg::dot;

/// Number of coefficients from which on the FFT is the faster one for a batch of three channels:
/// measured crossing at 6 for 128 samples and at 7 to 10 for 512.
const FFT_COEFFICIENTS: usize = 8;

/// A harmonic set that cannot be transformed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum TransformError {
    /// Harmonics repeat or are out of order.
    #[error("harmonics must be ascending: {after} follows {before}")]
    NotAscending {
        /// Earlier entry.
        before: usize,
        /// The entry after it.
        after: usize,
    },
    /// Too few samples to tell the harmonics apart.
    #[error("harmonic {harmonic} needs more than {} samples per period, not {samples}", 2 * harmonic)]
    TooFewSamples {
        /// Highest harmonic.
        harmonic: usize,
        /// Samples per period.
        samples: usize,
    },
}

/// Tables of one harmonic set and number of samples.
#[derive(Clone)]
pub struct HarmonicTransform {
    harmonics: Vec<usize>,
    n_samples: usize,
    /// `phi_c(tau_j)`, row c after row (`n_coefficients * n_samples`).
    basis: Vec<f64>,
    /// `sum_{i < j} psi_c(tau_i)`, row c after row (`n_coefficients * (n_samples + 1)`).
    cumulative: Vec<f64>,
    /// `sum_{i < j} psi_c(tau_i) phi_c'(tau_i)`, made when first asked for (`(n_samples + 1) * n_coefficients *
    /// n_coefficients`).
    products: OnceLock<Vec<f64>>,
    /// Those of every harmonic by itself, two a coefficient; small enough for the nearest caches.
    own_products: OnceLock<Vec<[f64; 2]>>,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

/// Buffers of the FFT.
#[derive(Debug, Clone)]
pub struct TransformScratch {
    spectrum: Vec<Complex64>,
    working: Vec<Complex64>,
}

impl std::fmt::Debug for HarmonicTransform {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .debug_struct("HarmonicTransform")
            .field("harmonics", &self.harmonics)
            .field("n_samples", &self.n_samples)
            .finish_non_exhaustive()
    }
}

impl HarmonicTransform {
    /// Tables for the ascending set `harmonics` (0 allowed) and `n_samples` samples per period.
    ///
    /// # Errors
    /// The set is not ascending, or its highest harmonic is not below half the number of samples.
    pub fn new(harmonics: &[usize], n_samples: usize) -> Result<Self, TransformError> {
        if let Some(pair) = harmonics.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(TransformError::NotAscending {
                before: pair[0],
                after: pair[1],
            });
        }
        if let Some(&harmonic) = harmonics.last()
            && 2 * harmonic >= n_samples
        {
            return Err(TransformError::TooFewSamples {
                harmonic,
                samples: n_samples,
            });
        }
        let mut basis = Vec::new();
        for &k in harmonics {
            let angle = |j: usize| TAU * ((k * j) % n_samples) as f64 / n_samples as f64;
            basis.extend((0..n_samples).map(|j| angle(j).cos()));
            if k > 0 {
                basis.extend((0..n_samples).map(|j| -angle(j).sin()));
            }
        }
        let mut planner = FftPlanner::new();
        let mut transform = Self {
            harmonics: harmonics.to_vec(),
            n_samples,
            basis,
            cumulative: Vec::new(),
            products: OnceLock::new(),
            own_products: OnceLock::new(),
            forward: planner.plan_fft_forward(n_samples),
            inverse: planner.plan_fft_inverse(n_samples),
        };
        for c in 0..transform.n_coefficients() {
            let scale = transform.projection_scale(c);
            let mut sum = 0.0;
            transform.cumulative.push(0.0);
            for j in 0..n_samples {
                sum += scale * transform.basis[c * n_samples + j];
                transform.cumulative.push(sum);
            }
        }
        Ok(transform)
    }

    /// The harmonic set, ascending.
    #[must_use]
    pub fn harmonics(&self) -> &[usize] {
        &self.harmonics
    }

    /// Samples per period, n.
    #[must_use]
    pub fn n_samples(&self) -> usize {
        self.n_samples
    }

    /// Real coefficients per channel: two per harmonic, one for harmonic 0.
    #[must_use]
    pub fn n_coefficients(&self) -> usize {
        2 * self.harmonics.len() - usize::from(self.has_mean())
    }

    /// Whether harmonic 0 belongs to the set; its coefficient is then number 0.
    #[must_use]
    pub fn has_mean(&self) -> bool {
        self.harmonics.first() == Some(&0)
    }

    /// `phi_c` at all samples (`n_samples`).
    #[must_use]
    pub fn basis(&self, coefficient: usize) -> &[f64] {
        &self.basis[coefficient * self.n_samples..][..self.n_samples]
    }

    /// Whether a signal changes sign after half a period, and the samples with it: where all harmonics are odd.
    pub(super) fn has_half_waves(&self) -> bool {
        self.n_samples.is_multiple_of(2) && self.harmonics.iter().all(|k| k % 2 == 1)
    }

    /// Ratio `psi_c / phi_c`: 1/n for harmonic 0, 2/n otherwise.
    #[must_use]
    pub fn projection_scale(&self, coefficient: usize) -> f64 {
        let mean = self.has_mean() && coefficient == 0;
        if mean {
            1.0 / self.n_samples as f64
        } else {
            2.0 / self.n_samples as f64
        }
    }

    /// `sum_{i < j} psi_c(tau_i)` for j = 0 .. n (`n_samples + 1`): the projection of a signal
    /// constant by stretches.
    #[must_use]
    pub fn cumulative_projection(&self, coefficient: usize) -> &[f64] {
        let length = self.n_samples + 1;
        &self.cumulative[coefficient * length..][..length]
    }

    /// `sum_{i < j} psi_c(tau_i) phi_c'(tau_i)`, a row per c (`n_coefficients * n_coefficients`).
    pub(super) fn products_to(&self, j: usize) -> &[f64] {
        let n = self.n_coefficients();
        let products = self.products.get_or_init(|| {
            let mut sums = vec![0.0; n * n];
            let mut products = sums.clone();
            for i in 0..self.n_samples {
                for (c, row) in sums.chunks_exact_mut(n).enumerate() {
                    let psi = self.projection_scale(c) * self.basis(c)[i];
                    for (other, sum) in row.iter_mut().enumerate() {
                        *sum += psi * self.basis(other)[i];
                    }
                }
                products.extend_from_slice(&sums);
            }
            products
        });
        &products[j * n * n..][..n * n]
    }

    /// `sum_{i < j} psi_c(tau_i) phi_c'(tau_i)` for the coefficients c' of the harmonic of c, two a coefficient; the mean has one of its own.
    pub(super) fn own_products_to(&self, j: usize) -> &[[f64; 2]] {
        let n = self.n_coefficients();
        let products = self.own_products.get_or_init(|| {
            let mut sums = vec![[0.0; 2]; n];
            let mut products = sums.clone();
            for i in 0..self.n_samples {
                for (c, sums) in sums.iter_mut().enumerate() {
                    let psi = self.projection_scale(c) * self.basis(c)[i];
                    for (sum, other) in sums.iter_mut().zip(self.own(c)) {
                        *sum += psi * self.basis(other)[i];
                    }
                }
                products.extend_from_slice(&sums);
            }
            products
        });
        &products[j * n..][..n]
    }

    /// The coefficients of the harmonic of a coefficient.
    pub(super) fn own(&self, coefficient: usize) -> Range<usize> {
        let mean = usize::from(self.has_mean());
        if coefficient < mean {
            0..mean
        } else {
            let first = coefficient - (coefficient - mean) % 2;
            first..first + 2
        }
    }

    /// Upper bound on a signal with these coefficients, the mean left out: the sum of the amplitudes of its harmonics.
    pub(super) fn excursion(&self, coefficients: impl Iterator<Item = f64>) -> f64 {
        let mut oscillation = coefficients.skip(usize::from(self.has_mean()));
        let mut sum = 0.0;
        while let (Some(re), Some(im)) = (oscillation.next(), oscillation.next()) {
            sum += (re * re + im * im).sqrt();
        }
        sum
    }

    /// Buffers for the methods that may use the FFT.
    #[must_use]
    pub fn scratch(&self) -> TransformScratch {
        let working = self
            .forward
            .get_inplace_scratch_len()
            .max(self.inverse.get_inplace_scratch_len());
        TransformScratch {
            spectrum: vec![Complex64::default(); self.n_samples],
            working: vec![Complex64::default(); working],
        }
    }

    /// Samples of a batch of channels: `coefficients` (`n_channels * n_coefficients`, channel after
    /// channel) to `histories` (`n_channels * n_samples`), by whichever way is the faster one.
    pub fn synthesize(
        &self,
        coefficients: &[f64],
        histories: &mut [f64],
        scratch: &mut TransformScratch,
    ) {
        if self.n_coefficients() < FFT_COEFFICIENTS {
            self.synthesize_by_sums(coefficients, histories);
        } else {
            self.synthesize_by_fft(coefficients, histories, scratch);
        }
    }

    /// Coefficients of a batch of channels: `histories` (`n_channels * n_samples`) to
    /// `coefficients` (`n_channels * n_coefficients`), by whichever way is the faster one.
    pub fn project(
        &self,
        histories: &[f64],
        coefficients: &mut [f64],
        scratch: &mut TransformScratch,
    ) {
        if self.n_coefficients() < FFT_COEFFICIENTS {
            self.project_by_sums(histories, coefficients);
        } else {
            self.project_by_fft(histories, coefficients, scratch);
        }
    }

    /// [`Self::synthesize`] by explicit sums.
    pub fn synthesize_by_sums(&self, coefficients: &[f64], histories: &mut [f64]) {
        let channels = coefficients.chunks_exact(self.n_coefficients().max(1));
        for (coefficients, history) in channels.zip(histories.chunks_exact_mut(self.n_samples)) {
            let (mean, oscillation) = coefficients.split_at(usize::from(self.has_mean()));
            history.fill(mean.first().copied().unwrap_or(0.0));
            let rows = self.basis[mean.len() * self.n_samples..].chunks_exact(2 * self.n_samples);
            for (pair, rows) in oscillation.chunks_exact(2).zip(rows) {
                let (cosine, minus_sine) = rows.split_at(self.n_samples);
                for ((x, &c), &s) in history.iter_mut().zip(cosine).zip(minus_sine) {
                    *x += pair[0] * c + pair[1] * s;
                }
            }
        }
    }

    /// [`Self::project`] by explicit sums.
    pub fn project_by_sums(&self, histories: &[f64], coefficients: &mut [f64]) {
        let channels = coefficients.chunks_exact_mut(self.n_coefficients().max(1));
        for (coefficients, history) in channels.zip(histories.chunks_exact(self.n_samples)) {
            for (c, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient = self.projection_scale(c) * dot(self.basis(c), history);
            }
        }
    }

    /// [`Self::synthesize`] by an FFT: two real channels are the real and imaginary part of one
    /// complex signal.
    pub fn synthesize_by_fft(
        &self,
        coefficients: &[f64],
        histories: &mut [f64],
        scratch: &mut TransformScratch,
    ) {
        let n = self.n_samples;
        let pairs = coefficients.chunks(2 * self.n_coefficients().max(1));
        for (coefficients, histories) in pairs.zip(histories.chunks_mut(2 * n)) {
            scratch.spectrum.fill(Complex64::default());
            for (channel, unit) in coefficients
                .chunks_exact(self.n_coefficients())
                .zip([Complex64::ONE, Complex64::I])
            {
                for (k, value) in self.complex_coefficients(channel) {
                    if k == 0 {
                        scratch.spectrum[0] += unit * value;
                    } else {
                        scratch.spectrum[k] += 0.5 * unit * value;
                        scratch.spectrum[n - k] += 0.5 * unit * value.conj();
                    }
                }
            }
            self.inverse
                .process_with_scratch(&mut scratch.spectrum, &mut scratch.working);
            let (first, second) = histories.split_at_mut(n);
            first
                .iter_mut()
                .zip(&scratch.spectrum)
                .for_each(|(x, z)| *x = z.re);
            second
                .iter_mut()
                .zip(&scratch.spectrum)
                .for_each(|(x, z)| *x = z.im);
        }
    }

    /// [`Self::project`] by an FFT: two real channels are the real and imaginary part of one
    /// complex signal.
    pub fn project_by_fft(
        &self,
        histories: &[f64],
        coefficients: &mut [f64],
        scratch: &mut TransformScratch,
    ) {
        let n = self.n_samples;
        let pairs = coefficients.chunks_mut(2 * self.n_coefficients().max(1));
        for (coefficients, histories) in pairs.zip(histories.chunks(2 * n)) {
            let (first, second) = histories.split_at(n);
            for (j, (z, &re)) in scratch.spectrum.iter_mut().zip(first).enumerate() {
                *z = Complex64::new(re, second.get(j).copied().unwrap_or(0.0));
            }
            self.forward
                .process_with_scratch(&mut scratch.spectrum, &mut scratch.working);
            // Z = P + i Q with P, Q the spectra of the channels; P_{n-k} = conj(P_k) and likewise
            // for Q.
            let (first, second) = coefficients.split_at_mut(self.n_coefficients());
            let mut c = 0;
            for &k in &self.harmonics {
                let (z, mirror) = (scratch.spectrum[k], scratch.spectrum[(n - k) % n].conj());
                let scale = self.projection_scale(c);
                let (p, q) = (
                    0.5 * scale * (z + mirror),
                    Complex64::new(0.0, -0.5 * scale) * (z - mirror),
                );
                for (channel, value) in [(&mut *first, p), (&mut *second, q)] {
                    if let Some(target) = channel.get_mut(c) {
                        *target = value.re;
                    }
                    if k > 0
                        && let Some(target) = channel.get_mut(c + 1)
                    {
                        *target = value.im;
                    }
                }
                c += if k > 0 { 2 } else { 1 };
            }
        }
    }

    /// Harmonics of one channel and their complex coefficients (real for harmonic 0).
    fn complex_coefficients<'a>(
        &'a self,
        channel: &'a [f64],
    ) -> impl Iterator<Item = (usize, Complex64)> + 'a {
        let (mean, oscillation) = channel.split_at(usize::from(self.has_mean()));
        let mean = mean.iter().map(|&value| Complex64::new(value, 0.0));
        let oscillation = oscillation
            .chunks_exact(2)
            .map(|pair| Complex64::new(pair[0], pair[1]));
        self.harmonics.iter().copied().zip(mean.chain(oscillation))
    }
}
