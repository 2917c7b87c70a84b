//! Patterns given as a table `pattern, blade, [mode,] deviation`, checked entry by entry.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::{ContactFactors, Deviations, Pattern};

/// A file of patterns that cannot be used.
#[derive(Debug, Error)]
pub enum PatternFileError {
    /// The file cannot be read.
    #[error("cannot read the patterns file {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The file is no table of the expected form.
    #[error("{}: {found}; accepted: {accepted}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        found: String,
        /// What is accepted.
        accepted: &'static str,
    },
    /// One entry is not accepted.
    #[error("{}:{line}: {column} = {value} is not accepted: {accepted}", path.display())]
    Entry {
        /// The file.
        path: PathBuf,
        /// Line of the file (row + 1 of a Parquet file, as if it had a header).
        line: usize,
        /// Column of the entry.
        column: &'static str,
        /// The value as written.
        value: String,
        /// What is accepted.
        accepted: String,
    },
    /// An entry is missing.
    #[error("{}: pattern {pattern} has no deviation for {missing}; accepted: one for every blade 0 to {}", path.display(), sectors.saturating_sub(1))]
    Missing {
        /// The file.
        path: PathBuf,
        /// Pattern with the gap.
        pattern: u32,
        /// The blade, or blade and mode, that is missing.
        missing: String,
        /// Number of sectors of the wheel.
        sectors: usize,
    },
}

/// One line of a file of patterns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatternRecord {
    /// Line of the file.
    pub line: usize,
    /// Pattern id.
    pub pattern: u32,
    /// Blade, from 0.
    pub blade: u32,
    /// Blade-alone mode, from 0; none = all modes.
    pub mode: Option<u32>,
    /// Relative deviation.
    pub deviation: f64,
}

/// The lines of a file of patterns, each correct in itself and no two for the same entry.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternRecords {
    path: PathBuf,
    records: Vec<PatternRecord>,
}

/// Patterns of a file, complete for a wheel of given size.
#[derive(Debug, Clone, PartialEq)]
pub struct PatternTable {
    patterns: BTreeMap<u32, Pattern>,
}

type Entries = BTreeMap<(u32, Option<u32>), (usize, f64)>;

impl PatternRecords {
    /// Root mean square of all deviations; 0 for an empty file.
    #[must_use]
    pub fn root_mean_square(&self) -> f64 {
        let squares: f64 = self
            .records
            .iter()
            .map(|record| record.deviation.powi(2))
            .sum();
        (squares / self.records.len().max(1) as f64).sqrt()
    }

    /// Checks the records of the file `path`.
    ///
    /// # Errors
    /// A deviation that is not a number above -1, an entry given twice, a file without entries.
    pub fn new(path: &Path, records: Vec<PatternRecord>) -> Result<Self, PatternFileError> {
        if records.is_empty() {
            return Err(PatternFileError::Form {
                path: path.to_owned(),
                found: "the file holds no pattern".to_owned(),
                accepted: "at least one line `pattern,blade,deviation` below the header",
            });
        }
        let mut seen = BTreeMap::new();
        for record in &records {
            if !record.deviation.is_finite() || record.deviation <= -1.0 {
                return Err(PatternFileError::Entry {
                    path: path.to_owned(),
                    line: record.line,
                    column: "deviation",
                    value: record.deviation.to_string(),
                    accepted: "a finite number above -1".to_owned(),
                });
            }
            let key = (record.pattern, record.blade, record.mode);
            if let Some(first) = seen.insert(key, record.line) {
                return Err(PatternFileError::Entry {
                    path: path.to_owned(),
                    line: record.line,
                    column: "blade",
                    value: record.blade.to_string(),
                    accepted: format!(
                        "one line per blade of pattern {}, which line {first} gives already",
                        record.pattern
                    ),
                });
            }
        }
        Ok(Self {
            path: path.to_owned(),
            records,
        })
    }

    /// Ids of the patterns, ascending.
    #[must_use]
    pub fn ids(&self) -> Vec<u32> {
        let mut ids: Vec<u32> = self.records.iter().map(|record| record.pattern).collect();
        ids.sort_unstable();
        ids.dedup();
        ids
    }

    /// Whether a deviation is given per mode.
    #[must_use]
    pub fn has_modes(&self) -> bool {
        self.records.iter().any(|record| record.mode.is_some())
    }

    /// The patterns for a wheel of `sectors` blades.
    ///
    /// # Errors
    /// A blade out of range, a blade or mode without deviation, a pattern that mixes deviations
    /// with and without mode.
    pub fn for_wheel(
        &self,
        sectors: usize,
        modes: usize,
    ) -> Result<PatternTable, PatternFileError> {
        let mut by_pattern: BTreeMap<u32, Entries> = BTreeMap::new();
        for record in &self.records {
            if record.blade as usize >= sectors {
                return Err(PatternFileError::Entry {
                    path: self.path.clone(),
                    line: record.line,
                    column: "blade",
                    value: record.blade.to_string(),
                    accepted: format!(
                        "0 to {} (the wheel has {sectors})",
                        sectors.saturating_sub(1)
                    ),
                });
            }
            if let Some(mode) = record.mode
                && mode as usize >= modes
            {
                return Err(PatternFileError::Entry {
                    path: self.path.clone(),
                    line: record.line,
                    column: "mode",
                    value: mode.to_string(),
                    accepted: format!(
                        "0 to {} (mistuning.cantilever_mode_count is {modes})",
                        modes.saturating_sub(1)
                    ),
                });
            }
            by_pattern
                .entry(record.pattern)
                .or_default()
                .insert((record.blade, record.mode), (record.line, record.deviation));
        }
        let patterns = by_pattern
            .into_iter()
            .map(|(id, entries)| Ok((id, self.complete(id, &entries, sectors)?)))
            .collect::<Result<_, PatternFileError>>()?;
        Ok(PatternTable { patterns })
    }

    fn complete(
        &self,
        id: u32,
        entries: &Entries,
        sectors: usize,
    ) -> Result<Pattern, PatternFileError> {
        let mut modes: Vec<Option<u32>> = entries.keys().map(|&(_, mode)| mode).collect();
        modes.sort_unstable();
        modes.dedup();
        if modes.len() > 1 && modes[0].is_none() {
            let line = entries
                .iter()
                .find(|((_, mode), _)| mode.is_none())
                .map_or(0, |(_, &(line, _))| line);
            return Err(PatternFileError::Entry {
                path: self.path.clone(),
                line,
                column: "mode",
                value: "(empty)".to_owned(),
                accepted: format!("a mode on every line of pattern {id}, or on none"),
            });
        }
        let mut values = Vec::with_capacity(sectors * modes.len());
        for blade in 0..sectors as u32 {
            for &mode in &modes {
                let Some(&(_, deviation)) = entries.get(&(blade, mode)) else {
                    return Err(PatternFileError::Missing {
                        path: self.path.clone(),
                        pattern: id,
                        missing: match mode {
                            Some(mode) => format!("blade {blade}, mode {mode}"),
                            None => format!("blade {blade}"),
                        },
                        sectors,
                    });
                };
                values.push(deviation);
            }
        }
        let numbered: Vec<u32> = modes.into_iter().flatten().collect();
        let deviations = if numbered.is_empty() {
            Deviations::PerBlade(values)
        } else {
            Deviations::PerMode {
                modes: numbered,
                values,
            }
        };
        Ok(Pattern {
            id,
            deviations,
            contact: ContactFactors::default(),
        })
    }
}

impl PatternTable {
    /// Ids of the patterns, ascending.
    #[must_use]
    pub fn ids(&self) -> Vec<u32> {
        self.patterns.keys().copied().collect()
    }

    /// Pattern `id`, if the table has it.
    #[must_use]
    pub fn pattern(&self, id: u32) -> Option<Pattern> {
        self.patterns.get(&id).cloned()
    }
}
