//! Writer of one Parquet file, row group by row group, atomically, with described columns.

use std::path::{Path, PathBuf};

use polars::prelude::{BatchedWriter, KeyValueMetadata, ParquetCompression, ParquetWriter};
use polars_parquet::write::schema_to_metadata_key;
use serde::{Deserialize, Serialize};

use super::atomic::{AtomicFile, BufferedFile};
use super::column::{Values, described_schema, frame, key, polars_schema};
use super::{ColumnSpec, TableError};
use crate::identity;
use crate::population::monte_carlo::{LoadCaseName, Scenario};

/// Version of the tables; raised when a column changes its meaning.
pub const SCHEMA_VERSION: u32 = 1;

/// Key of the study digest in the metadata of a file.
pub(super) const STUDY_DIGEST_KEY: &str = "blisk.study_digest";
/// Key of the digests of what the rows of each scenario are made from, separated by commas.
pub(super) const ROW_DIGESTS_KEY: &str = "blisk.row_digests";

/// Compression of the pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Compression {
    /// Zstandard; small. Default.
    #[default]
    Zstd,
    /// Snappy; for readers without Zstandard.
    Snappy,
}

/// What every table of a study says about itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableHeader {
    /// Digest of the study, hexadecimal.
    pub study_digest: String,
    /// Compression of its tables.
    pub compression: Compression,
    /// Load case of each scenario, in their order; empty in a study without load cases. Every table
    /// with scenarios and engine orders then has the column `load_case`.
    pub load_cases: Vec<LoadCaseName>,
}

impl TableHeader {
    /// Load case of each of `scenarios`, where the study has any.
    #[must_use]
    pub fn load_cases_of(scenarios: &[Scenario]) -> Vec<LoadCaseName> {
        scenarios
            .iter()
            .filter_map(|scenario| scenario.load_case)
            .collect()
    }

    /// Place of the column `load_case` in a table of `columns`, if it has one.
    fn place_of_load_case(&self, columns: &[ColumnSpec]) -> Option<usize> {
        let has_load_cases = !self.load_cases.is_empty() && columns.contains(&key::SCENARIO);
        let engine_order = || columns.iter().position(|own| *own == key::ENGINE_ORDER);
        has_load_cases.then(engine_order).flatten()
    }

    fn metadata(&self, columns: &[ColumnSpec], more: &[(&str, String)]) -> KeyValueMetadata {
        let mut pairs = vec![
            (
                "blisk.schema_version".to_owned(),
                SCHEMA_VERSION.to_string(),
            ),
            ("blisk.version".to_owned(), identity::VERSION.to_owned()),
            (STUDY_DIGEST_KEY.to_owned(), self.study_digest.clone()),
        ];
        for (key, value) in more {
            pairs.push(((*key).to_owned(), value.clone()));
        }
        for column in columns {
            pairs.push((format!("unit.{}", column.name), column.unit.to_owned()));
            pairs.push((
                format!("description.{}", column.name),
                column.description.to_owned(),
            ));
        }
        // In the place of the schema that the writer would make, which says nothing about the columns.
        let schema = schema_to_metadata_key(&described_schema(columns));
        pairs.extend(schema.value.map(|value| (schema.key, value)));
        KeyValueMetadata::from_static(pairs)
    }
}

/// A Parquet file under construction.
pub(super) struct TableWriter {
    path: PathBuf,
    columns: Vec<ColumnSpec>,
    /// Place of the column `load_case`, and the load case of each scenario.
    load_case: Option<(usize, Vec<LoadCaseName>)>,
    file: AtomicFile,
    writer: BatchedWriter<BufferedFile>,
}

impl TableWriter {
    pub(super) fn create(
        path: &Path,
        columns: &'static [ColumnSpec],
        header: &TableHeader,
    ) -> Result<Self, TableError> {
        Self::create_with(path, columns, header, &[])
    }

    /// Creates the file `path` with `columns`, and with more key-value pairs in the metadata than
    /// those of `header`.
    pub(super) fn create_with(
        path: &Path,
        columns: &'static [ColumnSpec],
        header: &TableHeader,
        more: &[(&str, String)],
    ) -> Result<Self, TableError> {
        let mut columns = columns.to_vec();
        let load_case = header.place_of_load_case(&columns);
        if let Some(place) = load_case {
            columns.insert(place, key::LOAD_CASE);
        }
        let file = AtomicFile::create(path)?;
        let compression = match header.compression {
            Compression::Zstd => ParquetCompression::Zstd(None),
            Compression::Snappy => ParquetCompression::Snappy,
        };
        // One thread, so that the writer neither needs a pool of its own nor depends on its size.
        let writer = ParquetWriter::new(file.writer()?)
            .with_compression(compression)
            .set_parallel(false)
            .with_key_value_metadata(Some(header.metadata(&columns, more)))
            .batched(&polars_schema(&columns))
            .map_err(|error| file.failed(error))?;
        Ok(Self {
            path: path.to_owned(),
            columns,
            load_case: load_case.map(|place| (place, header.load_cases.clone())),
            file,
            writer,
        })
    }

    /// Writes one row group.
    pub(super) fn write(&mut self, mut values: Vec<Values>) -> Result<(), TableError> {
        if let Some((place, names)) = &self.load_case {
            let of_scenarios = self
                .columns
                .iter()
                .position(|own| *own == key::SCENARIO)
                .and_then(|scenario| names_of(values.get(scenario)?, names));
            let reason = "its scenarios have no load case";
            values.insert(
                *place,
                of_scenarios.ok_or_else(|| TableError::encoding(&self.path, reason.to_owned()))?,
            );
        }
        let frame = frame(&self.columns, values)
            .map_err(|error| TableError::encoding(&self.path, error))?;
        self.writer
            .write_batch(&frame)
            .map_err(|error| self.file.failed(error))
    }

    /// Writes the footer and puts the file in its place.
    pub(super) fn finish(self) -> Result<(), TableError> {
        self.writer
            .finish()
            .map_err(|error| self.file.failed(error))?;
        self.file.commit()
    }

    /// Writes the footer and puts the file in its folder under a name made from its digest.
    pub(super) fn finish_as(
        self,
        name: impl FnOnce(&str) -> Result<String, TableError>,
    ) -> Result<(), TableError> {
        self.writer
            .finish()
            .map_err(|error| self.file.failed(error))?;
        self.file.commit_as(name)
    }
}

/// The load cases of a column of scenarios; none where one of them has none.
fn names_of(scenarios: &Values, names: &[LoadCaseName]) -> Option<Values> {
    let Values::Int32(scenarios) = scenarios else {
        return None;
    };
    let of = |scenario: &Option<i32>| {
        let place = usize::try_from((*scenario)?).ok()?;
        Some(Some(names.get(place)?.to_string()))
    };
    let names: Option<Vec<Option<String>>> = scenarios.iter().map(of).collect();
    names.map(Values::String)
}
