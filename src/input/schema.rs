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
        let (table, name) = place(&mut schema, &key.key);
        add(table, name, key);
    }
    // What has all its keys by now is also what a list is made of.
    for key in keys.iter().filter(|key| key.value == Value::TableOrTables) {
        let (table, name) = place(&mut schema, &key.key);
        let property = &mut table["properties"][name];
        let one = property.take();
        *property = json!({
            "description": one["description"],
            "anyOf": [one, { "type": "array", "items": one, "minItems": 1 }],
        });
    }
    schema
}

/// The schema of the table that a key is in, and the key's own name.
fn place<'a, 'b>(schema: &'a mut Json, key: &'b str) -> (&'a mut Json, &'b str) {
    let (tables, name) = key.rsplit_once('.').unwrap_or(("", key));
    let mut table = schema;
    for step in tables.split('.').filter(|step| !step.is_empty()) {
        table = &mut table["properties"][step];
        if table["items"].is_object() {
            table = &mut table["items"];
        }
    }
    (table, name)
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
