//! The nodal diameters of the tuned wheel under each linear contact condition, shared by the engines that are made of them.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::linalg::Matrix;
use crate::model::ReducedModel;
use crate::model::cyclic::NodalDiameter;
use crate::response::harmonic_balance::Damping;

use super::blade_shapes::Participation;
use super::resonances::{BandModes, resonances_that_count};
use super::tuned_diameter::TunedDiameter;
use super::wave_force::WaveForce;

/// The nodal diameters 0..=N/2 of the tuned wheel under stuck springs, under sliding ones, and without.
#[derive(Debug, Clone)]
pub(super) struct LinearLimits {
    sectors: usize,
    diameters: [Arc<Vec<TunedDiameter>>; 3],
}

impl LinearLimits {
    /// The limits of `model`; none if their modes are not found.
    pub(super) fn new(model: &ReducedModel, damping: Damping) -> Option<Self> {
        let under = |springs: &[f64]| Some(Arc::new(tuned_diameters(model, springs, damping)?));
        Some(Self {
            sectors: model.sectors,
            diameters: [
                under(&model.springs.stick)?,
                under(&model.springs.slide)?,
                under(&[])?,
            ],
        })
    }

    /// Under stuck springs.
    pub(super) fn stuck(&self) -> &[TunedDiameter] {
        &self.diameters[0]
    }

    /// Under stuck springs, under sliding ones, and without.
    pub(super) fn diameters(&self) -> &[Arc<Vec<TunedDiameter>>; 3] {
        &self.diameters
    }

    /// Lowest and highest angular frequency of the resonances that count, rad/s, over all excitations and conditions.
    pub(super) fn span(&self, forces: &[WaveForce]) -> Option<(f64, f64)> {
        let mut span: Option<(f64, f64)> = None;
        for diameters in &self.diameters {
            let none: Participation = diameters
                .iter()
                .map(|diameter| Matrix::zeros(0, diameter.size()))
                .collect();
            let everywhere = (f64::MIN_POSITIVE, f64::MAX);
            let all = BandModes::new(diameters, &none, self.sectors, 0.0, everywhere);
            for force in forces {
                for resonance in resonances_that_count(&all.tuned_peaks(diameters, force)) {
                    let omega = TAU * resonance.frequency_hz;
                    let (low, high) = span.unwrap_or((omega, omega));
                    span = Some((low.min(omega), high.max(omega)));
                }
            }
        }
        span
    }
}

/// The nodal diameters of a wheel with springs at the contact; none if their modes are not found.
fn tuned_diameters(
    model: &ReducedModel,
    springs: &[f64],
    damping: Damping,
) -> Option<Vec<TunedDiameter>> {
    let acts = springs.iter().any(|&spring| spring != 0.0);
    let springs = if acts { springs } else { &[] };
    (0..=model.sectors / 2)
        .map(|index| {
            let wave = model.wave(NodalDiameter {
                index,
                conjugate: false,
            });
            let waves = if model.is_standing(index) { 1 } else { 2 };
            TunedDiameter::new(&wave, springs, damping, waves)
        })
        .collect()
}
