//! What one build of the program solved is never mixed with what another one solves.

use std::path::Path;

use serde_json::Value;

use crate::blisk::{Ended, GOOD, Place};
use crate::forgery::forge;

const RESULTS: &str = "results/small";
const OTHER: &str = "0123456789abcdef0123456789abcdef";

/// What `blisk --version` says after `build`.
fn this_build(place: &Place) -> String {
    let version = place.run(&["--version"]).stdout;
    let line = version.lines().find_map(|line| line.strip_prefix("build "));
    line.expect("a build").to_owned()
}

fn of_another_build(manifest: &Path) {
    forge(manifest, |value| {
        assert!(value["build"].is_string(), "{value}");
        value["build"] = OTHER.into();
    });
}

fn refused(ended: &Ended, this: &str) {
    assert_eq!(ended.code, 9, "{}", ended.stderr);
    let wanted = format!("build: stored {OTHER}, this program {this}");
    assert!(ended.stderr.contains(&wanted), "{}", ended.stderr);
    assert!(ended.stderr.contains("--solve-anew"), "{}", ended.stderr);
}

fn solved() -> Place {
    let place = Place::with(GOOD);
    let run = place.run(&["run", "study.toml"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    place
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("read")).expect("JSON")
}

#[test]
fn the_version_names_build_and_commit() {
    let place = Place::new();
    let ended = place.run(&["--version"]);
    let lines: Vec<&str> = ended.stdout.lines().collect();
    let [program, build, commit] = lines[..] else {
        panic!("{}", ended.stdout);
    };
    assert_eq!(program, concat!("blisk ", env!("CARGO_PKG_VERSION")));
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let build = build.strip_prefix("build ").expect("a build");
    assert!(build.len() == 32 && digits(build), "{build}");
    let commit = commit.strip_prefix("commit ").expect("a commit");
    let hash = commit.strip_suffix(", changed").unwrap_or(commit);
    assert!(
        hash == "none" || (hash.len() >= 40 && digits(hash)),
        "{commit}"
    );
}

#[test]
fn manifest_and_run_records_hold_the_build_and_no_table_does() {
    let place = solved();
    let this = this_build(&place);
    let results = place.path(RESULTS);
    assert_eq!(json(&results.join("manifest.json"))["build"], *this);
    assert_eq!(json(&results.join("runs/1.json"))["build"], *this);
    for entry in std::fs::read_dir(&results).expect("a folder") {
        let path = entry.expect("an entry").path();
        let is_table = path.extension().is_some_and(|ending| ending == "parquet");
        if is_table || path.ends_with("summary.txt") {
            let content = std::fs::read(&path).expect("read");
            let found = content.windows(32).any(|part| part == this.as_bytes());
            assert!(!found, "{}", path.display());
        }
    }
}

#[test]
fn rows_of_another_build_are_neither_continued_nor_extended() {
    let place = solved();
    let this = this_build(&place);
    let manifest = place.path(RESULTS).join("manifest.json");
    of_another_build(&manifest);
    let table = place.path(RESULTS).join("responses.parquet");
    let before = [&manifest, &table].map(|path| std::fs::read(path).expect("read"));
    refused(&place.run(&["run", "study.toml"]), &this);
    place.write(
        "study.toml",
        &GOOD.replace("patterns = 10", "patterns = 14"),
    );
    refused(&place.run(&["run", "study.toml"]), &this);
    // What else differs is named as well.
    place.write("study.toml", &GOOD.replace("seed = 7", "seed = 8"));
    let both = place.run(&["run", "study.toml", "--solve-anew"]);
    assert_eq!(both.code, 9);
    assert!(both.stderr.contains("study.seed"), "{}", both.stderr);
    let after = [&manifest, &table].map(|path| std::fs::read(path).expect("read"));
    assert!(before == after);
    // A manifest of version 0.1.0 names no build.
    place.write("study.toml", GOOD);
    forge(&manifest, |value| {
        value.as_object_mut().expect("an object").remove("build");
    });
    let none = place.run(&["run", "study.toml"]);
    assert_eq!(none.code, 9, "{}", none.stderr);
    assert!(none.stderr.contains("stored (none)"), "{}", none.stderr);
}

#[test]
fn everything_is_solved_anew_where_that_is_asked_for() {
    let place = solved();
    let this = this_build(&place);
    let results = place.path(RESULTS);
    let read = |name: &str| std::fs::read(results.join(name)).expect("read");
    let fresh = [read("responses.parquet"), read("manifest.json")];
    // Rows of another build would show.
    let models = || {
        std::fs::read_dir(results.join("model"))
            .expect("a folder")
            .count()
    };
    assert_eq!(models(), 1);
    of_another_build(&results.join("manifest.json"));
    let anew = place.run(&["run", "study.toml", "--solve-anew"]);
    assert_eq!(anew.code, 0, "{}", anew.stderr);
    assert!(anew.stderr.contains("superseded/1"), "{}", anew.stderr);
    assert!(
        anew.stderr.contains("solved 30 rows, reused 0"),
        "{}",
        anew.stderr
    );
    assert!([read("responses.parquet"), read("manifest.json")] == fresh);
    let old = json(&results.join("superseded/1/manifest.json"));
    assert_eq!(old["build"], OTHER);
    assert_eq!(json(&results.join("runs/1.json"))["build"], *this);
    // Asked for again there is nothing to do.
    let again = place.run(&["run", "study.toml", "--solve-anew"]);
    assert!(
        again.stderr.contains("nothing to solve"),
        "{}",
        again.stderr
    );
    assert!(!results.join("superseded/2").exists());
}

#[test]
fn lost_manifest_and_records_leave_a_way_out() {
    let place = solved();
    let results = place.path(RESULTS);
    let fresh = std::fs::read(results.join("responses.parquet")).expect("read");
    std::fs::remove_file(results.join("manifest.json")).expect("removed");
    std::fs::remove_dir_all(results.join("runs")).expect("removed");
    for command in [&["run", "study.toml"][..], &["verify", RESULTS, "--repair"]] {
        let ended = place.run(command);
        assert_eq!(ended.code, 8, "{command:?} {}", ended.stderr);
        assert!(ended.stderr.contains("--solve-anew"), "{}", ended.stderr);
    }
    let anew = place.run(&["run", "study.toml", "--solve-anew"]);
    assert_eq!(anew.code, 0, "{}", anew.stderr);
    assert!(std::fs::read(results.join("responses.parquet")).expect("read") == fresh);
}

#[test]
fn shards_of_another_build_are_not_merged() {
    let place = Place::with(GOOD);
    let this = this_build(&place);
    for shard in ["1/2", "2/2"] {
        let ended = place.run(&["run", "study.toml", "--shard", shard]);
        assert_eq!(ended.code, 0, "{}", ended.stderr);
    }
    let merge = || place.run(&["merge", RESULTS, "--out", "results/merged"]);
    let manifest = |shard: &str| {
        place
            .path(RESULTS)
            .join(format!("shards/{shard}/manifest.json"))
    };
    of_another_build(&manifest("2-of-2"));
    let mixed = merge();
    assert_eq!(mixed.code, 9, "{}", mixed.stderr);
    let wanted = format!("build: {OTHER} in the first, {this} in the second");
    assert!(mixed.stderr.contains(&wanted), "{}", mixed.stderr);
    of_another_build(&manifest("1-of-2"));
    refused(&merge(), &this);
    let anew = ["run", "study.toml", "--solve-anew", "--shard"];
    for shard in ["1/2", "2/2"] {
        let ended = place.run(&[&anew[..], &[shard]].concat());
        assert_eq!(ended.code, 0, "{}", ended.stderr);
        assert!(ended.stderr.contains("reused 0"), "{}", ended.stderr);
    }
    assert_eq!(merge().code, 0, "{}", merge().stderr);
}

#[test]
fn a_comparison_names_the_builds_and_warns_where_they_differ() {
    let place = solved();
    let this = this_build(&place);
    let second = ["run", "study.toml", "--out", "results/second"];
    assert_eq!(place.run(&second).code, 0);
    let compare = || place.run(&["compare", RESULTS, "results/second"]);
    let same = compare();
    assert!(
        same.stdout.contains(&format!("build {this}")),
        "{}",
        same.stdout
    );
    assert!(!same.stdout.contains("WARNING: different builds"));
    of_another_build(&place.path("results/second/manifest.json"));
    let mixed = compare().stdout;
    for wanted in [
        &format!("A: build {this}"),
        &format!("B: build {OTHER}"),
        "WARNING: different builds",
    ] {
        assert!(mixed.contains(wanted), "{wanted}: {mixed}");
    }
    let json = place
        .run(&["compare", RESULTS, "results/second", "--json"])
        .stdout;
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json["folders"][1]["build"], OTHER);
}

#[test]
fn what_is_solved_again_beside_rows_of_another_build_is_said_to_be_so_or_left_out() {
    let place = solved();
    of_another_build(&place.path(RESULTS).join("manifest.json"));
    for command in [
        &["verify", RESULTS, "--scenario", "1", "--pattern", "3"][..],
        &["verify", RESULTS, "--sample", "1"],
    ] {
        let ended = place.run(command);
        let wanted = format!("warning: build {OTHER} solved the rows");
        assert!(ended.stderr.contains(&wanted), "{}", ended.stderr);
    }
    let report = place.run(&["report", RESULTS]);
    assert_eq!(report.code, 0, "{}", report.stderr);
    let wanted = "its curves need not be those of the rows";
    assert!(report.stderr.contains(wanted), "{}", report.stderr);
    let page = std::fs::read_to_string(place.path(RESULTS).join("report.html")).expect("read");
    assert!(page.contains(OTHER));
    // A repair would mix rows.
    let table = place.path(RESULTS).join("responses.parquet");
    let mut content = std::fs::read(&table).expect("read");
    content[200] ^= 1;
    std::fs::write(&table, &content).expect("written");
    let repair = place.run(&["verify", RESULTS, "--repair"]);
    refused(&repair, &this_build(&place));
    assert!(std::fs::read(&table).expect("read") == content);
}

#[test]
fn an_estimate_is_not_continued_by_another_build() {
    let study = GOOD.replace("patterns = 10", "patterns = 100");
    let place = Place::with(&study);
    let estimate = |solves: &str| {
        place.run(&[
            "estimate",
            "study.toml",
            "--out",
            "e",
            "--solves",
            solves,
            "--patterns",
            "100",
        ])
    };
    assert_eq!(estimate("60").code, 0, "{}", estimate("60").stderr);
    let header = place.path("e/parts/header.json");
    forge(&header, |value| value["build"] = OTHER.into());
    refused(&estimate("80"), &this_build(&place));
    assert_eq!(
        json(&place.path("e/estimate.json"))["build"],
        *this_build(&place)
    );
}
