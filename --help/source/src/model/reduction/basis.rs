//! Basis of one nodal diameter: stick and slide modes, or stick modes and attachment vectors.

use super::craig_bampton::{CraigBampton, pencil};
use crate::linalg::{Complex64, Matrix, OrthonormalBasis, orthonormal_basis};
use crate::model::reduced_model::{BasisChoice, ContactSprings};
use crate::model::sector::{ModelError, StiffnessKind};

/// Singular values below this share of the largest are dropped.
const DROP_BELOW: f64 = 1e-8;
/// M-orthonormal basis over the columns of a Craig-Bampton model.
///
/// # Errors
/// If a mass or the stuck stiffness is not positive definite.
pub fn basis_of(
    model: &CraigBampton,
    springs: &ContactSprings,
    choice: BasisChoice,
) -> Result<OrthonormalBasis<Complex64>, ModelError> {
    let h = model.nodal_diameter;
    let span = match choice {
        _ if model.whole_space => Matrix::identity(model.size()),
        BasisChoice::CraigBampton => Matrix::identity(model.size()),
        BasisChoice::StickSlide { stick, slide } => {
            let stick_modes = first(&model.modes(&springs.stick)?.1, stick);
            let slide_modes = first(&model.modes(&springs.slide)?.1, slide);
            stick_modes.beside(&slide_modes)
        }
        BasisChoice::StickAttachment { stick } => {
            let stick_modes = first(&model.modes(&springs.stick)?.1, stick);
            stick_modes.beside(&attachment_vectors(model, springs)?)
        }
    };
    let span = if span.columns() == model.size() {
        span
    } else {
        span.beside(&model.enrichment)
    };
    let real = |a: &Matrix<Complex64>| a.as_slice().iter().all(|x| x.im == 0.0);
    let basis = if real(&span) && real(&model.mass) {
        orthonormal_basis(&span.real(), &model.mass.real(), DROP_BELOW).map(|basis| {
            OrthonormalBasis {
                vectors: basis.vectors.to_complex(),
                singular_values: basis.singular_values,
            }
        })
    } else {
        orthonormal_basis(&span, &model.mass, DROP_BELOW)
    };
    basis.map_err(|_| ModelError::MassNotPositiveDefinite { nodal_diameter: h })
}

/// `K_stick^-1 C^T`: static response of the stuck structure to a unit force at each contact row.
fn attachment_vectors(
    model: &CraigBampton,
    springs: &ContactSprings,
) -> Result<Matrix<Complex64>, ModelError> {
    let h = model.nodal_diameter;
    let (eigenvalues, modes) = pencil(
        &model.stiffness_with_contact(&springs.stick),
        &model.mass,
        h,
    )?;
    if eigenvalues.first().is_some_and(|&lowest| lowest <= 0.0) {
        return Err(ModelError::StiffnessNotPositiveDefinite {
            nodal_diameter: h,
            what: StiffnessKind::Stick,
        });
    }
    // K^-1 = Phi Lambda^-1 Phi^H over all modes of the model.
    let mut participation = modes.adjoint_times(&model.contact.adjoint());
    for column in 0..participation.columns() {
        for (entry, eigenvalue) in participation
            .column_mut(column)
            .iter_mut()
            .zip(&eigenvalues)
        {
            *entry /= *eigenvalue;
        }
    }
    Ok(modes.times(&participation))
}

fn first(modes: &Matrix<Complex64>, count: usize) -> Matrix<Complex64> {
    modes.column_range(0, count.min(modes.columns()))
}
