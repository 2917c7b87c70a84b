//! The amplitude of every blade from the unknowns of a solution.

use super::options::AmplitudeMeasure;
use crate::linalg::{Complex64, add_times, add_times_vector};
use crate::response::harmonic_balance::{
    HarmonicBlock, HarmonicTransform, Structure, TransformError,
};

/// The measure called amplitude, ready for solutions with harmonics of one set.
#[derive(Debug, Clone)]
pub struct ObservedAmplitude {
    /// Instants of a period for [`AmplitudeMeasure::TimeMaximum`].
    time_grid: Option<HarmonicTransform>,
}

/// One harmonic of a solution.
#[derive(Clone, Copy)]
pub struct ObservedBlock<'a> {
    harmonic: u32,
    structure: &'a Structure,
    /// Complex unknowns.
    size: usize,
}

impl<'a> ObservedBlock<'a> {
    /// The harmonics of a solution, in their order.
    #[must_use]
    pub fn all(blocks: &'a [HarmonicBlock]) -> Vec<Self> {
        let block = |block: &'a HarmonicBlock| Self {
            harmonic: block.harmonic,
            structure: &block.structure,
            size: block.size(),
        };
        blocks.iter().map(block).collect()
    }

    /// Harmonic 1 alone.
    #[must_use]
    pub fn fundamental(structure: &'a Structure) -> [Self; 1] {
        [Self {
            harmonic: 1,
            structure,
            size: structure.size(),
        }]
    }
}

/// Complex displacement r, theta, z of the observed node, blade after blade, of one harmonic.
#[derive(Debug, Clone)]
pub(super) struct ObservedHarmonic {
    pub(super) harmonic: u32,
    pub(super) displacement: Vec<Complex64>,
}

impl ObservedAmplitude {
    /// `measure` for solutions with `harmonics`, over `time_samples` instants.
    ///
    /// # Errors
    /// If the instants cannot tell the harmonics apart.
    pub fn new(
        measure: AmplitudeMeasure,
        harmonics: &[u32],
        time_samples: usize,
    ) -> Result<Self, TransformError> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let time_grid = match measure {
            AmplitudeMeasure::Fundamental => None,
            AmplitudeMeasure::TimeMaximum => Some(HarmonicTransform::new(&set, time_samples)?),
        };
        Ok(Self { time_grid })
    }

    /// Amplitude of each blade, m: of the fundamental harmonic, or the largest over a period.
    /// `blocks` are harmonics and structures in the order of the unknowns `solution`.
    #[must_use]
    pub fn of(&self, blocks: &[ObservedBlock<'_>], solution: &[f64]) -> Vec<f64> {
        self.of_observed(&observed(blocks, solution))
    }

    /// [`Self::of`] from what is observed in every harmonic.
    pub(super) fn of_observed(&self, harmonics: &[ObservedHarmonic]) -> Vec<f64> {
        let rows = harmonics[0].displacement.len();
        (0..rows / 3)
            .map(|blade| match &self.time_grid {
                None => fundamental(harmonics, blade)
                    .iter()
                    .map(Complex64::norm_sqr)
                    .sum::<f64>()
                    .sqrt(),
                Some(grid) => time_maximum(grid, harmonics, blade),
            })
            .collect()
    }

    /// Harmonics of which the amplitude takes notice.
    pub(super) fn counts(&self, harmonic: u32) -> bool {
        harmonic == 1 || self.time_grid.is_some()
    }

    /// Whether `step` changes no amplitude by more than `share` of the largest one of `solution`.
    pub(super) fn is_steady(
        &self,
        blocks: &[ObservedBlock<'_>],
        solution: &[f64],
        step: &[f64],
        share: f64,
    ) -> bool {
        let (whole, change) = (observed(blocks, solution), observed(blocks, step));
        let length = |u: &[Complex64]| u.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        let blades = whole[0].displacement.len() / 3;
        let largest = (0..blades)
            .map(|blade| length(fundamental(&whole, blade)))
            .fold(0.0, f64::max);
        (0..blades).all(|blade| {
            let changed: f64 = change
                .iter()
                .filter(|observed| observed.harmonic == 1 || self.time_grid.is_some())
                .map(|observed| length(&observed.displacement[3 * blade..3 * blade + 3]))
                .sum();
            changed <= share * largest
        })
    }

    /// Amplitude of each blade after a solution has changed from `before` to `after`. A turn in
    /// phase of the fundamental does not count: at a peak it stands for a shift in frequency,
    /// which leaves the height of the peak as it is.
    pub(super) fn changed(
        &self,
        blocks: &[ObservedBlock<'_>],
        before: &[f64],
        after: &[f64],
    ) -> Vec<f64> {
        self.changed_observed(&observed(blocks, before), &observed(blocks, after))
    }

    /// [`Self::changed`] from what is observed in every harmonic.
    pub(super) fn changed_observed(
        &self,
        old: &[ObservedHarmonic],
        new: &[ObservedHarmonic],
    ) -> Vec<f64> {
        let plain = self.of_observed(new);
        plain
            .iter()
            .enumerate()
            .map(|(blade, &amplitude)| {
                let (old, new) = (fundamental(old, blade), fundamental(new, blade));
                let square: f64 = old.iter().map(Complex64::norm_sqr).sum();
                let along: f64 = old.iter().zip(new).map(|(a, b)| (a.conj() * b).re).sum();
                let length: f64 = new.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
                if length > 0.0 && square > 0.0 {
                    amplitude * along / (square.sqrt() * length)
                } else {
                    amplitude
                }
            })
            .collect()
    }
}

/// The observed displacement in every harmonic; zero in harmonic 0, which no measure counts.
fn observed(blocks: &[ObservedBlock<'_>], solution: &[f64]) -> Vec<ObservedHarmonic> {
    let mut start = 0;
    let mut harmonics = Vec::with_capacity(blocks.len());
    for &ObservedBlock {
        harmonic,
        structure,
        size: n,
    } in blocks
    {
        let rows = structure.observed();
        let mut re = vec![0.0; rows.real.rows()];
        let mut im = vec![0.0; rows.real.rows()];
        if harmonic > 0 {
            let x = &solution[start..start + 2 * n];
            let (x_re, x_im) = x.split_at(n);
            let mut both = vec![0.0; 2 * re.len()];
            add_times(&mut both, rows.real.as_slice(), x, (re.len(), 2, n));
            let (both_re, both_im) = both.split_at(re.len());
            re.copy_from_slice(both_re);
            im.copy_from_slice(both_im);
            if let Some(imaginary) = &rows.imaginary {
                add_times_vector(&mut re, -1.0, imaginary.as_slice(), x_im);
                add_times_vector(&mut im, 1.0, imaginary.as_slice(), x_re);
            }
        }
        start += n * if harmonic == 0 { 1 } else { 2 };
        let displacement = re
            .into_iter()
            .zip(im)
            .map(|(re, im)| Complex64::new(re, im));
        harmonics.push(ObservedHarmonic {
            harmonic,
            displacement: displacement.collect(),
        });
    }
    harmonics
}

/// Displacement of a blade in harmonic 1.
fn fundamental(harmonics: &[ObservedHarmonic], blade: usize) -> &[Complex64] {
    harmonics
        .iter()
        .find(|observed| observed.harmonic == 1)
        .map_or(&[], |observed| {
            &observed.displacement[3 * blade..3 * blade + 3]
        })
}

/// Largest norm over one period of a blade's displacement, harmonic 0 left out.
fn time_maximum(grid: &HarmonicTransform, harmonics: &[ObservedHarmonic], blade: usize) -> f64 {
    grid.largest_norm(&channels(grid, harmonics, blade))
}

/// Coefficients of a blade's displacement r, theta, z.
fn channels(grid: &HarmonicTransform, harmonics: &[ObservedHarmonic], blade: usize) -> Vec<f64> {
    let mut channels = Vec::with_capacity(3 * grid.n_coefficients());
    for component in 0..3 {
        let row = 3 * blade + component;
        for &harmonic in grid.harmonics() {
            let found = harmonics
                .iter()
                .find(|observed| observed.harmonic as usize == harmonic);
            let value = found.map_or(Complex64::default(), |observed| observed.displacement[row]);
            channels.push(value.re);
            if harmonic > 0 {
                channels.push(value.im);
            }
        }
    }
    channels
}
