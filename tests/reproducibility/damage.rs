//! A changed bit or a lost end of any file is found, or does no harm; never a wrong number.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use blisk::campaign::{
    RunOutcome, RunRequest, integrity, repair, run, status_of_folder, summarise,
};
use blisk::population::table::{Manifest, PartHeader, RunState, TableError, write_estimate};
use blisk::response::harmonic_balance::Status;
use blisk::settings::Progress;
use blisk::study::{PipelineError, Study};

use crate::folder::{Silent, bytes, copy, files, interrupt_in, reference, run_in};
use crate::forgery::Numbers;
use crate::mock_engine::{MockSource, study, study_text};

const PATTERNS: u32 = 40;

/// How a file is damaged.
#[derive(Debug, Clone, Copy)]
enum Damage {
    Bit(usize),
    Length(usize),
    ZeroPage(usize),
}

impl Damage {
    fn of(self, content: &[u8]) -> Vec<u8> {
        let mut damaged = content.to_vec();
        match self {
            Self::Bit(bit) => damaged[bit / 8] ^= 1 << (bit % 8),
            Self::Length(length) => damaged.truncate(length),
            Self::ZeroPage(start) => {
                let end = (start + 4096).min(damaged.len());
                damaged[start..end].fill(0);
            }
        }
        damaged
    }
}

/// Damages of `path`: `bits` random bits, `lengths` lengths, a page.
fn damages(path: &Path, bits: usize, lengths: usize, numbers: &mut Numbers) -> Vec<Damage> {
    let size = std::fs::metadata(path).expect("a file").len() as usize;
    if size == 0 {
        return Vec::new();
    }
    let mut all: Vec<Damage> = (0..bits)
        .map(|_| Damage::Bit(numbers.below(8 * size)))
        .collect();
    all.extend((0..lengths).map(|step| Damage::Length(size * step / lengths)));
    all.push(Damage::ZeroPage(numbers.below(size)));
    all
}

/// A folder with every kind of file that a run leaves: finished, or stopped halfway.
fn folder_of(finished: bool) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let whole = study(PATTERNS, |text| text);
    if finished {
        run_in(folder.path(), &whole, 2, &MockSource::default()).expect("run");
    } else {
        // Finished rows, and parts of more of them.
        let half = study(PATTERNS / 2, |text| text);
        run_in(folder.path(), &half, 2, &MockSource::default()).expect("run");
        interrupt_in(folder.path(), &whole, 20);
        interrupt_in(folder.path(), &whole, 20);
    }
    folder
}

/// What is left after the damage has to be a named file, or the true results.
fn expect_found_or_harmless(
    outcome: Result<RunOutcome, PipelineError>,
    folder: &Path,
    file: &Path,
    expected: &[Vec<u8>],
) -> bool {
    match outcome {
        Ok(_) => {
            assert!(
                bytes(folder) == expected,
                "wrong results: {}",
                file.display()
            );
            false
        }
        Err(PipelineError::Table(TableError::Damaged { path, .. })) => {
            assert_eq!(path, file, "the wrong file is named");
            true
        }
        Err(error) => panic!("{}: {error}", file.display()),
    }
}

/// Damages every file of a folder in turn, `bits` bits and `lengths` lengths each, and continues and
/// shows the study; one in `repairs` of the found ones is repaired. Gives the number of damages, and
/// of those that were found.
fn trial(finished: bool, bits: usize, lengths: usize, repairs: usize) -> (usize, usize) {
    let expected = reference(PATTERNS);
    let whole: Study = study(PATTERNS, |text| text);
    let intact = folder_of(finished);
    let before = summarise(intact.path()).expect("a summary").to_string();
    let mut numbers = Numbers(u64::from(finished));
    let (mut tried, mut found) = (0, 0);
    for file in files(intact.path()) {
        let name: PathBuf = file.strip_prefix(intact.path()).expect("below").to_owned();
        let content = std::fs::read(&file).expect("read");
        let mut folder = copy_of(intact.path());
        for damage in damages(&file, bits, lengths, &mut numbers) {
            let damaged = folder.path().join(&name);
            std::fs::write(&damaged, damage.of(&content)).expect("written");
            if let Ok(summary) = summarise(folder.path()) {
                let words = summary.to_string();
                assert_eq!(words, before, "{damage:?} {}", name.display());
            }
            // A status may fail, and must not panic.
            let _ = status_of_folder(folder.path());
            tried += 1;
            let outcome = run_in(folder.path(), &whole, 1, &MockSource::default());
            let is_found = expect_found_or_harmless(outcome, folder.path(), &damaged, &expected);
            found += usize::from(is_found);
            let is_repaired = is_found && numbers.below(repairs) == 0;
            if is_repaired {
                expect_repaired(folder.path(), &whole, &expected);
            }
            if is_repaired || !(is_found || finished) {
                folder = copy_of(intact.path());
            } else {
                std::fs::write(&damaged, &content).expect("restored");
            }
        }
    }
    (tried, found)
}

fn copy_of(folder: &Path) -> tempfile::TempDir {
    let target = tempfile::tempdir().expect("a temporary folder");
    copy(folder, target.path());
    target
}

fn expect_repaired(folder: &Path, whole: &Study, expected: &[Vec<u8>]) {
    let source = MockSource::default();
    // Where the manifest is lost, the study is that of the file.
    let file = folder.join("chain.toml");
    std::fs::write(&file, study_text(PATTERNS)).expect("written");
    let repaired = repair(folder, Some(&file), 1, &source, &Silent).expect("repaired");
    assert!(repaired.different.is_empty(), "{:?}", repaired.different);
    let [(_, place)] = &repaired.set_aside[..] else {
        panic!("{:?}", repaired.set_aside);
    };
    assert!(place.starts_with(folder.join("damaged")) && place.exists());
    run_in(folder, whole, 1, &source).expect("continued");
    assert!(bytes(folder) == expected);
}

#[test]
fn a_flipped_bit_or_a_lost_end_of_a_finished_study_is_found_or_harmless() {
    let (tried, found) = trial(true, 40, 64, 100);
    assert!(tried >= 600 && 2 * found > tried, "{found} of {tried}");
}

#[test]
fn a_flipped_bit_or_a_lost_end_of_an_unfinished_study_is_found_or_harmless() {
    let (tried, found) = trial(false, 20, 12, 60);
    assert!(tried >= 250 && 2 * found > tried, "{found} of {tried}");
}

/// `cargo test --release --test reproducibility -- --ignored ten_thousand`
#[test]
#[ignore = "about 5 minutes: ten thousand bits and 256 lengths of every file"]
#[expect(clippy::print_stderr, reason = "a measurement has to be told")]
fn ten_thousand_flipped_bits_are_found_or_harmless() {
    for finished in [true, false] {
        let count = files(folder_of(finished).path()).len();
        let (tried, found) = trial(finished, 10_000_usize.div_ceil(count), 256, 100);
        eprintln!("finished {finished}: {found} of {tried} damages found, the others harmless");
        assert!(tried >= 10_000 && 2 * found > tried, "{found} of {tried}");
    }
}

#[test]
fn swapped_doubled_deleted_and_foreign_parts_are_found_or_harmless() {
    let expected = reference(PATTERNS);
    let whole = study(PATTERNS, |text| text);
    let intact = folder_of(false);
    let parts = |folder: &Path| {
        let mut parts = files(&folder.join("parts"));
        parts.retain(|path| !path.ends_with("header.json"));
        parts
    };
    let changed = |change: &dyn Fn(&Path, &[PathBuf])| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        copy(intact.path(), folder.path());
        change(folder.path(), &parts(folder.path()));
        let outcome = run_in(folder.path(), &whole, 2, &MockSource::default());
        match outcome {
            Ok(_) => {
                assert!(bytes(folder.path()) == expected);
                false
            }
            Err(error) => {
                let words = error.to_string();
                let named = words.contains("parts/part-") || words.contains("parts/header.json");
                assert!(named, "{words}");
                true
            }
        }
    };
    assert!(parts(intact.path()).len() >= 2);
    let swapped = changed(&|folder, parts| {
        let other = folder.join("other");
        std::fs::rename(&parts[0], &other).expect("moved");
        std::fs::rename(&parts[1], &parts[0]).expect("moved");
        std::fs::rename(&other, &parts[1]).expect("moved");
    });
    assert!(swapped);
    let renamed = changed(&|folder, parts| {
        let name = parts[0].file_name().expect("a name").to_string_lossy();
        let other = name.replacen("part-0", "part-1", 1);
        std::fs::copy(&parts[0], folder.join("parts").join(other)).expect("copied");
    });
    assert!(renamed, "it does not begin where its name says");
    let doubled = changed(&|folder, parts| {
        let name = parts[0].file_name().expect("a name").to_string_lossy();
        let digest = name.rsplit_once('-').expect("a digest").1;
        let other = folder.join("parts").join(format!("part-0-{digest}"));
        std::fs::copy(&parts[0], other).expect("copied");
    });
    assert!(doubled, "the same rows twice");
    assert!(changed(
        &|_, parts| std::fs::remove_file(&parts[0]).expect("removed")
    ));
    let without_header = changed(&|folder, _| {
        std::fs::remove_file(folder.join("parts/header.json")).expect("removed");
    });
    assert!(without_header);
    assert!(changed(
        &|_, parts| std::fs::write(&parts[1], "").expect("written")
    ));
    let foreign = changed(&|folder, _| {
        let table = folder.join("responses.parquet");
        let target = folder.join("parts/part-0000000000-foreign.parquet");
        std::fs::copy(table, target).expect("copied");
    });
    assert!(foreign);
}

#[test]
fn a_lost_table_or_manifest_is_found_and_repaired() {
    let expected = reference(PATTERNS);
    let whole = study(PATTERNS, |text| text);
    for name in ["responses.parquet", "scenarios.parquet", "patterns.parquet"] {
        let folder = folder_of(true);
        std::fs::remove_file(folder.path().join(name)).expect("removed");
        let error = summarise(folder.path()).expect_err("missing");
        assert!(error.to_string().contains("it is missing"), "{error}");
        let source = MockSource::default();
        let repaired = repair(folder.path(), None, 1, &source, &Silent).expect("repaired");
        assert_eq!(repaired.missing, [folder.path().join(name)]);
        let outcome = repaired.outcome.expect("a run");
        let solved = if name == "responses.parquet" { 160 } else { 0 };
        assert_eq!(outcome.rows_solved, solved, "{name}");
        assert!(repaired.different.is_empty() && bytes(folder.path()) == expected);
    }
    let folder = folder_of(true);
    std::fs::remove_file(folder.path().join("manifest.json")).expect("removed");
    let source = MockSource::default();
    let error = run_in(folder.path(), &whole, 1, &source).expect_err("missing");
    assert!(
        error.to_string().contains("manifest.json is damaged"),
        "{error}"
    );
    let whole_again = repair(folder_of(true).path(), None, 1, &source, &Silent).expect("whole");
    assert!(whole_again.outcome.is_none() && whole_again.set_aside.is_empty());
}

#[test]
fn parts_stay_until_every_table_that_replaces_them_is_there() {
    let expected = reference(PATTERNS);
    let whole = study(PATTERNS, |text| text);
    let (unfinished, finished) = (folder_of(false), folder_of(true));
    for name in ["responses.parquet", "summary.txt"] {
        for missing in [false, true] {
            let folder = copy_of(unfinished.path());
            let next = folder.path().join("next");
            std::fs::create_dir(&next).expect("made");
            let manifest = Manifest::read(finished.path())
                .expect("whole")
                .expect("there");
            for table in manifest.tables.keys() {
                std::fs::copy(finished.path().join(table), next.join(table)).expect("copied");
            }
            manifest.write(&next).expect("written");
            let parts = files(&folder.path().join("parts"));
            if missing {
                std::fs::remove_file(next.join(name)).expect("removed");
                let _ = std::fs::remove_file(folder.path().join(name));
            } else {
                std::fs::write(next.join(name), "half").expect("written");
            }
            let source = MockSource::default();
            let words = run_in(folder.path(), &whole, 1, &source).expect_err(name);
            assert!(words.to_string().contains(name), "{words}");
            assert_eq!(files(&folder.path().join("parts")), parts);
            repair(folder.path(), None, 1, &source, &Silent).expect(name);
            for part in parts {
                assert!(part.exists(), "{}", part.display());
            }
            run_in(folder.path(), &whole, 1, &source).expect(name);
            assert!(bytes(folder.path()) == expected, "{name} {missing}");
        }
    }
}

#[test]
fn a_repair_leaves_the_study_in_the_manifest() {
    let folder = folder_of(false);
    let before = Manifest::read(folder.path())
        .expect("whole")
        .expect("there");
    assert_eq!(before.state, RunState::Finished);
    std::fs::write(folder.path().join("responses.parquet"), "").expect("written");
    let source = MockSource::default();
    let repaired = repair(folder.path(), None, 1, &source, &Silent).expect("repaired");
    assert!(repaired.outcome.is_none(), "another study goes on from it");
    let after = Manifest::read(folder.path())
        .expect("whole")
        .expect("there");
    assert_eq!(
        (after.state, &after.study),
        (RunState::Running, &before.study)
    );
    assert!(after.tables.is_empty());
    // A study that differs is still refused.
    let other = study(PATTERNS, |text| text.replace("seed = 7", "seed = 8"));
    let refused = run_in(folder.path(), &other, 1, &source);
    let different = matches!(refused, Err(PipelineError::DifferentStudy { .. }));
    assert!(different, "{refused:?}");
    let whole = study(PATTERNS, |text| text);
    run_in(folder.path(), &whole, 1, &source).expect("continued");
    assert!(bytes(folder.path()) == reference(PATTERNS));
}

#[test]
fn damaged_models_and_estimates_go_aside() {
    let folder = folder_of(true);
    let place = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(place("model")).expect("made");
    std::fs::write(place("model/abc"), "no model").expect("written");
    std::fs::write(place("sample.parquet"), "another sample").expect("written");
    let digest = blake3::hash(b"a sample").to_hex().to_string();
    let estimate = serde_json::json!({ "sample_digest": digest });
    write_estimate(folder.path(), &estimate).expect("written");
    assert!(!integrity(folder.path()).expect("readable").is_whole());
    let source = MockSource::default();
    let repaired = repair(folder.path(), None, 1, &source, &Silent).expect("repaired");
    let moved: Vec<PathBuf> = repaired
        .set_aside
        .into_iter()
        .map(|(from, _)| from)
        .collect();
    let expected = ["model/abc", "estimate.json", "sample.parquet"].map(place);
    assert_eq!(moved, expected);
    assert!(integrity(folder.path()).expect("readable").is_whole());
}

/// Damages a part while the run goes on, and looks at the status.
struct Damaging<'a> {
    folder: &'a Path,
    seen: Mutex<Option<bool>>,
}

impl Progress for Damaging<'_> {
    fn row(&self, _status: Status) {
        // Parts are written beside the rows that are solved meanwhile.
        std::thread::sleep(Duration::from_millis(2));
        let header = PartHeader::read(self.folder).expect("whole");
        let Some(name) = header.and_then(|header| header.parts.into_iter().next()) else {
            return;
        };
        let part = self.folder.join("parts").join(name);
        let mut seen = self.seen.lock().expect("no panic");
        if seen.is_some() {
            return;
        }
        let content = std::fs::read(&part).expect("read");
        let mut damaged = content.clone();
        damaged[content.len() / 3] ^= 1;
        std::fs::write(&part, damaged).expect("written");
        let status = status_of_folder(self.folder);
        *seen = Some(matches!(
            status,
            Err(PipelineError::Table(TableError::Damaged { .. }))
        ));
        std::fs::write(part, content).expect("restored");
    }
}

#[test]
fn a_damaged_part_of_a_study_that_is_being_extended_is_named_by_its_status() {
    let folder = folder_of(true);
    let damaging = Damaging {
        folder: folder.path(),
        seen: Mutex::new(None),
    };
    let request = RunRequest {
        study: &study(4 * PATTERNS, |text| text),
        results: folder.path(),
        threads: 1,
    };
    run(request, &MockSource::default(), &damaging).expect("extended");
    assert_eq!(*damaging.seen.lock().expect("no panic"), Some(true));
}
