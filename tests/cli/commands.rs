//! The commands on good input, and wrong use of them.

use crate::blisk::{GOOD, Place};

#[test]
fn init_writes_a_study_that_check_accepts_and_never_overwrites_one() {
    let place = Place::new();
    let first = place.run(&["init"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    assert!(first.stdout.contains("study.toml"));
    let check = place.run(&["check", "study.toml"]);
    assert_eq!(check.code, 0, "{}", check.stderr);
    let again = place.run(&["init"]);
    assert_eq!(again.code, 7);
    assert!(again.stderr.contains("exists already"));
    assert_eq!(place.run(&["init", "--out", "other.toml"]).code, 0);
    assert!(place.path("other.toml").exists());
}

#[test]
fn check_tells_the_size_of_the_study() {
    let place = Place::with(GOOD);
    let check = place.run(&["check", "study.toml"]);
    assert_eq!(check.code, 0, "{}", check.stderr);
    assert!(
        check.stdout.contains("10 patterns x 3 scenarios = 30 rows"),
        "{}",
        check.stdout
    );
    assert!(check.stderr.is_empty());
}

#[test]
fn check_as_json_gives_the_study_with_every_default() {
    let place = Place::with(GOOD);
    let check = place.run(&["check", "study.toml", "--json"]);
    assert_eq!(check.code, 0, "{}", check.stderr);
    let value: serde_json::Value = serde_json::from_str(&check.stdout).expect("JSON");
    assert_eq!(value["study"]["solver"]["samples_per_period"], 128);
    assert_eq!(value["study"]["reduction"]["basis"], "auto");
    assert_eq!(value["study"]["mistuning"]["projection"], "exact");
    assert_eq!(value["rows"], 30);
    assert_eq!(value["study_digest"].as_str().expect("a string").len(), 64);
}

#[test]
fn the_digest_knows_numbers_and_no_names_places_or_order_of_keys() {
    let digest = |study: &str| {
        let check = Place::with(study).run(&["check", "study.toml", "--json"]);
        assert_eq!(check.code, 0, "{}", check.stderr);
        let value: serde_json::Value = serde_json::from_str(&check.stdout).expect("JSON");
        value["study_digest"].as_str().expect("a string").to_owned()
    };
    let reference = digest(GOOD);
    for same in [
        GOOD.replace("\"small\"", "\"renamed\""),
        GOOD.replace("patterns = 10", "patterns = 99"),
        GOOD.replace("amplitude_n = 10.0", "amplitude_n = 10"),
        GOOD.replace("name = \"small\"\nseed = 7", "seed = 7\nname = \"small\""),
        format!("{GOOD}samples_per_period = 128\n[output]\ncompression = \"snappy\"\n"),
    ] {
        assert_eq!(digest(&same), reference, "{same}");
    }
    for other in [
        GOOD.replace("seed = 7", "seed = 8"),
        GOOD.replace("0.3\n", "0.31\n"),
        GOOD.replace("blade_mass_kg = 0.25", "blade_mass_kg = 0.250001"),
        GOOD.replace("[1, 3]", "[1]"),
        GOOD.replace("[0.03]", "[0.03, 0.01]"),
    ] {
        assert_ne!(digest(&other), reference, "{other}");
    }
}

#[test]
fn patterns_from_a_file_lie_beside_the_study_and_count_for_themselves() {
    let place = Place::new();
    let lines: Vec<String> = (0..6).map(|blade| format!("3,{blade},0.01")).collect();
    place.write(
        "p.csv",
        &format!("pattern,blade,deviation\n{}\n", lines.join("\n")),
    );
    let study = GOOD
        .replace("distribution = { kind = \"normal\" }", "file = \"p.csv\"")
        .replace("standard_deviation = [0.03]\n", "")
        .replace("patterns = 10\n", "");
    place.write("study.toml", &study);
    let check = place.run(&["check", "study.toml"]);
    assert_eq!(check.code, 0, "{}", check.stderr);
    assert!(
        check.stdout.contains("1 patterns x 3 scenarios"),
        "{}",
        check.stdout
    );
}

#[test]
fn wrong_use_of_the_command_line_exits_with_2_and_says_what_is_accepted() {
    let place = Place::with(
        &GOOD
            .replace("[2]", "[2, 3]")
            .replace("[0.03]", "[0.03, 0.01]"),
    );
    let response = [
        "response",
        "study.toml",
        "--frequencies",
        "340:370:5",
        "--out",
        "c.csv",
    ];
    let with = |more: &[&'static str]| -> Vec<&'static str> { [&response[..], more].concat() };
    let tuned = ["--pattern", "tuned", "--load", "50"];
    let cases: Vec<(Vec<&str>, &str)> = vec![
        (vec![], "Usage"),
        (vec!["runn"], "similar"),
        (vec!["run"], "STUDY"),
        (vec!["run", "study.toml", "--threads", "0"], "1..=1024"),
        (with(&["--pattern", "tuned", "--load", "-3"]), "--load"),
        (
            with(&["--pattern", "tuned", "--load", "sticky"]),
            "stuck, slide or free",
        ),
        (
            with(&["--pattern", "first", "--load", "50"]),
            "accepted: tuned",
        ),
        (with(&tuned), "--engine-order, one of 2, 3"),
        (
            with(&[&tuned[..], &["--engine-order", "4"]].concat()),
            "accepted: 2, 3",
        ),
        (
            with(&["--pattern", "1", "--load", "50", "--engine-order", "2"]),
            "--standard-deviation, one of 0.03, 0.01",
        ),
        (
            with(&[
                "--pattern",
                "1",
                "--load",
                "50",
                "--engine-order",
                "2",
                "--standard-deviation",
                "0.5",
            ]),
            "accepted: 0.03, 0.01",
        ),
    ];
    for (arguments, fragment) in cases {
        let ended = place.run(&arguments);
        assert_eq!(ended.code, 2, "{arguments:?}: {}", ended.stderr);
        assert!(
            ended.stderr.contains(fragment),
            "{arguments:?}: {}",
            ended.stderr
        );
        assert!(ended.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn a_frequency_grid_that_is_none_is_refused() {
    let place = Place::with(GOOD);
    for grid in [
        "340:370",
        "340:370:1",
        "370:340:5",
        "0:10:5",
        "a:b:c",
        "340:370:0",
        "1:inf:3",
        "1:nan:3",
    ] {
        let ended = place.run(&[
            "response",
            "study.toml",
            "--pattern",
            "tuned",
            "--load",
            "free",
            "--frequencies",
            grid,
            "--out",
            "c.csv",
        ]);
        assert_eq!(ended.code, 2, "{grid}");
        assert!(
            ended.stderr.contains("START:STOP:COUNT"),
            "{grid}: {}",
            ended.stderr
        );
    }
    let ended = place.run(&[
        "response",
        "study.toml",
        "--pattern",
        "tuned",
        "--load",
        "free",
        "--frequencies",
        "1:2:3",
        "--out",
        "curve.txt",
    ]);
    assert_eq!(ended.code, 2);
    assert!(
        ended.stderr.contains(".csv or .parquet"),
        "{}",
        ended.stderr
    );
}

#[test]
fn help_and_version_are_results() {
    let place = Place::new();
    for arguments in [["--help"], ["--version"]] {
        let ended = place.run(&arguments);
        assert_eq!(ended.code, 0);
        assert!(ended.stdout.contains("blisk") && ended.stderr.is_empty());
    }
    let help = place.run(&["--help"]).stdout;
    for command in [
        "init",
        "check",
        "model",
        "run",
        "response",
        "stats",
        "Exit codes",
    ] {
        assert!(help.contains(command), "{command}");
    }
}

#[test]
fn files_that_are_not_there_exit_with_7_and_are_named() {
    let place = Place::new();
    let check = place.run(&["check", "nowhere.toml"]);
    assert_eq!(check.code, 7);
    assert!(check.stderr.contains("nowhere.toml"), "{}", check.stderr);
    let stats = place.run(&["stats", "nowhere"]);
    assert_eq!(stats.code, 7);
    assert!(stats.stderr.contains("manifest.json"), "{}", stats.stderr);
    place.write(
        "study.toml",
        &GOOD
            .replace(
                "distribution = { kind = \"normal\" }\n",
                "file = \"absent.csv\"\n",
            )
            .replace("standard_deviation = [0.03]\n", ""),
    );
    let patterns = place.run(&["check", "study.toml"]);
    assert_eq!(patterns.code, 7);
    assert!(
        patterns.stderr.contains("absent.csv"),
        "{}",
        patterns.stderr
    );
}

#[test]
fn a_damaged_manifest_exits_with_8() {
    let place = Place::new();
    std::fs::create_dir(place.path("r")).expect("create");
    place.write("r/manifest.json", "{ \"schema\": 1 ");
    let stats = place.run(&["stats", "r"]);
    assert_eq!(stats.code, 8);
    assert!(stats.stderr.contains("manifest.json"), "{}", stats.stderr);
}

#[test]
fn a_model_is_exported_as_a_bundle_that_another_study_reads() {
    let place = Place::with(GOOD);
    // The export is written before the reduction begins.
    let exported = place.run(&["model", "study.toml", "--export", "bundle"]);
    assert!(place.path("bundle/K.mtx").exists(), "{}", exported.stderr);
    let start = GOOD.find("[model]").expect("a model");
    let end = GOOD.find("[contact]").expect("a contact");
    let study = format!(
        "{}[model]\nsource = \"bundle\"\n[model.bundle]\npath = \"bundle\"\n{}",
        &GOOD[..start],
        &GOOD[end..]
    );
    place.write("second.toml", &study);
    let check = place.run(&["check", "second.toml"]);
    assert_eq!(check.code, 0, "{}", check.stderr);
    // A bundle with a matrix of the wrong size is a matter of the model, not of the study.
    let matrix = std::fs::read_to_string(place.path("bundle/M.mtx")).expect("read");
    place.write(
        "bundle/M.mtx",
        &matrix.replacen("symmetric", "skew-symmetric", 1),
    );
    let refused = place.run(&["check", "second.toml"]);
    assert_eq!(refused.code, 4, "{}", refused.stderr);
    assert!(refused.stderr.contains("M.mtx:1"), "{}", refused.stderr);
}

#[test]
fn response_by_continuation_says_whether_the_curve_is_complete_and_the_directions_agree() {
    let place = Place::with(GOOD);
    let response = |load: &'static str, frequencies: &'static str, more: &[&'static str]| {
        let arguments = [
            "response",
            "study.toml",
            "--continuation",
            "--pattern",
            "tuned",
            "--load",
            load,
            "--frequencies",
            frequencies,
            "--out",
            "curve.csv",
        ];
        place.run(&[&arguments[..], more].concat())
    };
    let followed = response("50", "340:370:7", &["--json"]);
    assert_eq!(followed.code, 0, "{}", followed.stderr);
    let value: serde_json::Value = serde_json::from_str(&followed.stdout).expect("JSON");
    assert_eq!(value["complete"]["up"], true);
    assert_eq!(value["complete"]["down"], true);
    assert_eq!(value["curve"]["directions_agree"], true);
    assert_eq!(value["curve"]["folds"].as_array().map(Vec::len), Some(0));
    let full = response("50", "340:370:7", &["--fidelity", "full"]);
    assert_eq!(full.code, 2);
    assert!(
        full.stderr.contains("--fidelity reduced"),
        "{}",
        full.stderr
    );
    // Two directions, seven frequencies, six blades.
    assert_eq!(value["rows"], 84);
    let table = std::fs::read_to_string(place.path("curve.csv")).expect("the table");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(
        lines[0],
        "frequency_hz,blade,amplitude_m,status,direction,branch,fold"
    );
    assert_eq!(lines.len(), 85);
    assert!(lines[1].starts_with("340,0,") && lines[1].ends_with(",ok,up,0,false"));
    assert!(lines[43].starts_with("370,0,") && lines[43].ends_with(",ok,down,0,false"));
    let told = response("50", "340:370:7", &[]);
    assert!(told.stdout.contains("both directions pass the same"));
    let linear = response("stuck", "340:370:7", &[]);
    assert_eq!(linear.code, 2);
    assert!(linear.stderr.contains("one branch"), "{}", linear.stderr);
    assert_eq!(response("50", "340:340:1", &[]).code, 2);
}
