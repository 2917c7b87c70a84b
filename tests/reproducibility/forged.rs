//! Files with a checksum that fits and content that no run writes: a clear error, and nothing outside of the folder
//! is read, moved or removed.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use blisk::campaign::{
    CompareRequest, ReportRequest, compare, integrity, merge, repair, report, status_of_folder,
    summarise, summarise_partly,
};
use blisk::population::table::TableError;
use blisk::report::html_report;
use blisk::settings::ReducedEngineSource;
use blisk::study::PipelineError;
use serde_json::{Value, json};

use crate::folder::{Silent, copy, files, interrupt_in, run_in};
use crate::forgery::forge;
use crate::mock_engine::{MockSource, study, study_text};

const PATTERNS: u32 = 12;

/// A folder with results in `results`, finished or with parts, a study file, and files that are no concern of them.
fn place(finished: bool) -> tempfile::TempDir {
    let place = tempfile::tempdir().expect("a temporary folder");
    let results = place.path().join("results");
    let whole = study(PATTERNS, |text| text);
    if finished {
        run_in(&results, &whole, 1, &MockSource::default()).expect("run");
    } else {
        interrupt_in(&results, &whole, 8);
    }
    std::fs::write(place.path().join("chain.toml"), study_text(PATTERNS)).expect("written");
    for victim in ["victim", "victim.parquet", "victims/responses.parquet"] {
        let path = place.path().join(victim);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, victim).expect("written");
    }
    place
}

/// Everything beside the results, with its content.
fn outside(place: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let beside = files(place).into_iter();
    beside
        .filter(|path| {
            !path.starts_with(place.join("results")) && !path.starts_with(place.join("out"))
        })
        .map(|path| (path.clone(), std::fs::read(&path).expect("read")))
        .collect()
}

/// Every command that reads results.
const COMMANDS: [&str; 9] = [
    "run",
    "extend",
    "stats",
    "status",
    "integrity",
    "report",
    "compare",
    "merge",
    "repair",
];

/// What a command does with the results of a place.
fn carry_out(command: &str, place: &Path) -> Result<(), PipelineError> {
    let (results, file) = (place.join("results"), place.join("chain.toml"));
    let source = MockSource::default();
    match command {
        "run" => run_in(&results, &study(PATTERNS, |text| text), 1, &source).map(drop),
        "extend" => run_in(&results, &study(PATTERNS + 4, |text| text), 1, &source).map(drop),
        "stats" => summarise_partly(&results).and_then(|_| summarise(&results).map(drop)),
        "status" => status_of_folder(&results).map(drop),
        "integrity" => {
            let found = integrity(&results)?;
            found.is_whole().then_some(()).ok_or_else(|| {
                let reason = "not whole".to_owned();
                TableError::Damaged {
                    path: results,
                    reason,
                }
                .into()
            })
        }
        "report" => {
            let request = ReportRequest {
                results,
                study_file: Some(file),
                curves: false,
                model: true,
            };
            report(&request, &source).map(|found| drop(html_report(&found)))
        }
        "compare" => {
            let request = CompareRequest {
                folders: vec![results.clone(), results],
                baseline: None,
                percent: 50.0,
            };
            compare(&request).map(drop)
        }
        "merge" => merge(
            &[results],
            &place.join("out"),
            Some(&file),
            &ReducedEngineSource,
        )
        .map(drop),
        _ => repair(&results, Some(&file), 1, &source, &Silent).map(drop),
    }
}

/// Carries out every command on a copy of `from`; those that succeeded. None may panic, take long or touch what is
/// outside of the results.
fn survivors(from: &Path) -> Vec<&'static str> {
    let mut survived = Vec::new();
    for name in COMMANDS {
        let place = tempfile::tempdir().expect("a temporary folder");
        copy(from, place.path());
        let before = outside(place.path());
        let began = Instant::now();
        let ended = catch_unwind(AssertUnwindSafe(|| carry_out(name, place.path())));
        let took = began.elapsed();
        assert!(took < Duration::from_secs(20), "{name} takes long");
        match ended.unwrap_or_else(|_| panic!("{name} panics")) {
            Ok(()) => survived.push(name),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        assert!(
            outside(place.path()) == before,
            "{name} touches what is outside"
        );
    }
    survived
}

/// Names that lead out of a folder, or are none of its tables.
const NAMES: [&str; 12] = [
    "../victim",
    "../victim.parquet",
    "../victims/responses.parquet",
    "parts/../../victim",
    "responses.parquet/../../victim",
    "./../victim",
    "..",
    ".",
    "",
    "manifest.json",
    "runs/1.json",
    "victims\\..\\victim",
];

/// The same, absolute.
fn names(place: &Path) -> Vec<String> {
    let absolute = place.join("victim").to_string_lossy().into_owned();
    NAMES
        .map(str::to_owned)
        .into_iter()
        .chain([absolute])
        .collect()
}

const DIGEST: &str = "0000000000000000000000000000000000000000000000000000000000000000";

#[test]
fn a_name_in_a_manifest_leads_nowhere() {
    let intact = place(true);
    let mut count = 0;
    for name in names(intact.path()) {
        // In the manifest, with and without the tables that are there; and in one that is to take its place.
        for kind in 0..3 {
            let place = tempfile::tempdir().expect("a temporary folder");
            copy(intact.path(), place.path());
            let manifest = place.path().join("results/manifest.json");
            if kind == 2 {
                let next = place.path().join("results/next/manifest.json");
                std::fs::create_dir_all(next.parent().expect("a folder")).expect("made");
                std::fs::copy(&manifest, &next).expect("copied");
                forge(&next, |value| {
                    value["tables"][name.as_str()] = DIGEST.into();
                });
            } else {
                forge(&manifest, |value| {
                    if kind == 1 {
                        value["tables"] = json!({});
                    }
                    value["tables"][name.as_str()] = DIGEST.into();
                });
            }
            let survived = survivors(place.path());
            // What waits in next/ is no concern of those that only read.
            let repaired = survived.iter().all(|own| *own == "repair" || kind == 2);
            assert!(repaired, "{name:?} {kind}: {survived:?}");
            assert!(!survived.contains(&"run") && !survived.contains(&"integrity"));
            count += 1;
        }
    }
    assert!(count >= 39, "{count}");
}

#[test]
fn a_name_in_a_header_or_a_record_leads_nowhere() {
    let finished = place(true);
    let unfinished = place(false);
    for name in names(finished.path()) {
        let place = tempfile::tempdir().expect("a temporary folder");
        copy(unfinished.path(), place.path());
        forge(&place.path().join("results/parts/header.json"), |value| {
            value["parts"]
                .as_array_mut()
                .expect("a list")
                .push(name.as_str().into());
        });
        let survived = survivors(place.path());
        assert!(
            survived.iter().all(|own| *own == "repair"),
            "{name:?}: {survived:?}"
        );
        // The manifest is lost, and the record says which tables there were.
        let place = tempfile::tempdir().expect("a temporary folder");
        copy(finished.path(), place.path());
        let results = place.path().join("results");
        std::fs::remove_file(results.join("manifest.json")).expect("removed");
        forge(&results.join("runs/1.json"), |value| {
            value["tables"][name.as_str()] = DIGEST.into();
        });
        assert!(survivors(place.path()).is_empty(), "{name:?}");
    }
}

#[test]
fn a_forged_manifest_ends_with_a_clear_error() {
    let intact = place(true);
    let forgeries: [(&str, Value); 24] = [
        ("/schema", json!(0)),
        ("/schema", json!(2)),
        ("/schema", json!(4_294_967_295_u32)),
        ("/patterns", json!(0)),
        ("/patterns", json!(4_294_967_296_u64)),
        ("/patterns", json!(18_446_744_073_709_551_615_u64)),
        ("/shard", json!({ "number": 0, "count": 0 })),
        ("/shard", json!({ "number": 1, "count": 0 })),
        ("/shard", json!({ "number": 0, "count": 4 })),
        ("/shard", json!({ "number": 5, "count": 4 })),
        ("/shard", json!({ "number": 1, "count": 4_294_967_295_u32 })),
        ("/shard", json!({ "number": 1, "count": 13 })),
        ("/scenarios", json!([])),
        ("/scenarios/0/scenario", json!(1)),
        (
            "/scenarios/0/scenario",
            json!(18_446_744_073_709_551_615_u64),
        ),
        ("/scenarios/0/tuned_amplitude_m", json!(1e308)),
        ("/scenarios/0/tuned_amplitude_m", json!(-1.0)),
        ("/scenarios/1/tuned_frequency_hz", json!(1e300)),
        ("/scenarios/0/standard_deviation", json!(-1e308)),
        ("/scenarios/0/engine_order", json!(-1)),
        ("/tables/responses.parquet", json!("")),
        ("/tables/responses.parquet", json!("00")),
        ("/state", json!("stopped")),
        ("/counts", json!(7)),
    ];
    for (pointer, value) in &forgeries {
        let place = tempfile::tempdir().expect("a temporary folder");
        copy(intact.path(), place.path());
        let manifest = place.path().join("results/manifest.json");
        forge(&manifest, |content| match content.pointer_mut(pointer) {
            Some(there) => *there = value.clone(),
            None => content[pointer.trim_start_matches('/')] = value.clone(),
        });
        let survived = survivors(place.path());
        let repaired = survived.iter().all(|own| *own == "repair");
        assert!(repaired, "{pointer} {value}: {survived:?}");
    }
}

#[test]
#[cfg(unix)]
fn a_link_in_the_place_of_a_file_or_folder_is_not_followed() {
    use std::os::unix::fs::symlink;
    for (name, finished) in [
        ("manifest.json", true),
        ("responses.parquet", true),
        ("scenarios.parquet", true),
        ("summary.txt", true),
        ("runs", true),
        ("next", true),
        ("model", true),
        ("parts", false),
        ("parts", true),
        (".lock", true),
        ("damaged", true),
        ("shards", true),
    ] {
        let place = place(finished);
        let results = place.path().join("results");
        let elsewhere = place.path().join("elsewhere");
        std::fs::create_dir_all(&elsewhere).expect("made");
        let target = elsewhere.join(name);
        if results.join(name).exists() {
            std::fs::rename(results.join(name), &target).expect("moved");
        } else {
            std::fs::create_dir(&target).expect("made");
            std::fs::write(target.join("kept"), "kept").expect("written");
        }
        symlink(&target, results.join(name)).expect("linked");
        let before = outside(place.path());
        let whole = study(PATTERNS, |text| text);
        let source = MockSource::default();
        let refused = run_in(&results, &whole, 1, &source)
            .expect_err(name)
            .to_string();
        assert!(refused.contains("symbolic link"), "{name}: {refused}");
        let _ = (summarise(&results), status_of_folder(&results));
        if let Ok(found) = integrity(&results) {
            assert!(!found.is_whole(), "{name}");
        }
        let file = place.path().join("chain.toml");
        let repaired = repair(&results, Some(&file), 1, &source, &Silent);
        assert!(outside(place.path()) == before, "{name}");
        if [".lock", "damaged"].contains(&name) {
            let words = repaired.expect_err(name).to_string();
            assert!(words.ends_with("remove it"), "{name}: {words}");
        } else {
            repaired.expect(name);
            run_in(&results, &whole, 1, &source).expect(name);
            assert!(outside(place.path()) == before, "{name}");
        }
    }
}

#[test]
#[cfg(unix)]
fn a_folder_a_loop_or_a_broken_link_in_the_place_of_a_file_is_repaired() {
    use std::os::unix::fs::symlink;
    for name in ["manifest.json", "responses.parquet", "patterns.parquet"] {
        for kind in ["folder", "loop", "broken"] {
            let place = place(true);
            let results = place.path().join("results");
            let path = results.join(name);
            std::fs::remove_file(&path).expect("removed");
            match kind {
                "folder" => std::fs::create_dir(&path).expect("made"),
                "loop" => symlink(name, &path).expect("linked"),
                _ => symlink("nowhere", &path).expect("linked"),
            }
            let whole = study(PATTERNS, |text| text);
            let source = MockSource::default();
            let refused = run_in(&results, &whole, 1, &source).expect_err(name);
            assert!(matches!(
                refused,
                PipelineError::Table(TableError::Damaged { .. })
            ));
            let file = place.path().join("chain.toml");
            let repaired = repair(&results, Some(&file), 1, &source, &Silent).expect(name);
            assert!(repaired.different.is_empty(), "{name} {kind}");
            assert_eq!(repaired.set_aside.len(), 1, "{name} {kind}");
            let again = run_in(&results, &whole, 1, &source).expect("whole again");
            assert_eq!(again.rows_solved, 0);
        }
    }
}

#[test]
fn what_is_not_of_the_program_is_neither_moved_nor_removed() {
    let source = MockSource::default();
    // Files of someone who has nothing to do with the program.
    for name in ["model", "runs", "parts", "next/notes.txt", "parts/a.csv"] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(&path, "mine").expect("written");
        let refused = repair(folder.path(), None, 1, &source, &Silent);
        let nothing = matches!(refused, Err(PipelineError::NoResults { .. }));
        assert!(nothing, "{name}: {refused:?}");
        assert_eq!(files(folder.path()), [path], "{name}");
    }
    // A run takes from next/ what it left there, and nothing else.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let own = ["summary.txt", ".summary.txt.4294967294.tmp"];
    let others = ["notes.txt", "below/summary.txt"];
    for name in own.iter().chain(&others) {
        let path = folder.path().join("next").join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(&path, "mine").expect("written");
    }
    run_in(folder.path(), &study(PATTERNS, |text| text), 1, &source).expect("run");
    for name in own {
        assert!(!folder.path().join("next").join(name).exists(), "{name}");
    }
    for name in others {
        assert!(folder.path().join("next").join(name).exists(), "{name}");
    }
}
