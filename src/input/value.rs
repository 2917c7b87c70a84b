//! What a key accepts.

use std::fmt;

use serde_json::{Value as Json, json};

/// Ends of a range of numbers; an end is included if its flag says so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower end, and whether it is included.
    pub low: Option<(f64, bool)>,
    /// Upper end, and whether it is included.
    pub high: Option<(f64, bool)>,
}

impl Range {
    /// Any finite number.
    pub const ANY: Self = Self {
        low: None,
        high: None,
    };

    /// Above `low`.
    #[must_use]
    pub const fn above(low: f64) -> Self {
        Self {
            low: Some((low, false)),
            high: None,
        }
    }

    /// At least `low`.
    #[must_use]
    pub const fn at_least(low: f64) -> Self {
        Self {
            low: Some((low, true)),
            high: None,
        }
    }

    /// From `low` to `high`, both included.
    #[must_use]
    pub const fn from_to(low: f64, high: f64) -> Self {
        Self {
            low: Some((low, true)),
            high: Some((high, true)),
        }
    }

    /// At most `high`.
    #[must_use]
    pub const fn up_to(self, high: f64) -> Self {
        Self {
            high: Some((high, true)),
            ..self
        }
    }

    /// Whether it holds a number.
    #[must_use]
    pub fn holds(&self, number: f64) -> bool {
        let above = |(low, included): (f64, bool)| number > low || included && number >= low;
        let below = |(high, included): (f64, bool)| number < high || included && number <= high;
        number.is_finite() && self.low.is_none_or(above) && self.high.is_none_or(below)
    }

    /// Below `high`.
    #[must_use]
    pub const fn below(self, high: f64) -> Self {
        Self {
            high: Some((high, false)),
            ..self
        }
    }
}

/// What a key accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A table with keys of its own.
    Table,
    /// One or more tables with the same keys, each `[[key]]`.
    Tables,
    /// A table `[key]`, or one or more `[[key]]` with the same keys.
    TableOrTables,
    /// A finite number.
    Number(Range),
    /// A whole number from the first to the second.
    Whole(i64, i64),
    /// A text, and what it must be.
    Text(&'static str),
    /// `true` or `false`.
    Flag,
    /// One of these names.
    Name(&'static [&'static str]),
    /// A list of different values, at least one.
    List(&'static Value),
    /// A list of numbers of which some may be the same.
    Numbers(Range),
    /// This many finite numbers.
    Vector(u64),
    /// An ascending list of this many values, or of any number from one.
    Ascending(&'static Value, Option<u64>),
    /// A list of lists of two: these names, the first a whole number from the two, the second a number.
    Pairs([&'static str; 2], [i64; 2], Range),
    /// Any of these.
    Either(&'static [Value]),
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.low, self.high) {
            (None, None) => write!(f, "any finite number"),
            (Some((low, true)), None) => write!(f, "at least {low}"),
            (Some((low, false)), None) => write!(f, "above {low}"),
            (None, Some((high, true))) => write!(f, "up to {high}"),
            (None, Some((high, false))) => write!(f, "below {high}"),
            (Some((low, true)), Some((high, true))) => write!(f, "{} to {}", said(low), said(high)),
            (Some((low, from)), Some((high, to))) => {
                let from = if from { "at least" } else { "above" };
                let to = if to { "at most" } else { "below" };
                write!(f, "{from} {}, {to} {}", said(low), said(high))
            }
        }
    }
}

/// Small numbers as powers of ten.
fn said(number: f64) -> String {
    if number != 0.0 && !(1e-3..1e15).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        number.to_string()
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table => write!(f, "a table"),
            Self::Tables => write!(f, "one or more tables"),
            Self::TableOrTables => write!(f, "a table, or one or more tables"),
            Self::Number(range) => write!(f, "{range}"),
            Self::Whole(low, high) => write!(f, "whole number, {low} to {high}"),
            Self::Text(what) => write!(f, "{what}"),
            Self::Flag => write!(f, "`true`, `false`"),
            Self::Name(names) => {
                let names: Vec<String> = names.iter().map(|name| format!("`\"{name}\"`")).collect();
                write!(f, "{}", names.join(", "))
            }
            Self::List(value) => write!(f, "list of different values: {value}"),
            Self::Numbers(range) => write!(f, "list: {range}"),
            Self::Vector(count) => write!(f, "{count} numbers"),
            Self::Ascending(value, None) => write!(f, "ascending list: {value}"),
            Self::Ascending(value, Some(count)) => write!(f, "{count} ascending values: {value}"),
            Self::Pairs([first, second], [low, high], range) => write!(
                f,
                "list of `[{first}, {second}]`: whole number, {low} to {high}; {range}"
            ),
            Self::Either(values) => {
                let values: Vec<String> = values.iter().map(ToString::to_string).collect();
                write!(f, "{}", values.join("; or "))
            }
        }
    }
}

impl Value {
    /// What is accepted, as a message about a refused value says it.
    #[must_use]
    pub(crate) fn in_words(&self) -> String {
        match self {
            Self::Number(Range {
                low: Some((low, from)),
                high: Some((high, to)),
            }) => {
                let (low, high) = (said(*low), said(*high));
                match (from, to) {
                    (true, true) => format!("a number from {low} to {high}"),
                    (true, false) => format!("a number of at least {low} and below {high}"),
                    (false, true) => format!("a number above {low} and at most {high}"),
                    (false, false) => format!("a number above {low} and below {high}"),
                }
            }
            Self::Number(
                range @ Range {
                    low: Some((_, false)),
                    high: None,
                },
            ) => {
                format!("a finite number {range}")
            }
            Self::Number(range) => format!("a finite number of {range}"),
            Self::Whole(low, high) => format!("a whole number from {low} to {high}"),
            Self::Name(names) => {
                let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
                match names.as_slice() {
                    [before @ .., last] if !before.is_empty() => {
                        format!("{} or {last}", before.join(", "))
                    }
                    names => names.concat(),
                }
            }
            other => other.to_string().replace('`', ""),
        }
    }

    /// Whether it accepts a number.
    pub(crate) fn holds(&self, number: f64) -> bool {
        match self {
            Self::Number(range) => range.holds(number),
            Self::Whole(low, high) => (*low as f64..=*high as f64).contains(&number),
            _ => true,
        }
    }

    /// The value in JSON Schema.
    #[must_use]
    pub fn schema(&self) -> Json {
        match self {
            // A list of tables is made of the one, once it has its keys.
            Self::Table | Self::TableOrTables => {
                json!({ "type": "object", "additionalProperties": false })
            }
            Self::Tables => json!({
                "type": "array", "items": Self::Table.schema(), "minItems": 1,
            }),
            Self::Number(range) => {
                let mut schema = json!({ "type": "number" });
                let ends = [
                    (range.low, ["minimum", "exclusiveMinimum"]),
                    (range.high, ["maximum", "exclusiveMaximum"]),
                ];
                for (end, [included, excluded]) in ends {
                    if let Some((value, is_included)) = end {
                        schema[if is_included { included } else { excluded }] = json!(value);
                    }
                }
                schema
            }
            Self::Whole(low, high) => {
                json!({ "type": "integer", "minimum": low, "maximum": high })
            }
            Self::Text(_) => json!({ "type": "string" }),
            Self::Flag => json!({ "type": "boolean" }),
            Self::Name(names) => json!({ "enum": names }),
            Self::List(value) => json!({
                "type": "array", "items": value.schema(), "minItems": 1, "uniqueItems": true,
            }),
            Self::Numbers(range) => json!({
                "type": "array", "items": Self::Number(*range).schema(), "minItems": 1,
            }),
            Self::Vector(count) => json!({
                "type": "array", "items": Self::Number(Range::ANY).schema(),
                "minItems": count, "maxItems": count,
            }),
            Self::Ascending(value, count) => {
                let mut schema = json!({
                    "type": "array", "items": value.schema(), "minItems": count.unwrap_or(1),
                    "uniqueItems": true,
                });
                if let Some(count) = count {
                    schema["maxItems"] = json!(count);
                }
                schema
            }
            // Draft 7 has no short way to say what each of the two is.
            Self::Pairs(..) => json!({
                "type": "array", "minItems": 1, "uniqueItems": true,
                "items": {
                    "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
                },
            }),
            Self::Either(values) => {
                let values: Vec<Json> = values.iter().map(Self::schema).collect();
                json!({ "anyOf": values })
            }
        }
    }
}
