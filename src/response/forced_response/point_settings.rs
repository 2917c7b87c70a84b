//! What the solution of a point needs besides the structure, and the amplitudes read off a solution.

use std::sync::Arc;

use super::options::{AmplitudeMeasure, SolverOptions};
use crate::linalg::add_times_vector;
use crate::model::cyclic::ContactGeometry;
use crate::response::friction::{ContactLaw, PairParameters, Ring};
use crate::response::harmonic_balance::{
    HarmonicTransform, NewtonBounds, Structure, TransformError,
};

/// Everything of a study that the solution of a point needs besides the structure.
#[derive(Debug, Clone)]
pub struct PointSettings {
    pub(super) harmonics: Vec<u32>,
    pub(super) transform: Arc<HarmonicTransform>,
    /// Transform of the observed displacement for [`AmplitudeMeasure::TimeMaximum`].
    time_grid: Option<Arc<HarmonicTransform>>,
    pub(super) bounds: NewtonBounds,
    pub(super) contact: Option<(ContactLaw, PairParameters)>,
    pub(super) ring: Ring,
    pub(super) geometry: ContactGeometry,
}

impl PointSettings {
    /// `harmonics` ascending, with 1; `contact` is the law with its per-sector parameters (the
    /// normal load is set per scenario).
    ///
    /// # Errors
    /// If the harmonics cannot be told apart with the samples asked for.
    pub fn new(
        options: &SolverOptions,
        harmonics: &[u32],
        contact: Option<(ContactLaw, PairParameters)>,
        geometry: ContactGeometry,
    ) -> Result<Self, TransformError> {
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let transform = HarmonicTransform::new(&set, options.samples_per_period)?;
        let time_grid = match options.amplitude {
            AmplitudeMeasure::Fundamental => None,
            AmplitudeMeasure::TimeMaximum => Some(Arc::new(HarmonicTransform::new(
                &set,
                options.time_samples,
            )?)),
        };
        Ok(Self {
            harmonics: harmonics.to_vec(),
            transform: Arc::new(transform),
            time_grid,
            bounds: NewtonBounds::with_tolerance(options.residual_tolerance),
            contact,
            ring: Ring::Locked,
            geometry,
        })
    }

    /// The same with what a free ring does under mean friction; locked at first.
    #[must_use]
    pub fn with_ring(self, ring: Ring) -> Self {
        Self { ring, ..self }
    }

    /// Harmonic set of the nonlinear solution.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// Amplitude of each blade: of the fundamental harmonic, or the largest over a period.
    pub(super) fn blade_amplitudes(
        &self,
        blocks: &[(u32, &Structure)],
        solution: &[f64],
    ) -> Vec<f64> {
        let rows = blocks[0].1.observed().real.rows();
        let mut start = 0;
        let mut coefficients: Vec<(u32, Vec<f64>, Vec<f64>)> = Vec::new();
        for &(harmonic, structure) in blocks {
            let observed = structure.observed();
            let real = &observed.real;
            let n = structure.size();
            let mut re = vec![0.0; rows];
            let mut im = vec![0.0; rows];
            if harmonic > 0 {
                let (x_re, x_im) = solution[start..start + 2 * n].split_at(n);
                add_times_vector(&mut re, 1.0, real.as_slice(), x_re);
                add_times_vector(&mut im, 1.0, real.as_slice(), x_im);
                if let Some(imaginary) = &observed.imaginary {
                    add_times_vector(&mut re, -1.0, imaginary.as_slice(), x_im);
                    add_times_vector(&mut im, 1.0, imaginary.as_slice(), x_re);
                }
            }
            start += n * if harmonic == 0 { 1 } else { 2 };
            coefficients.push((harmonic, re, im));
        }
        (0..rows / 3)
            .map(|blade| match &self.time_grid {
                None => coefficients
                    .iter()
                    .filter(|(harmonic, ..)| *harmonic == 1)
                    .flat_map(|(_, re, im)| {
                        (3 * blade..3 * blade + 3).map(|i| re[i].powi(2) + im[i].powi(2))
                    })
                    .sum::<f64>()
                    .sqrt(),
                Some(grid) => time_maximum(grid, &coefficients, blade),
            })
            .collect()
    }
}

/// Largest norm over one period of a blade's displacement, harmonic 0 left out.
fn time_maximum(
    grid: &HarmonicTransform,
    coefficients: &[(u32, Vec<f64>, Vec<f64>)],
    blade: usize,
) -> f64 {
    let mut channels = Vec::with_capacity(3 * grid.n_coefficients());
    for component in 0..3 {
        let row = 3 * blade + component;
        for &harmonic in grid.harmonics() {
            let found = coefficients
                .iter()
                .find(|(own, ..)| *own as usize == harmonic);
            let (re, im) = found.map_or((0.0, 0.0), |(_, re, im)| (re[row], im[row]));
            channels.push(re);
            if harmonic > 0 {
                channels.push(im);
            }
        }
    }
    grid.largest_norm(&channels)
}
