//! Contact-free modes of a mistuned wheel, and of one travelling wave of a tuned wheel.

use super::wheel_basis::WheelBasis;
use crate::linalg::{Complex64, Matrix, hermitian_eigen};
use crate::model::{ReducedModel, cyclic::NodalDiameter};

/// Real or complex rows over modes.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalRows {
    /// Real part, `n_rows x n_modes`.
    pub real: Matrix<f64>,
    /// Imaginary part, of the same shape; none where the rows are real.
    pub imaginary: Option<Matrix<f64>>,
}

impl ModalRows {
    fn from_complex(rows: &Matrix<Complex64>) -> Self {
        Self {
            real: rows.real(),
            imaginary: Some(rows.imaginary()),
        }
    }
}

/// Structure-only modes: `M = I`, `K = diag(eigenvalues)`, with what they move.
///
/// A mistuned wheel has real rows over all sectors; a travelling wave of the tuned wheel has
/// complex rows of one sector, which stands for all.
#[derive(Debug, Clone)]
pub struct StructuralModes {
    /// Eigenvalues, (rad/s)^2, mistuning included.
    pub eigenvalues: Vec<f64>,
    /// Eigenvalues of the tuned wheel in the tuned coordinates, (rad/s)^2.
    pub tuned_eigenvalues: Vec<f64>,
    /// Damping of the tuned coordinates besides the damping model of the structure, 1/s.
    pub added_damping_per_s: Vec<f64>,
    /// Tuned coordinates of each mode, orthonormal columns; none where they are the same.
    pub rotation: Option<Matrix<f64>>,
    /// Relative motion at the contact rows, sector after sector.
    pub contact: ModalRows,
    /// Displacement r, theta, z of the observed node, blade after blade.
    pub observed: ModalRows,
    /// Number of sectors the rows stand for: N for a wheel, 1 for a wave.
    pub sectors: usize,
}

impl StructuralModes {
    /// Modes of the wheel whose stiffness is changed by `change`, `size x size`; none if a value
    /// is not finite or the stiffness is no longer positive definite where it was.
    #[must_use]
    pub fn of_wheel(basis: &WheelBasis, change: &Matrix<f64>) -> Option<Self> {
        let mut stiffness = change.clone();
        for (i, &eigenvalue) in basis.eigenvalues().iter().enumerate() {
            stiffness[(i, i)] += eigenvalue;
        }
        let (eigenvalues, rotation) = hermitian_eigen(&stiffness).ok()?;
        let rows = |rows: &Matrix<f64>| ModalRows {
            real: rows.times(&rotation),
            imaginary: None,
        };
        Some(Self {
            contact: rows(basis.contact()),
            observed: rows(basis.observed()),
            eigenvalues,
            tuned_eigenvalues: basis.eigenvalues().to_vec(),
            added_damping_per_s: basis.added_damping_per_s().to_vec(),
            rotation: Some(rotation),
            sectors: basis.model().sectors,
        })
    }

    /// Modes of the wheel, its stiffness changed by `change`, held to the motions `shapes`
    /// (orthonormal columns, in its coordinates): the Rayleigh-Ritz modes of that space.
    #[must_use]
    pub fn of_subspace(
        basis: &WheelBasis,
        change: &Matrix<f64>,
        shapes: &Matrix<f64>,
    ) -> Option<Self> {
        let scaled = Matrix::from_fn(shapes.rows(), shapes.columns(), |i, j| {
            basis.eigenvalues()[i] * shapes[(i, j)]
        });
        let mut stiffness = shapes.adjoint_times(&change.times(shapes));
        let tuned = shapes.adjoint_times(&scaled);
        for (sum, &part) in stiffness.as_mut_slice().iter_mut().zip(tuned.as_slice()) {
            *sum += part;
        }
        let (eigenvalues, rotation) = hermitian_eigen(&stiffness).ok()?;
        let shapes = shapes.times(&rotation);
        let rows = |rows: &Matrix<f64>| ModalRows {
            real: rows.times(&shapes),
            imaginary: None,
        };
        Some(Self {
            contact: rows(basis.contact()),
            observed: rows(basis.observed()),
            eigenvalues,
            tuned_eigenvalues: basis.eigenvalues().to_vec(),
            added_damping_per_s: basis.added_damping_per_s().to_vec(),
            sectors: basis.model().sectors,
            rotation: Some(shapes),
        })
    }

    /// The travelling wave of a nodal diameter of the tuned wheel, one sector.
    #[must_use]
    pub fn of_wave(model: &ReducedModel, nodal_diameter: NodalDiameter) -> Self {
        let wave = model.wave(nodal_diameter);
        Self {
            eigenvalues: wave.eigenvalues.clone(),
            tuned_eigenvalues: wave.eigenvalues,
            added_damping_per_s: wave.added_damping_per_s,
            rotation: None,
            contact: ModalRows::from_complex(&wave.contact),
            observed: ModalRows::from_complex(&wave.observed),
            sectors: 1,
        }
    }

    /// Number of modes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.eigenvalues.len()
    }

    /// Modal force from its tuned coordinates.
    #[must_use]
    pub fn modal_force(&self, tuned: &[Complex64]) -> Vec<Complex64> {
        match &self.rotation {
            None => tuned.to_vec(),
            Some(rotation) => (0..rotation.columns())
                .map(|mode| {
                    rotation
                        .column(mode)
                        .iter()
                        .zip(tuned)
                        .map(|(&v, &f)| f * v)
                        .sum()
                })
                .collect(),
        }
    }
}
