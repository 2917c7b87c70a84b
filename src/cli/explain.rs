//! `blisk explain`, `blisk schema` and `blisk completions`: what a study file and the command line accept.

use std::collections::BTreeSet;
use std::fmt;

use clap::Args;
use clap_complete::Shell;
use serde::{Serialize, Serializer};

use super::exit::Failure;
use super::{ExitStatus, output};
use crate::input::{
    Term, mentions, misspelling, names_of_terms, nearest_key_names, plain, terms_about,
    warnings_about,
};
use crate::model::sector::import::{import_keys, import_schema};
use crate::population::table::{
    ColumnSpec, DISTRIBUTION_COLUMNS, MAIN_EFFECT_COLUMNS, PATTERN_COLUMNS, PERCENTILE_COLUMNS,
    RESPONSE_COLUMNS, SCENARIO_COLUMNS, TAIL_FIT_COLUMNS, TRADEOFF_COLUMNS, VERIFICATION_COLUMNS,
};
use crate::report::FIGURES;
use crate::response::harmonic_balance::Status;
use crate::study::{KeySpec, keys_about, keys_below, nearest_keys, study_schema};

/// Arguments of `blisk explain`.
#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// A key, like `solver.peak_tolerance`, a table, like `solver`, a column of results, like `harmonic_error`, a
    /// status of rows, like `stagnated`, a figure, like `safe`, a term, like `nodal diameter`, words, like `friction`, that are
    /// sought in names and meanings, or a warning as it is printed; `import` for the keys of import files [default: all keys of
    /// study files].
    #[arg(value_name = "KEY|WORD")]
    words: Vec<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Arguments of `blisk schema`.
#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// The schema of import files (`blisk import`) instead.
    #[arg(long)]
    import: bool,
}

/// Arguments of `blisk completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell.
    shell: Shell,
}

/// A key in the words of a user.
#[derive(Debug, Serialize)]
struct Explanation {
    key: String,
    accepted: String,
    default: &'static str,
    required: bool,
    meaning: &'static str,
}

impl From<&KeySpec> for Explanation {
    fn from(key: &KeySpec) -> Self {
        Self {
            key: key.key.clone(),
            accepted: key.value.to_string(),
            default: key.default,
            required: key.required,
            meaning: key.meaning,
        }
    }
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.key)?;
        let lines = [
            ("accepted", self.accepted.as_str()),
            ("default", self.default),
            ("meaning", self.meaning),
        ];
        for (name, words) in lines {
            if !words.is_empty() {
                writeln!(f, "  {name:<8}  {}", plain(words))?;
            }
        }
        Ok(())
    }
}

pub(super) fn explain(arguments: &ExplainArguments) -> Result<ExitStatus, Failure> {
    let found = Explanations::about(&arguments.words.join(" "))?;
    output::result(arguments.json, &found)?;
    Ok(ExitStatus::Done)
}

/// The tables whose columns are explained.
const TABLES: [(&str, &[ColumnSpec]); 9] = [
    ("responses.parquet", RESPONSE_COLUMNS),
    ("scenarios.parquet", SCENARIO_COLUMNS),
    ("percentiles.parquet", PERCENTILE_COLUMNS),
    ("distribution.parquet", DISTRIBUTION_COLUMNS),
    ("patterns.parquet", PATTERN_COLUMNS),
    ("main_effects.parquet", MAIN_EFFECT_COLUMNS),
    ("tail_fits.parquet", TAIL_FIT_COLUMNS),
    ("tradeoff.parquet", TRADEOFF_COLUMNS),
    ("verification.parquet", VERIFICATION_COLUMNS),
];

/// A word that is no key: with where it stands, and its meaning.
#[derive(Debug)]
struct Meaning {
    word: String,
    meaning: String,
}

impl From<Term> for Meaning {
    fn from(term: Term) -> Self {
        Self {
            word: term.word.to_owned(),
            meaning: term.meaning.to_owned(),
        }
    }
}

/// The status and the columns of this name; of a column in several tables each meaning once.
fn of_results(name: &str) -> Vec<Meaning> {
    let status = { Status::ALL.iter() }.filter(|status| status.name() == name);
    let statuses = status.map(|status| Meaning {
        word: format!("{name} (status of a row)"),
        meaning: status.meaning().to_owned(),
    });
    let mut found: Vec<Meaning> = statuses.collect();
    for (table, columns) in TABLES {
        for column in columns.iter().filter(|column| column.name == name) {
            let meaning = match column.unit {
                "" | "1" => column.description.to_owned(),
                unit => format!("{}; unit {unit}", column.description),
            };
            match found.iter_mut().find(|known| known.meaning == meaning) {
                Some(same) => same.word = same.word.replace(')', &format!(", {table})")),
                None => found.push(Meaning {
                    word: format!("{name} (column of {table})"),
                    meaning,
                }),
            }
        }
    }
    found
}

/// The figures that are named by `words`.
fn of_figures(words: &str) -> Vec<Meaning> {
    let named =
        |name: &&str| !words.is_empty() && mentions(&[&name.replace('-', " "), name], words);
    let figures = FIGURES.iter().map(|(_, name, about)| (*name, *about));
    { figures.filter(|(name, _)| named(name)) }
        .map(|(name, about)| Meaning {
            word: format!("{name} (figure)"),
            meaning: format!("{about}; blisk plot DIR {name} draws it"),
        })
        .collect()
}

/// Keys and terms that were asked for: as JSON the keys, as text both.
#[derive(Debug)]
pub struct Explanations {
    keys: Vec<Explanation>,
    terms: Vec<Meaning>,
    /// Whether a key has just the name that was asked for, which is then the first answer.
    keys_first: bool,
}

impl Explanations {
    /// The keys that `name` is or that stand below it, else the status, the columns and the figures of this name and the keys and
    /// terms that have its words; all keys for "".
    ///
    /// # Errors
    /// There is none of them; the message has the nearest names.
    pub fn about(name: &str) -> Result<Self, Failure> {
        let mut keys = keys_below(name);
        if keys.is_empty() {
            keys = import_keys_below(name);
        }
        // Of a key a figure may have the name too, like `contact`.
        let same_name = |own: &Meaning| own.word == format!("{name} (figure)");
        let mut terms = of_figures(name);
        terms.retain(same_name);
        if keys.is_empty() {
            terms.clear();
            keys = keys_about(name);
            // Terms that are named by the word, the status and columns of this name, terms that mention it.
            let named = |term: &Term| term.word.to_lowercase().contains(&name.to_lowercase());
            let (before, after): (Vec<Term>, Vec<Term>) =
                terms_about(name).into_iter().partition(named);
            terms.extend(before.into_iter().map(Meaning::from));
            terms.extend(of_results(name));
            terms.extend(of_figures(name));
            terms.extend(after.into_iter().map(Meaning::from));
            terms.extend({ warnings_about(name).into_iter() }.map(|own| Meaning {
                word: format!("{} (warning)", own.word),
                meaning: own.meaning.to_owned(),
            }));
        }
        if keys.is_empty() && terms.is_empty() {
            return Err(Failure::usage(unknown(name)));
        }
        let is_last = |key: &KeySpec| key.key.rsplit('.').next() == Some(name);
        let (named, others): (Vec<KeySpec>, Vec<KeySpec>) = keys.into_iter().partition(is_last);
        Ok(Self {
            keys_first: !named.is_empty(),
            keys: named.iter().chain(&others).map(Explanation::from).collect(),
            terms,
        })
    }
}

/// That nothing has this name, with the names that it may be meant for, or else with what can be explained.
fn unknown(name: &str) -> String {
    let mut near = if name.starts_with("import.") {
        nearest_key_names(&import_keys_below("import"), name)
    } else {
        nearest_keys(name)
    };
    if near.is_empty() {
        let columns = TABLES.iter().flat_map(|(_, columns)| *columns);
        let columns = columns.map(|column| column.name);
        let others = { Status::ALL.iter().map(|status| status.name()) }
            .chain(columns)
            .chain(FIGURES.iter().map(|(_, name, _)| *name))
            .chain(names_of_terms());
        let others: Vec<(usize, &str)> = others
            .filter_map(|own| Some((misspelling(name, own)?, own)))
            .collect();
        let nearest = others.iter().map(|own| own.0).min();
        let nearest = others.into_iter().filter(|own| Some(own.0) == nearest);
        let nearest: BTreeSet<&str> = nearest.map(|own| own.1).collect();
        near = nearest.into_iter().map(str::to_owned).collect();
    }
    if near.is_empty() {
        format!(
            "nothing has the name {name}, and no text has this word; accepted: a key of study files (`blisk explain` lists \
             them) or of import files (`blisk explain import`), a column of results, a status of rows, a figure, a term of \
             the glossary, a word of their texts, or a few words of a warning"
        )
    } else {
        format!(
            "there is no key {name}; did you mean {}?",
            near.join(" or ")
        )
    }
}

impl Serialize for Explanations {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.keys.serialize(serializer)
    }
}

impl fmt::Display for Explanations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let apart = !self.terms.is_empty() || self.keys.len() > 1;
        let terms = { self.terms.iter() }
            .map(|term| format!("{}\n  meaning   {}\n", term.word, term.meaning));
        let mut text: Vec<String> = terms.collect();
        let keys = self.keys.iter().map(ToString::to_string);
        let place = if self.keys_first { 0 } else { text.len() };
        text.splice(place..place, keys);
        f.write_str(&text.join(if apart { "\n" } else { "" }))
    }
}

/// Keys of import files, each after the word `import`: all of them for that word, else those that `name` is, or
/// that stand below it.
fn import_keys_below(name: &str) -> Vec<KeySpec> {
    let name = name.strip_prefix("import.").unwrap_or(name);
    let below = format!("{name}.");
    let chosen = |key: &KeySpec| name == "import" || key.key == name || key.key.starts_with(&below);
    import_keys()
        .into_iter()
        .filter(chosen)
        .map(|key| KeySpec {
            key: format!("import.{}", key.key),
            ..key
        })
        .collect()
}

pub(super) fn schema(arguments: &SchemaArguments) -> Result<ExitStatus, Failure> {
    output::json_only(&if arguments.import {
        import_schema()
    } else {
        study_schema()
    })?;
    Ok(ExitStatus::Done)
}

pub(super) fn completions(
    arguments: &CompletionsArguments,
    mut program: clap::Command,
) -> Result<ExitStatus, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut program, "blisk", &mut script);
    output::text(&String::from_utf8_lossy(&script))?;
    Ok(ExitStatus::Done)
}
