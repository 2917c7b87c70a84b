//! One file of rows, a part or a finished table: known by its digest, read pattern by pattern.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use super::responses::ResponseReader;
use super::{TableError, digest_stored};
use crate::population::monte_carlo::ResponseRow;

/// What comes after the digest in a message about a file that does not have it.
const NOT_AS_WRITTEN: &str = "its content is not what was written; `blisk verify DIR --repair` sets it aside and solves its rows again";
/// What comes after the name of a file that is not there.
const MISSING: &str =
    "it is missing; restore it, or let `blisk verify DIR --repair` have its rows solved again";

/// A file of rows that should have this digest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RowFile {
    /// Where it lies.
    pub path: PathBuf,
    /// BLAKE3 digest, hexadecimal.
    pub digest: String,
    /// A pattern that its first one does not come before.
    pub from: u32,
}

impl RowFile {
    /// Checks the content against the digest.
    ///
    /// # Errors
    /// The file cannot be read, is missing, or is not as written.
    pub fn check(&self) -> Result<(), TableError> {
        match digest_stored(&self.path)? {
            Some(found) if found == self.digest => Ok(()),
            Some(_) => Err(TableError::damaged(&self.path, NOT_AS_WRITTEN)),
            None => Err(TableError::damaged(&self.path, MISSING)),
        }
    }
}

/// Reads a file of rows pattern by pattern, for a study that may have other scenarios than the file.
pub(super) struct RowCursor {
    path: PathBuf,
    reader: ResponseReader,
    /// Index in the study of each scenario of the file; none: not a scenario of the study.
    places: Vec<Option<usize>>,
    waiting: VecDeque<ResponseRow>,
    last: Option<u32>,
}

impl RowCursor {
    /// Opens `file`, whose content is checked first, for the rows made from `row_digests`; none if
    /// it holds no such row.
    pub(super) fn open(file: &RowFile, row_digests: &[String]) -> Result<Option<Self>, TableError> {
        file.check()?;
        let reader = ResponseReader::open(&file.path)?;
        let places: Vec<Option<usize>> = reader
            .row_digests()
            .iter()
            .map(|digest| row_digests.iter().position(|ours| ours == digest))
            .collect();
        if places.iter().all(Option::is_none) {
            return Ok(None);
        }
        let mut cursor = Self {
            path: file.path.clone(),
            reader,
            places,
            waiting: VecDeque::new(),
            last: None,
        };
        if cursor.pattern()?.is_some_and(|first| first < file.from) {
            let reason = "its name is not that of its content";
            return Err(TableError::damaged(&file.path, reason));
        }
        Ok(Some(cursor))
    }

    /// Scenarios of the study that the file has, ascending.
    pub(super) fn scenarios(&self) -> Vec<usize> {
        let mut scenarios: Vec<usize> = self.places.iter().flatten().copied().collect();
        scenarios.sort_unstable();
        scenarios
    }

    /// The pattern of the next rows; none at the end.
    pub(super) fn pattern(&mut self) -> Result<Option<u32>, TableError> {
        if self.waiting.is_empty() {
            self.waiting = self.reader.next_batch()?.into();
        }
        Ok(self.waiting.front().map(|row| row.pattern))
    }

    /// The rows of the next pattern under the scenarios of the study, by its indices.
    pub(super) fn take(&mut self) -> Result<Vec<ResponseRow>, TableError> {
        let Some(pattern) = self.pattern()? else {
            return Ok(Vec::new());
        };
        if self.last.is_some_and(|last| last >= pattern) {
            return Err(disorder(&self.path, pattern));
        }
        self.last = Some(pattern);
        let mut rows = Vec::with_capacity(self.places.len());
        for place in 0..self.places.len() {
            if self.pattern()? != Some(pattern) {
                return Err(disorder(&self.path, pattern));
            }
            let Some(row) = self.waiting.pop_front() else {
                return Err(disorder(&self.path, pattern));
            };
            if let Some(scenario) = self.places[place] {
                rows.push(ResponseRow { scenario, ..row });
            }
        }
        Ok(rows)
    }
}

fn disorder(path: &Path, pattern: u32) -> TableError {
    let reason = format!("the rows of pattern {pattern} are incomplete or out of order");
    TableError::damaged(path, reason)
}
