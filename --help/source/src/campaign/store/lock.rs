//! The lock of a results folder: one process writes to it, and everyone can see which.
//!
//! The operating system holds the lock and lets go of it with the process, however that ends: after a
//! kill or a power failure nobody has to unlock. The content of the file says who holds it. Where the
//! file system knows no locks, that content decides alone: its process, by start time and boot of the
//! machine, lives or it does not.

use std::fs::{File, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::platform::{boot_identity, host_name, process_start};
use crate::population::table::{TableError, is_file};
use crate::study::PipelineError;

/// Name of the lock in its folder.
const LOCK: &str = ".lock";
/// Looks at a lock that is held before it counts as held: readers hold it for an instant.
const LOOKS: u32 = 4;
/// Time between them.
const PAUSE: Duration = Duration::from_millis(50);

/// The process that works, or last worked, in a results folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LockHolder {
    /// Process id.
    pub process: u32,
    /// Name of its machine.
    pub host: String,
    /// Boot of that machine; empty where it is not known.
    pub boot: String,
    /// Start of the process in the unit of its system; 0 where it is not known.
    pub process_start: u64,
    /// When it took the lock, seconds since 1970-01-01 UTC.
    pub since_unix_s: u64,
    /// Rows that it is to solve and those already stored when it began; none before it knows.
    pub rows: Option<(u64, u64)>,
}

impl std::fmt::Display for LockHolder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "process {} on {}", self.process, self.host)
    }
}

impl LockHolder {
    fn this() -> Self {
        let process = std::process::id();
        Self {
            process,
            host: host_name(),
            boot: boot_identity(),
            process_start: process_start(process).unwrap_or(0),
            since_unix_s: unix_seconds(),
            rows: None,
        }
    }

    /// Whether the process is known to have ended: `here` is a process of the machine that asks, and
    /// `start_of` tells the start of the processes that live there.
    fn has_ended(&self, here: &Self, start_of: impl Fn(u32) -> Option<u64>) -> bool {
        if self.host != here.host {
            return false;
        }
        if self.boot != here.boot {
            return true;
        }
        match start_of(self.process) {
            // The same number for a later process is another process.
            Some(start) => start != self.process_start,
            None => true,
        }
    }
}

/// A lock that is held as long as this is.
#[derive(Debug)]
pub(in crate::campaign) struct FolderLock {
    path: PathBuf,
    file: File,
    holder: LockHolder,
}

impl FolderLock {
    /// Locks the folder `folder`; also whoever held it before and did not let go of it by himself.
    pub(in crate::campaign) fn take(
        folder: &Path,
    ) -> Result<(Self, Option<LockHolder>), PipelineError> {
        let path = folder.join(LOCK);
        if let Err(TableError::Damaged { path, reason }) = is_file(&path) {
            let (reason, _) = reason.split_once(';').unwrap_or((&reason, ""));
            let reason = format!("{reason}; remove it");
            return Err(TableError::Damaged { path, reason }.into());
        }
        let io = |source| TableError::Io {
            action: "write to the folder",
            path: folder.to_owned(),
            source,
        };
        let file = File::options()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(io)?;
        let here = LockHolder::this();
        let held = |holder: Option<LockHolder>| PipelineError::Locked {
            folder: folder.to_owned(),
            holder: holder.map_or("another process".to_owned(), |holder| holder.to_string()),
        };
        let mut looks = 1;
        loop {
            match file.try_lock() {
                Ok(()) => break,
                Err(TryLockError::WouldBlock) if looks < LOOKS => {
                    looks += 1;
                    std::thread::sleep(PAUSE);
                }
                Err(TryLockError::WouldBlock) => return Err(held(read(&path))),
                Err(TryLockError::Error(_)) => {
                    // A file system without locks, or none to be had.
                    if let Some(holder) = read(&path)
                        && !holder.has_ended(&here, process_start)
                    {
                        return Err(held(Some(holder)));
                    }
                    break;
                }
            }
        }
        let before = read(&path);
        let mut lock = Self {
            path,
            file,
            holder: here,
        };
        lock.write().map_err(io)?;
        Ok((lock, before))
    }

    /// Lets everyone see how many rows are to be solved and how many were stored before.
    pub(super) fn announce(&mut self, planned: u64, stored: u64) -> Result<(), TableError> {
        self.holder.rows = Some((planned, stored));
        self.write().map_err(|source| TableError::Io {
            action: "write",
            path: self.path.clone(),
            source,
        })
    }

    fn write(&mut self) -> std::io::Result<()> {
        let text = serde_json::to_string(&self.holder)?;
        self.file.seek(SeekFrom::Start(0))?;
        self.file.set_len(0)?;
        self.file.write_all(text.as_bytes())
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        // An empty file says that nothing was broken off; if it cannot be emptied, the next one takes
        // the lock over all the same.
        let _ = self.file.set_len(0);
    }
}

/// Who works in the folder `folder`, and whether he still does; none if nobody does or was broken off.
pub(super) fn holder(folder: &Path) -> Option<(LockHolder, bool)> {
    let path = folder.join(LOCK);
    let holder = read(&path)?;
    let lives = match File::open(&path).map(|file| file.try_lock_shared()) {
        Ok(Ok(())) => false,
        Ok(Err(TryLockError::WouldBlock)) => true,
        _ => !holder.has_ended(&LockHolder::this(), process_start),
    };
    Some((holder, lives))
}

fn read(path: &Path) -> Option<LockHolder> {
    is_file(path).ok().filter(|there| *there)?;
    let mut text = String::new();
    File::open(path).ok()?.read_to_string(&mut text).ok()?;
    serde_json::from_str(&text).ok()
}

pub(in crate::campaign) fn unix_seconds() -> u64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_secs())
}

#[cfg(test)]
mod tests {
    use super::{FolderLock, LockHolder, holder};
    use crate::platform::process_start;
    use crate::study::PipelineError;

    #[test]
    fn a_process_that_was_killed_or_whose_number_or_machine_began_anew_has_ended() {
        let here = LockHolder::this();
        let lives = |_| Some(70);
        let before = LockHolder {
            process_start: 70,
            ..here.clone()
        };
        assert!(!before.has_ended(&here, lives));
        assert!(before.has_ended(&here, |_| None), "killed");
        assert!(before.has_ended(&here, |_| Some(71)), "number used again");
        let booted = LockHolder {
            boot: "another boot".to_owned(),
            ..before.clone()
        };
        assert!(booted.has_ended(&here, lives), "machine started again");
        let elsewhere = LockHolder {
            host: "elsewhere".to_owned(),
            ..booted
        };
        assert!(!elsewhere.has_ended(&here, |_| None), "nobody can know");
        assert!(here.process_start == 0 || process_start(here.process) == Some(here.process_start));
    }

    #[test]
    fn a_held_lock_names_its_process_and_a_broken_one_is_taken_over() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (mut lock, before) = FolderLock::take(folder.path()).expect("free");
        assert_eq!(before, None);
        lock.announce(30, 10).expect("written");
        let refused = FolderLock::take(folder.path()).expect_err("held");
        assert!(
            matches!(&refused, PipelineError::Locked { holder, .. } if *holder == lock.holder.to_string())
        );
        let (seen, lives) = holder(folder.path()).expect("someone");
        assert!(lives && seen.rows == Some((30, 10)));
        let killed = lock.holder.clone();
        // What a killed process leaves: its name in the file, and no lock.
        let text = std::fs::read(folder.path().join(".lock")).expect("read");
        drop(lock);
        assert_eq!(holder(folder.path()), None);
        std::fs::write(folder.path().join(".lock"), text).expect("written");
        assert!(holder(folder.path()).is_some_and(|(_, lives)| !lives));
        let (_lock, before) = FolderLock::take(folder.path()).expect("taken over");
        assert_eq!(before, Some(killed));
    }
}
