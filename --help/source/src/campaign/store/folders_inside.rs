//! Results folders inside of a results folder: those of its shards, and of the loads of a search.

use std::collections::BTreeMap;
use std::fs::FileType;
use std::path::{Path, PathBuf};

use crate::population::table::{Shard, TableError, is_folder};
use crate::study::PipelineError;

/// The folder of a shard below the results folder `results`, whether it is there or not.
///
/// # Errors
/// Something else stands there, such as a link, or the file system refused.
pub(in crate::campaign) fn folder_of_shard(
    results: &Path,
    shard: Shard,
) -> Result<PathBuf, TableError> {
    let shards = results.join("shards");
    is_folder(&shards)?;
    let folder = shards.join(shard.folder_name());
    is_folder(&folder)?;
    Ok(folder)
}

/// The folders of shards below the results folder `results`, by count and number. Links are not followed.
pub(in crate::campaign) fn shard_folders(
    results: &Path,
) -> Result<BTreeMap<(u32, u32), PathBuf>, PipelineError> {
    let shards = results.join("shards");
    let mut found = BTreeMap::new();
    if !is_folder(&shards)? {
        return Ok(found);
    }
    let unread = |source| TableError::Io {
        action: "read",
        path: shards.clone(),
        source,
    };
    for entry in std::fs::read_dir(&shards).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        if let Some(shard) = Shard::of_folder(&path)
            && is_folder(&path)?
        {
            found.insert((shard.count, shard.number), path);
        }
    }
    Ok(found)
}

/// Folders of single loads that an earlier search in `results` made, by load.
pub(in crate::campaign) fn folders_of_loads(results: &Path) -> Vec<(f64, PathBuf)> {
    let entries = std::fs::read_dir(results).into_iter().flatten().flatten();
    let mut folders: Vec<(f64, PathBuf)> = entries
        .filter_map(|entry| {
            // A link could lead out of the folder.
            entry.file_type().ok().filter(FileType::is_dir)?;
            let name = entry.file_name();
            let load = name.to_str()?.strip_prefix("load-")?.parse().ok()?;
            Some((load, entry.path()))
        })
        .collect();
    folders.sort_by(|a, b| a.0.total_cmp(&b.0));
    folders
}
