//! Where a wrong key or value of an import file is refused: unknown and missing keys, types and ranges, all at once.

use toml::{Table, Value as Written};

use super::finding::{Finding, Problem};
use super::source_map::{SourceMap, nearest};
use super::{KeySpec, Value};

/// Everything in `table` that `keys` do not accept, in the order of the file.
pub(crate) fn check(map: &SourceMap, table: &Table, keys: &[KeySpec]) -> Vec<Finding> {
    let mut check = Check {
        map,
        keys,
        findings: Vec::new(),
    };
    check.table("", "", table);
    check.findings.sort_by_key(|finding| finding.line);
    check.findings
}

struct Check<'a> {
    map: &'a SourceMap,
    keys: &'a [KeySpec],
    findings: Vec<Finding>,
}

/// Table and name of a key.
fn split(key: &str) -> (&str, &str) {
    key.rsplit_once('.').unwrap_or(("", key))
}

fn join(table: &str, name: &str) -> String {
    if table.is_empty() {
        name.to_owned()
    } else {
        format!("{table}.{name}")
    }
}

impl<'a> Check<'a> {
    /// The keys right below a table.
    fn children(&self, table: &str) -> Vec<&'a KeySpec> {
        let below = |key: &&KeySpec| split(&key.key).0 == table;
        self.keys.iter().filter(below).collect()
    }

    fn add(&mut self, key: &str, problem: Problem) {
        self.findings.push(self.map.finding(key, problem));
    }

    /// A table: `place` is where it stands, `name` its key (`force[1]` and `force`).
    fn table(&mut self, place: &str, name: &str, table: &Table) {
        let children = self.children(name);
        for (key, value) in table {
            let full_place = join(place, key);
            let full = join(name, key);
            if let Some(child) = children.iter().find(|child| child.key == full) {
                self.value(&full_place, child, value);
                continue;
            }
            let accepted: Vec<String> = children
                .iter()
                .map(|child| split(&child.key).1.to_owned())
                .collect();
            let problem = Problem::UnknownKey {
                suggestion: nearest(key, &accepted),
                accepted,
            };
            self.add(&full_place, problem);
        }
        for child in children {
            let key = split(&child.key).1;
            if child.required && !table.contains_key(key) {
                let accepted = accepted(child);
                self.add(&join(place, key), Problem::Missing { accepted });
            }
        }
    }

    fn value(&mut self, place: &str, key: &KeySpec, written: &Written) {
        match (key.value, written) {
            (Value::Table | Value::TableOrTables, Written::Table(table)) => {
                self.table(place, &key.key, table);
            }
            (Value::Tables | Value::TableOrTables, Written::Array(tables)) if is_tables(tables) => {
                for (index, table) in tables.iter().enumerate() {
                    if let Written::Table(table) = table {
                        self.table(&format!("{place}[{index}]"), &key.key, table);
                    }
                }
            }
            (value, written) if holds(value, written) => {}
            (value, written) => {
                let suggestion = match (value, written) {
                    (Value::Name(names), Written::String(text)) => {
                        let names: Vec<String> =
                            names.iter().map(|&name| name.to_owned()).collect();
                        nearest(text, &names).map(|name| format!("\"{name}\""))
                    }
                    _ => None,
                };
                let problem = Problem::NotAccepted {
                    value: self.map.value(place),
                    accepted: accepted(key),
                    suggestion,
                };
                self.add(place, problem);
            }
        }
    }
}

/// What a key accepts, without the marks of Markdown.
fn accepted(key: &KeySpec) -> String {
    match key.value {
        Value::Tables => format!("one or more tables [[{}]]", key.key),
        Value::TableOrTables => {
            format!("a table [{0}], or one or more tables [[{0}]]", key.key)
        }
        value => value.to_string().replace('`', ""),
    }
}

fn is_tables(values: &[Written]) -> bool {
    !values.is_empty() && values.iter().all(Written::is_table)
}

/// Whether a value that is no table is what its key accepts.
fn holds(value: Value, written: &Written) -> bool {
    match value {
        Value::Table | Value::Tables | Value::TableOrTables => false,
        Value::Number(range) => number(written).is_some_and(|number| range.holds(number)),
        Value::Whole(low, high) => written
            .as_integer()
            .is_some_and(|number| (low..=high).contains(&number)),
        Value::Text(_) => written.as_str().is_some_and(|text| !text.is_empty()),
        Value::Flag => written.is_bool(),
        Value::Name(names) => written.as_str().is_some_and(|text| names.contains(&text)),
        Value::Vector(count) => written.as_array().is_some_and(|values| {
            values.len() as u64 == count && values.iter().all(|value| number(value).is_some())
        }),
        Value::Numbers(range) => written.as_array().is_some_and(|values| {
            let accepted = |value| number(value).is_some_and(|number| range.holds(number));
            !values.is_empty() && values.iter().all(accepted)
        }),
        Value::List(value) | Value::Ascending(value, _) => written
            .as_array()
            .is_some_and(|values| values.iter().all(|written| holds(*value, written))),
        Value::Pairs(..) => written.is_array(),
        Value::Either(values) => values.iter().any(|&value| holds(value, written)),
    }
}

/// A finite number.
fn number(written: &Written) -> Option<f64> {
    let number = match written {
        Written::Integer(number) => Some(*number as f64),
        Written::Float(number) => Some(*number),
        _ => None,
    };
    number.filter(|number| number.is_finite())
}
