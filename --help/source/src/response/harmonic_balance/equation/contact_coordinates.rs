//! Modal coordinates of a wheel turned so that its contact rows move with the last of them alone.
//!
//! With `C^T = Q R` and the columns of Q in the opposite order, `C Q = [0 L]`: row i of C moves with the last i + 1
//! coordinates, and contact springs couple no more than the last m.

use crate::linalg::{BlockVector, Matrix, RowBlocks, householder_qr};

/// A structure in these coordinates.
#[derive(Debug)]
pub(in crate::response::harmonic_balance) struct ContactCoordinates {
    /// Q and its transpose.
    turn: RowBlocks,
    turn_back: RowBlocks,
    /// `C Q`.
    rows: Matrix<f64>,
    /// `Q^T diag(lambda) Q`, and the viscous damping, 1/s.
    stiffness: RowBlocks,
    viscous: Option<RowBlocks>,
    loss_factor: f64,
}

impl ContactCoordinates {
    /// Of contact rows, eigenvalues, the structural loss factor and the viscous damping, which `viscous` multiplies a matrix by.
    pub(super) fn new(
        contact: &Matrix<f64>,
        eigenvalues: &[f64],
        loss_factor: f64,
        viscous: Option<impl FnOnce(&Matrix<f64>) -> Matrix<f64>>,
    ) -> Self {
        let (orthogonal, upper) = householder_qr(&contact.adjoint());
        let n = eigenvalues.len();
        let turn = Matrix::from_fn(n, n, |i, j| orthogonal[(i, n - 1 - j)]);
        let scaled = Matrix::from_fn(n, n, |i, j| eigenvalues[i] * turn[(i, j)]);
        Self {
            rows: Matrix::from_fn(contact.rows(), n, |i, j| upper[(n - 1 - j, i)]),
            stiffness: RowBlocks::of(&turn.adjoint_times(&scaled)),
            viscous: viscous.map(|times| RowBlocks::of(&turn.adjoint_times(&times(&turn)))),
            loss_factor,
            turn_back: RowBlocks::of(&turn.adjoint()),
            turn: RowBlocks::of(&turn),
        }
    }

    /// `C Q`.
    pub(in crate::response::harmonic_balance) fn rows(&self) -> &Matrix<f64> {
        &self.rows
    }

    /// `Q^T (diag(lambda) + C^T k C) Q` for the springs k of the contact rows, N/m.
    pub(in crate::response::harmonic_balance) fn stuck(&self, springs: &[f64]) -> RowBlocks {
        let rows = &self.rows;
        let first = rows.columns().saturating_sub(rows.rows());
        let moving = rows.column_range(first, rows.columns());
        let scaled = Matrix::from_fn(moving.rows(), moving.columns(), |i, j| {
            springs[i] * moving[(i, j)]
        });
        let springs = moving.adjoint_times(&scaled);
        let mut stuck = self.stiffness.clone();
        for j in first..rows.columns() {
            for i in first..rows.columns() {
                stuck.add(i, j, springs[(i - first, j - first)]);
            }
        }
        stuck
    }

    /// Real matrices whose sum `D(omega)` is, and their factors.
    pub(in crate::response::harmonic_balance) fn damping(
        &self,
        omega: f64,
    ) -> Vec<(f64, &RowBlocks)> {
        let viscous = self.viscous.iter().map(|viscous| (omega, viscous));
        let structural = (self.loss_factor != 0.0).then_some((self.loss_factor, &self.stiffness));
        viscous.chain(structural).collect()
    }

    /// Modal amplitudes from coordinates.
    pub(in crate::response::harmonic_balance) fn modes_of(
        &self,
        coordinates: &BlockVector,
    ) -> BlockVector {
        self.turn.times(coordinates)
    }

    /// Coordinates from modal amplitudes.
    pub(in crate::response::harmonic_balance) fn turned(&self, modes: &BlockVector) -> BlockVector {
        self.turn_back.times(modes)
    }
}
