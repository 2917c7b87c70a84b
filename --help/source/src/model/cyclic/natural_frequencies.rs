//! Natural frequencies of the sector per nodal diameter, without contact or with linear contact springs.

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
/// If the mass of a nodal diameter is not positive definite, or the modes of its stiffness are not found.
pub fn contact_free_frequencies_hz(
    model: &SectorModel,
    count: usize,
) -> Result<Vec<Vec<f64>>, ModelError> {
    natural_frequencies_hz(model, [0.0; 3], count)
}

/// The lowest `count` natural frequencies, Hz, of nodal diameters 0 to N/2 with contact springs:
/// `per_sector` in the normal, first and second tangential direction, N/m, shared out over the pairs by
/// weight. A negative eigenvalue is given as a negative frequency, `-sqrt(-lambda) / 2 pi`.
///
/// # Errors
/// If the mass of a nodal diameter is not positive definite, or the modes of its stiffness are not found.
pub fn natural_frequencies_hz(
    model: &SectorModel,
    per_sector: [f64; 3],
    count: usize,
) -> Result<Vec<Vec<f64>>, ModelError> {
    let sector = CyclicSector::new(model);
    let springs = sector.contact().springs(per_sector);
    (0..=model.sectors / 2)
        .map(|h| {
            let contact = sector.contact_stiffness(&springs, h);
            let stiffness = sector.stiffness(h).plus(1.0, &contact);
            let mass = sector.mass(h);
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
