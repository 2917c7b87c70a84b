//! Motions at the contact as one list, harmonic after harmonic: in other harmonics, and with sectors at another time.
//!
//! Of every harmonic the real parts of its waves stand before the imaginary ones. Motions of a sector that are ahead by the phase
//! `phi` in harmonic 1 are ahead by `k phi` in harmonic k. A pair feels the motions of its sector alone: where they are ahead, so
//! are its forces.

use crate::linalg::Complex64;

use super::fields::{Field, SectorTransform, padded};

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

/// Motions a `share` of the way from `low` to `high`, both in the harmonics `set`: amplitudes on the line between them, phases on the
/// way of every sector.
///
/// Near a resonance phases change much and shapes little, and harmonic k turns k times as fast.
pub(super) fn between_turning(
    transform: &SectorTransform,
    low: &[f64],
    high: &[f64],
    set: &[u32],
    share: f64,
) -> Vec<f64> {
    let ahead = phases_ahead(transform, low, high, set);
    let turned = |motions: &[f64], part: f64| {
        let phases: Vec<f64> = ahead.iter().map(|phase| part * phase).collect();
        turned_ahead(transform, motions, set, &phases)
    };
    let (low, high) = (turned(low, share), turned(high, share - 1.0));
    let both = low.iter().zip(high);
    both.map(|(low, high)| (1.0 - share) * low + share * high)
        .collect()
}

/// Motions in the harmonics `set` whose sectors are ahead by phases of harmonic 1, rad.
pub(super) fn turned_ahead(
    transform: &SectorTransform,
    motions: &[f64],
    set: &[u32],
    phases: &[f64],
) -> Vec<f64> {
    let parts = set.iter().zip(waves_of(motions, set));
    let turned = parts.flat_map(|(&harmonic, waves)| {
        let Field { re, im } = turned_field(transform, &waves, harmonic, phases);
        re.into_iter().chain(im)
    });
    turned.collect()
}

/// A field of a harmonic over the waves whose sectors are ahead by phases of harmonic 1, rad.
pub(super) fn turned_field(
    transform: &SectorTransform,
    waves: &Field,
    harmonic: u32,
    phases: &[f64],
) -> Field {
    let angles = phases.iter().map(|phase| f64::from(harmonic) * phase);
    let turns: Vec<(f64, f64)> = angles.map(f64::sin_cos).collect();
    let mut sectors = over_sectors(transform, waves);
    let stride = padded(transform.sectors());
    let rows = sectors.re.chunks_exact_mut(stride);
    for (re, im) in rows.zip(sectors.im.chunks_exact_mut(stride)) {
        for ((x, y), (sine, cosine)) in re.iter_mut().zip(im).zip(&turns) {
            (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
        }
    }
    let mut turned = Field::zeros_like(waves);
    transform.to_waves(&sectors, &mut turned);
    turned
}

/// Phases of harmonic 1, rad, by which every sector of the motions `to` is ahead of that of `from`, both in the harmonics `set`: those
/// after which they are nearest to each other.
pub(super) fn phases_ahead(
    transform: &SectorTransform,
    from: &[f64],
    to: &[f64],
    set: &[u32],
) -> Vec<f64> {
    let fundamental = set.iter().position(|&k| k == 1).unwrap_or(0);
    let of_fundamental = |motions: &[f64]| {
        let waves = waves_of(motions, set).nth(fundamental);
        over_sectors(transform, &waves.unwrap_or_default())
    };
    let (from, to) = (of_fundamental(from), of_fundamental(to));
    let stride = padded(transform.sectors());
    let phase = |sector: usize| {
        let rows = (sector..from.re.len()).step_by(stride);
        let product: Complex64 = rows.map(|row| from.at(row).conj() * to.at(row)).sum();
        product.arg()
    };
    (0..transform.sectors()).map(phase).collect()
}

/// The fields of motions in the harmonics `set`, over the waves.
fn waves_of<'a>(motions: &'a [f64], set: &[u32]) -> impl Iterator<Item = Field> + use<'a> {
    let size = motions.len() / set.len().max(1);
    motions.chunks_exact(size.max(1)).map(|part| {
        let (re, im) = part.split_at(part.len() / 2);
        Field {
            re: re.to_vec(),
            im: im.to_vec(),
        }
    })
}

fn over_sectors(transform: &SectorTransform, waves: &Field) -> Field {
    let mut sectors = Field::zeros_like(waves);
    transform.to_sectors(waves, &mut sectors);
    sectors
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Motions of sectors that resonate each at a frequency of its own, in harmonics 1 and 3 of one channel, over the waves.
    fn resonant(transform: &SectorTransform, set: &[u32], frequency: f64) -> Vec<f64> {
        let sectors = transform.sectors();
        let fields = set.iter().map(|&harmonic| {
            let mut field = Field::zeros(1, sectors);
            for sector in 0..sectors {
                let distance = frequency - 0.1 * sector as f64;
                let motion = Complex64::new(1.0, distance).inv();
                let turned = (motion / motion.norm()).powu(harmonic);
                field.set(sector, turned * motion.norm() / f64::from(harmonic));
            }
            let mut waves = Field::zeros(1, sectors);
            transform.to_waves(&field, &mut waves);
            waves
        });
        fields
            .flat_map(|Field { re, im }| re.into_iter().chain(im))
            .collect()
    }

    #[test]
    fn every_harmonic_turns_by_its_number_times_the_phase_of_its_sector() {
        let transform = SectorTransform::new(5);
        let set = [0, 1, 3];
        let size = 2 * padded(5);
        let mut field = Field::zeros(1, 5);
        (0..5).for_each(|n| field.set(n, Complex64::new(1.0 + n as f64, 0.5 - n as f64)));
        let mut waves = Field::zeros(1, 5);
        transform.to_waves(&field, &mut waves);
        let of_one: Vec<f64> = waves.re.iter().chain(&waves.im).copied().collect();
        let motions = of_one.repeat(3);
        let phases = [0.7, -0.2, 0.0, 2.9, -1.3];
        let turned = turned_ahead(&transform, &motions, &set, &phases);
        for (harmonic, part) in set.iter().zip(turned.chunks_exact(size)) {
            let (re, im) = part.split_at(size / 2);
            let waves = Field {
                re: re.to_vec(),
                im: im.to_vec(),
            };
            let sectors = over_sectors(&transform, &waves);
            for (n, phase) in phases.iter().enumerate() {
                let expected = field.at(n) * Complex64::cis(f64::from(*harmonic) * phase);
                assert!((sectors.at(n) - expected).norm() < 1e-13);
            }
        }
        let found = phases_ahead(&transform, &motions, &turned, &set);
        assert!(found.iter().zip(phases).all(|(a, b)| (a - b).abs() < 1e-13));
    }

    #[test]
    fn motions_between_two_of_a_resonance_are_nearer_to_it_than_those_on_the_line() {
        let transform = SectorTransform::new(7);
        let set = [1, 3];
        let [low, high, exact] = [-0.2, 0.8, 0.3].map(|at| resonant(&transform, &set, at));
        let distance = |motions: &[f64]| {
            let squares = motions.iter().zip(&exact).map(|(a, b)| (a - b).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let line: Vec<f64> = low.iter().zip(&high).map(|(a, b)| 0.5 * (a + b)).collect();
        let turning = between_turning(&transform, &low, &high, &set, 0.5);
        assert!(
            distance(&turning) < 0.5 * distance(&line),
            "{} {}",
            distance(&turning),
            distance(&line)
        );
    }
}
