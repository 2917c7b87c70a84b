//! The identity of a build: what changes it and what does not; and parts of another build.

#[path = "../../build.rs"]
#[allow(dead_code, clippy::print_stdout)]
mod build_script;

use std::collections::BTreeMap;
use std::path::Path;

use blisk::campaign::{repair, set_other_builds_aside};
use blisk::identity;
use blisk::population::table::{Manifest, PartHeader};
use blisk::study::PipelineError;

use crate::folder::{Silent, bytes, copy, files, interrupt_in, reference, run_in};
use crate::mock_engine::{MockSource, study};

/// The covered files of this package, in a folder of their own, with documentation and a test beside them.
fn package() -> tempfile::TempDir {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    copy(&root.join("src"), &folder.path().join("src"));
    for file in ["build.rs", "Cargo.toml", "Cargo.lock"] {
        std::fs::copy(root.join(file), folder.path().join(file)).expect("copied");
    }
    for (name, text) in [("docs/a.md", "a page"), ("tests/a.rs", "a test")] {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, text).expect("written");
    }
    folder
}

fn identity_in(folder: &Path, settings: &[(&str, &str)]) -> String {
    let files = build_script::covered_files(folder).expect("read");
    assert!(files.len() > 300, "{} files", files.len());
    let pairs = settings.iter();
    let settings: BTreeMap<String, String> = pairs
        .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
        .collect();
    build_script::identity_of(&files, &settings)
}

#[test]
fn the_same_sources_are_the_same_build_in_any_folder_with_either_end_of_line() {
    let [first, second] = [package(), package()];
    let own = identity_in(first.path(), &[]);
    assert_eq!(own, identity_in(Path::new(env!("CARGO_MANIFEST_DIR")), &[]));
    for file in files(&second.path().join("src")) {
        let text = std::fs::read_to_string(&file).expect("text");
        std::fs::write(&file, text.replace('\n', "\r\n")).expect("written");
    }
    assert_eq!(own, identity_in(second.path(), &[]));
    std::fs::write(second.path().join("docs/a.md"), "another page").expect("written");
    std::fs::write(second.path().join("tests/b.rs"), "another test").expect("written");
    assert_eq!(own, identity_in(second.path(), &[]));
}

#[test]
fn a_changed_added_removed_or_renamed_source_is_another_build_and_so_is_a_changed_setting() {
    let package = package();
    let place = |name: &str| package.path().join(name);
    let mut seen = vec![identity_in(package.path(), &[])];
    let mut is_new = |what: &str, settings: &[(&str, &str)]| {
        let found = identity_in(package.path(), settings);
        assert!(!seen.contains(&found), "{what}");
        seen.push(found);
    };
    let append = |name: &str| {
        let text = std::fs::read_to_string(place(name)).expect("text");
        std::fs::write(place(name), text + " ").expect("written");
    };
    for name in [
        "src/lib.rs",
        "src/study/template.toml",
        "build.rs",
        "Cargo.toml",
        "Cargo.lock",
    ] {
        append(name);
        is_new(name, &[]);
    }
    std::fs::write(place("src/empty"), "").expect("written");
    is_new("added", &[]);
    std::fs::rename(place("src/empty"), place("src/void")).expect("renamed");
    is_new("renamed", &[]);
    std::fs::remove_file(place("Cargo.lock")).expect("removed");
    is_new("removed", &[]);
    is_new("a feature", &[("CARGO_FEATURE_A", "1")]);
    is_new("another feature", &[("CARGO_FEATURE_B", "1")]);
    is_new("a compiler", &[("rustc -vV", "1.95.0")]);
    is_new("another compiler", &[("rustc -vV", "1.96.0")]);
}

#[test]
fn the_commit_is_none_without_a_repository() {
    assert_eq!(build_script::commit_of(package().path()), "none");
}

#[test]
fn parts_of_another_build_are_refused_or_set_aside() {
    let whole = study(40, |text| text);
    let finished_before = [false, true];
    for finished in finished_before {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let results = folder.path();
        if finished {
            run_in(results, &study(20, |text| text), 2, &MockSource::default()).expect("run");
        }
        interrupt_in(results, &whole, 20);
        let mut header = PartHeader::read(results).expect("whole").expect("a header");
        assert_eq!(header.build, identity::BUILD);
        assert!(!header.parts.is_empty() && header.coming.is_none());
        header.build = "another".to_owned();
        header.write(results).expect("written");
        let refused = run_in(results, &whole, 1, &MockSource::default());
        let Err(PipelineError::DifferentBuild { stored, .. }) = refused else {
            panic!("{refused:?}");
        };
        assert_eq!(stored, "another");
        let place = set_other_builds_aside(results, &whole, None).expect("set aside");
        assert_eq!(place, Some(results.join("superseded/1")));
        assert!(results.join("superseded/1/parts/header.json").exists());
        let outcome = run_in(results, &whole, 1, &MockSource::default()).expect("anew");
        assert_eq!((outcome.rows_solved, outcome.rows_reused), (160, 0));
        assert!(bytes(results) == reference(40));
    }
}

#[test]
fn an_interrupted_move_of_other_results_is_gone_on_with() {
    let whole = study(40, |text| text);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let results = folder.path();
    run_in(results, &whole, 2, &MockSource::default()).expect("run");
    let mut manifest = Manifest::read(results).expect("whole").expect("there");
    manifest.build = "another".to_owned();
    manifest.write(results).expect("written");
    // The manifest goes first, and the process is killed.
    std::fs::create_dir_all(results.join("superseded/1")).expect("made");
    let gone = results.join("superseded/1/manifest.json");
    std::fs::rename(results.join("manifest.json"), gone).expect("moved");
    let refused = run_in(results, &whole, 1, &MockSource::default());
    assert!(
        matches!(refused, Err(PipelineError::Table(_))),
        "{refused:?}"
    );
    let place = set_other_builds_aside(results, &whole, None).expect("set aside");
    assert_eq!(place, Some(results.join("superseded/2")));
    let outcome = run_in(results, &whole, 1, &MockSource::default()).expect("anew");
    assert_eq!(outcome.rows_reused, 0);
    assert!(bytes(results) == reference(40));
}

#[test]
fn a_repair_makes_no_parts_of_another_build_its_own() {
    let whole = study(40, |text| text);
    for with_manifest in [false, true] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let results = folder.path();
        interrupt_in(results, &whole, 40);
        if !with_manifest {
            // As an interrupted estimate is.
            std::fs::remove_file(results.join("manifest.json")).expect("removed");
            std::fs::remove_dir_all(results.join("runs")).expect("removed");
        }
        let mut header = PartHeader::read(results).expect("whole").expect("a header");
        header.build = "another".to_owned();
        header.write(results).expect("written");
        let part = header.parts.iter().next().expect("a part");
        std::fs::write(results.join("parts").join(part), "").expect("written");
        let repaired = repair(results, None, 1, &MockSource::default(), &Silent);
        let after = PartHeader::read(results).expect("whole").expect("a header");
        assert_eq!(after.build, "another");
        if with_manifest {
            assert_eq!(repaired.expect("repaired").set_aside.len(), 1);
            assert!(!after.parts.contains(part));
        } else {
            let other = matches!(repaired, Err(PipelineError::DifferentBuild { .. }));
            assert!(other && after == header, "{repaired:?}");
        }
        let refused = run_in(results, &whole, 1, &MockSource::default());
        let other = matches!(refused, Err(PipelineError::DifferentBuild { .. }));
        assert!(other, "{refused:?}");
    }
}
