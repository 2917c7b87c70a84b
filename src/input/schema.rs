//! JSON Schema of a TOML file from its keys, for completion and checks in editors.

use serde_json::{Value as Json, json};

use super::{KeySpec, Value};

/// Dialect; editors of TOML know this one.
const DIALECT: &str = "http://json-schema.org/draft-07/schema#";

/// JSON Schema (draft 7) of a file with these keys, every table before what it holds. It knows names, types,
/// ranges and what must be there, not what keys have to do with each other.
pub(crate) fn schema_of(title: &str, keys: &[KeySpec]) -> Json {
    let mut schema = json!({
        "$schema": DIALECT,
        "title": title,
        "type": "object",
        "additionalProperties": false,
    });
    for key in keys {
        let path: Vec<&str> = key.key.split('.').collect();
        if let Some((name, tables)) = path.split_last() {
            let mut table = &mut schema;
            for step in tables {
                table = &mut table["properties"][*step];
                if table["items"].is_object() {
                    table = &mut table["items"];
                }
            }
            add(table, name, key);
        }
    }
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
