//! A look at all files of a folder finds what is not as it was written, and changes nothing; leftovers go.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use blisk::population::table::PartHeader;
use blisk::study::{FileState, PipelineError, integrity};

use crate::folder::{bytes, files, interrupt_in, reference, run_in};
use crate::mock_engine::{MockSource, study};

/// Content and time of every file.
fn snapshot(folder: &Path) -> BTreeMap<PathBuf, (Vec<u8>, SystemTime)> {
    let all = files(folder).into_iter();
    all.map(|path| {
        let time = std::fs::metadata(&path).and_then(|found| found.modified());
        let content = std::fs::read(&path).expect("read");
        (path, (content, time.expect("a time")))
    })
    .collect()
}

/// Files that are not whole, with their states; nothing may have changed.
fn found(folder: &Path) -> (bool, Vec<(String, FileState)>) {
    let before = snapshot(folder);
    let found = integrity(folder).expect("readable");
    assert!(snapshot(folder) == before, "a file has changed");
    let whole = found.is_whole();
    let others = found.files.into_iter();
    let others = others.filter(|file| file.state != FileState::Whole);
    let named = others.map(|file| (file.file.to_string_lossy().into_owned(), file.state));
    (whole, named.collect())
}

fn finished(patterns: u32) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let study = study(patterns, |text| text);
    run_in(folder.path(), &study, 2, &MockSource::default()).expect("run");
    folder
}

fn interrupted() -> tempfile::TempDir {
    let folder = finished(20);
    interrupt_in(folder.path(), &study(40, |text| text), 40);
    folder
}

#[test]
fn whole_folders_are_whole_and_every_file_is_looked_at() {
    for folder in [finished(20), interrupted()] {
        let (whole, others) = found(folder.path());
        assert!(whole && others.is_empty(), "{others:?}");
        let looked_at = integrity(folder.path()).expect("readable").files.len();
        // The lock has no content to check.
        assert_eq!(looked_at, files(folder.path()).len() - 1);
    }
    let empty = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(empty.path().join("notes.txt"), "mine").expect("written");
    let nothing = integrity(empty.path()).expect_err("no results");
    assert!(matches!(nothing, PipelineError::NoResults { .. }));
}

#[test]
fn a_changed_or_missing_file_of_any_kind_is_named() {
    for intact in [finished(20), interrupted()] {
        let folder = intact.path();
        for path in files(folder) {
            let name = path
                .strip_prefix(folder)
                .expect("below")
                .to_string_lossy()
                .into_owned();
            if name == ".lock" {
                continue;
            }
            let content = std::fs::read(&path).expect("read");
            let mut changed = content.clone();
            changed[content.len() / 2] ^= 1;
            std::fs::write(&path, changed).expect("written");
            let (whole, others) = found(folder);
            assert!(!whole, "{name}");
            assert!(
                others.contains(&(name.clone(), FileState::Damaged)),
                "{name}: {others:?}"
            );
            std::fs::remove_file(&path).expect("removed");
            let (whole, others) = found(folder);
            // A record of a run is missed by nothing.
            if !name.starts_with("runs/") {
                assert!(!whole, "{name}: {others:?}");
            }
            std::fs::write(&path, content).expect("restored");
        }
        assert!(found(folder).0);
    }
}

#[test]
fn a_deleted_part_is_noticed_and_a_killed_process_loses_none() {
    let whole = study(40, |text| text);
    let folder = interrupted();
    let header = PartHeader::read(folder.path())
        .expect("whole")
        .expect("a header");
    let name = header.parts.iter().next().expect("a part").clone();
    let path = folder.path().join("parts").join(&name);
    let content = std::fs::read(&path).expect("read");
    std::fs::remove_file(&path).expect("removed");
    let (whole_now, others) = found(folder.path());
    let expected = vec![(format!("parts/{name}"), FileState::Missing)];
    assert_eq!((whole_now, others), (false, expected));
    let refused = run_in(folder.path(), &whole, 1, &MockSource::default());
    let words = refused.expect_err("missing").to_string();
    assert!(
        words.contains(&name) && words.contains("missing"),
        "{words}"
    );
    std::fs::write(&path, content).expect("restored");
    // Killed after the part was named and before it took its place, or right after that.
    for there in [false, true] {
        let mut killed = header.clone();
        killed.parts.remove(&name);
        killed.coming = Some(name.clone());
        killed.write(folder.path()).expect("written");
        let aside = folder.path().with_extension("aside");
        if !there {
            std::fs::rename(&path, &aside).expect("moved");
        }
        assert_eq!(found(folder.path()), (true, Vec::new()));
        let copy = tempfile::tempdir().expect("a temporary folder");
        crate::folder::copy(folder.path(), copy.path());
        run_in(copy.path(), &whole, 2, &MockSource::default()).expect("continued");
        assert!(bytes(copy.path()) == reference(40));
        if !there {
            std::fs::rename(&aside, &path).expect("moved back");
        }
    }
}

#[test]
fn what_is_not_of_the_program_or_has_no_checksum_is_said_to_be_so() {
    let folder = finished(20);
    for name in ["notes.txt", "report.html", "tail_fits.parquet"] {
        std::fs::write(folder.path().join(name), "a").expect("written");
    }
    let (whole, others) = found(folder.path());
    let expected = [
        ("notes.txt".to_owned(), FileState::Foreign),
        ("report.html".to_owned(), FileState::Unverified),
        ("tail_fits.parquet".to_owned(), FileState::Unverified),
    ];
    assert!(whole);
    assert_eq!(others, expected);
}

#[test]
fn what_dead_processes_left_is_removed_by_the_next_run() {
    let folder = finished(20);
    // No process has the largest number; this one lives.
    let lives = std::process::id();
    let kept = [
        format!(".table.parquet.{lives}.tmp"),
        format!("model/abc.{lives}.partial"),
    ];
    let gone = [
        ".manifest.json.4294967294.tmp",
        "parts/.part-0000000000.parquet.4294967294.tmp",
        "runs/.2.json.4294967294.tmp",
        "model/abc.4294967294.partial",
        "next/responses.parquet",
    ];
    for name in gone.into_iter().chain(kept.iter().map(String::as_str)) {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, "half").expect("written");
    }
    let whole = study(20, |text| text);
    run_in(folder.path(), &whole, 1, &MockSource::default()).expect("run");
    for name in gone {
        assert!(!folder.path().join(name).exists(), "{name}");
    }
    for name in kept {
        assert!(folder.path().join(&name).exists(), "{name}");
    }
}
