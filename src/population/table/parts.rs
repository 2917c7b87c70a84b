//! Parts: one finished file per block of patterns, so that an interrupted run loses little.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::responses::{ResponseReader, ResponseWriter};
use super::{TableError, TableHeader};
use crate::population::monte_carlo::{PatternBlock, ResponseRow, RowSink, Scenario};

/// The rows of a results folder while it is worked on: a finished table of an earlier, shorter run
/// (if any) and the parts `parts/part-XXXXXX.parquet`.
#[derive(Debug)]
pub struct PartStore {
    responses: PathBuf,
    folder: PathBuf,
    scenarios: Vec<Scenario>,
    header: TableHeader,
}

impl PartStore {
    /// The store of the results folder `results`.
    #[must_use]
    pub fn new(results: &Path, scenarios: &[Scenario], header: TableHeader) -> Self {
        Self {
            responses: results.join("responses.parquet"),
            folder: results.join("parts"),
            scenarios: scenarios.to_vec(),
            header,
        }
    }

    /// The finished table.
    #[must_use]
    pub fn responses(&self) -> &Path {
        &self.responses
    }

    /// Patterns whose rows are stored, in the finished table or in a part of this study.
    ///
    /// # Errors
    /// A file cannot be read, is damaged, or the table belongs to another study.
    pub fn done(&self) -> Result<BTreeSet<u32>, TableError> {
        let mut done = BTreeSet::new();
        if self.responses.exists() {
            done.extend(self.patterns_of(&self.responses)?.ok_or_else(|| {
                TableError::damaged(&self.responses, "it belongs to another study")
            })?);
        }
        for part in self.parts()? {
            done.extend(self.patterns_of(&part)?.into_iter().flatten());
        }
        Ok(done)
    }

    /// A sink that stores each of `blocks` as a part.
    #[must_use]
    pub fn sink<'a>(&'a self, blocks: &'a [PatternBlock]) -> PartSink<'a> {
        PartSink {
            store: self,
            blocks,
        }
    }

    /// Joins table and parts to a `responses.parquet` that holds the patterns of `ids` (ascending)
    /// in order, hands every row to `visit` on the way, and removes the parts.
    ///
    /// # Errors
    /// A file cannot be read or written, or a pattern is missing.
    pub fn assemble(
        &self,
        ids: &[u32],
        mut visit: impl FnMut(&ResponseRow),
    ) -> Result<(), TableError> {
        let mut sources = BTreeMap::new();
        let mut files = self.parts()?;
        if self.responses.exists() {
            files.push(self.responses.clone());
        }
        for file in files {
            if let Some(first) = self
                .patterns_of(&file)?
                .and_then(|ids| ids.first().copied())
            {
                sources.insert(first, file);
            }
        }
        let mut writer = ResponseWriter::create(&self.responses, &self.scenarios, &self.header)?;
        let mut expected = ids
            .iter()
            .flat_map(|&id| (0..self.scenarios.len()).map(move |scenario| (id, scenario)));
        for file in sources.into_values() {
            let mut reader = ResponseReader::open(&file)?;
            loop {
                let rows = reader.next_batch()?;
                if rows.is_empty() {
                    break;
                }
                for row in &rows {
                    if expected.next() != Some((row.pattern, row.scenario)) {
                        let reason = format!("its pattern {} is out of order", row.pattern);
                        return Err(TableError::damaged(&file, reason));
                    }
                    visit(row);
                }
                writer.write(rows)?;
            }
        }
        if let Some((pattern, _)) = expected.next() {
            let reason = format!("no part holds pattern {pattern}");
            return Err(TableError::damaged(&self.folder, reason));
        }
        writer.finish()?;
        self.remove_parts()
    }

    fn remove_parts(&self) -> Result<(), TableError> {
        if self.folder.exists() {
            std::fs::remove_dir_all(&self.folder)
                .map_err(TableError::io("remove", &self.folder))?;
        }
        Ok(())
    }

    fn parts(&self) -> Result<Vec<PathBuf>, TableError> {
        if !self.folder.exists() {
            return Ok(Vec::new());
        }
        let entries =
            std::fs::read_dir(&self.folder).map_err(TableError::io("read", &self.folder))?;
        let mut parts = Vec::new();
        for entry in entries {
            let path = entry.map_err(TableError::io("read", &self.folder))?.path();
            let name = path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned());
            if name.is_some_and(|name| name.starts_with("part-") && name.ends_with(".parquet")) {
                parts.push(path);
            }
        }
        parts.sort();
        Ok(parts)
    }

    /// Ids of the patterns of a file, ascending; none if it belongs to another study.
    fn patterns_of(&self, path: &Path) -> Result<Option<Vec<u32>>, TableError> {
        let mut reader = ResponseReader::open(path)?;
        if reader.study_digest() != Some(&self.header.study_digest) {
            return Ok(None);
        }
        let mut ids: Vec<u32> = Vec::new();
        let mut place = 0;
        loop {
            let rows = reader.next_batch()?;
            if rows.is_empty() {
                break;
            }
            for row in rows {
                let in_order = match ids.last() {
                    _ if place == 0 => ids.last().is_none_or(|&last| last < row.pattern),
                    last => last == Some(&row.pattern),
                };
                if !in_order || row.scenario != place {
                    let reason = format!("the rows of pattern {} are out of order", row.pattern);
                    return Err(TableError::damaged(path, reason));
                }
                if place == 0 {
                    ids.push(row.pattern);
                }
                place = (place + 1) % self.scenarios.len();
            }
        }
        if place != 0 {
            return Err(TableError::damaged(
                path,
                "the rows of its last pattern are incomplete",
            ));
        }
        Ok(Some(ids))
    }
}

/// Stores each block of rows as a part.
#[derive(Debug)]
pub struct PartSink<'a> {
    store: &'a PartStore,
    blocks: &'a [PatternBlock],
}

impl RowSink for PartSink<'_> {
    type Error = TableError;

    fn block(&mut self, block: usize, rows: Vec<ResponseRow>) -> Result<(), TableError> {
        let name = format!("part-{:06}.parquet", self.blocks[block].index);
        let path = self.store.folder.join(name);
        let mut writer = ResponseWriter::create(&path, &self.store.scenarios, &self.store.header)?;
        writer.write(rows)?;
        writer.finish()
    }
}
