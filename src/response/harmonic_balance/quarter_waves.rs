//! The harmonic transform of several rows at once, by a quarter of the period where that pays.
//!
//! A signal falls into four parts: its even and odd harmonics, of either the cosines and the sines. Each of them has the
//! same size at `tau`, `-tau`, `pi - tau` and `pi + tau`:
//!
//! ```text
//! x(tau)      =  CE + CO + SE + SO        x(-tau)     =  CE + CO - SE - SO
//! x(pi + tau) =  CE - CO + SE - SO        x(pi - tau) =  CE - CO - SE + SO
//! ```

use std::sync::Arc;

use super::HarmonicTransform;
use crate::linalg::set_times;

/// Coefficients from which on quarters are taken.
const FROM: usize = 6;

/// The transform of matrices with a row per signal, column-major: a column per coefficient or per sample.
#[derive(Debug)]
pub(super) struct QuarterWaves {
    transform: Arc<HarmonicTransform>,
    /// The parts of a quarter of the period, or all coefficients over the whole period.
    parts: Vec<Part>,
    quarters: bool,
    coefficients: Vec<f64>,
    samples: [Vec<f64>; 4],
}

/// Some coefficients over some samples.
#[derive(Debug)]
struct Part {
    coefficients: Vec<usize>,
    /// `phi_c(tau_j)`, a column per sample; `psi_c(tau_j)`, a column per coefficient.
    basis: Vec<f64>,
    projection: Vec<f64>,
}

impl QuarterWaves {
    pub(super) fn new(transform: &Arc<HarmonicTransform>) -> Self {
        let (count, samples) = (transform.n_coefficients(), transform.n_samples());
        let quarters = count >= FROM && samples.is_multiple_of(4);
        let parts = if quarters {
            let mut parts: [Vec<usize>; 4] = Default::default();
            let mut coefficient = 0;
            for &k in transform.harmonics() {
                parts[k % 2].push(coefficient);
                coefficient += 1;
                if k > 0 {
                    parts[2 + k % 2].push(coefficient);
                    coefficient += 1;
                }
            }
            parts.map(|own| Part::new(transform, own, samples / 4)).into()
        } else {
            vec![Part::whole(transform, (0..count).collect())]
        };
        Self {
            transform: Arc::clone(transform),
            parts,
            quarters,
            coefficients: Vec::new(),
            samples: Default::default(),
        }
    }

    /// Samples of the signals with these coefficients.
    pub(super) fn synthesize(&mut self, coefficients: &[f64], samples: &mut [f64]) {
        let rows = coefficients.len() / self.transform.n_coefficients();
        let count = self.transform.n_samples();
        if !self.quarters {
            let size = (rows, count, self.transform.n_coefficients());
            set_times(samples, coefficients, &self.parts[0].basis, size);
            return;
        }
        let points = count / 4 + 1;
        for (part, samples) in self.parts.iter().zip(&mut self.samples) {
            self.coefficients.clear();
            for &c in &part.coefficients {
                self.coefficients.extend_from_slice(&coefficients[c * rows..][..rows]);
            }
            samples.resize(rows * points, 0.0);
            let size = (rows, points, part.coefficients.len());
            set_times(samples, &self.coefficients, &part.basis, size);
        }
        let [even_cosine, odd_cosine, even_sine, odd_sine] = &self.samples;
        for j in 0..points {
            let place = j * rows..(j + 1) * rows;
            let (ce, co) = (&even_cosine[place.clone()], &odd_cosine[place.clone()]);
            let (se, so) = (&even_sine[place.clone()], &odd_sine[place]);
            let [plus, minus, mirrored, turned] = self::points(count, j).map(|at| at * rows);
            for row in 0..rows {
                let (same, other) = (ce[row] + co[row], ce[row] - co[row]);
                let (sum, difference) = (se[row] + so[row], se[row] - so[row]);
                samples[plus + row] = same + sum;
                samples[minus + row] = same - sum;
                samples[mirrored + row] = other - difference;
                samples[turned + row] = other + difference;
            }
        }
    }

    /// Coefficients of the signals with these samples.
    pub(super) fn project(&mut self, samples: &[f64], coefficients: &mut [f64]) {
        let count = self.transform.n_samples();
        let rows = samples.len() / count;
        if !self.quarters {
            let size = (rows, self.transform.n_coefficients(), count);
            set_times(coefficients, samples, &self.parts[0].projection, size);
            return;
        }
        let points = count / 4 + 1;
        let [even_cosine, odd_cosine, even_sine, odd_sine] = &mut self.samples;
        for own in [&mut *even_cosine, odd_cosine, even_sine, odd_sine] {
            own.resize(rows * points, 0.0);
        }
        for j in 0..points {
            let [plus, minus, mirrored, turned] = self::points(count, j).map(|at| at * rows);
            for row in 0..rows {
                let (x, y) = (samples[plus + row], samples[minus + row]);
                let (z, w) = (samples[mirrored + row], samples[turned + row]);
                let place = j * rows + row;
                even_cosine[place] = (x + y) + (z + w);
                odd_cosine[place] = (x + y) - (z + w);
                even_sine[place] = (x - y) - (z - w);
                odd_sine[place] = (x - y) + (z - w);
            }
        }
        for (part, samples) in self.parts.iter().zip(&self.samples) {
            self.coefficients.resize(rows * part.coefficients.len(), 0.0);
            let size = (rows, part.coefficients.len(), points);
            set_times(&mut self.coefficients, samples, &part.projection, size);
            let own = self.coefficients.chunks_exact(rows);
            for (&c, own) in part.coefficients.iter().zip(own) {
                coefficients[c * rows..][..rows].copy_from_slice(own);
            }
        }
    }
}

/// Places of `tau_j`, `-tau_j`, `pi - tau_j` and `pi + tau_j` among so many samples.
fn points(count: usize, j: usize) -> [usize; 4] {
    [j, (count - j) % count, count / 2 - j, (count / 2 + j) % count]
}

impl Part {
    fn whole(transform: &HarmonicTransform, coefficients: Vec<usize>) -> Self {
        let last = transform.n_samples() - 1;
        Self::over(transform, coefficients, last, |_| 1.0)
    }

    /// Over the samples 0 to `last`, of which the ends of a quarter stand for two points, the others for four.
    fn new(transform: &HarmonicTransform, coefficients: Vec<usize>, last: usize) -> Self {
        let weight = move |j: usize| if j == 0 || j == last { 0.5 } else { 1.0 };
        Self::over(transform, coefficients, last, weight)
    }

    fn over(
        transform: &HarmonicTransform,
        coefficients: Vec<usize>,
        last: usize,
        weight: impl Fn(usize) -> f64,
    ) -> Self {
        let basis = (0..=last).flat_map(|j| coefficients.iter().map(move |&c| transform.basis(c)[j]));
        let basis: Vec<f64> = basis.collect();
        let mut projection = Vec::new();
        for &c in &coefficients {
            let scale = transform.projection_scale(c);
            let own = transform.basis(c)[..=last].iter().enumerate();
            projection.extend(own.map(|(j, phi)| scale * weight(j) * phi));
        }
        Self {
            basis,
            projection,
            coefficients,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::{HarmonicTransform, QuarterWaves};

    #[test]
    fn quarters_are_the_whole_period() {
        for (harmonics, samples) in [
            (&[0_usize, 1, 2, 3, 4, 7][..], 32),
            (&[1, 3, 5, 7], 16),
            (&[1], 12),
            (&[0, 1, 2, 3], 18),
        ] {
            let transform = Arc::new(HarmonicTransform::new(harmonics, samples).expect("a set"));
            let (rows, count) = (3, transform.n_coefficients());
            let number = |at: usize| (0.3 + 1.7 * at as f64).sin();
            let coefficients: Vec<f64> = (0..rows * count).map(number).collect();
            let mut waves = QuarterWaves::new(&transform);
            let mut histories = vec![0.0; rows * samples];
            waves.synthesize(&coefficients, &mut histories);
            for j in 0..samples {
                for row in 0..rows {
                    let of = |c: usize| coefficients[c * rows + row] * transform.basis(c)[j];
                    let sum: f64 = (0..count).map(of).sum();
                    assert!((sum - histories[j * rows + row]).abs() < 1e-13);
                }
            }
            let signals: Vec<f64> = (0..rows * samples).map(|at| number(at * at)).collect();
            let mut projected = vec![0.0; rows * count];
            waves.project(&signals, &mut projected);
            for c in 0..count {
                for row in 0..rows {
                    let of = |j: usize| signals[j * rows + row] * transform.basis(c)[j];
                    let sum = transform.projection_scale(c) * (0..samples).map(of).sum::<f64>();
                    assert!((sum - projected[c * rows + row]).abs() < 1e-13);
                }
            }
        }
    }
}
