//! The study of a results folder, put together again from its manifest.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::results_folder::verify_tables;
use crate::identity;
use crate::model::sector::SectorModel;
use crate::population::monte_carlo::{LoadCaseName, ResponseRow, Scenario, TunedReference};
use crate::population::table::{
    Manifest, ResponseReader, RunRecord, RunState, ScenarioEntry, TableError, is_folder,
};
use crate::response::mistuning::{Pattern, PatternSource};
use crate::settings::EngineSource;
use crate::study::{PipelineError, Study, StudyDigest, load_sector_model, pattern_source};

/// A finished study with its results.
#[derive(Debug)]
pub struct StoredStudy {
    /// The results folder.
    pub folder: PathBuf,
    /// Its manifest.
    pub manifest: Manifest,
    /// The study that the manifest holds.
    pub study: Study,
}

/// What a stored study is solved with again.
pub struct StoredModel {
    /// The sector model.
    pub sector: SectorModel,
    /// The patterns.
    pub patterns: PatternSource,
}

impl StoredStudy {
    /// The study of the folder `results`. Its inputs are sought beside `study_file`, or beside the
    /// study file of the last run.
    ///
    /// # Errors
    /// The folder holds no finished study, a table of it is damaged, an input is missing or has changed since, or the study is
    /// one of another version of the program.
    pub fn open(results: &Path, study_file: Option<&Path>) -> Result<Self, PipelineError> {
        let folder = results.to_owned();
        let Some(manifest) = Manifest::read(results)? else {
            return Err(PipelineError::NoResults { folder });
        };
        if manifest.state != RunState::Finished {
            return Err(PipelineError::Unfinished { folder });
        }
        verify_tables(results, &manifest)?;
        let beside = study_file.map(Path::to_owned).or_else(|| {
            let last = RunRecord::all(results).into_iter().next()?;
            (!last.study_file.as_os_str().is_empty()).then_some(last.study_file)
        });
        let beside = beside.unwrap_or_else(|| results.join("manifest.json"));
        let study = study_of(&manifest.study, &beside, results)?;
        let differences = StudyDigest::of(&study)?.differences(&manifest.number_keys);
        if !differences.is_empty() {
            return Err(PipelineError::InputsChanged {
                folder,
                differences,
            });
        }
        Ok(Self {
            folder,
            manifest,
            study,
        })
    }

    /// The results of the study in the file `study_file`, in the folder `results`.
    ///
    /// # Errors
    /// The study file cannot be read, the folder holds no finished study or a different one, a table of it is damaged, an
    /// input is missing or has changed since, or the study is one of another version of the program.
    pub fn of_study(study_file: &Path, results: &Path) -> Result<Self, PipelineError> {
        let study = Study::read(study_file)?;
        let folder = results.to_owned();
        let Some(manifest) = Manifest::read(results)? else {
            return Err(PipelineError::NoResults { folder });
        };
        let differences = StudyDigest::of(&study)?.differences(&manifest.number_keys);
        if !differences.is_empty() {
            return Err(PipelineError::DifferentStudy {
                folder,
                differences,
            });
        }
        Self::open(results, Some(study_file))
    }

    /// This stored study, read again from its folder as it stands now: for a process that has locked the folder since, as
    /// another process may have written there.
    ///
    /// # Errors
    /// The folder holds no finished study, a table of it is damaged, an input is missing or has changed since, or the study is
    /// one of another version of the program.
    pub(in crate::campaign) fn again(&self) -> Result<Self, PipelineError> {
        Self::open(&self.folder, Some(&self.study.path))
    }

    /// What to say of the builds of the program where another one solved the rows.
    #[must_use]
    pub fn other_build(&self) -> Option<String> {
        let stored = &self.manifest.build;
        (stored != identity::BUILD).then(|| {
            format!(
                "build {} solved the rows of {}, and this program is build {}",
                identity::named(stored),
                self.folder.display(),
                identity::BUILD
            )
        })
    }

    /// Sector model and patterns, from the inputs.
    ///
    /// # Errors
    /// The model is refused, or the patterns do not fit to it.
    pub fn model(&self) -> Result<StoredModel, PipelineError> {
        let sector = load_sector_model(&self.study)?;
        Ok(StoredModel {
            patterns: pattern_source(&self.study, &sector)?,
            sector,
        })
    }

    /// The engine of the run, its reduced model taken from the folder where it is kept there.
    ///
    /// # Errors
    /// The model cannot be reduced.
    pub fn engine(
        &self,
        model: &StoredModel,
        source: &dyn EngineSource,
    ) -> Result<Box<dyn crate::settings::Engine>, PipelineError> {
        let cache = self.folder.join("model");
        let cache = is_folder(&cache)?.then_some(cache);
        source.build(&self.study, &model.sector, cache.as_deref())
    }

    /// Load case of each scenario; empty where the study has none.
    #[must_use]
    pub(in crate::campaign) fn load_cases(&self) -> Vec<LoadCaseName> {
        let entries = self.manifest.scenarios.iter();
        entries.filter_map(|entry| entry.load_case).collect()
    }

    /// A scenario with its tuned reference as delivered; none if there is no such scenario.
    #[must_use]
    pub fn scenario(&self, index: usize) -> Option<(Scenario, TunedReference)> {
        let entry: &ScenarioEntry = self.manifest.scenarios.get(index)?;
        Some((entry.keys(), entry.tuned()))
    }

    /// The delivered rows at these places of `responses.parquet`, ascending.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn rows_at(&self, places: &[usize]) -> Result<Vec<ResponseRow>, TableError> {
        let reader = self.reader()?;
        let mut rows = Vec::with_capacity(places.len());
        let mut group: (usize, Vec<ResponseRow>) = (0, Vec::new());
        for &place in places.iter().filter(|&&place| place < reader.rows()) {
            let (first, of_group) = &group;
            if !(*first..first + of_group.len()).contains(&place) {
                group = reader.group_of(place)?;
            }
            rows.push(group.1[place - group.0].clone());
        }
        Ok(rows)
    }

    /// The delivered row of a scenario and pattern; none if there is no such row.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn row(&self, scenario: usize, pattern: u32) -> Result<Option<ResponseRow>, TableError> {
        let rows = self.filter(|row| row.scenario == scenario && row.pattern == pattern)?;
        Ok(rows.into_iter().next())
    }

    /// Number of delivered rows.
    ///
    /// # Errors
    /// The table cannot be read.
    pub fn row_count(&self) -> Result<usize, TableError> {
        Ok(self.reader()?.rows())
    }

    fn reader(&self) -> Result<ResponseReader, TableError> {
        ResponseReader::open(&self.folder.join("responses.parquet"))
    }

    fn filter(
        &self,
        wanted: impl Fn(&ResponseRow) -> bool,
    ) -> Result<Vec<ResponseRow>, TableError> {
        let mut reader = self.reader()?;
        let mut rows = Vec::new();
        loop {
            let batch = reader.next_batch()?;
            if batch.is_empty() {
                return Ok(rows);
            }
            rows.extend(batch.into_iter().filter(|row| wanted(row)));
        }
    }
}

impl StoredModel {
    /// The pattern of a row under a scenario; none if the study has no such pattern.
    #[must_use]
    pub fn pattern(&self, id: u32, scenario: &Scenario) -> Option<Pattern> {
        self.patterns.pattern(id, scenario.standard_deviation)
    }
}

/// The resolved study of a manifest as if it were the file `beside`.
pub(in crate::campaign) fn study_of(
    resolved: &Value,
    beside: &Path,
    results: &Path,
) -> Result<Study, PipelineError> {
    let damaged = |reason: String| TableError::Damaged {
        path: results.join("manifest.json"),
        reason,
    };
    let text = match toml_of(resolved) {
        Some(toml::Value::Table(table)) => {
            toml::to_string(&table).map_err(|error| damaged(error.to_string()))?
        }
        _ => return Err(damaged("its study is no table".to_owned()).into()),
    };
    Ok(Study::parse(beside, &text)?)
}

/// A JSON value as TOML, which has no null: none for null, whose key or place in a list is left out.
fn toml_of(value: &Value) -> Option<toml::Value> {
    Some(match value {
        Value::Null => return None,
        Value::Bool(flag) => toml::Value::Boolean(*flag),
        Value::Number(number) => match number.as_i64() {
            Some(integer) => toml::Value::Integer(integer),
            None => toml::Value::Float(number.as_f64()?),
        },
        Value::String(text) => toml::Value::String(text.clone()),
        Value::Array(values) => toml::Value::Array(values.iter().filter_map(toml_of).collect()),
        Value::Object(fields) => toml::Value::Table(
            fields
                .iter()
                .filter_map(|(key, value)| Some((key.clone(), toml_of(value)?)))
                .collect(),
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_resolved_study_of_every_example_is_read_back_as_the_same_study() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("studies");
        let mut count = 0;
        for entry in std::fs::read_dir(&folder).expect("the studies") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let study = Study::read(&path).expect("a valid study");
            let text = serde_json::to_string(&study.resolved()).expect("JSON");
            let value: Value = serde_json::from_str(&text).expect("JSON");
            let again = study_of(&value, &path, &folder).expect("the same study");
            assert_eq!(again.resolved(), study.resolved(), "{}", path.display());
            assert_eq!(again.scenarios(), study.scenarios());
            count += 1;
        }
        assert!(count >= 4);
    }
}
