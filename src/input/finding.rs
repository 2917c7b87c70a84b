//! The messages on what is wrong in a study file or an import file: line, key, value, and what is accepted.

use std::fmt;
use std::path::Path;

/// One thing that is wrong in a file.
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

/// A part of a line of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    /// The line.
    pub text: String,
    /// Characters before the part.
    pub start: usize,
    /// Characters of the part.
    pub width: usize,
}

/// Ways in which a key can be wrong.
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
pub(crate) fn listed(path: &Path, findings: &[Finding]) -> String {
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
