//! What a report was made from: version, commit, a digest of the sources, and the day.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use super::super::support::package;

/// What the numbers of a report follow from, besides the compiler.
const SOURCES: [&str; 9] = [
    "Cargo.toml",
    "Cargo.lock",
    "src",
    "studies",
    "tests/cases/one_dof.rs",
    "tests/cases/support.rs",
    "tests/cases/validation",
    "tests/cases/wheels.rs",
    "tests/data",
];

/// The build and the day of a report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// What `blisk --version` says.
    pub program: String,
    /// Commit of the working tree, `-changed` if files differ from it.
    pub commit: String,
    /// Digest of the files that the numbers follow from.
    pub sources: String,
    /// Day in UTC.
    pub date: String,
}

impl Identity {
    /// That of the tree and the program at hand.
    pub fn now() -> Self {
        Self {
            program: program(),
            commit: commit(),
            sources: digest(&SOURCES.map(package)),
            date: date(
                SystemTime::now()
                    .duration_since(UNIX_EPOCH)
                    .unwrap()
                    .as_secs(),
            ),
        }
    }

    /// The line of the pages that are made with the verdicts.
    pub fn line(&self) -> String {
        format!(
            "Made on {} by `studies/validation/run.sh` with {}, commit {}, sources {}.",
            self.date,
            self.program,
            &self.commit,
            &self.sources[..16]
        )
    }
}

fn program() -> String {
    let ended = Command::new(env!("CARGO_BIN_EXE_blisk"))
        .arg("--version")
        .output()
        .unwrap();
    let text = String::from_utf8(ended.stdout).unwrap();
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn commit() -> String {
    let git = |arguments: &[&str]| {
        let mut command = Command::new("git");
        command.args(arguments).current_dir(package("."));
        let ended = command.output().ok().filter(|ended| ended.status.success());
        ended.map(|ended| String::from_utf8(ended.stdout).unwrap().trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else {
        return "unknown".to_owned();
    };
    let mut changed = vec!["status", "--porcelain", "--"];
    changed.extend(SOURCES);
    let clean = git(&changed).is_some_and(|list| list.is_empty());
    if clean { commit } else { commit + "-changed" }
}

/// Digest of files and of all files of folders, with their paths.
fn digest(roots: &[PathBuf]) -> String {
    let mut files = Vec::new();
    for root in roots {
        collect(root, &mut files);
    }
    files.sort();
    let top = package("");
    let mut hasher = blake3::Hasher::new();
    for path in files {
        let name = path.strip_prefix(&top).unwrap_or(&path);
        let bytes = std::fs::read(&path).unwrap();
        hasher.update(name.to_string_lossy().as_bytes());
        hasher.update(&[0]);
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(&bytes);
    }
    let mut text = String::new();
    for byte in hasher.finalize().as_bytes() {
        write!(text, "{byte:02x}").unwrap();
    }
    text
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        for entry in std::fs::read_dir(path).unwrap() {
            collect(&entry.unwrap().path(), files);
        }
    } else {
        files.push(path.to_owned());
    }
}

/// Day of a number of seconds since 1970, in the Gregorian calendar.
fn date(seconds: u64) -> String {
    let is_leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut days = seconds / 86_400;
    let mut year = 1970;
    loop {
        let length = 365 + u64::from(is_leap(year));
        if days < length {
            break;
        }
        days -= length;
        year += 1;
    }
    let february = 28 + u64::from(is_leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}

#[cfg(test)]
mod tests {
    use super::{date, digest};

    #[test]
    fn days_are_those_of_the_calendar() {
        for (seconds, day) in [
            (0, "1970-01-01"),
            (951_782_400, "2000-02-29"),
            (1_709_251_199, "2024-02-29"),
            (1_767_225_599, "2025-12-31"),
            (4_107_542_400, "2100-03-01"),
        ] {
            assert_eq!(date(seconds), day);
        }
    }

    #[test]
    fn a_digest_follows_contents_and_names() {
        let folder = tempfile::tempdir().unwrap();
        let of = || digest(&[folder.path().to_owned()]);
        std::fs::write(folder.path().join("a"), "one").unwrap();
        let first = of();
        assert_eq!(first, of());
        std::fs::write(folder.path().join("a"), "two").unwrap();
        let second = of();
        assert_ne!(first, second);
        std::fs::rename(folder.path().join("a"), folder.path().join("b")).unwrap();
        assert_ne!(second, of());
    }
}
