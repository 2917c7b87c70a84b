//! Craig-Bampton reduction, stick and slide basis, component mode mistuning, a-posteriori error.

mod options;

pub use options::{Basis, ReductionOptions};
