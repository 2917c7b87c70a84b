//! Finished tables take the place of older ones all together, whatever happens in between.
//!
//! They are written into `next/`, the manifest with their digests last. Once that manifest stands,
//! the change is decided: the files are moved into their places, the manifest last, and whoever is
//! interrupted leaves a `next/` from which [`complete_publication`] goes on.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::atomic::{move_file, writer_of_temporary};
use super::part_header::PartHeader;
use super::places::{
    DAMAGED, NEXT, PARTS, SIDE_FILES, SUPERSEDED, Standing, TABLES, is_file, is_folder,
};
use super::{MANIFEST, Manifest, RowFile, TableError, digest_file, remove_parts};

/// Tables on their way into the results folder.
#[derive(Debug)]
pub struct Staging {
    results: PathBuf,
    tables: Vec<String>,
}

impl Staging {
    /// Begins in the results folder `results`.
    ///
    /// # Errors
    /// What an earlier attempt left cannot be removed.
    pub fn begin(results: &Path) -> Result<Self, TableError> {
        discard(results)?;
        Ok(Self {
            results: results.to_owned(),
            tables: Vec::new(),
        })
    }

    /// Where to write the table `name`.
    pub fn table(&mut self, name: &str) -> PathBuf {
        self.tables.push(name.to_owned());
        self.results.join(NEXT).join(name)
    }

    /// Puts all tables and `manifest`, which gets their digests, into their places, and removes the
    /// parts, whose rows the tables hold.
    ///
    /// # Errors
    /// A file cannot be read or moved.
    pub fn publish(self, mut manifest: Manifest) -> Result<Manifest, TableError> {
        let next = self.results.join(NEXT);
        for name in self.tables {
            let path = next.join(&name);
            let digest = digest_file(&path).map_err(TableError::io("read", &path))?;
            manifest.tables.insert(name, digest);
        }
        manifest.write(&next)?;
        complete_publication(&self.results)?;
        Ok(manifest)
    }
}

/// Completes a change that was decided on and interrupted; discards one that was not. True if there
/// was one to complete.
///
/// # Errors
/// A file cannot be moved, or is damaged or missing; nothing is changed then.
pub fn complete_publication(results: &Path) -> Result<bool, TableError> {
    let next = results.join(NEXT);
    is_folder(&next)?;
    let Some(manifest) = Manifest::read(&next)? else {
        discard(results)?;
        return Ok(false);
    };
    // Parts are removed for these tables, so all of them have to be there before anything is changed.
    for (name, digest) in &manifest.tables {
        let staged = next.join(name);
        let waits = is_file(&staged)?;
        let table = RowFile {
            path: if waits { staged } else { results.join(name) },
            digest: digest.clone(),
            from: 0,
        };
        table.check()?;
    }
    // Tables that the study no longer has go first: the manifest in place may still name them.
    if let Ok(Some(before)) = Manifest::read(results) {
        for name in before.tables.keys() {
            let path = results.join(name);
            if !manifest.tables.contains_key(name) && is_file(&path)? {
                std::fs::remove_file(&path).map_err(TableError::io("remove", &path))?;
            }
        }
    }
    for name in manifest.tables.keys() {
        let staged = next.join(name);
        if is_file(&staged)? {
            move_file(&staged, &results.join(name))?;
        }
    }
    remove_parts(results)?;
    move_file(&next.join(MANIFEST), &results.join(MANIFEST))?;
    discard(results)?;
    Ok(true)
}

/// Removes what waits in `next/`; what no command writes there stays, and the folder with it.
pub(super) fn discard(results: &Path) -> Result<(), TableError> {
    let next = results.join(NEXT);
    if !is_folder(&next)? {
        return Ok(());
    }
    for entry in std::fs::read_dir(&next).map_err(TableError::io("read", &next))? {
        let path = entry.map_err(TableError::io("read", &next))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let mut written = TABLES.iter().chain(&SIDE_FILES).chain(&[MANIFEST]);
        let is_ours = written.any(|known| *known == name) || writer_of_temporary(&name).is_some();
        if is_ours && stands(&path)? != Standing::Folder {
            std::fs::remove_file(&path).map_err(TableError::io("remove", &path))?;
        }
    }
    match std::fs::remove_dir(&next) {
        Err(error) if error.kind() != ErrorKind::DirectoryNotEmpty => {
            Err(TableError::io("remove", &next)(error))
        }
        _ => Ok(()),
    }
}

/// Makes the file of rows `path` of the results folder `results`, if it is there, a part of it.
///
/// # Errors
/// The file cannot be moved.
pub fn keep_as_part(results: &Path, path: &Path, digest: &str) -> Result<(), TableError> {
    if !is_file(path)? {
        return Ok(());
    }
    let name = format!("part-{:010}-{digest}.parquet", 0);
    let mut header = PartHeader::read(results)?.unwrap_or_default();
    header.announce(results, &name)?;
    move_file(path, &results.join(PARTS).join(name))?;
    header.close(results)
}

/// Moves a damaged file of the results folder `results` to `damaged/`, under a free name; its new place.
///
/// # Errors
/// The file cannot be moved.
pub fn set_aside(results: &Path, path: &Path) -> Result<PathBuf, TableError> {
    let name = path
        .file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let folder = results.join(DAMAGED);
    is_folder(&folder)?;
    let mut place = folder.join(&name);
    for number in 1.. {
        if stands(&place)? == Standing::Nothing {
            break;
        }
        place = folder.join(format!("{name}.{number}"));
    }
    move_file(path, &place)?;
    Ok(place)
}

/// Moves results, parts and records of runs of the results folder `results` to a folder of their own in
/// `superseded/`; that folder, if there was anything to move.
///
/// # Errors
/// A file cannot be moved.
pub fn supersede(results: &Path) -> Result<Option<PathBuf>, TableError> {
    let aside = results.join(SUPERSEDED);
    is_folder(&aside)?;
    let mut number = 1;
    while stands(&aside.join(number.to_string()))? != Standing::Nothing {
        number += 1;
    }
    let place = aside.join(number.to_string());
    let mut moved = false;
    // The manifest goes first: without it nothing vouches for what an interrupted move leaves. Rows go last: as long as
    // they stand, the move is gone on with.
    let [rows, tables @ ..] = TABLES;
    let names = [MANIFEST, NEXT, "runs"].into_iter();
    for name in names.chain(SIDE_FILES).chain(tables).chain([rows, PARTS]) {
        let path = results.join(name);
        if stands(&path)? != Standing::Nothing {
            move_file(&path, &place.join(name))?;
            moved = true;
        }
    }
    Ok(moved.then_some(place))
}

fn stands(path: &Path) -> Result<Standing, TableError> {
    Standing::at(path).map_err(TableError::io("read", path))
}
