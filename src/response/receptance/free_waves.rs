//! The wheel of an engine without its contact springs, one wave after the other: what the march in time of `response/stability` is made of.

use super::blade_shapes::{ShapesWanted, blade_shapes, in_shapes};
use super::engine::{EngineWheel, Limit, ReceptanceEngine};
use crate::linalg::{Complex64, Matrix};

/// Frequencies, relative to that of the excitation, at whose motions the blade shapes of a march are made: a disturbance
/// of a periodic motion moves at many.
const SHAPE_FREQUENCIES: [f64; 9] = [0.25, 0.5, 0.75, 0.9, 1.0, 1.1, 1.5, 2.0, 3.0];
/// Blade shapes of a march.
const SHAPES: usize = 8;

/// One wave h, 0..=N/2, in its contact-free modes: `q'' + c q' + lambda q = p`.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeWave {
    /// Eigenvalues lambda, (rad/s)^2.
    pub eigenvalues: Vec<f64>,
    /// Viscous damping c of every mode, 1/s; without that of a loss factor.
    pub viscous: Vec<f64>,
    /// Relative motion at the contact rows, `c x n`.
    pub contact: Matrix<Complex64>,
    /// Strain coordinates of the blade, `r x n`.
    pub strain: Matrix<Complex64>,
}

/// A wheel without its contact. Blade n adds `delta_n (1 + i eta) z` to the force on its strain coordinates z.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeWheel {
    /// Number of sectors N.
    pub sectors: usize,
    /// Waves 0..=N/2; those of `N - h` are the complex conjugates.
    pub waves: Vec<FreeWave>,
    /// Structural loss factor eta.
    pub loss_factor: f64,
    /// Deviation of every strain coordinate and sector, coordinate after coordinate.
    pub deviations: Vec<f64>,
}

impl ReceptanceEngine {
    /// The wheel without its contact, its blades in shapes made for motions around the angular frequency `omega`, rad/s;
    /// none where these are not found.
    #[must_use]
    pub fn free_wheel(&self, wheel: &EngineWheel, omega: f64) -> Option<FreeWheel> {
        let tuned = self.tuned_wheel(Limit::Stuck);
        let frequencies = SHAPE_FREQUENCIES.map(|share| share * omega);
        let participation = if self.acts_on_cantilever_modes() {
            tuned.strain().clone()
        } else {
            let wanted = ShapesWanted {
                frequencies: &frequencies,
                contact_forces: tuned.contact_forces(),
                excitations: tuned.forces(),
                deviation: tuned.deviation(),
                count: SHAPES,
            };
            let shapes = blade_shapes(&tuned.diameters, tuned.strain(), &wanted)?;
            in_shapes(tuned.strain(), &shapes)
        };
        let coordinates = participation.first()?.rows();
        let waves = tuned.diameters.iter().zip(participation);
        Some(FreeWheel {
            sectors: self.sectors(),
            waves: waves
                .map(|(diameter, strain)| FreeWave {
                    eigenvalues: diameter.eigenvalues().to_vec(),
                    viscous: diameter.viscous().to_vec(),
                    contact: diameter.contact.clone(),
                    strain,
                })
                .collect(),
            loss_factor: self.loss_factor,
            deviations: wheel.deviations(coordinates),
        })
    }
}
