//! The lines of a deck and of all files it includes, as keyword cards with their data.

use std::path::Path;

use crate::model::sector::error::ModelError;
use crate::model::sector::import::problem::ImportProblem;
use crate::model::sector::import::source::{Problem, Source};

/// Included files may include others this deep.
const MOST_DEPTH: usize = 16;

/// A line of one of the deck's files.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    file: usize,
    line: usize,
    start: usize,
    end: usize,
}

/// A keyword line with the data lines under it.
#[derive(Debug)]
pub(super) struct Card {
    /// Upper case, with the star, blanks as written: `*SOLID SECTION`.
    pub keyword: String,
    /// Names in upper case; values as written, `None` for a parameter without value.
    parameters: Vec<(String, Option<String>)>,
    pub place: Place,
    pub data: Vec<Place>,
}

/// A deck in memory.
#[derive(Debug, Default)]
pub(super) struct Cards {
    files: Vec<Source>,
    pub cards: Vec<Card>,
}

impl Card {
    /// Value of a parameter.
    pub fn value(&self, name: &str) -> Option<&str> {
        let (_, value) = self.parameters.iter().find(|(key, _)| key == name)?;
        value.as_deref()
    }

    /// Value of a parameter in upper case, as names of sets are compared.
    pub fn name(&self, parameter: &str) -> Option<String> {
        self.value(parameter).map(str::to_ascii_uppercase)
    }

    /// Whether a parameter is there, with or without value.
    pub fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|(key, _)| key == name)
    }
}

impl Cards {
    /// Reads a deck and what it includes.
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let mut cards = Self::default();
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        cards.add(path, folder, 1)?;
        Ok(cards)
    }

    fn add(&mut self, path: &Path, folder: &Path, depth: usize) -> Result<(), ModelError> {
        let file = self.files.len();
        self.files.push(Source::read(path)?);
        let mut continued = false;
        let mut start = 0;
        let mut number = 0;
        while start < self.files[file].text.len() {
            let text = &self.files[file].text;
            let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
            number += 1;
            let place = Place {
                file,
                line: number,
                start,
                end,
            };
            start = end + 1;
            let line = self.text(place);
            if line.is_empty() || line.starts_with("**") {
                continue;
            }
            if continued || line.starts_with('*') {
                let (line, ends_open) = (line.to_owned(), line.ends_with(','));
                if continued && let Some(card) = self.cards.last_mut() {
                    card.parameters.extend(parameters(&line));
                } else {
                    let (keyword, rest) = line.split_once(',').unwrap_or((&line, ""));
                    self.cards.push(Card {
                        keyword: keyword.trim().to_ascii_uppercase(),
                        parameters: parameters(rest),
                        place,
                        data: Vec::new(),
                    });
                }
                continued = ends_open;
                if !continued {
                    self.include(folder, depth)?;
                }
            } else if let Some(card) = self.cards.last_mut() {
                card.data.push(place);
            }
        }
        Ok(())
    }

    /// Puts the file of an `*INCLUDE` that has just been read in its place.
    fn include(&mut self, folder: &Path, depth: usize) -> Result<(), ModelError> {
        if self
            .cards
            .last()
            .is_none_or(|card| card.keyword != "*INCLUDE")
        {
            return Ok(());
        }
        let Some(card) = self.cards.pop() else {
            return Ok(());
        };
        let Some(name) = card.value("INPUT") else {
            let problem = ImportProblem::ParameterMissing {
                keyword: card.keyword,
                parameter: "INPUT",
            };
            return Err(self.refuse(card.place, problem));
        };
        let included = folder.join(name.trim_matches('"'));
        if depth >= MOST_DEPTH {
            let problem = ImportProblem::IncludeDepth {
                depth: depth + 1,
                most: MOST_DEPTH,
            };
            return Err(self.refuse(card.place, problem));
        }
        self.add(&included, folder, depth + 1)
    }

    /// The line without blanks at its ends.
    pub fn text(&self, place: Place) -> &str {
        self.files[place.file].text[place.start..place.end].trim()
    }

    /// The words between commas; an empty one at the end is none.
    pub fn words(&self, place: Place) -> Vec<&str> {
        let mut words: Vec<&str> = self.text(place).split(',').map(str::trim).collect();
        while words.last().is_some_and(|word| word.is_empty()) {
            words.pop();
        }
        words
    }

    pub fn refuse(&self, place: Place, problem: impl Into<Problem>) -> ModelError {
        self.files[place.file].refuse(place.line, problem)
    }
}

fn parameters(text: &str) -> Vec<(String, Option<String>)> {
    text.split(',')
        .map(str::trim)
        .filter(|word| !word.is_empty())
        .map(|word| match word.split_once('=') {
            Some((name, value)) => (
                name.trim().to_ascii_uppercase(),
                Some(value.trim().to_owned()),
            ),
            None => (word.to_ascii_uppercase(), None),
        })
        .collect()
}
