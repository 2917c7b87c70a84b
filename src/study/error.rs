//! What can be wrong with a study file: where, which key, which value, and what is accepted.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

use crate::model::sector::ModelError;
use crate::population::table::PatternParquetError;
use crate::response::mistuning::PatternFileError;

/// A study that cannot be used.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The study file cannot be read.
    #[error("cannot read the study {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Keys or values are not accepted; every one that was found.
    #[error("{}", listed(path, findings))]
    Invalid {
        /// The file.
        path: PathBuf,
        /// What was found.
        findings: Vec<Finding>,
    },
    /// The file of patterns is not accepted.
    #[error(transparent)]
    Patterns(#[from] PatternFileError),
    /// The Parquet file of patterns is not accepted.
    #[error(transparent)]
    PatternTable(#[from] PatternParquetError),
    /// The model is refused that a number of the study is made from.
    #[error(transparent)]
    Model(Box<ModelError>),
    /// An input file that the study names cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// One thing that is wrong in a study file.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Line of the file, from 1.
    pub line: usize,
    /// Full key, for instance `solver.peak_tolerance`; empty for a mistake of TOML itself.
    pub key: String,
    /// What is wrong.
    pub problem: Problem,
    /// The part of the file that it is about; none where something is missing.
    pub excerpt: Option<Excerpt>,
}

/// A part of a line of a study file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    /// The line.
    pub text: String,
    /// Characters before the part.
    pub start: usize,
    /// Characters of the part.
    pub width: usize,
}

/// Ways in which a key of a study file can be wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum Problem {
    /// The file is no TOML.
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// There is no such key.
    UnknownKey {
        /// The nearest key there is.
        suggestion: Option<String>,
        /// The keys there are.
        accepted: Vec<String>,
    },
    /// A key that is needed is absent.
    Missing {
        /// What is accepted.
        accepted: String,
    },
    /// The value is not accepted.
    NotAccepted {
        /// The value as written.
        value: String,
        /// What is accepted.
        accepted: String,
        /// The nearest value there is.
        suggestion: Option<String>,
    },
    /// The key does not go together with another.
    Conflict {
        /// Why not, and what to do.
        reason: String,
    },
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let key = &self.key;
        match &self.problem {
            Problem::Syntax { message } => write!(f, "{message}"),
            Problem::UnknownKey {
                suggestion,
                accepted,
            } => {
                write!(f, "unknown key {key}")?;
                if let Some(suggestion) = suggestion {
                    write!(f, "; did you mean {suggestion}?")?;
                }
                if accepted.is_empty() {
                    Ok(())
                } else {
                    write!(f, " (accepted: {})", accepted.join(", "))
                }
            }
            Problem::Missing { accepted } => {
                write!(f, "{key} is missing; accepted: {accepted}")
            }
            Problem::NotAccepted {
                value,
                accepted,
                suggestion,
            } => {
                write!(f, "{key} = {value} is not accepted")?;
                if let Some(suggestion) = suggestion {
                    write!(f, "; did you mean {suggestion}?")?;
                }
                write!(f, "; accepted: {accepted}")
            }
            Problem::Conflict { reason } => write!(f, "{key}: {reason}"),
        }
    }
}

/// Findings that are listed.
const LISTED: usize = 100;

/// The findings with their places, and the parts of the lines that they are about underlined.
fn listed(path: &std::path::Path, findings: &[Finding]) -> String {
    let told = findings.iter().take(LISTED).map(|finding| {
        let line = finding.line;
        let underlined = finding
            .excerpt
            .as_ref()
            .map_or_else(String::new, |excerpt| {
                let Excerpt { text, start, width } = excerpt;
                let number = line.to_string();
                let margin = " ".repeat(number.len());
                let (before, mark) = (" ".repeat(*start), "^".repeat(*width));
                format!("\n  {number} | {text}\n  {margin} | {before}{mark}")
            });
        format!("{}:{line}: {finding}{underlined}", path.display())
    });
    let mut told: Vec<String> = told.collect();
    if findings.len() > LISTED {
        let more = findings.len() - LISTED;
        told.push(format!("{}: and {more} more", path.display()));
    }
    told.join("\n")
}
