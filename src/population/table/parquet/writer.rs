//! Writer of one Parquet file, row group by row group, atomically, with described columns.

use std::path::{Path, PathBuf};

use polars::prelude::{BatchedWriter, KeyValueMetadata, ParquetCompression, ParquetWriter};
use polars_parquet::write::schema_to_metadata_key;

use super::columns::{described_schema, frame, polars_schema};
use crate::identity;
use crate::population::monte_carlo::LoadCaseName;
use crate::population::table::atomic::{AtomicFile, BufferedFile};
use crate::population::table::column::{Values, key};
use crate::population::table::header::STUDY_DIGEST_KEY;
use crate::population::table::{ColumnSpec, Compression, SCHEMA_VERSION, TableError, TableHeader};

/// A Parquet file under construction.
pub(in crate::population::table) struct TableWriter {
    path: PathBuf,
    columns: Vec<ColumnSpec>,
    /// Place of the column `load_case`, and the load case of each scenario.
    load_case: Option<(usize, Vec<LoadCaseName>)>,
    file: AtomicFile,
    writer: BatchedWriter<BufferedFile>,
}

impl TableWriter {
    pub(in crate::population::table) fn create(
        path: &Path,
        columns: &'static [ColumnSpec],
        header: &TableHeader,
    ) -> Result<Self, TableError> {
        Self::create_with(path, columns, header, &[])
    }

    /// Creates the file `path` with `columns`, and with more key-value pairs in the metadata than
    /// those of `header`.
    pub(in crate::population::table) fn create_with(
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
            .with_key_value_metadata(Some(metadata(header, &columns, more)))
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
    pub(in crate::population::table) fn write(
        &mut self,
        mut values: Vec<Values>,
    ) -> Result<(), TableError> {
        if let Some((place, names)) = &self.load_case {
            let of_scenarios = self
                .columns
                .iter()
                .position(|column| *column == key::SCENARIO)
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
    pub(in crate::population::table) fn finish(self) -> Result<(), TableError> {
        self.writer
            .finish()
            .map_err(|error| self.file.failed(error))?;
        self.file.commit()
    }

    /// Writes the footer and puts the file in its folder under a name made from its digest.
    pub(in crate::population::table) fn finish_as(
        self,
        name: impl FnOnce(&str) -> Result<String, TableError>,
    ) -> Result<(), TableError> {
        self.writer
            .finish()
            .map_err(|error| self.file.failed(error))?;
        self.file.commit_as(name)
    }
}

/// Version, study, and what each column holds.
fn metadata(
    header: &TableHeader,
    columns: &[ColumnSpec],
    more: &[(&str, String)],
) -> KeyValueMetadata {
    let mut pairs = vec![
        (
            "blisk.schema_version".to_owned(),
            SCHEMA_VERSION.to_string(),
        ),
        ("blisk.version".to_owned(), identity::VERSION.to_owned()),
        (STUDY_DIGEST_KEY.to_owned(), header.study_digest.clone()),
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
