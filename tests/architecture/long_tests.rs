//! The kept record of `.ci/long` holds every test that `cargo test` leaves out, and no other; those that
//! fail in it are listed as open.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

/// Names of the functions that follow `#[ignore`, each after that of its test binary.
fn ignored_tests(folder: &Path, binary: Option<&str>, found: &mut BTreeSet<(String, String)>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        if path.is_dir() {
            ignored_tests(&path, binary.or(Some(&name)), found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("a source");
            // What writes data is called so, and is no test.
            let names = names_after_ignore(&text).into_iter();
            for name in names.filter(|name| !name.starts_with("make_")) {
                found.insert((binary.unwrap_or("blisk").to_owned(), name));
            }
        }
    }
}

fn names_after_ignore(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut ignored = false;
    for line in text.lines().map(str::trim_start) {
        if line.starts_with("#[ignore") {
            ignored = true;
        } else if let Some(rest) = line.strip_prefix("fn ")
            && ignored
        {
            ignored = false;
            names.extend(rest.split('(').next().map(str::to_owned));
        }
    }
    names
}

fn record() -> serde_json::Value {
    let path = root().join("results/validation/long.json");
    let text = std::fs::read_to_string(&path).expect("results/validation/long.json, by .ci/long");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn the_record_of_long_tests_holds_each_of_them_and_no_other() {
    let mut wanted = BTreeSet::new();
    ignored_tests(&root().join("tests"), None, &mut wanted);
    ignored_tests(&root().join("src"), Some("blisk"), &mut wanted);
    assert!(wanted.len() > 30, "{wanted:?}");
    let record = record();
    let tests = record["tests"].as_object().expect("tests");
    let found: BTreeSet<_> = tests
        .keys()
        .map(|name| {
            let (binary, _) = name.split_once("::").expect("binary::name");
            let (_, function) = name.rsplit_once("::").expect("binary::name");
            (binary.to_owned(), function.to_owned())
        })
        .collect();
    assert_eq!(found, wanted, "run .ci/long");
    assert_eq!(record["missing"], 0, "run .ci/long");
}

#[test]
fn a_long_test_that_failed_is_listed_as_open() {
    let bars = std::fs::read_to_string(root().join("results/validation/open_bars.toml"));
    let bars: toml::Table = bars.expect("open_bars.toml").parse().expect("TOML");
    let listed: BTreeSet<&str> = bars["bar"]
        .as_array()
        .expect("bars")
        .iter()
        .filter_map(|bar| bar.get("test")?.as_str())
        .collect();
    let record = record();
    let failed: BTreeSet<&str> = record["tests"]
        .as_object()
        .expect("tests")
        .iter()
        .filter(|(_, test)| test["passed"] != true)
        .map(|(name, _)| name.as_str())
        .collect();
    assert_eq!(failed, listed);
}

#[test]
fn an_ignored_test_is_found_in_a_source() {
    let text = "#[test]\nfn one() {}\n#[test]\n#[ignore = \"long\"]\n#[expect(x)]\nfn two() {}\nfn three() {}\n";
    assert_eq!(names_after_ignore(text), ["two"]);
}
