//! Files of other codes as text, with the numbers that Fortran and C write.

use std::fs;
use std::path::{Path, PathBuf};

use super::problem::ImportProblem;
use crate::model::sector::error::ModelError;
use crate::model::sector::line_problem::LineProblem;

/// A file in memory. Bytes that are no UTF-8 (comments in older encodings) are replaced.
#[derive(Debug)]
pub(super) struct Source {
    pub path: PathBuf,
    pub text: String,
}

impl Source {
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let bytes = fs::read(path).map_err(|source| ModelError::File {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            path: path.to_owned(),
            text: String::from_utf8_lossy(&bytes).into_owned(),
        })
    }

    /// Lines with their numbers, from 1.
    pub fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        self.text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line))
    }

    /// Refuses a line.
    pub fn refuse(&self, line: usize, problem: impl Into<Problem>) -> ModelError {
        match problem.into() {
            Problem::Line(problem) => ModelError::Line {
                path: self.path.clone(),
                line,
                problem,
            },
            Problem::Import(problem) => ModelError::ImportLine {
                path: self.path.clone(),
                line,
                problem: Box::new(problem),
            },
        }
    }

    /// Refuses the file as a whole.
    pub fn refuse_whole(&self, problem: ImportProblem) -> ModelError {
        refuse(&self.path, problem)
    }

    /// Refuses a file whose last line has no end: it was cut off while it was written.
    pub fn require_last_line_end(&self) -> Result<(), ModelError> {
        if self.text.is_empty() || self.text.ends_with('\n') {
            return Ok(());
        }
        let last = self.text.lines().count();
        let what = "the last line has no end".to_owned();
        Err(self.refuse(last, ImportProblem::CutOff { what }))
    }
}

/// Refuses a file as a whole.
pub(super) fn refuse(path: &Path, problem: ImportProblem) -> ModelError {
    ModelError::Import {
        path: path.to_owned(),
        problem: Box::new(problem),
    }
}

/// A problem of a line, of either kind.
pub(super) enum Problem {
    Line(LineProblem),
    Import(ImportProblem),
}

impl From<LineProblem> for Problem {
    fn from(problem: LineProblem) -> Self {
        Self::Line(problem)
    }
}

impl From<ImportProblem> for Problem {
    fn from(problem: ImportProblem) -> Self {
        Self::Import(problem)
    }
}

/// A number as C, Fortran (`1.5D+03`) or Nastran (`1.5+3`) write it; it must be finite.
pub(super) fn real(field: &'static str, word: &str) -> Result<f64, LineProblem> {
    let refused = || LineProblem::NotANumber {
        field,
        found: word.to_owned(),
    };
    let plain = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
    // `parse` takes "inf" and "nan" as words; only digits may begin a number of a file.
    if !word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        return Err(refused());
    }
    if let Some(value) = plain(word) {
        return Ok(value);
    }
    let with_e = word.replace(['D', 'd'], "E");
    if let Some(value) = plain(&with_e) {
        return Ok(value);
    }
    // An exponent without letter: the last sign that is not the first character begins it.
    let exponent = word.rfind(['+', '-']).filter(|&at| at > 0);
    exponent
        .filter(|&at| word.as_bytes()[at - 1].is_ascii_digit() || word.as_bytes()[at - 1] == b'.')
        .and_then(|at| plain(&format!("{}E{}", &word[..at], &word[at..])))
        .ok_or_else(refused)
}

#[cfg(test)]
mod tests {
    use super::real;

    #[test]
    fn numbers_of_fortran_and_nastran_are_read() {
        for (word, value) in [
            ("1.5", 1.5),
            ("-1.5D+03", -1500.0),
            ("1.5d-3", 1.5e-3),
            ("1.5+3", 1500.0),
            ("-.25-2", -0.25e-2),
            ("7.", 7.0),
            ("2E5", 2e5),
        ] {
            assert_eq!(real("x", word), Ok(value), "{word}");
        }
        for word in [
            "", "nan", "inf", "-inf", "1.5+", "+", "1e400", "1..2", "E5", "1-2-3",
        ] {
            assert!(real("x", word).is_err(), "{word}");
        }
    }
}
