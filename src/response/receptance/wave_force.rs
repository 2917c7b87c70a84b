//! What excites the wheel: a force that travels as one wave.

use crate::linalg::Complex64;
use crate::model::ReducedModel;
use crate::model::cyclic::{NodalDiameter, nodal_diameter_of};

/// A travelling excitation of the wheel, in the contact-free modes of its wave.
#[derive(Debug, Clone)]
pub struct WaveForce {
    pub(super) diameter: NodalDiameter,
    /// Amplitude of the wave, `sqrt(N)` times the modal force of a sector.
    pub(super) modal: Vec<Complex64>,
}

impl WaveForce {
    /// The excitation of an engine order on `model`, its force vector times `amplitude_n`.
    #[must_use]
    pub fn new(model: &ReducedModel, engine_order: u32, amplitude_n: f64) -> Self {
        let diameter = nodal_diameter_of(1, engine_order, model.sectors);
        let scale = amplitude_n * model.force_factor(engine_order) * (model.sectors as f64).sqrt();
        let force = model.wave(diameter).force;
        Self {
            diameter,
            modal: force.column(0).iter().map(|f| f * scale).collect(),
        }
    }

    /// Nodal diameter, whether it is the conjugate one, and the modal force: what two excitations differ by.
    #[must_use]
    pub fn parts(&self) -> (usize, bool, Vec<[f64; 2]>) {
        let modal = self.modal.iter().map(|force| [force.re, force.im]);
        (
            self.diameter.index,
            self.diameter.conjugate,
            modal.collect(),
        )
    }

    /// Place of the wave among the N of the wheel.
    pub(super) fn wave(&self, sectors: usize) -> usize {
        if self.diameter.conjugate {
            sectors - self.diameter.index
        } else {
            self.diameter.index
        }
    }
}
