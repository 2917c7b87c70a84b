//! Basis of one nodal diameter: stick, slide and partial modes, or stick modes and attachment vectors.

use super::craig_bampton::{CraigBampton, pencil};
use crate::linalg::{Complex64, Matrix, OrthonormalBasis, orthonormal_basis};
use crate::model::reduced_model::{BasisChoice, ContactSprings};
use crate::model::sector::{ModelError, StiffnessKind};

/// Singular values below this share of the largest are dropped.
const DROP_BELOW: f64 = 1e-8;
/// Where the partial modes lie: share of the way from sliding to sticking of the lowest eigenvalue.
const PARTIAL_LEVELS: [f64; 2] = [1.0 / 3.0, 2.0 / 3.0];
/// Decades of contact stiffness below that of sticking in which a level is sought, and halvings of them: to 8 %.
const LEVEL_DECADES: f64 = 9.0;
const LEVEL_HALVINGS: usize = 8;

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
        BasisChoice::StickPartialSlide {
            stick,
            partial,
            slide,
        } => {
            let (stuck_values, stuck) = model.modes(&springs.stick)?;
            let (sliding_values, sliding) = model.modes(&springs.slide)?;
            let mut span = first(&stuck, stick).beside(&first(&sliding, slide));
            for level in PARTIAL_LEVELS {
                let ends = [&sliding_values, &stuck_values].map(|values| values[0]);
                let modes = partial_modes(model, springs, ends, level)?;
                span = span.beside(&first(&modes, partial));
            }
            span
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

/// Modes under the tangential contact stiffness at which the lowest eigenvalue has gone the share `level` of the
/// way between its `ends`, that of sliding and that of sticking.
///
/// A ring that slips moves as if it were held by springs softer than those of sticking; the shapes in between
/// span what the two extremes do not.
fn partial_modes(
    model: &CraigBampton,
    springs: &ContactSprings,
    ends: [f64; 2],
    level: f64,
) -> Result<Matrix<Complex64>, ModelError> {
    let softened = |decades: f64| {
        let share = 10.0_f64.powf(decades);
        let ends = springs.slide.iter().zip(&springs.stick);
        let between: Vec<f64> = ends
            .map(|(slide, stick)| slide + share * (stick - slide))
            .collect();
        model.modes(&between)
    };
    let wanted = ends[0] + level * (ends[1] - ends[0]);
    let (mut soft, mut stiff) = (-LEVEL_DECADES, 0.0);
    for _ in 0..LEVEL_HALVINGS {
        let middle = 0.5 * (soft + stiff);
        if softened(middle)?.0[0] < wanted {
            soft = middle;
        } else {
            stiff = middle;
        }
    }
    Ok(softened(stiff)?.1)
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
