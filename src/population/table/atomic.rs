//! Files that appear whole or not at all: written beside their place, synced, then renamed.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::TableError;

/// A file under construction; without [`AtomicFile::commit`] it vanishes.
#[derive(Debug)]
pub(super) struct AtomicFile {
    target: PathBuf,
    temporary: PathBuf,
    file: File,
    committed: bool,
}

impl AtomicFile {
    /// Opens a temporary file in the folder of `target`, which is made if need be.
    pub(super) fn create(target: &Path) -> Result<Self, TableError> {
        if let Some(folder) = folder_of(target) {
            std::fs::create_dir_all(folder).map_err(TableError::io("create the folder", folder))?;
        }
        let name = target
            .file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let temporary = target.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
        let file = File::create(&temporary).map_err(TableError::io("create", &temporary))?;
        Ok(Self {
            target: target.to_owned(),
            temporary,
            file,
            committed: false,
        })
    }

    /// A second handle to the open file.
    pub(super) fn handle(&self) -> Result<File, TableError> {
        self.file
            .try_clone()
            .map_err(TableError::io("open", &self.temporary))
    }

    /// Syncs the content and puts the file in its place.
    pub(super) fn commit(mut self) -> Result<(), TableError> {
        self.file
            .sync_all()
            .map_err(TableError::io("sync", &self.temporary))?;
        std::fs::rename(&self.temporary, &self.target)
            .map_err(TableError::io("rename a finished file to", &self.target))?;
        self.committed = true;
        // The rename itself is durable once the folder is synced, where a folder can be opened.
        if let Some(Ok(folder)) = folder_of(&self.target).map(File::open) {
            folder
                .sync_all()
                .map_err(TableError::io("sync the folder of", &self.target))?;
        }
        Ok(())
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if !self.committed {
            // Nothing more can be done about a leftover than to try to remove it.
            let _ = std::fs::remove_file(&self.temporary);
        }
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

/// Writes `content` to `target` atomically.
///
/// # Errors
/// The file system refused.
pub fn write_atomically(target: &Path, content: &[u8]) -> Result<(), TableError> {
    let file = AtomicFile::create(target)?;
    file.handle()?
        .write_all(content)
        .map_err(TableError::io("write", target))?;
    file.commit()
}
