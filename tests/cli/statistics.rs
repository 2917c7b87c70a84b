//! What the commands say about populations: the same counts everywhere, comparisons.

use crate::blisk::{GOOD, Place};

/// A wheel whose blades lose their stiffness in some patterns.
fn with_failures() -> String {
    GOOD.replace("patterns = 10", "patterns = 80")
        .replace(
            "standard_deviation = [0.03]",
            "standard_deviation = [0.05, 0.5]",
        )
        .replace("[\"slide\", 50, \"stuck\"]", "[\"slide\", 50]")
}

#[test]
fn rows_are_counted_the_same_in_table_manifest_summary_json_and_exit_code() {
    let place = Place::with(&with_failures());
    let run = place.run(&["run", "study.toml", "--json"]);
    let summary: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let manifest = std::fs::read_to_string(place.path("results/small/manifest.json"));
    let manifest: serde_json::Value =
        serde_json::from_str(&manifest.expect("manifest")).expect("JSON");
    let mut total = [0_u64; 3];
    for (place, scenario) in summary["scenarios"]
        .as_array()
        .expect("a list")
        .iter()
        .enumerate()
    {
        let counts = &manifest["scenarios"][place]["counts"];
        let keys = ["planned", "ok", "failed"];
        for (sum, key) in total.iter_mut().zip(keys) {
            assert_eq!(
                scenario["rows"][key], counts[key],
                "scenario {place}, {key}"
            );
            *sum += counts[key].as_u64().expect("a count");
        }
        let by_status = counts["by_status"].as_object().expect("a table");
        assert_eq!(&scenario["rows"]["by_status"], &counts["by_status"]);
        let all: u64 = by_status
            .values()
            .filter_map(serde_json::Value::as_u64)
            .sum();
        assert_eq!(all, 80);
        let failed = all - by_status["ok"].as_u64().expect("a count");
        assert_eq!(counts["failed"], failed);
        let bound = scenario["rows"]["failed_share_upper_bound"]
            .as_f64()
            .expect("a share");
        assert!(bound > failed as f64 / 80.0 && bound <= 1.0);
    }
    assert_eq!(total[0], 320);
    assert_eq!(total[0], total[1] + total[2]);
    assert!(
        total[2] > 10,
        "this study is meant to fail in many patterns"
    );
    for (sum, key) in total.iter().zip(["planned", "ok", "failed"]) {
        assert_eq!(summary["rows"][key], *sum);
        assert_eq!(manifest["counts"][key], *sum);
    }
    let text = std::fs::read_to_string(place.path("results/small/summary.txt")).expect("summary");
    let line = format!("{} rows ok, {} failed", total[1], total[2]);
    assert!(text.contains(&line), "{text}");
    // Failures beyond the gate of P95 cost its value, in both commands.
    assert_eq!(run.code, 5);
    assert_eq!(place.run(&["stats", "results/small"]).code, 5);
}

fn json(place: &Place, arguments: &[&str]) -> serde_json::Value {
    let ended = place.run(arguments);
    assert_eq!(ended.code, 0, "{arguments:?}: {}", ended.stderr);
    serde_json::from_str(&ended.stdout).expect("JSON")
}

/// Two loads, 100 patterns.
fn two_loads() -> String {
    GOOD.replace("patterns = 10", "patterns = 100")
        .replace("[\"slide\", 50, \"stuck\"]", "[\"slide\", 50]")
}

fn comparisons(value: &serde_json::Value) -> &Vec<serde_json::Value> {
    value["quantities"][0]["comparisons"]
        .as_array()
        .expect("a list")
}

#[test]
fn loads_of_one_folder_are_compared_on_common_patterns() {
    let place = Place::with(&two_loads());
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let report = json(&place, &["compare", "results/small", "--json"]);
    let found = comparisons(&report);
    assert_eq!(found.len(), 1);
    assert_eq!(
        (&found[0]["pairing"], &found[0]["pairs"]["pairs"]),
        (&"same_patterns".into(), &100.into())
    );
    // The same percentiles as everywhere else.
    let stats = json(&place, &["stats", "results/small", "--json"]);
    let p95 = |scenario: usize| {
        let percentiles = &stats["scenarios"][scenario]["peak_amplitude_m"]["percentiles"];
        let found = percentiles
            .as_array()
            .expect("a list")
            .iter()
            .find(|p| p["percent"] == 95.0);
        found.expect("P95")["value"].as_f64().expect("estimable")
    };
    let of = |side: &str| {
        found[0]["percentile"][side]["value"]
            .as_f64()
            .expect("a number")
    };
    // The baseline is the best load.
    assert!(
        of("baseline").total_cmp(&p95(1)).is_eq() && of("candidate").total_cmp(&p95(0)).is_eq()
    );
    let difference = &found[0]["percentile"]["difference"];
    let bounds = ["lower", "upper"].map(|bound| difference[bound].as_f64().expect("a bound"));
    let value = difference["value"].as_f64().expect("a value");
    assert!(bounds[0] <= value && value <= bounds[1]);
    // Friction lowers the peak in this wheel: the set of possible bests is the one load.
    let best = &report["quantities"][0]["best"][0];
    assert_eq!(best["lowest"], 1);
    assert_eq!(best["loads"][0]["could_be_best"], false);
    assert_eq!(best["loads"][1]["could_be_best"], true);
    // The other way round the signs change.
    let turned = json(
        &place,
        &["compare", "results/small", "--baseline", "0", "--json"],
    );
    let back = comparisons(&turned)[0]["percentile"]["difference"]["value"].as_f64();
    assert!((back.expect("a value") + value).abs() < 1e-12 * value.abs());
    let text = place.run(&["compare", "results/small", "--percentile", "90"]);
    assert_eq!(text.code, 0, "{}", text.stderr);
    for fragment in [
        "P90 of the peak amplitude",
        "engine order 2, standard deviation 3 %, against 50 N per sector",
        "100 common patterns",
        "lowest P90",
    ] {
        assert!(
            flat(&text.stdout).contains(fragment),
            "{fragment} in\n{}",
            text.stdout
        );
    }
}

/// A text without its line ends.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn folders_are_paired_on_equal_patterns_and_independent_otherwise_and_say_which() {
    let place = Place::with(&two_loads());
    let variants = [
        ("a", two_loads()),
        (
            "friction",
            two_loads().replace("coefficient = 0.3", "coefficient = 0.5"),
        ),
        (
            "longer",
            two_loads().replace("patterns = 100", "patterns = 120"),
        ),
        ("seed", two_loads().replace("seed = 7", "seed = 8")),
        ("wider", two_loads().replace("[0.03]", "[0.06]")),
        ("load", two_loads().replace("50]", "60]")),
    ];
    for (name, study) in &variants {
        place.write("study.toml", study);
        let run = place.run(&["run", "study.toml", "--out", name]);
        assert_eq!(run.code, 0, "{}", run.stderr);
    }
    let pairing = |other: &str, baseline: &[&str]| {
        let report = json(
            &place,
            &[&["compare", "a", other, "--json"], baseline].concat(),
        );
        let found = comparisons(&report).last().cloned().expect("a comparison");
        let unmatched = report["unmatched"].as_array().expect("a list").len();
        (found, unmatched)
    };
    let (friction, unmatched) = pairing("friction", &[]);
    assert_eq!(
        (&friction["pairing"], unmatched),
        (&"same_patterns".into(), 0)
    );
    let (longer, _) = pairing("longer", &[]);
    assert_eq!(longer["pairing"], "same_patterns");
    assert_eq!(longer["patterns"], serde_json::json!([100, 100]));
    assert_eq!(longer["patterns_left_out"], serde_json::json!([0, 20]));
    // The same rows twice differ by nothing.
    assert_eq!(longer["percentile"]["difference"]["upper"], 0.0);
    let (seed, _) = pairing("seed", &[]);
    assert_eq!(seed["pairing"], "independent");
    assert!(seed["pairs"].is_null() && seed["percentile"]["difference"]["lower"].is_number());
    let (wider, _) = pairing("wider", &["--baseline", "1"]);
    assert_eq!(wider["pairing"], "same_unit_draws");
    let (load, unmatched) = pairing("load", &[]);
    assert_eq!(
        (&load["candidate"]["contact"], unmatched),
        (&"slide".into(), 1)
    );
    let text = place.run(&["compare", "a", "seed", "load"]).stdout;
    assert!(
        text.contains("independent") && text.contains("no counterpart in A: C 60 N"),
        "{text}"
    );
}

#[test]
fn blades_in_other_random_contact_are_not_the_same_wheels() {
    let varied = |deviation: f64, per: &str| {
        format!(
            "{}\n[contact.variation]\nfriction_coefficient = {{ kind = \"lognormal\", \
             standard_deviation = {deviation}, per = \"{per}\" }}\n",
            two_loads().replace("patterns = 100", "patterns = 80")
        )
    };
    // The same blades from a file: with another seed the contact alone is another.
    let line = |place: u32| {
        let (pattern, blade) = (place / 6, place % 6);
        let deviation = f64::from((pattern * 37 + blade * 101) % 41) / 800.0 - 0.025;
        format!("{pattern},{blade},{deviation}\n")
    };
    let lines: Vec<String> = (0..480).map(line).collect();
    let blades = format!("pattern,blade,deviation\n{}", lines.concat());
    let from_file = |seed: u64, variation: bool| {
        let study = if variation {
            varied(0.2, "wheel")
        } else {
            two_loads()
        };
        study
            .replace("patterns = 100\n", "")
            .replace("patterns = 80\n", "")
            .replace("seed = 7", &format!("seed = {seed}"))
            .replace(
                "distribution = { kind = \"normal\" }",
                "file = \"blades.csv\"",
            )
            .replace("standard_deviation = [0.03]\n", "")
    };
    let place = Place::with(GOOD);
    place.write("blades.csv", &blades);
    for (name, study) in [
        ("a", varied(0.2, "wheel")),
        (
            "load",
            varied(0.2, "wheel").replace(
                "structural_loss_factor = 0.002",
                "structural_loss_factor = 0.003",
            ),
        ),
        ("wider", varied(0.3, "wheel")),
        ("sectors", varied(0.2, "sector")),
        (
            "nominal",
            two_loads().replace("patterns = 100", "patterns = 80"),
        ),
        ("file", from_file(7, true)),
        ("file-again", from_file(7, true)),
        ("file-seed", from_file(8, true)),
        ("file-nominal", from_file(7, false)),
        ("file-nominal-seed", from_file(8, false)),
    ] {
        place.write("study.toml", &study);
        let run = place.run(&["run", "study.toml", "--out", name]);
        assert_eq!(run.code, 0, "{name}: {}", run.stderr);
    }
    for (first, second, expected) in [
        ("a", "load", "same_patterns"),
        ("a", "wider", "same_blades"),
        ("a", "sectors", "same_blades"),
        ("a", "nominal", "same_blades"),
        ("file", "file-again", "same_patterns"),
        ("file", "file-seed", "same_blades"),
        ("file", "file-nominal", "same_blades"),
        ("file-nominal", "file-nominal-seed", "same_patterns"),
    ] {
        let report = json(&place, &["compare", first, second, "--json"]);
        for found in comparisons(&report) {
            assert_eq!(found["pairing"], expected, "{first}, {second}");
            assert_eq!(found["pairs"]["pairs"], 80);
        }
    }
    let text = place.run(&["compare", "a", "wider"]).stdout;
    assert!(flat(&text).contains("80 sets of blades"), "{text}");
}

#[test]
fn a_comparison_that_cannot_be_made_is_refused_or_says_what_is_missing() {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["compare", "nowhere"]).code, 7);
    assert_eq!(place.run(&["compare"]).code, 2);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let refused = place.run(&["compare", "results/small", "--percentile", "100"]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.stderr.contains("above 0 and below 100"),
        "{}",
        refused.stderr
    );
    let absent = place.run(&["compare", "results/small", "--baseline", "3"]);
    assert_eq!(absent.code, 2);
    assert!(
        absent.stderr.contains("accepted: a number below 3"),
        "{}",
        absent.stderr
    );
    // Ten patterns support no P95: null, and no failure.
    let report = json(&place, &["compare", "results/small", "--json"]);
    assert!(comparisons(&report)[0]["percentile"]["difference"].is_null());
    assert_eq!(report["quantities"][0]["best"], serde_json::json!([]));
    // Failed rows that leave a comparison without a value are a breached gate.
    place.write("study.toml", &with_failures());
    assert_eq!(
        place.run(&["run", "study.toml", "--out", "failing"]).code,
        5
    );
    let gate = place.run(&["compare", "failing"]);
    assert_eq!(gate.code, 5, "{}", gate.stderr);
}

#[test]
fn tail_fits_stand_beside_the_percentiles_of_the_sample_and_are_the_same_each_time() {
    let place = Place::with(&two_loads());
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let plain = json(&place, &["stats", "results/small", "--json"]);
    assert!(plain.get("tails").is_none());
    let first = place.run(&["stats", "results/small", "--tails", "--json"]);
    assert_eq!(first.code, 0, "{}", first.stderr);
    let table = std::fs::read(place.path("results/small/tail_fits.parquet")).expect("a table");
    let again = place.run(&["stats", "results/small", "--tails", "--json"]);
    assert_eq!(first.stdout, again.stdout);
    let rewritten = std::fs::read(place.path("results/small/tail_fits.parquet"));
    assert!(table == rewritten.expect("a table"));
    let report: serde_json::Value = serde_json::from_str(&first.stdout).expect("JSON");
    let tails = report["tails"].as_array().expect("a list");
    assert_eq!(tails.len(), 4);
    for tail in tails {
        for fit in tail["fits"].as_array().expect("two laws") {
            let p95 = &fit["percentiles"][0];
            assert!(p95["empirical"]["value"].is_number() && p95["empirical"]["upper"].is_number());
            let converged = fit["status"] == "converged";
            assert_eq!(converged, p95["model"].is_object(), "{fit}");
            assert_eq!(converged, fit["p_value"].is_number(), "{fit}");
        }
    }
    let text = place.run(&["stats", "results/small", "--tails"]).stdout;
    assert!(
        text.contains("tail of the peak amplitude in µm at 50 N per sector")
            && text.contains("sample"),
        "{text}"
    );
}

#[test]
fn the_best_load_is_searched_on_the_same_patterns_and_a_second_search_solves_nothing() {
    let place = Place::with(&two_loads());
    let arguments = [
        "optimum",
        "study.toml",
        "--between",
        "40:4000",
        "--resolution",
        "0.5",
        "--json",
    ];
    let first = place.run(&arguments);
    assert_eq!(first.code, 0, "{}", first.stderr);
    let report: serde_json::Value = serde_json::from_str(&first.stdout).expect("JSON");
    let loads = report["best"]["loads"].as_array().expect("a list");
    assert!(loads.len() >= 5, "{}", loads.len());
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let values: Vec<(f64, f64)> = loads
        .iter()
        .map(|load| {
            (
                number(&load["normal_load_n"]),
                number(&load["percentile"]["value"]),
            )
        })
        .collect();
    assert!(values.windows(2).all(|pair| pair[0].0 < pair[1].0));
    let lowest = values
        .iter()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .expect("loads");
    assert!(
        number(&report["normal_load_n"])
            .total_cmp(&lowest.0)
            .is_eq()
    );
    // Inside, enclosed by loads that are significantly worse, and those are close.
    assert!(lowest.0 > 40.0 && lowest.0 < 4000.0, "{values:?}");
    assert_eq!(report["resolved"], true);
    let bounds = ["normal_load_lower_n", "normal_load_upper_n"].map(|key| number(&report[key]));
    assert!(bounds[0] < lowest.0 && lowest.0 < bounds[1], "{bounds:?}");
    let (lower, upper) = (&report["best"]["lower"], &report["best"]["upper"]);
    assert!(number(lower) <= lowest.1 && lowest.1 <= number(upper));
    // Every load is a results folder with the same patterns.
    let folders: Vec<String> = values
        .iter()
        .map(|(load, _)| format!("results/small-optimum/load-{load}"))
        .collect();
    let compared = place.run(&[
        "compare",
        &folders[0],
        &folders[1],
        "--baseline",
        "0",
        "--json",
    ]);
    assert_eq!(compared.code, 0, "{}", compared.stderr);
    let compared: serde_json::Value = serde_json::from_str(&compared.stdout).expect("JSON");
    assert_eq!(comparisons(&compared)[0]["pairing"], "same_patterns");
    // Its cost was said before it began, and its time once rows said it.
    assert!(
        first.stderr.contains("no load is solved yet; about"),
        "{}",
        first.stderr
    );
    let record = |folder: &str| place.path(folder).join("runs/2.json").exists();
    let again = place.run(&arguments);
    assert_eq!(again.stdout, first.stdout);
    assert!(!record(&folders[0]), "a finished load was run again");
    let text = place.run(&arguments[..arguments.len() - 1]);
    assert!(text.stdout.contains("could be best"), "{}", text.stdout);
}

#[test]
fn a_search_starts_from_the_loads_of_the_study_and_finds_none_worse_than_these() {
    let three = two_loads().replace("[\"slide\", 50]", "[\"slide\", 40, 100, 250, 4000]");
    let place = Place::with(&three);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let search = |more: &[&str]| {
        let request = ["optimum", "study.toml", "--between", "40:4000"];
        let ended = place.run(&[&request[..], more].concat());
        assert_eq!(ended.code, 0, "{}", ended.stderr);
        let report: serde_json::Value = serde_json::from_str(&ended.stdout).expect("JSON");
        (report, ended.stderr)
    };
    let (report, said) = search(&["--resolution", "0.3", "--json"]);
    let said = flat(&said);
    assert!(
        said.contains("solved already: 40 N, 100 N, 250 N, 4000 N; about"),
        "{said}"
    );
    assert!(
        said.contains("rows; about") && said.contains("of processor time"),
        "{said}"
    );
    let loads = report["best"]["loads"].as_array().expect("a list");
    let value = |load: &serde_json::Value| load["percentile"]["value"].as_f64().expect("a value");
    let of = |wanted: f64| {
        let found = loads.iter().find(|load| load["normal_load_n"] == wanted);
        value(found.unwrap_or_else(|| panic!("{wanted} N is among {report}")))
    };
    let lowest = loads.iter().map(value).fold(f64::INFINITY, f64::min);
    for known in [40.0, 100.0, 250.0, 4000.0] {
        assert!(lowest <= of(known));
        assert!(
            !place
                .path(&format!("results/small-optimum/load-{known}"))
                .exists()
        );
    }
    let best = report["normal_load_n"].as_f64().expect("a load");
    assert!(of(best).total_cmp(&lowest).is_eq());
    // What the study has is what the search shows of it.
    let stats = json(&place, &["stats", "results/small", "--json"]);
    let percentiles = stats["scenarios"][2]["peak_amplitude_m"]["percentiles"].clone();
    let percentiles = percentiles.as_array().expect("a list").clone();
    let p95 = percentiles
        .iter()
        .find(|own| own["percent"] == 95.0)
        .expect("P95");
    assert_eq!(p95["value"].as_f64(), Some(of(100.0)));
    // A folder gives the load of its name, and none that it holds besides.
    let own = std::fs::read_dir(place.path("results/small-optimum")).expect("a folder");
    let names = own.map(|entry| entry.expect("an entry").file_name());
    let solved = names
        .filter_map(|name| name.into_string().ok())
        .find(|name| name.starts_with("load-"));
    let solved = format!("results/small-optimum/{}", solved.expect("a load"));
    let renamed = place.path("results/small-optimum/load-77");
    std::fs::create_dir(&renamed).expect("made");
    for entry in std::fs::read_dir(place.path(&solved)).expect("a folder") {
        let entry = entry.expect("an entry");
        if entry.file_type().expect("a type").is_file() {
            std::fs::copy(entry.path(), renamed.join(entry.file_name())).expect("copied");
        }
    }
    let (again, _) = search(&["--resolution", "0.3", "--json"]);
    assert_eq!(again["best"]["loads"], report["best"]["loads"]);
    // Results of other patterns are left alone, and the search says why.
    place.write("study.toml", &three.replace("seed = 7", "seed = 8"));
    let (_, said) = search(&["--resolution", "1", "--out", "other", "--json"]);
    assert!(
        flat(&said).contains("no load of results/small is taken: study.seed is 7 there and 8 here"),
        "{said}"
    );
}

#[test]
fn a_search_that_cannot_be_made_is_refused() {
    let place = Place::with(&two_loads().replace("[0.03]", "[0.03, 0.05]"));
    let search = |more: &[&str]| {
        place.run(&[&["optimum", "study.toml", "--between", "40:400"], more].concat())
    };
    let several = search(&[]);
    assert_eq!(several.code, 2, "{}", several.stderr);
    assert!(
        several.stderr.contains("one standard deviation"),
        "{}",
        several.stderr
    );
    let several = flat(&several.stderr);
    let said = "sweep.standard_deviation has 2; accepted: one of them, like [0.03]; `blisk run`";
    assert!(several.contains(said), "{several}");
    place.write("study.toml", &two_loads());
    let few = search(&["--percentile", "99"]);
    assert_eq!(few.code, 2);
    assert!(
        flat(&few.stderr)
            .contains("study.patterns from 368 on, or --percentile 95, for which they are enough"),
        "{}",
        few.stderr
    );
    let turned = place.run(&["optimum", "study.toml", "--between", "400:40"]);
    assert_eq!(turned.code, 2);
    assert!(
        turned.stderr.contains("the lower first"),
        "{}",
        turned.stderr
    );
}

#[test]
fn an_estimate_solves_few_rows_is_the_same_for_any_threads_and_continues() {
    let place = Place::with(&two_loads().replace("patterns = 100", "patterns = 400"));
    let estimate = |out: &str, threads: &str, solves: &str| {
        place.run(&[
            "estimate",
            "study.toml",
            "--target",
            "90",
            "--solves",
            solves,
            "--out",
            out,
            "--threads",
            threads,
            "--json",
        ])
    };
    let first = estimate("results/one", "1", "100");
    assert_eq!(first.code, 0, "{}", first.stderr);
    let report: serde_json::Value = serde_json::from_str(&first.stdout).expect("JSON");
    assert_eq!(report["patterns"], 400);
    for scenario in report["scenarios"].as_array().expect("a list") {
        assert!(scenario["rows"]["planned"].as_u64().expect("a count") <= 100);
        // What surrogates cost beside rows is weighed: four of them for each solve.
        let of_surrogates = |key: &str| scenario["surrogates"][key].as_f64().expect("a number");
        let in_time = of_surrogates("gain") / (1.0 + 4.0 * of_surrogates("cost"));
        assert!((of_surrogates("gain_in_time") / in_time - 1.0).abs() < 1e-9);
        assert!(of_surrogates("cost") > 0.05, "{scenario}");
        let found = 400 - scenario["without_surrogate"].as_u64().expect("a count");
        assert_eq!(found > 0, in_time >= 1.2, "{scenario}");
        for quantity in scenario["quantities"].as_array().expect("a list") {
            assert!(quantity["mean"]["value"].as_f64() > Some(0.0));
            for percentile in quantity["percentiles"].as_array().expect("a list") {
                if let Some(value) = percentile["value"].as_f64() {
                    assert!(percentile["lower"].as_f64() <= Some(value));
                    assert!(percentile["upper"].as_f64() >= Some(value));
                }
            }
        }
    }
    let second = estimate("results/two", "3", "100");
    assert_eq!(second.stdout, first.stdout);
    let bytes =
        |folder: &str| std::fs::read(place.path(folder).join("sample.parquet")).expect("a table");
    assert_eq!(bytes("results/one"), bytes("results/two"));
    // More solves take the rows that are there, and come to what they would have alone.
    let more = estimate("results/one", "2", "160");
    assert_eq!(more.code, 0, "{}", more.stderr);
    assert_eq!(estimate("results/three", "2", "160").stdout, more.stdout);
    let refused = estimate("results/four", "1", "20");
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("at least 60"), "{}", refused.stderr);
    let text = place.run(&[
        "estimate",
        "study.toml",
        "--target",
        "mean",
        "--solves",
        "100",
        "--out",
        "results/one",
    ]);
    assert!(
        text.stdout.contains("simple random sample"),
        "{}",
        text.stdout
    );
}

/// With automatic harmonics a lumped wheel is solved on tuned receptances; surrogates are of its masses themselves.
#[test]
fn an_estimate_with_automatic_harmonics_has_surrogates() {
    let automatic = two_loads().replace("harmonics = [1, 3]", "harmonics = \"auto\"");
    let place = Place::with(&automatic.replace("patterns = 100", "patterns = 400"));
    let arguments = "estimate study.toml --target 90 --solves 60 --json";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let ended = place.run(&arguments);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(!ended.stderr.contains("panicked"), "{}", ended.stderr);
    let report: serde_json::Value = serde_json::from_str(&ended.stdout).expect("JSON");
    let scenarios = report["scenarios"].as_array().expect("a list");
    assert!(!scenarios.is_empty());
    for scenario in scenarios {
        let gain = scenario["surrogates"]["gain"].as_f64();
        assert!(gain.is_some_and(|gain| gain > 0.0), "{scenario}");
    }
}
