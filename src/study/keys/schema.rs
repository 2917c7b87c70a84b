//! The JSON Schema of study files, for completion and checks in editors.

use serde_json::{Value as Json, json};

use super::{KeySpec, Value, keys};

/// Dialect; editors of TOML know this one.
const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

/// JSON Schema (draft 7) of study files. It knows names, types, ranges and what must be there; what keys have to
/// do with each other is said by `blisk check`.
#[must_use]
pub fn study_schema() -> Json {
    let mut schema = json!({
        "$schema": DIALECT,
        "title": "Study file of blisk",
        "type": "object",
        "additionalProperties": false,
    });
    for key in keys() {
        let path: Vec<&str> = key.key.split('.').collect();
        if let Some((name, tables)) = path.split_last() {
            let mut table = &mut schema;
            for step in tables {
                table = &mut table["properties"][*step];
                if table["items"].is_object() {
                    table = &mut table["items"];
                }
            }
            add(table, name, &key);
        }
    }
    // Exactly one model of damping.
    schema["properties"]["damping"]["minProperties"] = json!(1);
    schema["properties"]["damping"]["maxProperties"] = json!(1);
    schema
}

fn add(table: &mut Json, name: &str, key: &KeySpec) {
    let mut schema = key.value.schema();
    schema["description"] = json!(described(key));
    table["properties"][name] = schema;
    if key.required {
        match table["required"].as_array_mut() {
            Some(required) => required.push(json!(name)),
            None => table["required"] = json!([name]),
        }
    }
}

fn described(key: &KeySpec) -> String {
    match (key.value, key.meaning) {
        (Value::Table, meaning) => meaning.to_owned(),
        (_, "") => format!("Default: {}.", key.default),
        (_, meaning) => format!("{meaning}. Default: {}.", key.default),
    }
}
