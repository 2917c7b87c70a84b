//! One mistuning pattern: the deviation of every blade of a wheel, and its contact.

use serde::Serialize;

use super::ContactFactors;

/// Relative deviations of the blades of one wheel, in blade order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum Deviations {
    /// One deviation of the blade stiffness per blade, all modes alike; length N sectors.
    PerBlade(Vec<f64>),
    /// One deviation per blade and blade-alone mode, relative in eigenvalue: `(f / f0)^2 - 1`.
    PerMode {
        /// Blade-alone modes, ascending from 0; length `n_modes`.
        modes: Vec<u32>,
        /// Deviations, blade by blade: `values[blade * n_modes + mode]`.
        values: Vec<f64>,
    },
}

impl Deviations {
    /// Root mean square of all of them.
    #[must_use]
    pub fn root_mean_square(&self) -> f64 {
        let (Self::PerBlade(values) | Self::PerMode { values, .. }) = self;
        let squares: f64 = values.iter().map(|value| value.powi(2)).sum();
        (squares / values.len().max(1) as f64).sqrt()
    }
}

/// One mistuning pattern.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pattern {
    /// Id, from 0 or as in the file of patterns.
    pub id: u32,
    /// Deviations of its blades.
    pub deviations: Deviations,
    /// Its contact relative to the nominal one.
    pub contact: ContactFactors,
}

impl Pattern {
    /// A wheel of nominal contact with one relative deviation of the blade stiffness per blade, in blade order.
    #[must_use]
    pub fn of_blades(id: u32, deviations: Vec<f64>) -> Self {
        Self {
            id,
            deviations: Deviations::PerBlade(deviations),
            contact: ContactFactors::default(),
        }
    }

    /// Number of blades.
    #[must_use]
    pub fn blades(&self) -> usize {
        match &self.deviations {
            Deviations::PerBlade(values) => values.len(),
            Deviations::PerMode { modes, values } => values.len() / modes.len().max(1),
        }
    }

    /// Every deviation as `(blade, mode, deviation)`; no mode means all modes.
    #[must_use]
    pub fn entries(&self) -> Vec<(u32, Option<u32>, f64)> {
        match &self.deviations {
            Deviations::PerBlade(values) => (0..)
                .zip(values)
                .map(|(blade, &deviation)| (blade, None, deviation))
                .collect(),
            Deviations::PerMode { modes, values } => (0..)
                .zip(values.chunks(modes.len().max(1)))
                .flat_map(|(blade, of_blade)| {
                    modes
                        .iter()
                        .zip(of_blade)
                        .map(move |(&mode, &deviation)| (blade, Some(mode), deviation))
                })
                .collect(),
        }
    }

    /// Whether stiffnesses and contact parameters are above zero.
    #[must_use]
    pub fn is_possible(&self) -> bool {
        let (Deviations::PerBlade(values) | Deviations::PerMode { values, .. }) = &self.deviations;
        let is_physical = |&deviation: &f64| deviation > -1.0 && deviation.is_finite();
        values.iter().all(is_physical) && self.contact.are_possible()
    }

    /// Largest absolute deviation.
    #[must_use]
    pub fn largest_deviation(&self) -> f64 {
        let (Deviations::PerBlade(values) | Deviations::PerMode { values, .. }) = &self.deviations;
        values
            .iter()
            .fold(0.0, |largest, value| value.abs().max(largest))
    }
}
