//! A run in pieces comes to the same bytes as a run at once.

use std::sync::atomic::{AtomicI64, Ordering};

use blisk::campaign::{RunRequest, run};
use blisk::response::harmonic_balance::Status;
use blisk::settings::Progress;
use blisk::study::PipelineError;

use crate::folder::{bytes, reference, run_in};
use crate::mock_engine::{MockSource, study};

/// Ends a run by a panic after some rows, as far as a process can end itself in a test.
struct Interrupting {
    rows_left: AtomicI64,
}

impl Progress for Interrupting {
    fn row(&self, _status: Status) {
        assert!(
            self.rows_left.fetch_sub(1, Ordering::SeqCst) > 0,
            "interrupted on purpose"
        );
    }
}

#[test]
fn every_number_of_threads_gives_the_same_bytes() {
    let expected = reference(500);
    for threads in [2, 4, 16] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        run_in(
            folder.path(),
            &study(500, |text| text),
            threads,
            &MockSource::default(),
        )
        .expect("run");
        assert!(bytes(folder.path()) == expected, "{threads} threads");
    }
}

#[test]
fn a_finished_study_is_not_solved_again() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let study = study(100, |text| text);
    let first = run_in(folder.path(), &study, 2, &MockSource::default()).expect("run");
    let before = bytes(folder.path());
    let source = MockSource::default();
    let second = run_in(folder.path(), &study, 2, &source).expect("second run");
    assert_eq!(source.solved.load(Ordering::SeqCst), 0);
    assert_eq!((second.rows_solved, second.rows_reused), (0, 400));
    assert_eq!(second.summary.rows, first.summary.rows);
    assert_eq!(second.summary.to_string(), first.summary.to_string());
    assert!(bytes(folder.path()) == before);
    assert!(!folder.path().join("parts").exists());
}

#[test]
fn raising_the_number_of_patterns_solves_only_the_new_ones() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(
        folder.path(),
        &study(130, |text| text),
        2,
        &MockSource::default(),
    )
    .expect("run");
    let source = MockSource::default();
    let longer = run_in(folder.path(), &study(500, |text| text), 2, &source).expect("longer run");
    // Two standard deviations are two calls a pattern.
    assert_eq!(source.solved.load(Ordering::SeqCst), 2 * 370);
    assert_eq!((longer.rows_solved, longer.rows_reused), (4 * 370, 4 * 130));
    assert!(bytes(folder.path()) == reference(500));
}

#[test]
fn an_interrupted_run_continues_to_the_same_bytes() {
    let expected = reference(500);
    for rows in [0, 1, 99, 800, 1960] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let study = study(500, |text| text);
        let progress = Interrupting {
            rows_left: AtomicI64::new(rows),
        };
        let request = RunRequest {
            study: &study,
            results: folder.path(),
            threads: 2,
        };
        let interrupted = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            run(request, &MockSource::default(), &progress)
        }));
        assert!(interrupted.is_err(), "the listener panics");
        let source = MockSource::default();
        let outcome = run_in(folder.path(), &study, 3, &source).expect("continued");
        assert_eq!(outcome.rows_solved + outcome.rows_reused, 2000);
        if rows >= 800 {
            assert!(outcome.rows_reused > 0, "parts were used");
        }
        assert!(
            bytes(folder.path()) == expected,
            "stopped after {rows} rows"
        );
    }
}

#[test]
fn another_study_in_the_folder_is_refused_with_the_keys_that_differ() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(
        folder.path(),
        &study(20, |text| text),
        2,
        &MockSource::default(),
    )
    .expect("run");
    let before = bytes(folder.path());
    let edits: [(&str, &str, &str); 5] = [
        (
            "seed = 7",
            "seed = 8",
            "study.seed: 7 in the folder, 8 in the study",
        ),
        (
            "engine_orders = [3, 5]",
            "engine_orders = [3]",
            "excitation.engine_orders",
        ),
        ("[0.03, 0.01]", "[0.03, 0.02]", "sweep.standard_deviation"),
        (
            "= 0.01\n",
            "= 0.02\n",
            "damping.structural_loss_factor: 0.01",
        ),
        (
            "patterns = 20",
            "patterns = 19",
            "study.patterns: 20 in the folder, 19",
        ),
    ];
    for (old, new, expected) in edits {
        let other = study(20, |text| text.replacen(old, new, 1));
        let error = run_in(folder.path(), &other, 2, &MockSource::default()).expect_err(new);
        assert!(
            matches!(error, PipelineError::DifferentStudy { .. }),
            "{error}"
        );
        assert!(error.to_string().contains(expected), "{error}");
    }
    assert!(bytes(folder.path()) == before);
}

#[test]
fn neutral_keys_do_not_make_another_study() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(
        folder.path(),
        &study(20, |text| text),
        2,
        &MockSource::default(),
    )
    .expect("run");
    let renamed = study(20, |text| {
        text.replace("\"chain\"", "\"renamed\"") + "[output]\ncompression = \"snappy\"\n"
    });
    let outcome = run_in(folder.path(), &renamed, 1, &MockSource::default()).expect("same study");
    assert_eq!(outcome.rows_solved, 0);
}

#[test]
fn a_damaged_table_is_found_and_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    run_in(
        folder.path(),
        &study(20, |text| text),
        2,
        &MockSource::default(),
    )
    .expect("run");
    let table = folder.path().join("responses.parquet");
    let whole = std::fs::read(&table).expect("read");
    let refused = |content: &[u8]| {
        std::fs::write(&table, content).expect("write");
        let error = blisk::campaign::summarise(folder.path()).expect_err("damaged");
        assert!(error.to_string().contains("responses.parquet"), "{error}");
        let study = study(30, |text| text);
        let error = run_in(folder.path(), &study, 1, &MockSource::default()).expect_err("damaged");
        assert!(matches!(error, PipelineError::Table(_)), "{error}");
    };
    for keep in [0, 4, 100, whole.len() / 2, whole.len() - 1] {
        refused(&whole[..keep]);
    }
    for place in (0..whole.len()).step_by(whole.len() / 100) {
        let mut flipped = whole.clone();
        flipped[place] ^= 1 << (place % 8);
        refused(&flipped);
    }
    std::fs::write(&table, &whole).expect("restore");
    assert!(blisk::campaign::summarise(folder.path()).is_ok());
    std::fs::remove_file(&table).expect("remove");
    let error = blisk::campaign::summarise(folder.path()).expect_err("missing");
    assert!(error.to_string().contains("missing"), "{error}");
}

/// Peak memory of this process so far, MiB; Linux only.
fn peak_memory_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

/// What everything but the physics costs: at most 50 us a row of processor time of two threads, the million rows seen again in 10 s,
/// and memory that is no more than 24 bytes a row beside that of a tenth of the rows.
/// `cargo test --release --test reproducibility -- --ignored --nocapture overhead`.
#[test]
#[ignore = "about 1 minute: a million rows of a made-up engine"]
#[expect(clippy::print_stderr, reason = "a measurement has to be told")]
fn overhead_of_a_million_rows_is_small_and_memory_does_not_grow_with_them() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut memory_mib = Vec::new();
    for patterns in [25_000, 250_000] {
        let began = std::time::Instant::now();
        let study = study(patterns, |text| text);
        let outcome = run_in(folder.path(), &study, 2, &MockSource::default()).expect("run");
        let seconds = began.elapsed().as_secs_f64();
        let again = std::time::Instant::now();
        run_in(folder.path(), &study, 2, &MockSource::default()).expect("nothing to solve");
        eprintln!(
            "{} rows: {seconds:.2} s, {:.2} us a row; shown again in {:.2} s; peak memory {:.0} MiB",
            4 * patterns,
            1e6 * seconds / outcome.rows_solved as f64,
            again.elapsed().as_secs_f64(),
            peak_memory_mib().unwrap_or(f64::NAN)
        );
        assert!(
            seconds / (outcome.rows_solved as f64) < 50e-6,
            "{seconds} s"
        );
        assert!(again.elapsed().as_secs_f64() < 10.0);
        memory_mib.extend(peak_memory_mib());
    }
    // Where the system tells: Linux.
    if let [few, many] = memory_mib[..] {
        let rows = 4.0 * (250_000.0 - 25_000.0);
        let of_rows = (many - few) * 1024.0 * 1024.0 / rows;
        assert!(
            of_rows < 24.0,
            "{of_rows} bytes a row: {few} and {many} MiB"
        );
    }
}
