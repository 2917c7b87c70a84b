//! The file layer: files that appear whole or not at all, and are known by their BLAKE3 digest.
//!
//! A file is written beside its place, synced, renamed, and its folder synced. Whoever is
//! interrupted leaves a hidden `.*.tmp`, which [`remove_leftovers`] takes away.

use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::TableError;
use crate::model::writer_of_leftover;
use crate::platform;

/// Bytes that are gathered before they are written.
const BUFFER: usize = 1 << 16;

/// BLAKE3 digest of a file, hexadecimal.
///
/// # Errors
/// The file cannot be read.
pub fn digest_file(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// Temporary files of this process.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the files that this process has under construction and lets it neither begin nor finish another:
/// for a process that ends at once.
pub fn abandon_unfinished() {
    let files = unfinished();
    for path in &*files {
        // Whoever writes to the folder next tries again.
        let _ = std::fs::remove_file(path);
    }
    // Nobody gets the list any more.
    std::mem::forget(files);
}

/// A file under construction; without [`AtomicFile::commit`] it vanishes.
#[derive(Debug)]
pub(super) struct AtomicFile {
    target: PathBuf,
    temporary: PathBuf,
    file: File,
    failure: Failure,
    committed: bool,
}

/// The first error of the file system while a file was written.
type Failure = Arc<Mutex<Option<io::Error>>>;

/// An open file under construction; keeps the error of the file system, which encoders turn into words.
#[derive(Debug)]
pub(super) struct BufferedFile {
    file: BufWriter<File>,
    failure: Failure,
}

impl BufferedFile {
    fn keep<T>(&self, written: io::Result<T>) -> io::Result<T> {
        written.inspect_err(|error| {
            let same = match error.raw_os_error() {
                Some(code) => io::Error::from_raw_os_error(code),
                None => io::Error::from(error.kind()),
            };
            if let Ok(mut kept) = self.failure.lock() {
                kept.get_or_insert(same);
            }
        })
    }
}

impl Write for BufferedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        self.keep(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.keep(flushed)
    }
}

impl AtomicFile {
    /// Opens a temporary file in the folder of `target`, which is made if need be.
    pub(super) fn create(target: &Path) -> Result<Self, TableError> {
        if is_special(target) {
            let reason = "a device or pipe is no place for this file";
            let error = io::Error::new(io::ErrorKind::InvalidInput, reason);
            return Err(TableError::io("write", target)(error));
        }
        if let Some(folder) = folder_of(target) {
            std::fs::create_dir_all(folder).map_err(TableError::io("create the folder", folder))?;
        }
        let name = target
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let temporary = target.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
        let file = {
            let mut unfinished = unfinished();
            // What a killed process with the same number left, or a link of that name, is not written to.
            let _ = std::fs::remove_file(&temporary);
            let created = File::create_new(&temporary);
            let file = created.map_err(TableError::io("create", &temporary))?;
            unfinished.insert(temporary.clone());
            file
        };
        Ok(Self {
            target: target.to_owned(),
            temporary,
            file,
            failure: Failure::default(),
            committed: false,
        })
    }

    /// The open file, to be written to from its beginning and flushed before the commit.
    pub(super) fn writer(&self) -> Result<BufferedFile, TableError> {
        let file = self
            .file
            .try_clone()
            .map_err(TableError::io("open", &self.temporary))?;
        Ok(BufferedFile {
            file: BufWriter::with_capacity(BUFFER, file),
            failure: Arc::clone(&self.failure),
        })
    }

    /// Why writing failed: what the file system said, or else `reason`.
    pub(super) fn failed(&self, reason: impl Display) -> TableError {
        let failure = self.failure.lock().ok().and_then(|mut kept| kept.take());
        match failure {
            Some(source) => TableError::io("write", &self.target)(source),
            None => TableError::encoding(&self.target, reason.to_string()),
        }
    }

    /// Syncs the content and puts the file in its place.
    pub(super) fn commit(self) -> Result<(), TableError> {
        let target = self.target.clone();
        self.commit_to(&target)
    }

    /// Syncs the content and puts the file in its folder under a name made from its digest; `name` is
    /// called when the content is written and before the file takes its place.
    pub(super) fn commit_as(
        self,
        name: impl FnOnce(&str) -> Result<String, TableError>,
    ) -> Result<(), TableError> {
        let digest =
            digest_file(&self.temporary).map_err(TableError::io("read", &self.temporary))?;
        let target = self.target.with_file_name(name(&digest)?);
        self.commit_to(&target)
    }

    fn commit_to(mut self, target: &Path) -> Result<(), TableError> {
        self.file
            .sync_all()
            .map_err(TableError::io("sync", &self.temporary))?;
        {
            let mut unfinished = unfinished();
            std::fs::rename(&self.temporary, target)
                .map_err(TableError::io("rename a finished file to", target))?;
            unfinished.remove(&self.temporary);
            self.committed = true;
        }
        sync_folder_of(target)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if !self.committed {
            unfinished().remove(&self.temporary);
            // Nothing more can be done about a leftover than to try to remove it.
            let _ = std::fs::remove_file(&self.temporary);
        }
    }
}

/// Moves a finished file to another place on the same file system, durably.
pub(super) fn move_file(from: &Path, to: &Path) -> Result<(), TableError> {
    if let Some(folder) = folder_of(to) {
        std::fs::create_dir_all(folder).map_err(TableError::io("create the folder", folder))?;
    }
    std::fs::rename(from, to).map_err(TableError::io("rename a finished file to", to))?;
    sync_folder_of(to)
}

/// Removes what interrupted writes of processes that have ended left in `folder`.
///
/// # Errors
/// The folder cannot be read or changed.
pub fn remove_leftovers(folder: &Path) -> Result<(), TableError> {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(TableError::io("read", folder)(error)),
    };
    for entry in entries {
        let path = entry.map_err(TableError::io("read", folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let writer = writer_of_temporary(&name).or_else(|| writer_of_leftover(&name));
        let ended = |process: u32| platform::process_start(process).is_none();
        if writer.is_some_and(ended) && !path.is_dir() {
            match std::fs::remove_file(&path) {
                // Another process that has just begun has removed it.
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                removed => removed.map_err(TableError::io("remove", &path))?,
            }
        }
    }
    Ok(())
}

/// The process that writes, or wrote and did not finish, the hidden file `name`; none for any other file.
pub(super) fn writer_of_temporary(name: &str) -> Option<u32> {
    let (_, process) = name
        .strip_prefix('.')?
        .strip_suffix(".tmp")?
        .rsplit_once('.')?;
    process.parse().ok()
}

/// A rename is durable once the folder is synced, where a folder can be opened.
fn sync_folder_of(target: &Path) -> Result<(), TableError> {
    match folder_of(target).map(File::open) {
        Some(Ok(folder)) => folder
            .sync_all()
            .map_err(TableError::io("sync the folder of", target)),
        _ => Ok(()),
    }
}

fn folder_of(target: &Path) -> Option<&Path> {
    target.parent().map(|folder| {
        if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        }
    })
}

/// Whether `target` is there and is neither a file nor a folder: a device or a pipe, which a rename would replace.
fn is_special(target: &Path) -> bool {
    std::fs::metadata(target).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Writes `content` to `target` atomically; to a device or a pipe, as it comes.
///
/// # Errors
/// The file system refused.
pub fn write_atomically(target: &Path, content: &[u8]) -> Result<(), TableError> {
    if is_special(target) {
        let written = File::options()
            .write(true)
            .open(target)
            .and_then(|mut file| file.write_all(content));
        return written.map_err(TableError::io("write", target));
    }
    let file = AtomicFile::create(target)?;
    let mut writer = file.writer()?;
    let written = writer.write_all(content).and_then(|()| writer.flush());
    written.map_err(|error| file.failed(error))?;
    file.commit()
}
