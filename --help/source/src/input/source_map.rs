//! Where each key of a TOML file stands, so that every message can name its line.

use std::collections::BTreeMap;
use std::ops::Range;

use strsim::damerau_levenshtein;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::finding::{Excerpt, Finding, Problem};

/// Bytes of a line that are shown before and from the beginning of the part that a message is about.
const BEFORE: usize = 150;
const AFTER: usize = 250;

/// Spans of the keys and values of a TOML text, by full key.
#[derive(Debug, Clone, Default)]
pub(crate) struct SourceMap {
    text: String,
    /// Where each line begins.
    lines: Vec<usize>,
    places: BTreeMap<String, Place>,
}

#[derive(Debug, Clone)]
struct Place {
    key: Range<usize>,
    value: Range<usize>,
}

impl SourceMap {
    /// Parses `text`; a finding if it is no TOML.
    pub(crate) fn new(text: &str) -> Result<Self, Box<Finding>> {
        let mut map = Self {
            text: text.to_owned(),
            lines: std::iter::once(0)
                .chain(text.match_indices('\n').map(|(end, _)| end + 1))
                .collect(),
            places: BTreeMap::new(),
        };
        match DeTable::parse(text) {
            Ok(table) => {
                map.add_table("", table.get_ref());
                Ok(map)
            }
            Err(error) => Err(Box::new(map.describe(&error))),
        }
    }

    fn add_table(&mut self, path: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            let full = if path.is_empty() {
                key.get_ref().to_string()
            } else {
                format!("{path}.{}", key.get_ref())
            };
            self.add_value(full, key.span(), value);
        }
    }

    fn add_value(&mut self, path: String, key: Range<usize>, value: &Spanned<DeValue<'_>>) {
        match value.get_ref() {
            DeValue::Table(table) => self.add_table(&path, table),
            DeValue::Array(array) => {
                for (index, element) in array.iter().enumerate() {
                    self.add_value(format!("{path}[{index}]"), element.span(), element);
                }
            }
            _ => {}
        }
        let value = value.span();
        self.places.insert(path, Place { key, value });
    }

    /// Whether `key` is written.
    pub(crate) fn holds(&self, key: &str) -> bool {
        self.places.contains_key(key)
    }

    /// Line of `key`, or of the innermost table above it that is there; 1 if there is none.
    pub(crate) fn line(&self, key: &str) -> usize {
        let mut path = key;
        loop {
            if let Some(place) = self.places.get(path) {
                return self.line_at(place.key.start);
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => return 1,
            }
        }
    }

    /// `problem` with `key`, underlined in the file: the value where that is the matter, else the key.
    pub(crate) fn finding(&self, key: &str, problem: Problem) -> Finding {
        let of_value = matches!(problem, Problem::NotAccepted { .. });
        let part = |place: &Place| {
            if of_value {
                place.value.clone()
            } else {
                place.key.clone()
            }
        };
        Finding {
            line: self.line(key),
            key: key.to_owned(),
            problem,
            excerpt: self
                .places
                .get(key)
                .map(part)
                .and_then(|part| self.excerpt(&part)),
        }
    }

    /// The part `range` of its line, up to the end of that; none where it is empty. Of a long line what is near.
    fn excerpt(&self, range: &Range<usize>) -> Option<Excerpt> {
        let line = self.line_at(range.start);
        let start = *self.lines.get(line - 1)?;
        let end = self
            .lines
            .get(line)
            .map_or(self.text.len(), |next| next - 1);
        let start = self.boundary(start.max(range.start.saturating_sub(BEFORE)));
        let end = self.boundary(end.min(range.start + AFTER));
        let part = self.text.get(range.start..range.end.min(end))?;
        let (text, before) = (
            self.text.get(start..end)?,
            self.text.get(start..range.start)?,
        );
        // A tab is as wide as the terminal likes.
        let plain = |text: &str| text.trim_end().replace('\t', " ");
        (!part.is_empty()).then(|| Excerpt {
            text: plain(text),
            start: before.chars().count(),
            width: part.trim_end().chars().count(),
        })
    }

    /// The first end of a character from `offset` on.
    fn boundary(&self, offset: usize) -> usize {
        let mut ends = offset..=self.text.len();
        ends.find(|&end| self.text.is_char_boundary(end))
            .unwrap_or(self.text.len())
    }

    /// The value of `key` as written.
    pub(crate) fn value(&self, key: &str) -> String {
        self.places
            .get(key)
            .and_then(|place| self.text.get(place.value.clone()))
            .unwrap_or("(absent)")
            .to_owned()
    }

    fn line_at(&self, offset: usize) -> usize {
        // What is missing at the end is missing on the last line.
        let last = self.lines.len() - usize::from(self.text.ends_with('\n'));
        let line = self.lines.partition_point(|&start| start <= offset);
        line.clamp(1, last.max(1))
    }

    /// The innermost key whose name or value covers `offset`.
    fn key_at(&self, offset: usize) -> String {
        let covers = |range: &Range<usize>| range.contains(&offset);
        self.places
            .iter()
            .filter(|(_, place)| covers(&place.key) || covers(&place.value))
            .max_by_key(|(path, _)| path.len())
            .map_or_else(String::new, |(path, _)| path.clone())
    }

    /// The finding that an error of the TOML reader stands for.
    pub(crate) fn describe(&self, error: &toml::de::Error) -> Finding {
        let offset = error.span().map_or(0, |span| span.start);
        let line = self.line_at(offset);
        let key = self.key_at(offset);
        let message = error.message();
        let named = backticked(message);
        let problem = if message.starts_with("unknown field") {
            let (unknown, accepted) = split_first(named);
            Problem::UnknownKey {
                suggestion: nearest(&unknown, &accepted),
                accepted,
            }
        } else if message.starts_with("unknown variant") {
            let (unknown, accepted) = split_first(named);
            Problem::NotAccepted {
                value: self.value(&key),
                suggestion: nearest(&unknown, &accepted).map(|name| format!("\"{name}\"")),
                accepted: accepted
                    .iter()
                    .map(|name| format!("\"{name}\""))
                    .collect::<Vec<_>>()
                    .join(", "),
            }
        } else if let Some((_, expected)) = message.rsplit_once(", expected ")
            && !key.is_empty()
        {
            Problem::NotAccepted {
                value: self.value(&key),
                accepted: plain(expected),
                suggestion: None,
            }
        } else if let Some(field) = message.strip_prefix("missing field ") {
            let field = field.trim_matches('`');
            return Finding {
                line,
                key: if key.is_empty() {
                    field.to_owned()
                } else {
                    format!("{key}.{field}")
                },
                problem: Problem::Missing {
                    accepted: "a value".to_owned(),
                },
                excerpt: None,
            };
        } else {
            Problem::Syntax {
                message: message.replace('\n', " "),
            }
        };
        let excerpt = error.span().and_then(|span| self.excerpt(&span));
        Finding {
            line,
            key,
            problem,
            excerpt,
        }
    }
}

/// The names that stand between backticks.
fn backticked(message: &str) -> Vec<String> {
    message
        .split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

fn split_first(mut names: Vec<String>) -> (String, Vec<String>) {
    if names.is_empty() {
        (String::new(), names)
    } else {
        let rest = names.split_off(1);
        (names.remove(0), rest)
    }
}

/// The name nearest to `written`, if it is near enough to be meant.
pub(crate) fn nearest(written: &str, names: &[String]) -> Option<String> {
    names
        .iter()
        .map(|name| (damerau_levenshtein(written, name), name))
        .min()
        .filter(|&(distance, name)| {
            distance
                <= name
                    .chars()
                    .count()
                    .max(written.chars().count())
                    .div_ceil(3)
                || name.starts_with(written)
        })
        .map(|(_, name)| name.clone())
}

/// Names of Rust types in the words of a user.
fn plain(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "u64" | "usize" => "a whole number of at least 0".to_owned(),
        "u32" => "a whole number from 0 to 4294967295".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a boolean" => "true or false".to_owned(),
        other if other.starts_with("struct ") => "a table".to_owned(),
        other => other.to_owned(),
    }
}
