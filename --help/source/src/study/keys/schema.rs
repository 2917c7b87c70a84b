//! The JSON Schema of study files, for completion and checks in editors.

use serde_json::{Value as Json, json};

use super::keys;
use crate::input::schema_of;

/// JSON Schema (draft 7) of study files. It knows names, types, ranges and what must be there; what keys have to
/// do with each other is said by `blisk check`.
#[must_use]
pub fn study_schema() -> Json {
    let mut schema = schema_of("Study file of blisk", &keys());
    // Exactly one model of damping.
    schema["properties"]["damping"]["minProperties"] = json!(1);
    schema["properties"]["damping"]["maxProperties"] = json!(1);
    schema
}
