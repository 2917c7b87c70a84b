//! Motions at the contact as one list, harmonic after harmonic: in other harmonics, and at another time.
//!
//! Of every harmonic the real parts of its waves stand before the imaginary ones. Motions that are ahead by the phase `phi` in
//! harmonic 1 are ahead by `k phi` in harmonic k.

use crate::linalg::dot;

/// Scalar product over the norms from which on two motions are alike.
const ALIKE: f64 = 0.8;

/// Puts motions in the harmonics `from` in the place of those of a solution in `to`.
pub fn overlay(all: &mut [f64], motions: &[f64], from: &[u32], to: &[u32]) {
    let size = motions.len() / from.len().max(1);
    for (harmonic, part) in from.iter().zip(motions.chunks_exact(size.max(1))) {
        if let Some(place) = to.iter().position(|k| k == harmonic) {
            all[place * size..][..size].copy_from_slice(part);
        }
    }
}

/// Motions in the harmonics `from` as a start in those of `to`; harmonics that `from` does not have do not move.
#[must_use]
pub fn embedded(motions: &[f64], from: &[u32], to: &[u32]) -> Vec<f64> {
    let size = motions.len() / from.len().max(1);
    let mut all = vec![0.0; size * to.len()];
    overlay(&mut all, motions, from, to);
    all
}

/// Motions in the harmonics `set` ahead by a phase of harmonic 1, rad.
#[must_use]
pub fn turned_ahead(mut motions: Vec<f64>, set: &[u32], phase: f64) -> Vec<f64> {
    let size = motions.len() / set.len().max(1);
    for (&harmonic, part) in set.iter().zip(motions.chunks_exact_mut(size.max(1))) {
        let (re, im) = part.split_at_mut(size / 2);
        turn(f64::from(harmonic) * phase, re, im);
    }
    motions
}

/// Complex numbers times `e^{i angle}`, in place.
pub(super) fn turn(angle: f64, re: &mut [f64], im: &mut [f64]) {
    let (sine, cosine) = angle.sin_cos();
    for (x, y) in re.iter_mut().zip(im) {
        (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
    }
}

/// Phase of harmonic 1, rad, by which the motions `to` are ahead of `from`, both in the harmonics `set`: that after which they are
/// nearest to each other. 0 where they are not alike even then: between resonances that lie side by side the shape changes with the phase.
#[must_use]
pub fn phase_ahead(from: &[f64], to: &[f64], set: &[u32]) -> f64 {
    let size = from.len() / set.len().max(1);
    let place = set.iter().position(|&k| k == 1).unwrap_or(0);
    let parts = |motions| -> (&[f64], &[f64]) {
        let motions: &[f64] = motions;
        motions[place * size..][..size].split_at(size / 2)
    };
    let ((a, b), (c, d)) = (parts(from), parts(to));
    let (real, imaginary) = (dot(a, c) + dot(b, d), dot(a, d) - dot(b, c));
    let square = |x: &[f64], y: &[f64]| dot(x, x) + dot(y, y);
    let least = ALIKE.powi(2) * square(a, b) * square(c, d);
    if real.powi(2) + imaginary.powi(2) < least {
        return 0.0;
    }
    imaginary.atan2(real)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_harmonic_turns_by_its_number_times_the_phase() {
        let set = [0, 1, 3];
        let motions = vec![2.0, 0.0, 0.3, -0.4, 1.0, 0.5];
        let phase = 0.7_f64;
        let turned = turned_ahead(motions.clone(), &set, phase);
        for (place, &harmonic) in set.iter().enumerate() {
            let (x, y) = (motions[2 * place], motions[2 * place + 1]);
            let angle = f64::from(harmonic) * phase;
            let expected = [
                x * angle.cos() - y * angle.sin(),
                x * angle.sin() + y * angle.cos(),
            ];
            assert!((turned[2 * place] - expected[0]).abs() < 1e-15);
            assert!((turned[2 * place + 1] - expected[1]).abs() < 1e-15);
        }
        assert!((phase_ahead(&motions, &turned, &set) - phase).abs() < 1e-15);
    }

    #[test]
    fn motions_of_another_shape_have_no_phase() {
        let (first, turned) = ([1.0, 0.2, 0.0, 0.1], [0.0, -0.1, 1.0, 0.2]);
        let ahead = phase_ahead(&first, &turned, &[1]);
        assert!((ahead - 0.5 * std::f64::consts::PI).abs() < 1e-15);
        let other = [0.2, 1.0, 0.1, 0.3];
        assert!(phase_ahead(&first, &other, &[1]).abs() < 1e-15);
    }
}
