//! Natural frequencies of the contact-free sector per nodal diameter, to compare with the code it came from.

use std::f64::consts::TAU;

use super::cyclic_sector::CyclicSector;
use crate::linalg::lowest_modes;
use crate::model::sector::{ModelError, SectorModel, StiffnessKind};

/// The lowest `count` natural frequencies, Hz, of nodal diameters 0 to N/2.
///
/// A body that nothing holds has frequencies of nought; one that rotation softens may have negative
/// eigenvalues, which are given as negative frequencies, `-sqrt(-lambda) / 2 pi`.
///
/// # Errors
/// If the mass of a nodal diameter is not positive definite.
pub fn contact_free_frequencies_hz(
    model: &SectorModel,
    count: usize,
) -> Result<Vec<Vec<f64>>, ModelError> {
    let sector = CyclicSector::new(model);
    (0..=model.sectors / 2)
        .map(|h| {
            let (stiffness, mass) = (sector.stiffness(h), sector.mass(h));
            if mass.factor().is_err() {
                return Err(ModelError::MassNotPositiveDefinite { nodal_diameter: h });
            }
            // Below all eigenvalues: (2 pi 1 Hz)^2 does for free bodies, more for softened ones.
            let mut shift = -TAU * TAU;
            let refused = |_| ModelError::StiffnessNotPositiveDefinite {
                nodal_diameter: h,
                what: StiffnessKind::Structure,
            };
            let factor = loop {
                match stiffness.plus(-shift, &mass).factor() {
                    Ok(factor) => break factor,
                    Err(error) if shift.abs() > 1e12 => return Err(refused(error)),
                    Err(_) => shift *= 16.0,
                }
            };
            let (values, _) = lowest_modes(&factor, &mass, shift, count).map_err(refused)?;
            Ok(values
                .into_iter()
                .map(|lambda| lambda.signum() * lambda.abs().sqrt() / TAU)
                .collect())
        })
        .collect()
}
