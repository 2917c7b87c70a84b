//! Runs in a results folder, and what they leave there.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI64, Ordering};

use blisk::campaign::{RunOutcome, RunRequest, run};
use blisk::response::harmonic_balance::Status;
use blisk::settings::Progress;
use blisk::study::{PipelineError, Study};

use crate::mock_engine::{MockSource, study};

/// A listener without a word.
pub struct Silent;

impl Progress for Silent {}

/// Asks the run to stop after some rows.
pub struct Stopping {
    rows_left: AtomicI64,
}

impl Stopping {
    pub fn after(rows: i64) -> Self {
        Self {
            rows_left: AtomicI64::new(rows),
        }
    }
}

impl Progress for Stopping {
    fn row(&self, _status: Status) {
        self.rows_left.fetch_sub(1, Ordering::SeqCst);
    }

    fn stop_requested(&self) -> bool {
        self.rows_left.load(Ordering::SeqCst) <= 0
    }
}

pub fn run_in(
    folder: &Path,
    study: &Study,
    threads: usize,
    source: &MockSource,
) -> Result<RunOutcome, PipelineError> {
    let request = RunRequest {
        study,
        results: folder,
        threads,
    };
    run(request, source, &Silent)
}

/// Stops the run of `study` after about `rows` rows.
pub fn interrupt_in(folder: &Path, study: &Study, rows: i64) {
    let request = RunRequest {
        study,
        results: folder,
        threads: 2,
    };
    let stopped = run(request, &MockSource::default(), &Stopping::after(rows));
    assert!(matches!(stopped, Err(PipelineError::Interrupted { .. })));
}

const FILES: [&str; 7] = [
    "responses.parquet",
    "scenarios.parquet",
    "percentiles.parquet",
    "distribution.parquet",
    "patterns.parquet",
    "manifest.json",
    "summary.txt",
];

/// The results, byte by byte.
pub fn bytes(folder: &Path) -> Vec<Vec<u8>> {
    FILES
        .iter()
        .map(|file| std::fs::read(folder.join(file)).expect(file))
        .collect()
}

/// The results of an undisturbed run of `study`.
pub fn reference_of(study: &Study) -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let outcome = run_in(folder.path(), study, 1, &MockSource::default()).expect("the run");
    let rows = study.scenarios().len() as u64 * u64::from(study.patterns);
    assert_eq!(outcome.rows_solved, rows);
    bytes(folder.path())
}

pub fn reference(patterns: u32) -> Vec<Vec<u8>> {
    reference_of(&study(patterns, |text| text))
}

/// All files below `folder`, ascending.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Copies all files below `from` to `to`.
pub fn copy(from: &Path, to: &Path) {
    for file in files(from) {
        let target = to.join(file.strip_prefix(from).expect("below"));
        std::fs::create_dir_all(target.parent().expect("a folder")).expect("made");
        std::fs::copy(&file, &target).expect("copied");
    }
}
