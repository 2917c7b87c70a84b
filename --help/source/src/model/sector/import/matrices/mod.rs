//! Stiffness and mass as other codes write them, each row with its node and direction.

mod calculix;
mod dmig;
mod dof_table;
mod harwell_boeing;
mod op4;
mod read;
mod symmetric;

pub(super) use read::{MatrixFiles, MatrixFormat, read, read_stiffness};

use crate::linalg::SymmetricSparse;

/// Node and Cartesian direction (0, 1, 2) of each row of a matrix.
pub(super) type Rows = Vec<(usize, usize)>;

/// Entries `(row, column, value)` of a matrix, from 0.
pub(super) type Triplets = Vec<(usize, usize, f64)>;

/// Stiffness and mass with their rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Matrices {
    pub rows: Rows,
    pub stiffness: SymmetricSparse,
    pub mass: SymmetricSparse,
}
