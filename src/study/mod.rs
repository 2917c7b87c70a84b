//! The study file: as written, checked, resolved; and the pipeline that turns it into tables.

mod digest;
mod error;
mod mistuning;
mod raw;
mod resolved;
mod source_map;
mod validate;
mod validate_mistuning;

pub use digest::{StudyDigest, digest_file};
pub use error::{Finding, Problem, StudyError};
pub use mistuning::{Mistuning, MistuningSource};
pub use resolved::{ModelSource, OutputOptions, Study};
