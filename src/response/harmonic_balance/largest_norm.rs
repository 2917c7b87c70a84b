//! The largest norm of a displacement over the instants of a period.
//!
//! Of channels with harmonics `u_k` no instant is higher than harmonic 1 there and all others together,
//!
//! ```text
//! |x(tau)| <= |x_1(tau)| + H,    |x_1(tau)|^2 = p + Re(q e^{2 i tau}),    p = 1/2 sum |u_1|^2,    q = 1/2 sum u_1^2,
//! H = sum_{k > 1} |u_k|
//! ```
//!
//! so with `tau_0` the instant at which harmonic 1 is the highest only those are asked at which `|x_1| >= |x(tau_0)| - H`.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use super::HarmonicTransform;
use crate::linalg::Complex64;

/// What rounding may take from a norm.
const ROUNDING: f64 = 1e-12;

impl HarmonicTransform {
    /// Largest Euclidean norm over the samples of a displacement of up to three components,
    /// harmonic 0 left out.
    ///
    /// `coefficients` (`n_components * n_coefficients`); use a transform of 1024 samples for
    /// `time_maximum`. Not a number if a coefficient is not finite.
    #[must_use]
    pub fn largest_norm(&self, coefficients: &[f64]) -> f64 {
        if !coefficients.iter().all(|value| value.is_finite()) {
            return f64::NAN;
        }
        self.largest_square(coefficients).sqrt()
    }

    /// Oscillation of one component at an instant.
    fn at(&self, coefficients: &[f64], instant: usize) -> f64 {
        let first = usize::from(self.has_mean());
        let oscillation = coefficients.iter().enumerate().skip(first);
        oscillation.map(|(c, x)| x * self.basis(c)[instant]).sum()
    }

    /// Largest square of the norm.
    fn largest_square(&self, coefficients: &[f64]) -> f64 {
        let first = usize::from(self.has_mean());
        let components = coefficients.chunks_exact(self.n_coefficients().max(1));
        let moving: Vec<&[f64]> = components
            .filter(|component| component[first..].iter().any(|&value| value != 0.0))
            .collect();
        let mut largest = 0.0_f64;
        for range in self.instants_of_largest(&moving) {
            let mut squares = vec![0.0; range.len()];
            let mut history = squares.clone();
            for component in &moving {
                history.fill(0.0);
                for (c, coefficient) in component.iter().enumerate().skip(first) {
                    let row = &self.basis(c)[range.clone()];
                    let instants = history.iter_mut().zip(row);
                    instants.for_each(|(x, phi)| *x += coefficient * phi);
                }
                for (square, x) in squares.iter_mut().zip(&history) {
                    *square += x * x;
                }
            }
            largest = squares.into_iter().fold(largest, f64::max);
        }
        largest
    }

    /// Instants of a period, or of half of one where the other is the same, among which the largest norm of these components
    /// is.
    fn instants_of_largest(&self, moving: &[&[f64]]) -> [Range<usize>; 4] {
        let n = self.n_samples();
        let halves = if self.has_half_waves() { 1 } else { 2 };
        let different = n * halves / 2;
        let all = [0..different, 0..0, 0..0, 0..0];
        let Some((highest, reach)) = self.where_fundamental_leads(moving) else {
            return all;
        };
        let to_instant = n as f64 / TAU;
        let mut ranges = [const { 0..0 }; 4];
        for half in 0..halves {
            let middle = highest + PI * half as f64;
            let from = ((middle - reach) * to_instant).floor() - 1.0;
            let to = ((middle + reach) * to_instant).ceil() + 1.0;
            let count = (to - from) as usize + 1;
            if halves * count >= different {
                return all;
            }
            let from = from.rem_euclid(different as f64) as usize;
            ranges[2 * half] = from..(from + count).min(different);
            // What lies beyond the end.
            ranges[2 * half + 1] = 0..(from + count).saturating_sub(different);
        }
        ranges
    }

    /// Angle at which harmonic 1 of the components is the highest, and the distance beyond which, there and half a period later,
    /// no instant comes up to it; none where any may.
    fn where_fundamental_leads(&self, moving: &[&[f64]]) -> Option<(f64, f64)> {
        let first = usize::from(self.has_mean());
        let oscillating = self.harmonics().iter().skip(first);
        let (mut p, mut q, mut others) = (0.0, Complex64::default(), 0.0);
        for (place, &harmonic) in oscillating.enumerate() {
            let at = first + 2 * place;
            let parts = moving
                .iter()
                .map(|component| Complex64::new(component[at], component[at + 1]));
            if harmonic == 1 {
                for u in parts {
                    p += 0.5 * u.norm_sqr();
                    q += 0.5 * u * u;
                }
            } else {
                others += parts.map(|u| u.norm_sqr()).sum::<f64>().sqrt();
            }
        }
        let highest = -0.5 * q.arg();
        let n = self.n_samples() as f64;
        let instant = (highest * n / TAU).round().rem_euclid(n) as usize;
        let square: f64 = moving
            .iter()
            .map(|component| self.at(component, instant).powi(2))
            .sum();
        let least = square.sqrt() * (1.0 - ROUNDING) - others;
        let cosine = (least * least - p) / q.norm();
        // Not a number where harmonic 1 does not move, or moves on a circle.
        (least > 0.0 && cosine > -1.0).then(|| (highest, 0.5 * cosine.min(1.0).acos()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest of all instants of a period, one by one.
    fn largest_of_all(transform: &HarmonicTransform, coefficients: &[f64]) -> f64 {
        let count = transform.n_coefficients();
        let square = |instant: usize| -> f64 {
            let components = coefficients.chunks_exact(count);
            let squares = components.map(|component| transform.at(component, instant).powi(2));
            squares.sum()
        };
        (0..transform.n_samples())
            .map(square)
            .fold(0.0, f64::max)
            .sqrt()
    }

    #[test]
    fn the_largest_is_among_the_instants_that_are_asked() {
        let sets: [&[usize]; 6] = [
            &[1],
            &[1, 3],
            &[1, 3, 5, 7],
            &[0, 1, 2, 3],
            &[0, 2],
            &[2, 3],
        ];
        let (mut asked, mut all) = (0, 0);
        for (set, samples) in sets.into_iter().flat_map(|set| [(set, 128), (set, 91)]) {
            let transform = HarmonicTransform::new(set, samples).expect("enough samples");
            let count = transform.n_coefficients();
            let first = usize::from(transform.has_mean());
            // Of half waves only one is looked at in any case.
            let different = if transform.has_half_waves() {
                samples / 2
            } else {
                samples
            };
            for case in 0..200 {
                let mut draw = case as f64;
                let mut next = || {
                    draw += 1.0;
                    (draw * 0.618_033_988_75 + 0.1 * (draw * draw).sin()).fract() - 0.5
                };
                // Higher harmonics from as strong as harmonic 1 to none.
                let share = [1.0, 0.3, 0.05, 0.0][case % 4];
                let channels = 1 + case % 3;
                let coefficients: Vec<f64> = (0..channels * count)
                    .map(|i| next() * if i % count < first + 2 { 1.0 } else { share })
                    .collect();
                let expected = largest_of_all(&transform, &coefficients);
                let found = transform.largest_norm(&coefficients);
                assert!(
                    (found - expected).abs() <= 1e-14,
                    "{set:?} {found} {expected}"
                );
                let moving: Vec<&[f64]> = coefficients.chunks_exact(count).collect();
                let ranges = transform.instants_of_largest(&moving);
                if share < 0.1 && set.contains(&1) {
                    asked += ranges.into_iter().map(|range| range.len()).sum::<usize>();
                    all += different;
                }
            }
        }
        assert!(asked < all / 2, "{asked} of {all}");
    }

    #[test]
    fn a_circle_is_as_large_at_every_instant() {
        let transform = HarmonicTransform::new(&[1], 64).expect("enough samples");
        let circle = [1.0, 0.0, 0.0, 1.0];
        assert!((transform.largest_norm(&circle) - 1.0).abs() < 1e-15);
        let nearly = [1.0, 0.0, 1e-9, 1.0];
        let expected = largest_of_all(&transform, &nearly);
        assert!((transform.largest_norm(&nearly) - expected).abs() < 1e-15);
        assert!(transform.largest_norm(&[0.0; 4]).abs() < f64::MIN_POSITIVE);
    }
}
