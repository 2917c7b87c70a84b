//! Fields over the sectors of a wheel and over its waves, and the way between them.
//!
//! A field has several channels, each with one complex number per sector or per wave:
//!
//! ```text
//! x_n = (1/sqrt N) sum_h X_h e^{i h n alpha},    n, h = 0 .. N-1,    alpha = 2 pi / N
//! ```
//!
//! Real and imaginary parts stand apart and sectors side by side, padded by zeros to whole [`LANES`], so that a
//! vector of the machine holds several sectors. No sum is taken in another order for it.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined is compiled for vectors"
)]

use crate::linalg::{Complex64, Loops, dot, vectorized};
use crate::model::cyclic::phase;

/// Sectors that are handled side by side.
pub(super) const LANES: usize = 8;

/// Sectors with their padding.
pub(super) fn padded(sectors: usize) -> usize {
    sectors.next_multiple_of(LANES)
}

/// Complex numbers, channel after channel, each over the padded sectors.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Field {
    pub(super) re: Vec<f64>,
    pub(super) im: Vec<f64>,
}

impl Field {
    pub(super) fn zeros(channels: usize, sectors: usize) -> Self {
        let entries = channels * padded(sectors);
        Self {
            re: vec![0.0; entries],
            im: vec![0.0; entries],
        }
    }

    pub(super) fn zeros_like(other: &Self) -> Self {
        Self {
            re: vec![0.0; other.re.len()],
            im: vec![0.0; other.im.len()],
        }
    }

    pub(super) fn fill(&mut self, value: f64) {
        self.re.fill(value);
        self.im.fill(value);
    }

    pub(super) fn at(&self, place: usize) -> Complex64 {
        Complex64::new(self.re[place], self.im[place])
    }

    pub(super) fn set(&mut self, place: usize, value: Complex64) {
        (self.re[place], self.im[place]) = (value.re, value.im);
    }

    /// Adds `factor` times another field.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        for (sum, value) in self.re.iter_mut().zip(&other.re) {
            *sum += factor * value;
        }
        for (sum, value) in self.im.iter_mut().zip(&other.im) {
            *sum += factor * value;
        }
    }
}

/// Transform between sectors and waves.
#[derive(Debug)]
pub(super) struct SectorTransform {
    sectors: usize,
    /// `cos(h n alpha) / sqrt N` over h, padded, for n = 0..=N/2.
    cosine: Vec<f64>,
    sine: Vec<f64>,
}

impl SectorTransform {
    pub(super) fn new(sectors: usize) -> Self {
        let stride = padded(sectors);
        let half = sectors / 2 + 1;
        let (mut cosine, mut sine) = (vec![0.0; half * stride], vec![0.0; half * stride]);
        let scale = 1.0 / (sectors as f64).sqrt();
        for n in 0..half {
            for h in 0..sectors {
                let turn = phase(h, n, sectors) * scale;
                (cosine[n * stride + h], sine[n * stride + h]) = (turn.re, turn.im);
            }
        }
        Self {
            sectors,
            cosine,
            sine,
        }
    }

    pub(super) fn sectors(&self) -> usize {
        self.sectors
    }

    /// Waves of a field over the sectors.
    pub(super) fn to_waves(&self, sectors: &Field, waves: &mut Field) {
        vectorized(Turned {
            transform: self,
            sign: -1.0,
            from: sectors,
            to: waves,
        });
    }

    /// Sectors of a field over the waves.
    pub(super) fn to_sectors(&self, waves: &Field, sectors: &mut Field) {
        vectorized(Turned {
            transform: self,
            sign: 1.0,
            from: waves,
            to: sectors,
        });
    }
}

/// `to_h = (1/sqrt N) sum_n from_n e^{sign i h n alpha}`; n and N - n have one cosine, and sines of opposite sign.
struct Turned<'a> {
    transform: &'a SectorTransform,
    sign: f64,
    from: &'a Field,
    to: &'a mut Field,
}

impl Loops for Turned<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let sectors = self.transform.sectors;
        let stride = padded(sectors);
        let chunks = stride / LANES;
        let (cosine, _) = self.transform.cosine.as_chunks::<LANES>();
        let (sine, _) = self.transform.sine.as_chunks::<LANES>();
        let from = self.from.re.chunks_exact(stride);
        let from = from.zip(self.from.im.chunks_exact(stride));
        let to = self.to.re.chunks_exact_mut(stride);
        let to = to.zip(self.to.im.chunks_exact_mut(stride));
        for ((re, im), (to_re, to_im)) in from.zip(to) {
            let (to_re, _) = to_re.as_chunks_mut::<LANES>();
            let (to_im, _) = to_im.as_chunks_mut::<LANES>();
            for chunk in 0..chunks {
                let (mut sum_re, mut sum_im) = ([0.0; LANES], [0.0; LANES]);
                for n in 0..=sectors / 2 {
                    let alone = n == 0 || 2 * n == sectors;
                    let (other_re, other_im) = if alone {
                        (0.0, 0.0)
                    } else {
                        (re[sectors - n], im[sectors - n])
                    };
                    let (even_re, even_im) = (re[n] + other_re, im[n] + other_im);
                    let odd_re = self.sign * (re[n] - other_re);
                    let odd_im = -self.sign * (im[n] - other_im);
                    let (c, s) = (&cosine[n * chunks + chunk], &sine[n * chunks + chunk]);
                    for lane in 0..LANES {
                        sum_re[lane] += c[lane] * even_re + s[lane] * odd_im;
                        sum_im[lane] += c[lane] * even_im + s[lane] * odd_re;
                    }
                }
                (to_re[chunk], to_im[chunk]) = (sum_re, sum_im);
            }
        }
    }
}

/// Sector after sector, in it row after row, from row after row of padded sectors.
pub(super) fn turned(from: &[f64], stride: usize, rows: usize, to: &mut [f64]) {
    for (row, row_values) in from.chunks_exact(stride).enumerate() {
        for (to, value) in to[row..].iter_mut().step_by(rows).zip(row_values) {
            *to = *value;
        }
    }
}

/// The way back of [`turned`].
pub(super) fn returned(from: &[f64], stride: usize, rows: usize, to: &mut [f64]) {
    for (row, row_values) in to.chunks_exact_mut(stride).enumerate() {
        for (to, value) in row_values.iter_mut().zip(from[row..].iter().step_by(rows)) {
            *to = *value;
        }
    }
}

/// Sum of squares.
pub(super) fn norm_squared(field: &Field) -> f64 {
    dot(&field.re, &field.re) + dot(&field.im, &field.im)
}

/// Numbers of all fields, one after the other, times `factor`.
pub(super) fn flatten(fields: &[Field], factor: f64, flat: &mut Vec<f64>) {
    flat.clear();
    for field in fields {
        let both = field.re.iter().chain(&field.im);
        flat.extend(both.map(|value| factor * value));
    }
}

/// The way back of [`flatten`].
pub(super) fn unflatten(flat: &[f64], fields: &mut [Field]) {
    let mut from = 0;
    for field in fields {
        for part in [&mut field.re, &mut field.im] {
            let count = part.len();
            part.copy_from_slice(&flat[from..from + count]);
            from += count;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(place: usize) -> Complex64 {
        let turn = 0.3 + 1.7 * place as f64 + 0.01 * (place * place) as f64;
        Complex64::new(turn.sin(), (1.3 * turn).cos())
    }

    #[test]
    fn waves_are_those_of_the_sums_and_return_to_the_sectors() {
        for sectors in [1, 2, 7, 8, 13, 24] {
            let stride = padded(sectors);
            let transform = SectorTransform::new(sectors);
            let mut field = Field::zeros(3, sectors);
            for place in 0..3 * stride {
                if place % stride < sectors {
                    field.set(place, number(place));
                }
            }
            let mut waves = Field::zeros(3, sectors);
            transform.to_waves(&field, &mut waves);
            for channel in 0..3 {
                for h in 0..stride {
                    let turned = |n| field.at(channel * stride + n) * phase(h, n, sectors).conj();
                    let sum: Complex64 = if h < sectors {
                        (0..sectors).map(turned).sum::<Complex64>() / (sectors as f64).sqrt()
                    } else {
                        Complex64::default()
                    };
                    assert!((sum - waves.at(channel * stride + h)).norm() < 1e-13);
                }
            }
            let mut back = Field::zeros(3, sectors);
            transform.to_sectors(&waves, &mut back);
            for place in 0..3 * stride {
                assert!(
                    (back.at(place) - field.at(place)).norm() < 1e-13,
                    "{sectors}"
                );
            }
        }
    }
}
