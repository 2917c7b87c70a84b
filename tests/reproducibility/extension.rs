//! A study that grows keeps its rows, and only what is new is solved.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use blisk::campaign::{RunRequest, run};
use blisk::response::harmonic_balance::Status;
use blisk::settings::Progress;
use blisk::study::{PipelineError, Study};

use crate::folder::{bytes, files, interrupt_in, reference_of, run_in};
use crate::mock_engine::{MockSource, study};

fn small(edit: &[(&str, &str)]) -> Study {
    study(40, |text| {
        edit.iter().fold(text, |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replacen(old, new, 1)
        })
    })
}

#[test]
fn added_scenarios_are_solved_alone_and_the_tables_are_those_of_a_run_at_once() {
    let edits: [&[(&str, &str)]; 4] = [
        &[("[0.03, 0.01]", "[0.03, 0.02, 0.01]")],
        &[("engine_orders = [3, 5]", "engine_orders = [1, 3, 5]")],
        &[("[0.03, 0.01]", "[0.01, 0.03]")],
        &[
            ("patterns = 40", "patterns = 100"),
            ("[0.03, 0.01]", "[0.01, 0.02, 0.03]"),
            ("engine_orders = [3, 5]", "engine_orders = [5, 4, 3]"),
        ],
    ];
    for edit in edits {
        let folder = tempfile::tempdir().expect("a temporary folder");
        run_in(folder.path(), &small(&[]), 2, &MockSource::default()).expect("run");
        let grown = small(edit);
        let rows = grown.scenarios().len() as u64 * u64::from(grown.patterns);
        let outcome = run_in(folder.path(), &grown, 2, &MockSource::default()).expect("grown");
        assert_eq!(
            (outcome.rows_solved, outcome.rows_reused),
            (rows - 160, 160)
        );
        assert!(bytes(folder.path()) == reference_of(&grown), "{edit:?}");
        assert!(!folder.path().join("parts").exists() && !folder.path().join("next").exists());
    }
}

#[test]
fn a_broken_off_extension_leaves_the_finished_results_and_is_continued_or_dropped() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let first = small(&[]);
    run_in(folder.path(), &first, 2, &MockSource::default()).expect("run");
    let before = bytes(folder.path());
    let grown = small(&[("[0.03, 0.01]", "[0.03, 0.02, 0.01]")]);
    interrupt_in(folder.path(), &grown, 30);
    assert!(files(&folder.path().join("parts")).len() > 1);
    assert!(bytes(folder.path()) == before);
    assert!(blisk::campaign::summarise(folder.path()).is_ok());
    let source = MockSource::default();
    let back = run_in(folder.path(), &first, 2, &source).expect("the former study");
    assert_eq!(
        (back.rows_solved, source.solved.load(Ordering::SeqCst)),
        (0, 0)
    );
    let outcome = run_in(folder.path(), &grown, 2, &MockSource::default()).expect("continued");
    assert!(outcome.rows_reused > 160, "{}", outcome.rows_reused);
    assert!(bytes(folder.path()) == reference_of(&grown));
}

#[test]
fn another_edit_on_top_of_a_broken_off_one_keeps_what_it_can() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(folder.path(), &small(&[]), 2, &MockSource::default()).expect("run");
    interrupt_in(
        folder.path(),
        &small(&[("[0.03, 0.01]", "[0.03, 0.02, 0.01]")]),
        30,
    );
    interrupt_in(
        folder.path(),
        &small(&[("patterns = 40", "patterns = 90")]),
        100,
    );
    let all = small(&[
        ("patterns = 40", "patterns = 100"),
        ("[0.03, 0.01]", "[0.02, 0.03, 0.01]"),
    ]);
    let outcome = run_in(folder.path(), &all, 3, &MockSource::default()).expect("all");
    assert!(
        outcome.rows_reused >= 160 + 30 + 100,
        "{}",
        outcome.rows_reused
    );
    assert!(bytes(folder.path()) == reference_of(&all));
}

#[test]
fn rows_made_from_another_model_are_solved_anew() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(folder.path(), &small(&[]), 2, &MockSource::default()).expect("run");
    let grown = small(&[("[0.03, 0.01]", "[0.03, 0.02, 0.01]")]);
    let other = MockSource {
        model: "a basis chosen with the new scenario".to_owned(),
        ..MockSource::default()
    };
    let listening = Listening::default();
    let request = RunRequest {
        study: &grown,
        results: folder.path(),
        threads: 2,
    };
    let outcome = run(request, &other, &listening).expect("grown");
    assert_eq!((outcome.rows_solved, outcome.rows_reused), (240, 0));
    // Whoever watches hears before the first row how many that are stored are solved again.
    assert_eq!(listening.anew.load(Ordering::SeqCst), 160);
    assert!(!listening.late.load(Ordering::SeqCst));
    // What is new alone is nothing to say.
    let listening = Listening::default();
    let longer = small(&[
        ("[0.03, 0.01]", "[0.03, 0.02, 0.01]"),
        ("patterns = 40", "patterns = 50"),
    ]);
    let request = RunRequest {
        study: &longer,
        ..request
    };
    let outcome = run(request, &other, &listening).expect("longer");
    assert_eq!((outcome.rows_solved, outcome.rows_reused), (60, 240));
    assert_eq!(listening.anew.load(Ordering::SeqCst), 0);
}

/// Rows that are said to be solved anew, and whether that comes after the first row.
#[derive(Default)]
struct Listening {
    anew: AtomicU64,
    began: AtomicBool,
    late: AtomicBool,
}

impl Progress for Listening {
    fn solves_anew(&self, rows: u64, why: &str) {
        assert!(!why.is_empty());
        self.anew.fetch_add(rows, Ordering::SeqCst);
        let late = self.began.load(Ordering::SeqCst);
        self.late.store(late, Ordering::SeqCst);
    }

    fn row(&self, _status: Status) {
        self.began.store(true, Ordering::SeqCst);
    }
}

#[test]
fn other_tables_are_written_without_a_solve() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(folder.path(), &small(&[]), 2, &MockSource::default()).expect("run");
    let output = |line: &str| study(40, |text| format!("{text}[output]\n{line}\n"));
    let source = MockSource::default();
    for (line, patterns) in [
        ("patterns = false", false),
        ("compression = \"snappy\"", true),
    ] {
        let study = output(line);
        let outcome = run_in(folder.path(), &study, 1, &source).expect("tables");
        assert_eq!((outcome.rows_solved, outcome.rows_reused), (0, 160));
        let table = folder.path().join("patterns.parquet");
        assert_eq!(table.exists(), patterns, "{line}");
        if patterns {
            assert!(bytes(folder.path()) == reference_of(&study));
        }
    }
    assert_eq!(source.solved.load(Ordering::SeqCst), 0);
}

#[test]
fn nothing_can_be_taken_away() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(folder.path(), &small(&[]), 2, &MockSource::default()).expect("run");
    let before = bytes(folder.path());
    let edits = [
        (
            "[0.03, 0.01]",
            "[0.03]",
            "sweep.standard_deviation: [0.03,0.01] in the folder, [0.03] (values can be added, none taken away)",
        ),
        (
            "[3, 5]",
            "[3, 4]",
            "excitation.engine_orders: [3,5] in the folder, [3,4]",
        ),
        (
            "patterns = 40",
            "patterns = 39",
            "study.patterns: 40 in the folder, 39 (a total, which can only grow)",
        ),
    ];
    for (old, new, expected) in edits {
        let refused = run_in(
            folder.path(),
            &small(&[(old, new)]),
            1,
            &MockSource::default(),
        );
        let error = refused.expect_err(new);
        assert!(
            matches!(error, PipelineError::DifferentStudy { .. }),
            "{error}"
        );
        assert!(error.to_string().contains(expected), "{error}");
    }
    assert!(bytes(folder.path()) == before);
}
