//! The harmonic transform of several rows at once, by a quarter of the period where the samples allow it.
//!
//! A signal falls into four parts: its even and odd harmonics, of either the cosines and the sines. Each of them has the
//! same size at `tau`, `-tau`, `pi - tau` and `pi + tau`:
//!
//! ```text
//! x(tau)      =  CE + CO + SE + SO        x(-tau)     =  CE + CO - SE - SO
//! x(pi + tau) =  CE - CO + SE - SO        x(pi - tau) =  CE - CO - SE + SO
//! ```

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use std::sync::Arc;

use super::lanes::LANES;
use crate::linalg::{Loops, vectorized};
use crate::response::harmonic_balance::HarmonicTransform;

/// Groups of [`LANES`] signals that are transformed at once.
pub(super) const WIDTH: usize = 3;

/// Points of a quarter of the period that are folded at once: they stay in the nearest cache.
const TILE: usize = 16;

/// One coefficient or sample of all signals.
type Column = [[f64; LANES]; WIDTH];

/// The transform of [`WIDTH`] groups of [`LANES`] signals each: a column of them per coefficient or sample.
#[derive(Debug)]
pub(super) struct QuarterWaves {
    transform: Arc<HarmonicTransform>,
    /// Cosines of even and of odd harmonics, then sines of even and odd ones; all coefficients stand in the first of them where
    /// the samples are no multiple of four.
    parts: [Part; 4],
    quarters: bool,
}

/// Some coefficients over some samples.
#[derive(Debug, Default)]
struct Part {
    coefficients: Vec<usize>,
    /// `phi_c(tau_j)` and `psi_c(tau_j)`, those of every sample side by side.
    basis: Vec<f64>,
    projection: Vec<f64>,
}

impl QuarterWaves {
    pub(super) fn new(transform: &Arc<HarmonicTransform>) -> Self {
        let samples = transform.n_samples();
        let quarters = samples.is_multiple_of(4);
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
            parts.map(|coefficients| Part::quarter(transform, coefficients))
        } else {
            let mut parts: [Part; 4] = Default::default();
            parts[0] = Part::whole(transform);
            parts
        };
        Self {
            transform: Arc::clone(transform),
            parts,
            quarters,
        }
    }

    /// Samples of the signals with these coefficients.
    pub(super) fn synthesize(&self, coefficients: &[f64], samples: &mut [f64]) {
        vectorized(Synthesized {
            waves: self,
            coefficients,
            samples,
        });
    }

    /// Coefficients of the signals with these samples.
    pub(super) fn project(&self, samples: &[f64], coefficients: &mut [f64]) {
        vectorized(Projected {
            waves: self,
            coefficients,
            samples,
        });
    }
}

struct Synthesized<'a> {
    waves: &'a QuarterWaves,
    coefficients: &'a [f64],
    samples: &'a mut [f64],
}

impl Loops for Synthesized<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.waves.transform.n_samples();
        let coefficients = columns(self.coefficients);
        let samples = self.samples.as_chunks_mut::<LANES>().0;
        let samples = samples.as_chunks_mut::<WIDTH>().0;
        let [ce, co, se, so] = &self.waves.parts;
        if !self.waves.quarters {
            for (j, sample) in samples.iter_mut().enumerate() {
                *sample = ce.sum(j, coefficients);
            }
            return;
        }
        for j in 0..=count / 4 {
            let (ce, co) = (ce.sum(j, coefficients), co.sum(j, coefficients));
            let (se, so) = (se.sum(j, coefficients), so.sum(j, coefficients));
            let [plus, minus, mirrored, turned] = points_of(count, j);
            for group in 0..WIDTH {
                for lane in 0..LANES {
                    let (a, b) = (ce[group][lane], co[group][lane]);
                    let (c, d) = (se[group][lane], so[group][lane]);
                    samples[plus][group][lane] = (a + b) + (c + d);
                    samples[minus][group][lane] = (a + b) - (c + d);
                    samples[mirrored][group][lane] = (a - b) - (c - d);
                    samples[turned][group][lane] = (a - b) + (c - d);
                }
            }
        }
    }
}

struct Projected<'a> {
    waves: &'a QuarterWaves,
    coefficients: &'a mut [f64],
    samples: &'a [f64],
}

impl Loops for Projected<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.waves.transform.n_samples();
        let samples = columns(self.samples);
        let coefficients = self.coefficients.as_chunks_mut::<LANES>().0;
        let coefficients = coefficients.as_chunks_mut::<WIDTH>().0;
        coefficients.fill([[0.0; LANES]; WIDTH]);
        if !self.waves.quarters {
            self.waves.parts[0].add(0, samples, coefficients);
            return;
        }
        let mut folded = [[[[0.0; LANES]; WIDTH]; TILE]; 4];
        let end = count / 4 + 1;
        let mut first = 0;
        while first < end {
            let tile = TILE.min(end - first);
            for at in 0..tile {
                fold(samples, points_of(count, first + at), at, &mut folded);
            }
            for (part, folded) in self.waves.parts.iter().zip(&folded) {
                part.add(first, &folded[..tile], coefficients);
            }
            first += tile;
        }
    }
}

/// What the four parts are at the four points that stand for one.
#[inline(always)]
fn fold(samples: &[Column], points: [usize; 4], at: usize, folded: &mut [[Column; TILE]; 4]) {
    let [plus, minus, mirrored, turned] = points;
    let (x, y) = (&samples[plus], &samples[minus]);
    let (z, w) = (&samples[mirrored], &samples[turned]);
    for group in 0..WIDTH {
        for lane in 0..LANES {
            let (x, y) = (x[group][lane], y[group][lane]);
            let (z, w) = (z[group][lane], w[group][lane]);
            folded[0][at][group][lane] = (x + y) + (z + w);
            folded[1][at][group][lane] = (x + y) - (z + w);
            folded[2][at][group][lane] = (x - y) - (z - w);
            folded[3][at][group][lane] = (x - y) + (z - w);
        }
    }
}

#[inline(always)]
fn columns(numbers: &[f64]) -> &[Column] {
    numbers.as_chunks::<LANES>().0.as_chunks::<WIDTH>().0
}

/// Places of `tau_j`, `-tau_j`, `pi - tau_j` and `pi + tau_j` among so many samples.
#[inline(always)]
fn points_of(count: usize, j: usize) -> [usize; 4] {
    [
        j,
        (count - j) % count,
        count / 2 - j,
        (count / 2 + j) % count,
    ]
}

impl Part {
    /// The signals of these coefficients at sample j.
    #[inline(always)]
    fn sum(&self, j: usize, coefficients: &[Column]) -> Column {
        let count = self.coefficients.len();
        let mut sums = [[0.0; LANES]; WIDTH];
        let basis = &self.basis[j * count..(j + 1) * count];
        for (&c, &phi) in self.coefficients.iter().zip(basis) {
            let coefficient = &coefficients[c];
            for group in 0..WIDTH {
                for lane in 0..LANES {
                    sums[group][lane] += phi * coefficient[group][lane];
                }
            }
        }
        sums
    }

    /// Adds what the signals are of these coefficients over samples from `first` on.
    #[inline(always)]
    fn add(&self, first: usize, signals: &[Column], coefficients: &mut [Column]) {
        let mut at = 0;
        while at + 1 < self.coefficients.len() {
            self.add_to([at, at + 1], first, signals, coefficients);
            at += 2;
        }
        if at < self.coefficients.len() {
            self.add_to([at], first, signals, coefficients);
        }
    }

    #[inline(always)]
    fn add_to<const N: usize>(
        &self,
        places: [usize; N],
        first: usize,
        signals: &[Column],
        coefficients: &mut [Column],
    ) {
        let count = self.coefficients.len();
        let projection = self.projection[first * count..].chunks_exact(count);
        let mut sums = places.map(|at| coefficients[self.coefficients[at]]);
        for (signal, projection) in signals.iter().zip(projection) {
            for (sum, &at) in sums.iter_mut().zip(&places) {
                let psi = projection[at];
                for group in 0..WIDTH {
                    for lane in 0..LANES {
                        sum[group][lane] += psi * signal[group][lane];
                    }
                }
            }
        }
        for (sum, at) in sums.into_iter().zip(places) {
            coefficients[self.coefficients[at]] = sum;
        }
    }

    /// All coefficients over the whole period.
    fn whole(transform: &HarmonicTransform) -> Self {
        let coefficients = (0..transform.n_coefficients()).collect();
        Self::over(transform, coefficients, transform.n_samples() - 1, |_| 1.0)
    }

    /// Over a quarter of the period, whose ends stand for two points each and the others for four.
    fn quarter(transform: &HarmonicTransform, coefficients: Vec<usize>) -> Self {
        let last = transform.n_samples() / 4;
        let weight = |j: usize| if j == 0 || j == last { 0.5 } else { 1.0 };
        Self::over(transform, coefficients, last, weight)
    }

    fn over(
        transform: &HarmonicTransform,
        coefficients: Vec<usize>,
        last: usize,
        weight: impl Fn(usize) -> f64,
    ) -> Self {
        let (mut basis, mut projection) = (Vec::new(), Vec::new());
        for j in 0..=last {
            for &c in &coefficients {
                let phi = transform.basis(c)[j];
                basis.push(phi);
                projection.push(transform.projection_scale(c) * weight(j) * phi);
            }
        }
        Self {
            coefficients,
            basis,
            projection,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::{HarmonicTransform, LANES, QuarterWaves, WIDTH};

    #[test]
    fn quarters_are_the_whole_period() {
        for (harmonics, samples) in [
            (&[0_usize, 1, 2, 3, 4, 7][..], 32),
            (&[1, 3, 5, 7], 16),
            (&[1], 12),
            (&[0, 1, 2, 3], 18),
        ] {
            let transform = Arc::new(HarmonicTransform::new(harmonics, samples).expect("a set"));
            let (rows, count) = (WIDTH * LANES, transform.n_coefficients());
            let number = |at: usize| (0.3 + 1.7 * at as f64).sin();
            let coefficients: Vec<f64> = (0..rows * count).map(number).collect();
            let waves = QuarterWaves::new(&transform);
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
