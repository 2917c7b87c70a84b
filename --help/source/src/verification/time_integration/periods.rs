//! One period of a march, sample by sample, and what changed since the period before.

use std::f64::consts::TAU;

use super::stepper::TimeStepper;
use crate::linalg::{Complex64, Matrix, add_times_vector};
use crate::response::harmonic_balance::Status;

/// Histories of one period: observed displacement and contact force at every step.
#[derive(Debug, Clone)]
pub(super) struct Period {
    /// Displacement r, theta, z of the observed nodes, step after step (`n_steps x 3 N`).
    observed: Vec<f64>,
    /// Contact force of every row, step after step.
    force: Vec<f64>,
    /// Number of observed components, 3 N.
    components: usize,
    steps: usize,
    /// Displacement of the contact rows at the end.
    contact_end: Vec<f64>,
    /// Pairs that slip, and that are open, at any step.
    slipping: Vec<bool>,
    separated: Vec<bool>,
}

impl Period {
    /// Marches one period; `observed` are the rows of the observed nodes.
    pub(super) fn march(
        stepper: &mut TimeStepper<'_>,
        observed: &Matrix<f64>,
    ) -> Result<Self, Status> {
        let steps = stepper.steps_per_period();
        let components = observed.rows();
        let pairs = stepper.pairs().len();
        let mut period = Self {
            observed: vec![0.0; steps * components],
            force: Vec::with_capacity(steps * stepper.contact_force_n().len()),
            components,
            steps,
            contact_end: Vec::new(),
            slipping: vec![false; pairs],
            separated: vec![false; pairs],
        };
        for sample in period.observed.chunks_exact_mut(components) {
            stepper.advance()?;
            add_times_vector(sample, 1.0, observed.as_slice(), stepper.position());
            period.force.extend_from_slice(stepper.contact_force_n());
            for (index, pair) in stepper.pairs().iter().enumerate() {
                period.slipping[index] |= pair.slipping;
                period.separated[index] |= pair.separated();
            }
        }
        period.contact_end = stepper.contact_displacement_m().to_vec();
        Ok(period)
    }

    /// Largest change of an observed displacement since `before`, relative to the largest one.
    pub(super) fn blade_change(&self, before: &Self) -> f64 {
        relative_change(&self.observed, &before.observed)
    }

    /// Largest change of a contact force since `before`, relative to the largest one.
    pub(super) fn force_change(&self, before: &Self) -> f64 {
        relative_change(&self.force, &before.force)
    }

    /// Largest shift of the given contact rows since the end of `before`, m.
    pub(super) fn creep_m(&self, before: &Self, rows: impl Iterator<Item = usize>) -> f64 {
        rows.map(|row| (self.contact_end[row] - before.contact_end[row]).abs())
            .fold(0.0, f64::max)
    }

    /// Complex amplitude of harmonic 1 of every observed component, m.
    pub(super) fn fundamental(&self) -> Vec<Complex64> {
        let mut sums = vec![Complex64::default(); self.components];
        for (step, sample) in self.observed.chunks_exact(self.components).enumerate() {
            // The sample after step j belongs to the phase j + 1.
            let turn = (step + 1) as f64 / self.steps as f64;
            let weight = Complex64::from_polar(2.0 / self.steps as f64, -TAU * turn);
            for (sum, &x) in sums.iter_mut().zip(sample) {
                *sum += weight * x;
            }
        }
        sums
    }

    /// Largest norm over the period of every blade's displacement about its mean, m.
    pub(super) fn time_maxima(&self) -> Vec<f64> {
        let mut mean = vec![0.0; self.components];
        for sample in self.observed.chunks_exact(self.components) {
            for (mean, x) in mean.iter_mut().zip(sample) {
                *mean += x / self.steps as f64;
            }
        }
        let mut largest = vec![0.0_f64; self.components / 3];
        for sample in self.observed.chunks_exact(self.components) {
            let blades = sample.chunks_exact(3).zip(mean.chunks_exact(3));
            for (largest, (x, mean)) in largest.iter_mut().zip(blades) {
                let square: f64 = x.iter().zip(mean).map(|(x, mean)| (x - mean).powi(2)).sum();
                *largest = largest.max(square.sqrt());
            }
        }
        largest
    }

    /// Shares of pairs that slip, and that are open, at any step.
    pub(super) fn shares(&self) -> (f64, f64) {
        let share = |flags: &[bool]| {
            flags.iter().filter(|&&flag| flag).count() as f64 / flags.len().max(1) as f64
        };
        (share(&self.slipping), share(&self.separated))
    }
}

/// Largest difference relative to the largest value; zero where everything is.
fn relative_change(now: &[f64], before: &[f64]) -> f64 {
    let largest = now.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let change = now
        .iter()
        .zip(before)
        .fold(0.0_f64, |change, (a, b)| change.max((a - b).abs()));
    if largest > 0.0 {
        change / largest
    } else {
        change
    }
}

/// Amplitude of every blade, m: Euclidean norm over its three complex components.
pub(super) fn blade_norms(components: &[Complex64]) -> Vec<f64> {
    let blades = components.chunks_exact(3);
    blades
        .map(|blade| blade.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt())
        .collect()
}
