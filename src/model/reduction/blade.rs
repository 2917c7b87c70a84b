//! The blade's stiffness in reduced coordinates: exact projection and cantilever participation.

use crate::linalg::{Complex64, Matrix, hermitian_pencil, lowest_modes};
use crate::model::blade_energy::BladeEnergy;
use crate::model::cyclic::CyclicSector;
use crate::model::reduced_model::CantileverModes;
use crate::model::sector::ModelError;

/// At most so many free blade dofs, the cantilever modes are found by a dense solution.
const DENSE_BLADE: usize = 60;

/// Strain energy of the blade over the bases of the nodal diameters, in factors: W and `K_blade W`.
pub(super) fn blade_energy(sector: &CyclicSector<'_>, bases: &[Matrix<Complex64>]) -> BladeEnergy {
    let dofs = sector.blade_dofs();
    let blade = sector.blade_stiffness();
    let local = blade.principal(&dofs);
    let mut motions = Matrix::zeros(dofs.len(), 0);
    let mut forces = Matrix::zeros(dofs.len(), 0);
    for basis in bases {
        // K_blade is real: real motions have real forces.
        let part = basis.select_rows(&dofs);
        let force = local.times(&part);
        for (all, part) in [(&mut motions, part), (&mut forces, force)] {
            all.append(&part.real());
            all.append(&part.imaginary());
        }
    }
    BladeEnergy::Factors { motions, forces }
}

/// Cantilever modes of the blade and their participation in the bases of the nodal diameters.
///
/// # Errors
/// If no blade dof is free of other structure, or the held blade's stiffness or mass is not
/// positive definite.
pub fn cantilever_modes(
    sector: &CyclicSector<'_>,
    bases: &[Matrix<Complex64>],
    count: usize,
) -> Result<CantileverModes, ModelError> {
    let free = sector.free_blade_dofs();
    if free.is_empty() {
        return Err(ModelError::NoFreeBladeDof);
    }
    let blade = sector.blade_stiffness();
    // All mass of a free blade dof is the blade's own.
    let mass = sector.mass(0).principal(&free);
    let held = blade.principal(&free);
    let indefinite = |_| ModelError::CantileverNotPositiveDefinite;
    let count = count.min(free.len());
    let (eigenvalues, modes) = if free.len() <= DENSE_BLADE {
        let all: Vec<usize> = (0..free.len()).collect();
        let (values, modes) = hermitian_pencil(
            &held.block(&all, &all).real(),
            &mass.block(&all, &all).real(),
        )
        .map_err(indefinite)?;
        (
            values[..count].to_vec(),
            modes.column_range(0, count).to_complex(),
        )
    } else {
        let factor = held.factor().map_err(indefinite)?;
        lowest_modes(&factor, &mass, 0.0, count).map_err(indefinite)?
    };
    let participation = bases
        .iter()
        .map(|basis| {
            let force = blade.times(basis).select_rows(&free);
            let mut share = modes.adjoint_times(&force);
            for column in 0..share.columns() {
                for (entry, eigenvalue) in share.column_mut(column).iter_mut().zip(&eigenvalues) {
                    *entry /= *eigenvalue;
                }
            }
            share
        })
        .collect();
    Ok(CantileverModes {
        eigenvalues,
        participation,
    })
}
