//! Whole runs with the real engine on a wheel of six masses.

use std::sync::Mutex;

use blisk::campaign::{RunRequest, run};
use blisk::settings::{Progress, ReducedEngineSource};
use blisk::study::Study;

use crate::blisk::{GOOD, Place};
use crate::missed_peaks::WHEEL;

#[test]
fn run_writes_tables_and_summary_and_a_second_run_solves_nothing() {
    let place = Place::with(GOOD);
    let first = place.run(&["run", "study.toml", "--threads", "2"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    assert!(
        first.stderr.contains("solved 30 rows, reused 0"),
        "{}",
        first.stderr
    );
    for file in [
        "responses.parquet",
        "scenarios.parquet",
        "percentiles.parquet",
        "distribution.parquet",
        "patterns.parquet",
        "manifest.json",
        "runs/1.json",
    ] {
        assert!(place.path("results/small").join(file).exists(), "{file}");
    }
    let summary =
        std::fs::read_to_string(place.path("results/small/summary.txt")).expect("summary");
    assert_eq!(first.stdout.trim_end(), summary.trim_end());
    assert!(!place.path("results/small/parts").exists());
    let second = place.run(&["run", "study.toml"]);
    assert_eq!(second.code, 0);
    assert!(
        second.stderr.contains("nothing to solve"),
        "{}",
        second.stderr
    );
    assert_eq!(second.stdout, first.stdout);
    let stats = place.run(&["stats", "results/small"]);
    assert_eq!((stats.code, &stats.stdout), (0, &first.stdout));
}

#[test]
fn run_as_json_holds_the_numbers_of_the_summary() {
    let place = Place::with(GOOD);
    let run = place.run(&["run", "study.toml", "--json", "--out", "here"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let value: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(value["rows"]["planned"], 30);
    assert_eq!(value["scenarios"].as_array().expect("a list").len(), 3);
    assert_eq!(value["scenarios"][1]["normal_load_n"], 50.0);
    assert!(
        value["scenarios"][1]["tuned_amplitude_m"]
            .as_f64()
            .expect("a number")
            > 0.0
    );
    let stats = place.run(&["stats", "here", "--json"]);
    assert_eq!(stats.stdout, run.stdout);
}

#[test]
fn a_longer_study_continues_and_a_different_one_exits_with_9() {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    place.write(
        "study.toml",
        &GOOD.replace("patterns = 10", "patterns = 25"),
    );
    let longer = place.run(&["run", "study.toml"]);
    assert_eq!(longer.code, 0, "{}", longer.stderr);
    assert!(
        longer.stderr.contains("solved 45 rows, reused 30"),
        "{}",
        longer.stderr
    );
    let fresh = Place::with(&GOOD.replace("patterns = 10", "patterns = 25"));
    assert_eq!(fresh.run(&["run", "study.toml", "--threads", "1"]).code, 0);
    for file in [
        "responses.parquet",
        "scenarios.parquet",
        "percentiles.parquet",
        "distribution.parquet",
        "patterns.parquet",
        "manifest.json",
    ] {
        let read =
            |place: &Place| std::fs::read(place.path("results/small").join(file)).expect(file);
        assert!(read(&place) == read(&fresh), "{file}");
    }
    place.write("study.toml", &GOOD.replace("= 0.3\n", "= 0.4\n"));
    let other = place.run(&["run", "study.toml"]);
    assert_eq!(other.code, 9);
    assert!(
        other
            .stderr
            .contains("contact.friction_coefficient: 0.3 in the folder, 0.4 in the study"),
        "{}",
        other.stderr
    );
}

#[test]
fn an_added_load_is_solved_alone_and_a_removed_one_exits_with_9() {
    let loads = |list: &str| GOOD.replace("[\"slide\", 50, \"stuck\"]", list);
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let grown = loads("[\"slide\", 25.5, 50, \"stuck\"]");
    place.write("study.toml", &grown);
    let more = place.run(&["run", "study.toml"]);
    assert_eq!(more.code, 0, "{}", more.stderr);
    let words = "solved 10 rows, reused 30";
    assert!(more.stderr.contains(words), "{}", more.stderr);
    let fresh = Place::with(&grown);
    assert_eq!(fresh.run(&["run", "study.toml"]).code, 0);
    for file in ["responses.parquet", "scenarios.parquet", "summary.txt"] {
        let read =
            |place: &Place| std::fs::read(place.path("results/small").join(file)).expect(file);
        assert!(read(&place) == read(&fresh), "{file}");
    }
    place.write("study.toml", &loads("[\"slide\", 25.5, \"stuck\"]"));
    let fewer = place.run(&["run", "study.toml"]);
    assert_eq!(fewer.code, 9, "{}", fewer.stderr);
    let words = "sweep.normal_load_n: [\"slide\",25.5,50.0,\"stuck\"] in the folder";
    assert!(fewer.stderr.contains(words), "{}", fewer.stderr);
}

/// Twelve sectors under automatic harmonics: their sets and errors are judged on wheels of the study's largest standard deviation.
fn judged() -> String {
    let edits = [
        ("sectors = 36", "sectors = 12"),
        ("patterns = 50", "patterns = 2"),
        ("engine_orders = [4]", "engine_orders = [3]"),
        (", standard_deviation = 0.04 }", " }"),
        ("[10, 30, 60, 100]", "[30]\nstandard_deviation = [0.01]"),
    ];
    edits
        .iter()
        .fold(WHEEL.to_owned(), |study, (before, after)| {
            assert!(study.contains(before), "{before}");
            study.replace(before, after)
        })
}

#[test]
fn a_study_that_grows_gives_the_rows_of_a_fresh_one_where_its_settings_are_judged_anew() {
    for (before, after) in [
        (
            "standard_deviation = [0.01]",
            "standard_deviation = [0.01, 0.04]",
        ),
        ("engine_orders = [3]", "engine_orders = [3, 4]"),
        ("normal_load_n = [30]", "normal_load_n = [10, 30]"),
    ] {
        let study = judged();
        let grown = study.replace(before, after);
        assert_ne!(grown, study);
        let (place, fresh) = (Place::with(&study), Place::with(&grown));
        assert_eq!(place.run(&["run", "study.toml"]).code, 0);
        place.write("study.toml", &grown);
        for own in [&place, &fresh] {
            let run = own.run(&["run", "study.toml"]);
            assert_eq!(run.code, 0, "{}", run.stderr);
        }
        for file in ["responses.parquet", "scenarios.parquet", "summary.txt"] {
            let read = |own: &Place| std::fs::read(own.path("results/lumped36").join(file));
            let bytes = [&place, &fresh].map(|own| read(own).expect(file));
            assert!(bytes[0] == bytes[1], "{after}: {file}");
        }
    }
}

#[test]
fn response_writes_every_blade_at_every_frequency_both_ends_included() {
    let place = Place::with(GOOD);
    for (pattern, load, out) in [
        ("tuned", "50", "a.csv"),
        ("3", "50", "b.csv"),
        ("9", "stuck", "c.csv"),
    ] {
        let curve = place.run(&[
            "response",
            "study.toml",
            "--pattern",
            pattern,
            "--load",
            load,
            "--frequencies",
            "340:370:4",
            "--out",
            out,
        ]);
        assert_eq!(curve.code, 0, "{}", curve.stderr);
        let text = std::fs::read_to_string(place.path(out)).expect("read");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "frequency_hz,blade,amplitude_m,status");
        assert_eq!(lines.len(), 1 + 4 * 6);
        assert!(
            lines[1].starts_with("340,0,") && lines[24].starts_with("370,5,"),
            "{text}"
        );
        assert!(
            lines[1..].iter().all(|line| line.ends_with(",ok")),
            "{text}"
        );
    }
    let parquet = place.run(&[
        "response",
        "study.toml",
        "--pattern",
        "tuned",
        "--load",
        "free",
        "--frequencies",
        "340:370:4",
        "--out",
        "d.parquet",
        "--json",
    ]);
    assert_eq!(parquet.code, 0, "{}", parquet.stderr);
    let value: serde_json::Value = serde_json::from_str(&parquet.stdout).expect("JSON");
    assert_eq!((&value["rows"], &value["failed"]), (&24.into(), &0.into()));
    let absent = place.run(&[
        "response",
        "study.toml",
        "--pattern",
        "10",
        "--load",
        "50",
        "--frequencies",
        "340:370:4",
        "--out",
        "e.csv",
    ]);
    assert_eq!(absent.code, 2);
    assert!(
        absent.stderr.contains("accepted: tuned, or 0 to 9"),
        "{}",
        absent.stderr
    );
}

#[test]
fn model_tells_every_nodal_diameter() {
    let place = Place::with(GOOD);
    let model = place.run(&["model", "study.toml", "--json"]);
    assert_eq!(model.code, 0, "{}", model.stderr);
    let value: serde_json::Value = serde_json::from_str(&model.stdout).expect("JSON");
    assert_eq!(
        value["nodal_diameters"].as_array().expect("a list").len(),
        4
    );
    let text = place.run(&["model", "study.toml"]).stdout;
    assert!(text.contains("stick Hz"), "{text}");
}

#[test]
fn an_unwritable_results_folder_exits_with_7_and_is_named() {
    let place = Place::with(GOOD);
    place.write("file", "");
    let run = place.run(&["run", "study.toml", "--out", "file/results"]);
    assert_eq!(run.code, 7);
    assert!(run.stderr.contains("file/results"), "{}", run.stderr);
}

#[test]
fn tables_are_byte_identical_on_1_2_and_8_threads() {
    let place = Place::with(GOOD);
    let tables = |threads: &str| -> Vec<Vec<u8>> {
        let run = place.run(&["run", "study.toml", "--threads", threads, "--out", threads]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let files = [
            "responses.parquet",
            "scenarios.parquet",
            "percentiles.parquet",
            "distribution.parquet",
            "patterns.parquet",
            "manifest.json",
        ];
        files
            .map(|file| std::fs::read(place.path(threads).join(file)).expect(file))
            .to_vec()
    };
    let one = tables("1");
    assert_eq!(one, tables("2"));
    assert_eq!(one, tables("8"));
}

#[test]
fn a_load_on_a_wheel_without_contact_is_refused() {
    let place = Place::with(GOOD);
    let one_dof = concat!(env!("CARGO_MANIFEST_DIR"), "/studies/one-dof.toml");
    let out = ["--frequencies", "900:1100:5", "--out", "curve.csv"];
    let response = |load: &str| {
        let mut arguments = vec!["response", one_dof, "--pattern", "tuned", "--load", load];
        arguments.extend(["--standard-deviation", "0.01"]);
        arguments.extend(out);
        place.run(&arguments)
    };
    let refused = response("50");
    assert_eq!(refused.code, 2, "{}", refused.stderr);
    assert!(
        refused.stderr.contains("the model has no contact"),
        "{}",
        refused.stderr
    );
    assert_eq!(response("free").code, 0);
}

#[test]
fn a_study_that_stops_early_says_so_and_one_that_misses_its_target_ends_with_6() {
    let rule = |width: f64| {
        let study = GOOD.replace("patterns = 10", "patterns = 64");
        format!("{study}\n[stop]\npercentile = 50\nrelative_width = {width}\n")
    };
    let place = Place::with(&rule(1.0));
    let run = place.run(&["run", "study.toml", "--json"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let summary: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(summary["stop"]["looks"], serde_json::json!([8, 16, 32, 64]));
    assert_eq!(summary["stop"]["met"], true);
    assert_eq!(summary["stop"]["quantity"], "peak_amplitude_m");
    assert_eq!(summary["patterns"], 8);
    let text = place.run(&["stats", "results/small"]);
    assert_eq!(text.code, 0);
    assert!(
        text.stdout
            .contains("reached at look 1 of 4, 8 of at most 64 patterns"),
        "{}",
        text.stdout
    );
    place.write("study.toml", &rule(1e-6));
    for (solved, command) in [(true, "run"), (false, "run")] {
        let missed = place.run(&[command, "study.toml"]);
        assert_eq!(missed.code, 6, "{}", missed.stderr);
        assert_eq!(missed.stderr.contains("solved 168 rows, reused 24"), solved);
        assert!(
            missed.stdout.contains("NOT reached at look 4 of 4"),
            "{}",
            missed.stdout
        );
    }
    assert_eq!(place.run(&["stats", "results/small"]).code, 6);
    // Neither shards nor a script of them can follow the rule.
    for refused in [
        place.run(&["run", "study.toml", "--shard", "1/2"]),
        place.run(&["slurm", "study.toml", "--tasks", "2"]),
    ] {
        assert_eq!(refused.code, 2, "{}", refused.stderr);
        assert!(
            refused.stderr.contains("has a [stop]"),
            "{}",
            refused.stderr
        );
    }
    assert!(!place.path("small-slurm.sh").exists());
    // A row of a study that stopped is solved again as any other.
    let replayed = place.run(&[
        "verify",
        "results/small",
        "--scenario",
        "1",
        "--pattern",
        "3",
    ]);
    assert_eq!(replayed.code, 0, "{}", replayed.stderr);
}

#[test]
fn a_plan_says_what_a_study_takes_and_what_its_percentiles_are_worth_and_writes_nothing() {
    let rule = "\n[stop]\npercentile = 50\nrelative_width = 0.02\n";
    let study = GOOD.replace("patterns = 10", "patterns = 400") + rule;
    let place = Place::with(&study);
    let planned = place.run(&[
        "plan",
        "study.toml",
        "--pilot",
        "40",
        "--threads",
        "2",
        "--json",
    ]);
    assert_eq!(planned.code, 0, "{}", planned.stderr);
    assert!(!place.path("results").exists());
    let plan: serde_json::Value = serde_json::from_str(&planned.stdout).expect("JSON");
    assert_eq!(plan["rows"], 1200);
    assert_eq!(plan["pilot_rows"]["ok"], 120);
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let cpu = &plan["time"]["cpu_s"];
    assert!(number(&cpu["lower"]) <= number(&cpu["value"]));
    assert!(number(&cpu["value"]) <= number(&cpu["upper"]));
    let mean = number(&plan["cpu_s_per_pattern"]);
    assert!((number(&cpu["value"]) / (400.0 * mean) - 1.0).abs() < 1e-12);
    assert!(number(&plan["processor_share"]) <= 1.0);
    assert!(number(&plan["time"]["wall_s"]) >= number(&plan["set_up_s"]));
    assert!(number(&plan["memory_bytes"]) > 1e6);
    // P50 of 40 patterns has an interval, P95 has none; P99 needs 368 patterns.
    let percentiles = plan["percentiles"].as_array().expect("a list");
    let of = |percent: u64| {
        let found = percentiles.iter().find(|p| p["percent"] == percent);
        found.expect("a percentile")
    };
    let width = number(&of(50)["peak_amplitude_m_relative_width"]);
    assert!(of(95)["peak_amplitude_m_relative_width"].is_null());
    assert_eq!(
        (&of(99)["needed_patterns"], &of(99)["estimable"]),
        (&368.into(), &true.into())
    );
    let looks = plan["stop"]["looks"].as_array().expect("a list");
    let sizes: Vec<u64> = looks
        .iter()
        .filter_map(|look| look["patterns"].as_u64())
        .collect();
    assert_eq!(sizes, [25, 50, 100, 200, 400]);
    // What was foretold comes: the study without the rule has that width within a third, and its
    // tables that size within a quarter.
    place.write("study.toml", &study.replace(rule, ""));
    let run = place.run(&["run", "study.toml", "--json"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let summary: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let scenarios = summary["scenarios"].as_array().expect("a list");
    let widths = scenarios.iter().map(|scenario| {
        let percentiles = scenario["peak_amplitude_m"]["percentiles"].as_array();
        let found = percentiles
            .expect("a list")
            .iter()
            .find(|p| p["percent"] == 50.0);
        let found = found.expect("P50");
        (number(&found["upper"]) - number(&found["lower"])) / number(&found["value"])
    });
    let widest = widths.fold(0.0, f64::max);
    assert!((width / widest - 1.0).abs() < 0.34, "{width}, {widest}");
    let size = |table: &str| {
        let path = place.path("results/small").join(table);
        std::fs::metadata(path).expect("a table").len() as f64
    };
    let bytes = size("responses.parquet") + size("patterns.parquet");
    let foretold = number(&plan["disk"]["results_bytes"]);
    assert!((foretold / bytes - 1.0).abs() < 0.25, "{foretold}, {bytes}");
    let text = place.run(&["plan", "study.toml", "--pilot", "2"]).stdout;
    assert!(
        text.contains("400 patterns x 3 scenarios = 1200 rows"),
        "{text}"
    );
}

/// What is stored is not planned again: rows of fewer patterns, of other loads, and all of them.
#[test]
fn a_plan_counts_the_rows_that_are_stored_and_writes_nothing() {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let files = || {
        let mut found: Vec<(String, u64)> = Vec::new();
        for folder in ["results", "results/small", "results/small/parts"] {
            for entry in std::fs::read_dir(place.path(folder)).into_iter().flatten() {
                let entry = entry.expect("an entry");
                let size = entry.metadata().expect("a file").len();
                found.push((entry.path().display().to_string(), size));
            }
        }
        found.sort();
        found
    };
    let before = files();
    let plan = |study: &str| {
        place.write("study.toml", study);
        let arguments = ["plan", "study.toml", "--pilot", "4"];
        let text = place.run(&arguments);
        assert_eq!(text.code, 0, "{}", text.stderr);
        let json = place.run(&[&arguments[..], &["--json"]].concat());
        let json: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
        (text.stdout, json)
    };
    let (text, json) = plan(GOOD);
    let said = "30 of 30 rows are stored in results/small: none is left to solve";
    assert!(text.contains(said), "{text}");
    assert!(json["stored"]["time"].is_null());
    let longer = GOOD.replace("patterns = 10", "patterns = 40");
    let (text, json) = plan(&longer);
    let said = "30 of 120 rows are stored in results/small; the rest, like: 30 patterns, ";
    assert!(text.contains(said), "{text}");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let of = |time: &serde_json::Value| number(&time["cpu_s"]["value"]);
    let share = of(&json["stored"]["time"]) / of(&json["time"]);
    assert!((share - 0.75).abs() < 1e-9, "{share}");
    // A second load takes about half of the time; the linear limits, which are stored, take next to none.
    let (text, json) = plan(&GOOD.replace("50, ", "50, 55, "));
    assert!(text.contains("30 of 40 rows are stored"), "{text}");
    let patterns = number(&json["stored"]["time"]["patterns"]);
    assert!((3.0..=7.0).contains(&patterns), "{patterns}");
    // Rows of another study are none of it.
    let (text, json) = plan(&GOOD.replace("seed = 7", "seed = 8"));
    assert!(
        !text.contains("stored") && json["stored"].is_null(),
        "{text}"
    );
    assert_eq!(files(), before);
}

#[test]
fn a_search_for_the_best_load_does_not_go_into_the_results_of_a_study() {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let files = || {
        std::fs::read_dir(place.path("results/small"))
            .expect("a folder")
            .count()
    };
    let before = files();
    let search = "optimum study.toml --between 40:60 --percentile 50 --out results/small";
    let arguments: Vec<&str> = search.split(' ').collect();
    let ended = place.run(&arguments);
    assert_eq!(ended.code, 2, "{}", ended.stderr);
    for words in [
        "--out results/small: it holds the results of a study",
        "accepted: a folder of its own for the search, like results/small-optimum",
        "--solved results/small",
    ] {
        assert!(ended.stderr.contains(words), "{words}: {}", ended.stderr);
    }
    assert_eq!(files(), before);
}

#[test]
fn a_load_that_is_added_keeps_the_rows_of_the_others() {
    let place = Place::new();
    let written = place.run(&["init", "--example", "quickstart", "--out", "ring.toml"]);
    assert_eq!(written.code, 0, "{}", written.stderr);
    let study = std::fs::read_to_string(place.path("ring.toml")).expect("a study");
    let loads = "[\"slide\", 240, 320, 480, 800, 1600, 4000, \"stuck\"]";
    assert!(study.contains("patterns = 440") && study.contains(loads));
    let study = study.replace("patterns = 440", "patterns = 2");
    place.write("ring.toml", &study.replace(loads, "[\"slide\", 480, 1600]"));
    let first = place.run(&["run", "ring.toml", "--out", "ring"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    // Between the others and beyond them; what is stated of the model is measured under each load by itself.
    for (loads, reused) in [
        ("[\"slide\", 480, 800, 1600]", 6),
        ("[\"slide\", 480, 800, 1600, 4000, \"stuck\"]", 8),
    ] {
        let own = study.replace(
            "[\"slide\", 240, 320, 480, 800, 1600, 4000, \"stuck\"]",
            loads,
        );
        place.write("ring.toml", &own);
        let more = place.run(&["run", "ring.toml", "--out", "ring"]);
        assert_eq!(more.code, 0, "{}", more.stderr);
        assert!(!more.stderr.contains("solved anew"), "{}", more.stderr);
        let said = format!("reused {reused};");
        assert!(more.stderr.contains(&said), "{said}: {}", more.stderr);
    }
    // All of them at once are the same rows.
    let at_once = place.run(&["run", "ring.toml", "--out", "at-once"]);
    assert_eq!(at_once.code, 0, "{}", at_once.stderr);
    let rows = |folder: &str| std::fs::read(place.path(&format!("{folder}/responses.parquet")));
    assert!(rows("ring").expect("a table") == rows("at-once").expect("a table"));
}

/// Keeps what it is told before the rows.
#[derive(Default)]
struct Told(Mutex<Vec<String>>);

impl Progress for Told {
    fn step(&self, words: &str) {
        self.0.lock().expect("a list").push(words.to_owned());
    }
}

/// What the beginning of a run of `study` is at.
fn steps_of(study: &str) -> Vec<String> {
    let place = Place::with(study);
    let told = Told::default();
    let request = RunRequest {
        study: &Study::read(&place.path("study.toml")).expect("a study"),
        results: &place.path("results"),
        threads: 2,
    };
    run(request, &ReducedEngineSource, &told).expect("results");
    told.0.into_inner().expect("a list")
}

#[test]
fn a_run_says_which_tuned_wheel_is_solved_and_what_the_reduction_is_at() {
    let steps = steps_of(&GOOD.replace("harmonics = [1, 3]", ""));
    let (before, tuned) = steps.split_at(steps.len() - 3);
    let expected = [
        "tuned wheel: load 1 of 3 (slide)",
        "tuned wheel: load 2 of 3 (50 N)",
        "tuned wheel: load 3 of 3 (stuck)",
    ];
    assert_eq!(tuned, expected);
    for step in [
        "receptances of the tuned wheel with 60 fixed-interface modes",
        "choosing the harmonics: 0 of 1 loads done",
        "choosing the harmonics: 1 of 1 loads done",
    ] {
        assert!(before.iter().any(|own| own == step), "{step}: {before:?}");
    }
    // One tuned wheel for both standard deviations; engine orders are named where there are several.
    let more = GOOD
        .replace("engine_orders = [2]", "engine_orders = [1, 2]")
        .replace(
            "standard_deviation = [0.03]",
            "standard_deviation = [0.03, 0.01]",
        );
    let steps = steps_of(&more);
    let tuned = steps.iter().filter(|step| step.starts_with("tuned wheel"));
    assert_eq!(tuned.count(), 6, "{steps:?}");
    let last = "tuned wheel: load 6 of 6 (engine order 2, stuck)";
    assert_eq!(steps.last().map(String::as_str), Some(last));
}
