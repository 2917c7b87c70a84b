//! `blisk tradeoff`, `[accuracy]` and `run --accuracy`.

use serde_json::Value;

use crate::blisk::{GOOD, Place};

/// The good study without the settings that `[accuracy]` chooses.
fn open() -> String {
    GOOD.replace("[solver]\nharmonics = [1, 3]\n", "")
}

fn accurate() -> String {
    format!("{}[accuracy]\namplitude_error = 0.01\n", open())
}

fn read(place: &Place, file: &str) -> Vec<u8> {
    std::fs::read(place.path(file)).expect(file)
}

fn manifest(place: &Place, results: &str) -> Value {
    let bytes = read(place, &format!("{results}/manifest.json"));
    serde_json::from_slice(&bytes).expect("JSON")
}

#[test]
fn a_trade_off_names_the_cheapest_settings_and_writes_the_same_tables_with_any_threads() {
    let place = Place::with(GOOD);
    let command = |out: &str, threads: &str| {
        let ended = place.run(&[
            "tradeoff",
            "study.toml",
            "--out",
            out,
            "--threads",
            threads,
            "--json",
        ]);
        assert_eq!(ended.code, 0, "{}", ended.stderr);
        serde_json::from_str::<Value>(&ended.stdout).expect("JSON")
    };
    let report = command("one", "1");
    command("two", "2");
    for table in ["tradeoff.parquet", "tradeoff_rows.parquet"] {
        let [one, two] = ["one", "two"].map(|out| read(&place, &format!("{out}/{table}")));
        assert!(one == two, "{table}");
    }
    assert!(place.path("one/tradeoff_times.parquet").exists());
    assert_eq!(report["reference"]["kind"], "joint");
    assert_eq!(report["reference"]["without_value"], 0);
    let settings = report["settings"].as_array().expect("a list");
    let number = |setting: &Value, path: &str| setting.pointer(path).and_then(Value::as_f64);
    for choice in report["choices"].as_array().expect("a list") {
        let accepted = choice["accepted_error"].as_f64().expect("a number");
        let chosen = choice["setting"].as_u64().expect("a setting") as usize;
        let upper = number(&settings[chosen], "/amplitude/p95_upper").expect("a bound");
        assert!(upper <= accepted, "{accepted}: {upper}");
        // Nothing that is cheaper is as good.
        for other in settings {
            let cheaper = other["operations"].as_f64() < settings[chosen]["operations"].as_f64();
            let upper = number(other, "/amplitude/p95_upper").unwrap_or(f64::INFINITY);
            assert!(!cheaper || upper > accepted, "{other}");
        }
    }
    // Under a constant normal load, harmonics 1 and 3 leave out more than they do with 5.
    let error = |harmonics: &str| {
        let of_set = |own: &&Value| own["harmonics"] == harmonics && own["knob"] == "harmonics";
        let setting = settings.iter().find(of_set).expect("a level");
        number(setting, "/knob_amplitude/p95").expect("an error")
    };
    assert!(error("1") > error("1-3-5") && error("1-3-5") > error("1-3-5-7"));
    let shown = place.run(&["tradeoff", "study.toml", "--patterns", "4"]);
    // Settings, rows and time are said before the ladder is solved.
    let said = shown
        .stderr
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    for words in [
        "settings of 4 patterns: about",
        "rows; about",
        "of processor time",
    ] {
        assert!(said.contains(words), "{words} in {said}");
    }
    assert!(
        shown.stdout.contains("cheapest within 1 %: setting"),
        "{}",
        shown.stdout
    );
}

#[test]
fn the_full_contact_model_confirms_the_reference() {
    let place = Place::with(GOOD);
    let ended = place.run(&[
        "tradeoff",
        "study.toml",
        "--reference",
        "full",
        "--patterns",
        "2",
        "--json",
    ]);
    let report: Value = serde_json::from_str(&ended.stdout).expect("JSON");
    let check = &report["reference"]["full_contact"][0];
    assert_eq!(check["status"], "ok");
    let error = check["amplitude_error"].as_f64().expect("a number");
    assert!(error.abs() < 3e-4, "{error}");
}

#[test]
fn linear_limits_alone_have_nothing_to_trade() {
    let place = Place::with(&GOOD.replace("\"slide\", 50, \"stuck\"", "\"slide\", \"stuck\""));
    let ended = place.run(&["tradeoff", "study.toml"]);
    assert_eq!(ended.code, 2);
    assert!(
        ended.stderr.contains("sweep.normal_load_n"),
        "{}",
        ended.stderr
    );
}

#[test]
fn an_accepted_error_chooses_settings_once_and_records_the_evidence() {
    let place = Place::with(&accurate());
    let run = place.run(&["run", "study.toml", "--out", "one", "--threads", "1"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stdout.contains("accepted numerical error of 1 %"),
        "{}",
        run.stdout
    );
    let chosen = &manifest(&place, "one")["chosen"]["accuracy"];
    assert_eq!(chosen["met"], true);
    let upper = chosen["evidence"]["amplitude"]["p95_upper"].as_f64();
    assert!(upper.expect("a bound") <= 0.01);
    assert!(
        !chosen["evidence"]["tried"]
            .as_array()
            .expect("a list")
            .is_empty()
    );
    // The rows are those of the settings written by hand.
    let setting = &chosen["setting"];
    assert_eq!(setting["basis"], "tuned_receptances");
    let text = |key: &str| setting[key].as_str().expect("a level").to_owned();
    let level = text("harmonics");
    let tolerance = level.strip_prefix("auto ").expect("automatic harmonics");
    let by_hand = format!(
        "{}[reduction]\nerror = {}\n[solver]\nharmonic_tolerance = {tolerance}\nsamples_per_period = {}\n\
         peak_tolerance = {}\n",
        open(),
        text("reduction_error"),
        text("samples_per_period"),
        text("peak_tolerance"),
    );
    place.write("by-hand.toml", &by_hand);
    let written = place.run(&["run", "by-hand.toml", "--out", "by-hand"]);
    assert_eq!(written.code, 0, "{by_hand}\n{}", written.stderr);
    let amplitudes = |results: &str| {
        let stats = place.run(&["stats", results, "--json"]);
        let value: Value = serde_json::from_str(&stats.stdout).expect("JSON");
        value["scenarios"].clone()
    };
    assert_eq!(amplitudes("one"), amplitudes("by-hand"));
    // The same with any number of threads, from the command line, and solved again.
    let two = place.run(&["run", "study.toml", "--out", "two", "--threads", "2"]);
    assert_eq!(two.stdout, run.stdout);
    place.write("open.toml", &open());
    let three = place.run(&["run", "open.toml", "--out", "three", "--accuracy", "1%"]);
    assert_eq!(three.code, 0, "{}", three.stderr);
    for other in ["two", "three"] {
        for table in ["responses.parquet", "scenarios.parquet", "manifest.json"] {
            let same =
                read(&place, &format!("one/{table}")) == read(&place, &format!("{other}/{table}"));
            assert!(same, "{table} of {other}");
        }
    }
    let again = place.run(&["run", "study.toml", "--out", "one"]);
    assert!(
        again.stderr.contains("nothing to solve"),
        "{}",
        again.stderr
    );
    let replay = place.run(&["verify", "one", "--scenario", "1", "--pattern", "3"]);
    assert!(replay.stdout.contains("bit-identical"), "{}", replay.stdout);
}

#[test]
fn an_accepted_error_of_linear_limits_needs_no_sample() {
    let study = accurate().replace("\"slide\", 50, \"stuck\"", "\"slide\", \"stuck\"");
    let place = Place::with(&study);
    let run = place.run(&["run", "study.toml", "--out", "one"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let chosen = &manifest(&place, "one")["chosen"]["accuracy"];
    assert_eq!(chosen["met"], true);
    assert!(chosen["evidence"].is_null());
}

#[test]
fn a_longer_study_keeps_the_settings_and_shards_come_to_the_same_bytes() {
    let place = Place::with(&accurate());
    assert_eq!(place.run(&["run", "study.toml", "--out", "grown"]).code, 0);
    place.write(
        "study.toml",
        &accurate().replace("patterns = 10", "patterns = 25"),
    );
    assert_eq!(place.run(&["run", "study.toml", "--out", "grown"]).code, 0);
    assert_eq!(place.run(&["run", "study.toml", "--out", "whole"]).code, 0);
    for share in ["1/2", "2/2"] {
        let shard = place.run(&["run", "study.toml", "--out", "cut", "--shard", share]);
        assert_eq!(shard.code, 0, "{}", shard.stderr);
        // The next one finds no choice, and makes the same.
        std::fs::remove_dir_all(place.path("cut/model")).expect("a cache");
    }
    let merged = place.run(&[
        "merge",
        "cut/shards/1-of-2",
        "cut/shards/2-of-2",
        "--out",
        "merged",
    ]);
    assert_eq!(merged.code, 0, "{}", merged.stderr);
    for results in ["grown", "merged"] {
        for table in ["responses.parquet", "scenarios.parquet"] {
            let same = read(&place, &format!("{results}/{table}"))
                == read(&place, &format!("whole/{table}"));
            assert!(same, "{table} of {results}");
        }
    }
}

#[test]
fn what_a_study_says_itself_wins_over_an_accepted_error() {
    let place = Place::with(GOOD);
    let run = place.run(&["run", "study.toml", "--out", "one", "--accuracy", "1%"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let manifest = manifest(&place, "one");
    let chosen = &manifest["chosen"]["accuracy"];
    assert_eq!(chosen["setting"]["harmonics"], "1-3");
    assert_eq!(
        manifest["study"]["solver"]["harmonics"],
        serde_json::json!([1, 3])
    );
    assert!(manifest["study"]["solver"]["peak_tolerance"].is_null());
    // The reference is not held to them, so that what they leave out is told.
    let worst = |chosen: &Value| chosen["evidence"]["amplitude"]["worst"].as_f64();
    place.write("first.toml", &GOOD.replace("[1, 3]", "[1]"));
    let first = place.run(&["run", "first.toml", "--out", "first", "--accuracy", "1%"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    let of_first = self::manifest(&place, "first")["chosen"]["accuracy"].clone();
    assert_eq!(of_first["setting"]["harmonics"], "1");
    assert!(worst(&of_first).expect("an error") > 2.0 * worst(chosen).expect("an error"));
    // Tolerances too, and without a number the accepted error is 1 %.
    let stated = "[solver]\nsamples_per_period = 96\npeak_tolerance = 2e-4\n[accuracy]\n";
    place.write("stated.toml", &format!("{}{stated}", open()));
    let run = place.run(&["run", "stated.toml", "--out", "stated"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let chosen = self::manifest(&place, "stated")["chosen"]["accuracy"].clone();
    assert_eq!(chosen["accepted_error"], 0.01);
    assert_eq!(chosen["setting"]["samples_per_period"], "96");
    assert_eq!(chosen["setting"]["peak_tolerance"], "2e-4");
}

#[test]
fn an_accepted_error_and_a_basis_exclude_each_other() {
    let place = Place::with(&GOOD.replace(
        "[solver]\nharmonics = [1, 3]\n",
        "[reduction]\nstick_modes = 4\n",
    ));
    let both = place.run(&["run", "study.toml", "--accuracy", "1%"]);
    assert_eq!(both.code, 3);
    for fragment in ["reduction.stick_modes", "accuracy.amplitude_error"] {
        assert!(both.stderr.contains(fragment), "{}", both.stderr);
    }
    for refused in ["2", "0%", "x"] {
        assert_eq!(
            place
                .run(&["run", "study.toml", "--accuracy", refused])
                .code,
            2
        );
    }
    let place = Place::with(&accurate());
    let twice = place.run(&["run", "study.toml", "--accuracy", "0.01"]);
    assert_eq!(twice.code, 3);
    assert!(twice.stderr.contains("--accuracy"), "{}", twice.stderr);
    let response = place.run(&[
        "response",
        "study.toml",
        "--pattern",
        "0",
        "--load",
        "50",
        "--frequencies",
        "340:380:3",
        "--out",
        "r.csv",
        "--harmonics",
        "1",
    ]);
    assert_eq!(response.code, 2, "{}", response.stderr);
}
