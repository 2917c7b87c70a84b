//! Results of another build of the program set aside, so that everything is solved anew in their place.

use std::path::{Path, PathBuf};

use super::folders_inside::folder_of_shard;
use super::lock::FolderLock;
use super::results_folder::{RESPONSES, VERSION, differences};
use crate::identity;
use crate::population::table::{
    Manifest, PartHeader, Shard, Standing, TableError, supersede, unlisted_parts,
};
use crate::study::{PipelineError, Study, StudyDigest};

/// Moves the results in the folder `results`, or in that of a shard below it, to `superseded/`, unless this
/// build solved them; where they are now, if any were moved. Results that nothing vouches for, because files of them are
/// lost or damaged, are moved as well. `blisk run` then solves the study from its beginning.
///
/// # Errors
/// The folder holds a different study or is in use, or a file cannot be moved.
pub fn set_other_builds_aside(
    results: &Path,
    study: &Study,
    shard: Option<Shard>,
) -> Result<Option<PathBuf>, PipelineError> {
    let folder = match shard {
        None => results.to_owned(),
        Some(shard) => folder_of_shard(results, shard)?,
    };
    if !folder.is_dir() {
        return Ok(None);
    }
    let (_lock, _) = FolderLock::take(&folder)?;
    if is_of_this_build(&folder)? {
        return Ok(None);
    }
    if let Ok(Some(manifest)) = Manifest::read(&folder) {
        let digest = StudyDigest::of(study)?;
        let mut differences = differences(&manifest, study, &digest, shard);
        // Another build may know other keys, each with a default.
        differences.retain(|(key, theirs, ours)| {
            key != VERSION && theirs != "(absent)" && ours != "(absent)"
        });
        if !differences.is_empty() {
            return Err(PipelineError::DifferentStudy {
                folder,
                differences,
            });
        }
    }
    Ok(supersede(&folder)?)
}

/// Whether everything that rows are taken from was solved by this build.
fn is_of_this_build(folder: &Path) -> Result<bool, TableError> {
    let stands =
        [folder.to_owned(), folder.join("next")].map(|place| build_of(Manifest::read(&place)));
    let mut known = false;
    for build in stands {
        match build? {
            Stored::Nothing => {}
            Stored::Rows(build) if build == identity::BUILD => known = true,
            Stored::Rows(_) | Stored::Damaged => return Ok(false),
        }
    }
    let header = PartHeader::read(folder).map(|header| header.map(|header| header.build));
    let parts = match header {
        Ok(Some(build)) => build == identity::BUILD,
        Ok(None) => unlisted_parts(folder)?.is_empty(),
        Err(TableError::Damaged { .. }) => false,
        Err(error) => return Err(error),
    };
    let table = folder.join(RESPONSES);
    let table = Standing::at(&table).map_err(|source| TableError::Io {
        action: "read",
        path: table,
        source,
    })?;
    Ok(parts && (known || table == Standing::Nothing))
}

/// Whose rows a manifest is about.
enum Stored {
    Nothing,
    Rows(String),
    Damaged,
}

fn build_of(manifest: Result<Option<Manifest>, TableError>) -> Result<Stored, TableError> {
    match manifest {
        Ok(None) => Ok(Stored::Nothing),
        Ok(Some(manifest)) => Ok(Stored::Rows(manifest.build)),
        Err(TableError::Damaged { .. }) => Ok(Stored::Damaged),
        Err(error) => Err(error),
    }
}
