//! One table of a results folder, found and checked against its digest, for readers outside of the program.

use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use super::results_folder::verify_tables;
use crate::population::table::{
    Manifest, RunState, SIDE_FILES, SideTables, TABLES, TableError, is_file,
};
use crate::study::PipelineError;

/// The file of the table `name`, like `responses.parquet`, of the folder `results`, after a look at its digest.
///
/// A table that nothing notes a digest of, such as `tail_fits.parquet`, is taken as it is.
///
/// # Errors
/// The folder has no such table, it is not as it was written, or the study is not finished.
pub fn checked_table(results: &Path, name: &str) -> Result<PathBuf, PipelineError> {
    let path = results.join(name);
    let is_there = if TABLES.contains(&name) {
        let mut manifest = Manifest::read(results)?.ok_or_else(|| PipelineError::NoResults {
            folder: results.to_owned(),
        })?;
        if manifest.state != RunState::Finished {
            return Err(PipelineError::Unfinished {
                folder: results.to_owned(),
            });
        }
        manifest.tables.retain(|table, _| table == name);
        verify_tables(results, &manifest)?;
        !manifest.tables.is_empty()
    } else if SIDE_FILES.contains(&name) {
        if let Some(noted) = SideTables::read(results)?.tables.get(name) {
            noted.check(&path)?;
        }
        is_file(&path)?
    } else {
        false
    };
    if is_there {
        return Ok(path);
    }
    Err(PipelineError::Table(TableError::Io {
        action: "read",
        path,
        source: Error::new(ErrorKind::NotFound, "the results have no such table"),
    }))
}
