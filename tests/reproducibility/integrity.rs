//! A look at all files of a folder finds what is not as it was written, and changes nothing; leftovers go.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use blisk::campaign::{FileState, StoredStudy, VerifyRequest, audit_peaks, integrity, verify};
use blisk::population::table::{
    Compression, PartHeader, TableHeader, remove_leftovers, write_estimate, write_sample,
};
use blisk::study::PipelineError;

use crate::folder::{Silent, bytes, files, interrupt_in, reference, run_in};
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

#[test]
fn folders_of_single_loads_are_read_as_those_of_shards_are() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let load = folder.path().join("load-5");
    let study = study(20, |text| text);
    run_in(&load, &study, 2, &MockSource::default()).expect("run");
    assert_eq!(found(folder.path()), (true, Vec::new()));
    let build = integrity(folder.path()).expect("readable").build;
    assert_eq!(build.as_deref(), Some(blisk::identity::BUILD));
    std::fs::write(load.join("responses.parquet"), "half").expect("written");
    let expected = vec![("load-5/responses.parquet".to_owned(), FileState::Damaged)];
    assert_eq!(found(folder.path()), (false, expected));
}

#[test]
fn an_estimate_goes_before_its_sample_is_replaced() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let header = TableHeader {
        study_digest: "0".repeat(64),
        compression: Compression::default(),
        load_cases: Vec::new(),
    };
    let digest = write_sample(folder.path(), &[], &header).expect("written");
    let estimate = serde_json::json!({ "sample_digest": digest });
    write_estimate(folder.path(), &estimate).expect("written");
    // The same sample again.
    write_sample(folder.path(), &[], &header).expect("written");
    assert_eq!(found(folder.path()), (true, Vec::new()));
    // Another one; the process is killed before it writes the estimate.
    let other = TableHeader {
        study_digest: "1".repeat(64),
        ..header
    };
    write_sample(folder.path(), &[], &other).expect("written");
    let expected = vec![("sample.parquet".to_owned(), FileState::Unverified)];
    assert_eq!(found(folder.path()), (true, expected));
}

#[test]
fn two_processes_remove_the_same_leftovers() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for number in 0..500 {
        let name = format!("{number}.4294967294.partial");
        std::fs::write(folder.path().join(name), "half").expect("written");
    }
    std::thread::scope(|scope| {
        let both = [0; 2].map(|_| scope.spawn(|| remove_leftovers(folder.path())));
        for one in both {
            one.join().expect("no panic").expect("removed by either");
        }
    });
    assert!(files(folder.path()).is_empty());
}

#[test]
fn a_sample_is_drawn_from_what_stands_there_once_the_folder_is_locked() {
    let folder = finished(20);
    let stored = StoredStudy::open(folder.path(), None).expect("whole");
    std::fs::remove_file(folder.path().join("manifest.json")).expect("removed");
    let request = VerifyRequest {
        sample: 2,
        seed: None,
        threads: 1,
    };
    let source = MockSource::default();
    let verified = verify(&stored, &source, request, &Silent).map(drop);
    let audited = audit_peaks(&stored, &source, request, &Silent).map(drop);
    for refused in [verified, audited] {
        let nothing = matches!(refused, Err(PipelineError::NoResults { .. }));
        assert!(nothing, "{refused:?}");
    }
}
