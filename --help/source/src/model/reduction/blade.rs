//! The blade's stiffness in reduced coordinates: exact projection and cantilever participation.

use crate::linalg::{Complex64, Matrix, hermitian_pencil, lowest_modes};
use crate::model::cyclic::CyclicSector;
use crate::model::reduced_model::CantileverModes;
use crate::model::sector::ModelError;

/// At most so many free blade dofs, the cantilever modes are found by a dense solution.
const DENSE_BLADE: usize = 60;

/// Gram matrix `W^T K_blade W` of the blade rows `W = [Re B_0, Im B_0, Re B_1, Im B_1, ...]`,
/// real symmetric, `2 sum n_modes` square: every block `B_h^H K_blade B_h'` follows from it.
#[must_use]
pub fn blade_gram(sector: &CyclicSector<'_>, bases: &[Matrix<Complex64>]) -> Matrix<f64> {
    let dofs = sector.blade_dofs();
    let blade = sector.blade_stiffness();
    let mut rows = Matrix::zeros(dofs.len(), 0);
    for basis in bases {
        let part = basis.select_rows(&dofs);
        rows = rows.beside(&part.real()).beside(&part.imaginary());
    }
    let local = blade.principal(&dofs);
    let loaded = local.times(&rows.to_complex()).real();
    let mut gram = rows.adjoint_times(&loaded);
    for i in 0..gram.rows() {
        for j in 0..i {
            let mean = 0.5 * (gram[(i, j)] + gram[(j, i)]);
            gram[(i, j)] = mean;
            gram[(j, i)] = mean;
        }
    }
    gram
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
