//! Linear algebra of the project: a thin, named layer over faer, the only place that names it, and loops that faer has
//! no fast form of.

mod dense;
mod exponential;
mod krylov;
mod lu;
mod matrix;
mod sparse;
mod symmetric_sparse;
mod vector_sums;
mod vectors;

pub use dense::{
    NotPositiveDefinite, OrthonormalBasis, eigenvalues, hermitian_eigen, hermitian_pencil,
    orthonormal_basis,
};
pub use exponential::exponential;
pub use krylov::{Minimised, gmres};
pub use lu::LuWorkspace;
pub use matrix::{
    Matrix, Scalar, add_times, add_times_vector, add_transpose_times, add_transpose_times_vector,
    dot, set_times,
};
pub use rustfft::num_complex::Complex64;
pub use sparse::{HermitianSparse, SparseFactor, lowest_modes};
pub use symmetric_sparse::SymmetricSparse;
pub(crate) use vector_sums::{Columns, Dots, Orthogonalised, Subtracted};
pub use vectors::{Loops, vectorized};
