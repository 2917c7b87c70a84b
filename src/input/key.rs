//! One key of a TOML file, how it is declared, and how it is found by a name that is near to it.

use strsim::damerau_levenshtein;

use super::Value;

/// What a file may say under one key.
#[derive(Debug, Clone, PartialEq)]
pub struct KeySpec {
    /// Full key, like `solver.peak_tolerance`.
    pub key: String,
    /// What it accepts.
    pub value: Value,
    /// Its default in words or as it would be written; none for a table.
    pub default: &'static str,
    /// Whether the file (or the table that it is in) must have it.
    pub required: bool,
    /// What it means, with its unit, in Markdown.
    pub meaning: &'static str,
    /// How a message names what it accepts.
    pub(crate) words: Words,
    /// What depends on it.
    pub(crate) effect: Effect,
    /// Whether the program chooses it under `[accuracy]`, unless the study states it.
    pub(crate) is_of_accuracy: bool,
    /// Whether a resolved study has it as null where it has no value, and does not leave it out.
    pub(crate) is_or_null: bool,
}

/// How a message names what a key accepts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Words {
    /// The words of the value.
    OfValue,
    /// The words of the value, and then these.
    With(&'static str),
    /// These alone.
    Instead(&'static str),
}

/// What of a study depends on a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// Every number.
    Numbers,
    /// Which scenarios there are; a row depends on those of its own alone.
    Scenarios,
    /// No number: names, places, how much is computed and written.
    None,
}

/// A key as it is declared in the table that it is in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) key: &'static str,
    pub(crate) value: Value,
    pub(crate) default: &'static str,
    pub(crate) meaning: &'static str,
    words: Words,
    below: &'static [Entry],
    effect: Effect,
    is_of_accuracy: bool,
    is_or_null: bool,
}

/// Default of a key that must be there.
pub(crate) const REQUIRED: &str = "required";

/// A key with its value, default and meaning; [`toml_table`](super::toml_table) gives it the name of its field.
pub(crate) const fn key(value: Value, default: &'static str, meaning: &'static str) -> Entry {
    Entry {
        key: "",
        value,
        default,
        meaning,
        words: Words::OfValue,
        below: &[],
        effect: Effect::Numbers,
        is_of_accuracy: false,
        is_or_null: false,
    }
}

/// A table that may be left out, with the keys `below` it.
pub(crate) const fn table(meaning: &'static str, below: &'static [Entry]) -> Entry {
    key(Value::Table, "", meaning).with(below)
}

/// A key under its name.
pub(crate) const fn entry(
    name: &'static str,
    value: Value,
    default: &'static str,
    meaning: &'static str,
) -> Entry {
    key(value, default, meaning).named(name)
}

impl Entry {
    pub(crate) const fn named(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// With the keys of the table or tables that it is.
    pub(crate) const fn with(self, below: &'static [Entry]) -> Self {
        Self { below, ..self }
    }

    /// Messages say this after what the value accepts.
    pub(crate) const fn and(self, words: &'static str) -> Self {
        let words = Words::With(words);
        Self { words, ..self }
    }

    /// Messages say this in the place of what the value accepts.
    pub(crate) const fn told(self, words: &'static str) -> Self {
        let words = Words::Instead(words);
        Self { words, ..self }
    }

    /// Neither it nor a key below it changes a number.
    pub(crate) const fn neutral(self) -> Self {
        let effect = Effect::None;
        Self { effect, ..self }
    }

    /// It, or every key below it, lists scenarios.
    pub(crate) const fn of_scenarios(self) -> Self {
        let effect = Effect::Scenarios;
        Self { effect, ..self }
    }

    /// The program chooses it under `[accuracy]`.
    pub(crate) const fn of_accuracy(self) -> Self {
        let is_of_accuracy = true;
        Self {
            is_of_accuracy,
            ..self
        }
    }

    /// Null in a resolved study where it has no value.
    pub(crate) const fn or_null(self) -> Self {
        let is_or_null = true;
        Self { is_or_null, ..self }
    }

    /// Adds itself, its name after `table`, and all keys below it.
    fn add_to(&self, table: &str, effect: Effect, keys: &mut Vec<KeySpec>) {
        let key = if table.is_empty() {
            self.key.to_owned()
        } else {
            format!("{table}.{}", self.key)
        };
        // What a table changes is what its keys change.
        let effect = if effect == Effect::Numbers {
            self.effect
        } else {
            effect
        };
        let spec = KeySpec {
            effect,
            ..KeySpec::new(self, key.clone())
        };
        keys.push(spec);
        for below in self.below {
            below.add_to(&key, effect, keys);
        }
    }
}

/// All keys of a file that has `entries`, each table before what is below it.
pub(crate) fn all_keys(entries: &[Entry]) -> Vec<KeySpec> {
    let mut keys = Vec::new();
    for entry in entries {
        entry.add_to("", Effect::Numbers, &mut keys);
    }
    keys
}

impl KeySpec {
    /// The key of a table's entry under its full name.
    pub(crate) fn new(entry: &Entry, key: String) -> Self {
        Self {
            key,
            value: entry.value,
            default: entry.default,
            required: entry.default == REQUIRED,
            meaning: entry.meaning,
            words: entry.words,
            effect: entry.effect,
            is_of_accuracy: entry.is_of_accuracy,
            is_or_null: entry.is_or_null,
        }
    }

    /// What it accepts, as a message says it.
    pub(crate) fn accepted(&self) -> String {
        match self.words {
            Words::OfValue => self.value.in_words(),
            Words::With(words) => self.value.in_words() + words,
            Words::Instead(words) => words.to_owned(),
        }
    }
}

/// The keys of `all` that `name` may be meant for: those that end in it, or else whose last part has it, or else the nearest
/// in spelling; none where no key is near.
#[must_use]
pub fn nearest_key_names(all: &[KeySpec], name: &str) -> Vec<String> {
    let last = |key: &KeySpec| key.key.rsplit('.').next().unwrap_or_default().to_owned();
    let wanted = name.rsplit('.').next().unwrap_or_default();
    let those = |chosen: &dyn Fn(&KeySpec) -> bool| -> Vec<String> {
        let keys = all.iter().filter(|key| chosen(key));
        keys.map(|key| key.key.clone()).collect()
    };
    let same = those(&|key| last(key) == wanted);
    if !same.is_empty() {
        return same;
    }
    let containing = those(&|key| !wanted.is_empty() && last(key).contains(wanted));
    if !containing.is_empty() {
        return containing;
    }
    let distance = |key: &KeySpec| {
        let [whole, of_last] = [(name, key.key.as_str()), (wanted, &last(key))]
            .map(|(written, own)| misspelling(written, own));
        whole.into_iter().chain(of_last).min()
    };
    let nearest = all.iter().filter_map(distance).min();
    those(&|key| nearest.is_some() && distance(key) == nearest)
}

/// In how many letters `written` differs from `name`, if it is near enough to be meant for it: by a quarter of its letters at
/// most, a space in the place of an underscore not counted.
pub(crate) fn misspelling(written: &str, name: &str) -> Option<usize> {
    let [written, name] = [written, name].map(|own| own.to_lowercase().replace(' ', "_"));
    let letters = written.chars().count();
    let most = if letters < 3 { 0 } else { (letters / 4).max(1) };
    Some(damerau_levenshtein(&written, &name)).filter(|distance| *distance <= most)
}
