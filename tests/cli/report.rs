//! The report: its numbers are those of the tables, its page stands alone, and its figures are drawn.

use std::fmt::Write;

use serde_json::Value;

use crate::blisk::{GOOD, Place};

/// Friction between both linear limits, enough patterns for a P95.
fn study() -> String {
    GOOD.replace("patterns = 10", "patterns = 80").replace(
        "[\"slide\", 50, \"stuck\"]",
        "[\"slide\", 50, 100, 200, \"stuck\"]",
    )
}

/// A finished study in `results/small`.
fn finished(study: &str) -> Place {
    let place = Place::with(study);
    let run = place.run(&["run", "study.toml"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    place
}

fn json(place: &Place, arguments: &[&str]) -> Value {
    let ended = place.run(arguments);
    assert_eq!(ended.code, 0, "{arguments:?}: {}", ended.stderr);
    serde_json::from_str(&ended.stdout).expect("JSON")
}

fn read(place: &Place, name: &str) -> String {
    std::fs::read_to_string(place.path(name)).expect("a file")
}

/// Every element that is opened is closed in order, and there is no stray `<` or `&`.
fn assert_well_formed(markup: &str) {
    const VOID: [&str; 2] = ["meta", "link"];
    let mut open: Vec<&str> = Vec::new();
    let body = markup.split_once("<html").map_or(markup, |(_, rest)| {
        open.push("html");
        rest.split_once('>').expect("an end").1
    });
    // Style sheets are no markup.
    let mut pieces = body.split('<');
    pieces.next();
    for piece in pieces {
        let (tag, text) = piece
            .split_once('>')
            .unwrap_or_else(|| panic!("no end: {piece}"));
        let name = tag.split_whitespace().next().expect("a name");
        if let Some(closed) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed), "{piece}");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
        let in_style = open.last() == Some(&"style");
        assert!(in_style || !text.contains('>'), "{piece}");
        for entity in text.split('&').skip(1) {
            let name = entity.split(';').next().expect("a part");
            let known = ["amp", "lt", "gt", "quot", "#39"].contains(&name);
            assert!(in_style || known, "{entity}");
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn a_report_is_one_page_that_needs_nothing_else() {
    let place = finished(&study());
    let ended = place.run(&["report", "results/small"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(ended.stdout.contains("wrote results/small/report.html"));
    let page = read(&place, "results/small/report.html");
    assert_well_formed(&page);
    // Nothing is fetched and nothing runs.
    for outside in ["http", "<script", "url(", "@import", "src="] {
        assert!(!page.contains(outside), "{outside}");
    }
    for id in [
        "amplitude-0",
        "amplification-factor-0",
        "amplitude-distribution-0",
        "amplification-factor-distribution-0",
        "uncertainty-0",
        "median-response-0",
        "worst-response-0",
        "worst-blades-0",
        "contact-0",
    ] {
        assert!(page.contains(&format!("<figure id=\"{id}\">")), "{id}");
    }
    for none in ["NaN", "\"inf", ",inf", ">inf", " inf ", "-inf"] {
        assert!(!page.contains(none), "{none}");
    }
    // The same results give the same bytes, and the report leaves the results as they are.
    assert_eq!(
        place
            .run(&["report", "results/small", "--out", "again.html"])
            .code,
        0
    );
    assert_eq!(page, read(&place, "again.html"));
    assert_eq!(place.run(&["stats", "results/small"]).code, 0);
}

#[test]
fn a_report_opens_with_a_percentile_that_the_patterns_support() {
    let place = finished(&study());
    let text = place
        .run(&["report", "results/small", "--no-curves"])
        .stdout;
    let p95 = text.find("95th percentile").expect("a question");
    let p99 = text.find("99th percentile").expect("a question");
    let unknown = text.find("Not known").expect("80 patterns give no P99");
    assert!(p95 < p99 && p99 < unknown, "{text}");
    assert!(text.contains("N per sector: P95 ="), "{text}");
}

#[test]
fn the_numbers_of_a_report_are_those_of_the_other_commands() {
    let place = finished(&study());
    let report = json(&place, &["report", "results/small", "--json"]);
    assert!(!place.path("results/small/report.html").exists());
    assert_eq!(
        report["summary"],
        json(&place, &["stats", "results/small", "--json"])
    );
    let group = &report["groups"][0];
    let choices = group["choices"].as_array().expect("a list");
    // 80 patterns give no P99, but a P95.
    assert!(choices[0]["best"].is_null() && choices[0]["lowest"].is_null());
    assert_eq!(
        (&choices[0]["percent"], &choices[0]["needed_patterns"]),
        (&99.0.into(), &368.into())
    );
    let compared = json(&place, &["compare", "results/small", "--json"]);
    assert_eq!(choices[1]["best"], compared["quantities"][0]["best"][0]);
    assert_eq!(choices[1]["enclosed"], true);
    let shown = group["shown"].as_u64().expect("a scenario") as usize;
    assert_eq!(choices[1]["lowest"], shown);
    let scenario = &report["summary"]["scenarios"][shown];
    for (place, quantity) in ["peak_amplitude_m", "amplification_factor"]
        .iter()
        .enumerate()
    {
        let drawn = group["distributions"][place]["percentiles"]
            .as_array()
            .expect("a list");
        let all = scenario[quantity]["percentiles"]
            .as_array()
            .expect("a list");
        assert!(
            drawn.iter().all(|percentile| all.contains(percentile)),
            "{quantity}"
        );
    }
}

#[test]
fn errors_bound_the_percentile_of_the_rows_that_state_them() {
    let place = finished(&study());
    let report = json(
        &place,
        &["report", "results/small", "--no-curves", "--json"],
    );
    for errors in report["groups"][0]["errors"].as_array().expect("a list") {
        let of_p95 = &errors["percentiles"][1];
        let value = of_p95["percentile"]["value"].as_f64().expect("a value");
        let [lowest, highest] =
            ["lowest", "highest"].map(|end| of_p95[end].as_f64().expect("a bound"));
        assert!(lowest < value && value < highest);
        // What every row states is no more than any row states.
        let common = &errors["common"];
        assert_eq!(common["peak"], 1e-3);
        let harmonics = common["harmonics"].as_f64();
        let linear = report["summary"]["scenarios"]
            [errors["scenario"].as_u64().expect("an index") as usize]["contact"]
            != "full";
        assert_eq!(harmonics.is_none(), linear);
        let least = errors["rows"]["stated"]["median"]
            .as_f64()
            .expect("an error");
        assert!(
            1.5 * harmonics.unwrap_or_default() + 1e-3 <= least,
            "{errors}"
        );
        // No percentile moves further than the row that states most.
        let stated = errors["rows"]["stated"]["largest"]
            .as_f64()
            .expect("an error");
        assert!(lowest >= value / (1.0 + stated) && highest <= value / (1.0 - stated));
    }
}

#[test]
fn the_answer_says_whether_numerical_error_could_change_the_choice() {
    let place = finished(&study());
    let arguments = ["report", "results/small", "--no-curves", "--json"];
    let report = json(&place, &arguments);
    let group = &report["groups"][0];
    let lowest = group["choices"][1]["lowest"].as_u64().expect("a scenario") as usize;
    let bound = |scenario: usize, end: &str| {
        let of_p95 = &group["errors"][scenario]["percentiles"][1];
        of_p95[end].as_f64().expect("a bound")
    };
    let others = (0..5).filter(|&other| other != lowest);
    let could = others
        .filter(|&other| bound(other, "lowest") < bound(lowest, "highest"))
        .count();
    let text = place
        .run(&["report", "results/small", "--no-curves"])
        .stdout;
    let sure = "Even if every solution is off by its full error bound, 100 N keeps the lowest P95.";
    let unsure = "If every solution is off by its full error bound, P95 may be lower at ";
    assert_eq!(text.contains(sure), could == 0, "{text}");
    assert_eq!(text.contains(unsure), could > 0, "{text}");
}

#[test]
fn the_wheels_of_a_report_are_those_that_were_delivered() {
    let place = finished(&study());
    let report = json(&place, &["report", "results/small", "--json"]);
    let wheels = &report["groups"][0]["wheels"];
    assert_eq!(wheels["wheels"], "solved");
    let scenario = wheels["scenario"].as_u64().expect("a scenario");
    let statistics = &report["summary"]["scenarios"][scenario as usize]["peak_amplitude_m"];
    let median = statistics["percentiles"]
        .as_array()
        .expect("a list")
        .iter()
        .find(|p| p["percent"] == 50.0);
    assert_eq!(
        wheels["median"]["peak_amplitude_m"],
        median.expect("P50")["value"]
    );
    for which in ["median", "worst"] {
        let wheel = &wheels[which];
        let id = wheel["pattern"].to_string();
        let row = json(
            &place,
            &[
                "verify",
                "results/small",
                "--scenario",
                &scenario.to_string(),
                "--pattern",
                &id,
                "--json",
            ],
        );
        assert_eq!(
            row["delivered"]["peak_amplitude_m"],
            wheel["peak_amplitude_m"]
        );
        // The curve passes the delivered peak, and nothing on it is higher.
        let peak = wheel["peak_amplitude_m"].as_f64().expect("an amplitude");
        let curve = wheel["full"]["amplitude_m"].as_array().expect("a list");
        let highest = curve.iter().filter_map(Value::as_f64).fold(0.0, f64::max);
        assert!(
            (highest / peak - 1.0).abs() < 1e-3,
            "{which}: {highest} {peak}"
        );
        // Welded and frictionless contact resonate more sharply than friction at its best load.
        for limit in ["stuck", "slide"] {
            let curve = wheel[limit]["amplitude_m"].as_array().expect("a list");
            assert!(curve.iter().filter_map(Value::as_f64).fold(0.0, f64::max) > peak);
        }
    }
    let state = &wheels["state"];
    let amplitudes = state["amplitude_m"].as_array().expect("a list");
    let blade = wheels["worst"]["peak_blade"].as_u64().expect("a blade") as usize;
    let peak = wheels["worst"]["peak_amplitude_m"]
        .as_f64()
        .expect("an amplitude");
    assert!((amplitudes[blade].as_f64().expect("an amplitude") / peak - 1.0).abs() < 1e-6);
    assert_eq!(amplitudes.len(), 6);
    assert_eq!(state["contact"].as_array().expect("a list").len(), 6);
    let deviations = state["deviation"].as_array().expect("a list");
    assert!(
        deviations
            .iter()
            .all(|d| d.as_f64().expect("a number").abs() < 0.2)
    );
}

#[test]
fn a_report_of_an_accepted_error_shows_contact_and_what_was_tried_for_it() {
    let open = study().replace("[solver]\nharmonics = [1, 3]\n", "");
    let place = finished(&format!("{open}[accuracy]\namplitude_error = 0.01\n"));
    let drawn = |figures: &[&str]| {
        assert_eq!(place.run(&["report", "results/small"]).code, 0);
        let page = read(&place, "results/small/report.html");
        assert_well_formed(&page);
        for id in figures {
            assert!(page.contains(&format!("<figure id=\"{id}-0\">")), "{id}");
        }
        page
    };
    let page = drawn(&["contact", "worst-blades", "worst-response", "accuracy"]);
    assert!(page.contains("What was tried for the accepted error"));
    assert!(page.contains("The settings were chosen on a sample of rows for an error of 1.0"));
    let report = json(
        &place,
        &["report", "results/small", "--no-curves", "--json"],
    );
    assert!(report["accuracy_ladder"].is_null());
    let trials = &report["accuracy_trials"];
    let tried = trials["tried"].as_array().expect("a list");
    let taken: Vec<&Value> = tried.iter().filter(|own| own["taken"] == true).collect();
    assert_eq!(taken.len(), 1, "{trials}");
    assert_eq!(taken[0]["rows"], trials["rows"]);
    assert!(taken[0]["worst"].as_f64().expect("an error") <= 0.01);
    // A measured ladder takes the place of the trials.
    let measured = place.run(&["tradeoff", "study.toml", "--patterns", "4"]);
    assert_eq!(measured.code, 0, "{}", measured.stderr);
    let page = drawn(&["contact", "accuracy"]);
    assert!(page.contains("What accuracy costs") && !page.contains("another state"));
    assert!(page.contains("Settings that nothing cheaper beats"));
}

#[test]
fn a_report_without_the_inputs_says_so_and_has_no_curves() {
    let of_file = GOOD
        .replace("patterns = 10\n", "")
        .replace(
            "distribution = { kind = \"normal\" }",
            "file = \"patterns.csv\"",
        )
        .replace("standard_deviation = [0.03]\n", "");
    let place = Place::with(&of_file);
    let mut table = "pattern,blade,deviation\n".to_owned();
    for pattern in 0..20 {
        for blade in 0..6 {
            let deviation = 0.03 * f64::from((7 * pattern + 5 * blade) % 11 - 5) / 5.0;
            writeln!(table, "{pattern},{blade},{deviation}").expect("a line");
        }
    }
    place.write("patterns.csv", &table);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let with_inputs = place.run(&["report", "results/small"]);
    assert_eq!((with_inputs.code, with_inputs.stderr.as_str()), (0, ""));
    assert!(read(&place, "results/small/report.html").contains("worst-response-0"));
    place.write("patterns.csv", &table.replace("-0.03", "-0.02"));
    let without = place.run(&["report", "results/small"]);
    assert_eq!(without.code, 0);
    assert!(
        without.stderr.contains("no response curves: "),
        "{}",
        without.stderr
    );
    let page = read(&place, "results/small/report.html");
    assert!(page.contains("No wheels were solved again: "));
    assert!(!page.contains("worst-response-0"));
    // A figure of wheels has nothing to draw then.
    let plot = place.run(&["plot", "results/small", "worst-response"]);
    assert_eq!(plot.code, 2);
    assert!(plot.stderr.contains("mistuning.file"), "{}", plot.stderr);
    let not_asked = place.run(&["report", "results/small", "--no-curves"]);
    assert_eq!((not_asked.code, not_asked.stderr.as_str()), (0, ""));
    let page = read(&place, "results/small/report.html");
    assert!(page.contains("No wheels were solved again: not asked for."));
}

#[test]
fn a_report_of_damaged_or_unfinished_results_is_refused() {
    let place = finished(&study());
    let path = place.path("results/small/responses.parquet");
    let mut bytes = std::fs::read(&path).expect("a table");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&path, bytes).expect("write");
    assert_eq!(place.run(&["report", "results/small"]).code, 8);
    assert_eq!(place.run(&["report", "nowhere"]).code, 7);
}

#[test]
fn single_figures_are_written_as_svg_files_of_their_own() {
    let place = finished(&study());
    for figure in [
        "amplitude",
        "amplification-factor",
        "uncertainty",
        "amplitude-distribution",
        "worst-response",
        "worst-blades",
        "contact",
    ] {
        let ended = place.run(&["plot", "results/small", figure]);
        assert_eq!(ended.code, 0, "{figure}: {}", ended.stderr);
        let drawing = read(&place, &format!("{figure}.svg"));
        assert_well_formed(&drawing);
        assert!(drawing.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
        for part in ["<title", "<desc", "<style", "viewBox"] {
            assert!(drawing.contains(part), "{figure}: {part}");
        }
        // Not every program knows variables of style sheets.
        assert!(!drawing.contains("var("), "{figure}");
    }
    let ended = place.run(&["plot", "results/small", "nothing"]);
    assert_eq!(ended.code, 2);
    assert!(ended.stderr.contains("worst-blades"), "{}", ended.stderr);
    let ended = place.run(&["plot", "results/small", "amplitude", "--out", "a.png"]);
    assert_eq!(ended.code, 2);
    assert!(ended.stderr.contains(".svg"), "{}", ended.stderr);
}

#[test]
fn several_engine_orders_are_sections_of_their_own_and_failures_are_accounted_for() {
    let several = study()
        .replace("engine_orders = [2]", "engine_orders = [1, 2]")
        .replace(
            "standard_deviation = [0.03]",
            "standard_deviation = [0.05, 0.5]",
        )
        .replace("[\"slide\", 50, 100, 200, \"stuck\"]", "[50]");
    let place = Place::with(&several);
    // Blades lose their stiffness in some patterns.
    assert_eq!(place.run(&["run", "study.toml"]).code, 5);
    let report = json(&place, &["report", "results/small", "--json"]);
    let groups = report["groups"].as_array().expect("a list");
    assert_eq!(groups.len(), 4);
    assert_eq!(groups[3]["scenarios"], serde_json::json!([3]));
    assert_eq!(place.run(&["report", "results/small"]).code, 0);
    let page = read(&place, "results/small/report.html");
    assert_well_formed(&page);
    assert!(page.contains("invalid_pattern"));
    assert!(page.contains("engine order 1, standard deviation of blade stiffness 50 %"));
    assert!(page.contains("Too many rows failed"));
    let ended = place.run(&["plot", "results/small", "amplitude"]);
    assert_eq!(ended.code, 2);
    assert!(
        ended
            .stderr
            .contains("--engine-order 2 --standard-deviation 0.5"),
        "{}",
        ended.stderr
    );
    let chosen = [
        "plot",
        "results/small",
        "amplitude",
        "--engine-order",
        "2",
        "--standard-deviation",
        "0.05",
    ];
    assert_eq!(place.run(&chosen).code, 0);
}

/// `manifest.json` with `edit` made to it, and the checksum that it then has.
fn forge(place: &Place, results: &str, edit: impl Fn(&mut Value)) {
    let path = format!("{results}/manifest.json");
    let mut manifest: Value = serde_json::from_str(&read(place, &path)).expect("JSON");
    edit(&mut manifest);
    manifest
        .as_object_mut()
        .expect("a table")
        .remove("checksum");
    let text = serde_json::to_string_pretty(&manifest).expect("JSON");
    let body = text.strip_suffix("\n}").expect("an object");
    let checksum = blake3::hash(body.as_bytes()).to_hex();
    place.write(
        &path,
        &format!("{body},\n  \"checksum\": \"{checksum}\"\n}}\n"),
    );
}

/// A tick for each unit of such an axis takes for ever.
#[test]
fn an_amplitude_at_the_end_of_the_range_of_numbers_is_drawn_or_refused_at_once() {
    let place = finished(&study());
    for amplitude in [1e308, 1e-308] {
        forge(&place, "results/small", |manifest| {
            for scenario in manifest["scenarios"].as_array_mut().expect("a list") {
                scenario["tuned_amplitude_m"] = amplitude.into();
            }
        });
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_blisk"))
            .args(["report", "results/small", "--no-curves"])
            .current_dir(place.path("."))
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("the binary starts");
        let began = std::time::Instant::now();
        let ended = loop {
            if let Some(ended) = child.try_wait().expect("a child") {
                break ended;
            }
            if began.elapsed().as_secs() > 60 {
                child.kill().expect("killed");
                panic!("{amplitude:e} m: no end");
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        };
        assert!(
            matches!(ended.code(), Some(0 | 8)),
            "{amplitude:e} m: {ended}"
        );
    }
}

#[test]
fn a_figure_whose_table_is_missing_says_which_command_makes_it() {
    let place = finished(GOOD);
    let plot = place.run(&["plot", "results/small", "accuracy"]);
    assert_eq!(plot.code, 2);
    for words in [
        "nothing to draw in accuracy: the folder has no tradeoff.parquet",
        "`blisk tradeoff`",
    ] {
        assert!(plot.stderr.contains(words), "{}", plot.stderr);
    }
    // Frequencies need no table of the folder.
    let plot = place.run(&["plot", "results/small", "campbell"]);
    assert_eq!(plot.code, 0, "{}", plot.stderr);
    assert!(read(&place, "campbell.svg").starts_with("<svg"));
    let both = place.run(&["stats", "results/small", "--csv", "--json"]);
    assert_eq!(both.code, 2);
    assert!(
        both.stderr.contains("'--csv' cannot be used with '--json'"),
        "{}",
        both.stderr
    );
}
