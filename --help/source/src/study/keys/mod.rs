//! Every key of a study file: what `blisk explain`, the JSON Schema and docs/study-file.md say of it.

mod contact_keys;
mod key;
mod model_keys;
mod schema;
pub(super) mod study_keys;

pub use crate::input::{KeySpec, Range, Value};
pub use key::{keys, keys_about, keys_below, nearest_keys};
pub use schema::study_schema;
pub(super) use study_keys::{EXCITATION_N, NORMAL_LOAD_N};
