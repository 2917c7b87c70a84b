//! Every write, sync, rename and the like of a run made to fail in turn, by `strace`: the run ends with
//! 7 and says where, and the next one comes to the bytes of an undisturbed one.

use std::path::Path;
use std::process::Command;

use crate::blisk::{GOOD, Place};

const TABLES: [&str; 4] = [
    "responses.parquet",
    "scenarios.parquet",
    "patterns.parquet",
    "manifest.json",
];

/// System calls that change files, and the error of each.
/// Where there are no locks, the run goes on without.
const CALLS: [(&str, &str); 7] = [
    ("write", "ENOSPC"),
    ("fsync", "EIO"),
    ("rename", "ENOSPC"),
    ("mkdir", "EROFS"),
    ("unlink,unlinkat,rmdir", "EROFS"),
    ("ftruncate", "EDQUOT"),
    ("flock", "ENOLCK"),
];

fn bytes(place: &Place, results: &str) -> Vec<Vec<u8>> {
    let read = |table: &str| std::fs::read(place.path(results).join(table)).expect(table);
    TABLES.map(read).to_vec()
}

/// Which calls fail: the one of that number of every thread, or from that number on all of them.
const LASTING: [&str; 2] = ["", "+"];

/// Runs the study into `results` with the calls `when` of `calls` of every thread failing; false if there was no such
/// call.
fn run_with_fault(place: &Place, results: &str, calls: (&str, &str), when: &str) -> bool {
    let (calls, error) = calls;
    let log = place.path("strace.log");
    let output = Command::new("strace")
        .args(["-f", "--seccomp-bpf", "-o"])
        .arg(&log)
        .arg(format!("--trace={calls}"))
        .arg(format!("--inject={calls}:error={error}:when={when}"))
        .arg(env!("CARGO_BIN_EXE_blisk"))
        .args(["run", "study.toml", "--threads", "1", "--out", results])
        .current_dir(place.path("."))
        .output()
        .expect("strace starts");
    let words = String::from_utf8_lossy(&output.stderr);
    let traced = std::fs::read_to_string(&log).expect("a log");
    let hit: Vec<&str> = traced
        .lines()
        .filter(|line| line.contains("(INJECTED)"))
        .collect();
    if hit.is_empty() {
        assert!(output.status.success(), "{words}");
        return false;
    }
    // A message may be lost, and what is only tidied up may stay, without an error.
    match output.status.code() {
        Some(0) => assert!(!hit.iter().any(|line| line.contains("write(1,")), "{hit:?}"),
        Some(7) => assert!(
            words.contains(results) || hit.iter().any(|line| is_of_message(line, &traced)),
            "{hit:?}: {words}"
        ),
        code => panic!("{calls} {when}: {code:?}: {words}{hit:?}"),
    }
    true
}

/// Whether a failed call was to write a message. Of a call that another thread interrupts in the log, the line before
/// tells.
fn is_of_message(line: &str, log: &str) -> bool {
    let (process, _) = line.split_once(' ').unwrap_or((line, ""));
    let begun = |other: &str| other.starts_with(process) && other.contains("<unfinished ...>");
    let resumed = line.contains("write resumed>");
    let before = log
        .lines()
        .take_while(|other| *other != line)
        .filter(|other| begun(other));
    let whole = if resumed { before.last() } else { Some(line) };
    whole.is_some_and(|whole| whole.contains("write(2,"))
}

/// Fails every `stride`-th call of each kind.
fn fail_in_turn(stride: usize) -> usize {
    let place = Place::with(GOOD);
    let run = place.run(&["run", "study.toml", "--out", "undisturbed"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let expected = bytes(&place, "undisturbed");
    let mut faults = 0;
    let kinds = CALLS
        .iter()
        .flat_map(|calls| LASTING.map(|lasting| (*calls, lasting)));
    for (calls, lasting) in kinds {
        for number in (1..).step_by(stride) {
            let when = format!("{number}{lasting}");
            let hit = run_with_fault(&place, "out", calls, &when);
            let run = place.run(&["run", "study.toml", "--out", "out"]);
            assert_eq!(run.code, 0, "{calls:?} {when}: {}", run.stderr);
            assert!(bytes(&place, "out") == expected, "{calls:?} {when}");
            assert!(!leftovers(&place.path("out")), "{calls:?} {when}");
            std::fs::remove_dir_all(place.path("out")).expect("removed");
            if !hit {
                break;
            }
            faults += 1;
        }
    }
    faults
}

/// Whether the folder holds anything of an interrupted write.
fn leftovers(folder: &Path) -> bool {
    let mut names = std::fs::read_dir(folder)
        .expect("a folder")
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.any(|name| name.contains(".tmp") || name == "next" || name == "parts")
}

/// `cargo test --release --test cli -- --ignored faults`
#[test]
#[ignore = "15 s; needs strace: stage faults of .ci/run"]
fn failing_writes_end_with_7_and_lose_nothing() {
    let faults = fail_in_turn(7);
    assert!(faults >= 8, "{faults} faults");
}

#[test]
#[ignore = "some minutes; needs strace"]
fn every_failing_write_ends_with_7_and_loses_nothing() {
    let faults = fail_in_turn(1);
    assert!(faults >= 100, "{faults} faults");
}
