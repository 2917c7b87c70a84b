//! Linear algebra of the project: a thin, named layer over faer, the only place that names it.

mod symmetric_sparse;

pub use rustfft::num_complex::Complex64;
pub use symmetric_sparse::SymmetricSparse;
