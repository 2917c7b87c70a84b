//! Every key of a study file, declared once: how it is read and written, what it accepts, and what `blisk explain`, the JSON Schema and
//! docs/study-file.md say of it.

pub(super) mod contact;
mod digest;
pub(super) mod excitation;
mod key;
pub(super) mod mistuning;
mod model;
mod model_options;
mod options_table;
mod ranges;
mod reduction;
mod schema;
pub(super) mod solver;
pub(super) mod structure;
pub(super) mod study_file;
pub(super) mod written;

pub use crate::input::{KeySpec, Range, Value};
pub use digest::StudyDigest;
pub(super) use key::study_key;
pub use key::{keys, keys_about, keys_below, nearest_keys};
pub(super) use model::{BundleTable, ModelKind, ModelTable};
pub(super) use options_table::OptionsTable;
pub(super) use reduction::ReductionTable;
pub use schema::study_schema;
