//! What people read: widths, units, names and the floor of a probability.

use blisk::population::table::{RESPONSE_COLUMNS, SCENARIO_COLUMNS};
use blisk::response::harmonic_balance::Status;
use serde_json::Value;

use crate::blisk::{GOOD, Place};

/// Friction at two loads between the linear limits, enough patterns for a P99.
fn study() -> String {
    GOOD.replace("patterns = 10", "patterns = 380").replace(
        "[\"slide\", 50, \"stuck\"]",
        "[\"slide\", 50, 100, \"stuck\"]",
    )
}

/// A finished study in `results/small`.
fn finished(study: &str) -> Place {
    let place = Place::with(study);
    let run = place.run(&["run", "study.toml"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    place
}

fn output(place: &Place, arguments: &[&str]) -> String {
    let ended = place.run(arguments);
    assert_eq!(ended.code, 0, "{arguments:?}: {}", ended.stderr);
    ended.stdout
}

fn json(place: &Place, arguments: &[&str]) -> Value {
    serde_json::from_str(&output(place, arguments)).expect("JSON")
}

fn widest(text: &str) -> usize {
    text.lines()
        .map(|line| line.chars().count())
        .max()
        .unwrap_or(0)
}

/// Check and report name once what a row is held to, and no text has the name of a column for what rows are solved on.
#[test]
fn what_rows_are_held_to_and_solved_on_is_said_in_plain_words() {
    let automatic = GOOD.replace("harmonics = [1, 3]", "peak_tolerance = 2e-3");
    let accuracy = format!("{automatic}\n[accuracy]\namplitude_error = 0.02\n");
    let accuracy = accuracy.replace("peak_tolerance = 2e-3", "");
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for (study, of_check, of_report) in [
        (
            &automatic,
            "the amplitude of each row is held to 0.2 % by samples per period and 2 % by harmonics \
             (solver.peak_tolerance, solver.harmonic_tolerance; accuracy.amplitude_error sets both)",
            "the amplitude of each row is held to 0.2 % by samples per period and 2 % by harmonics",
        ),
        (
            &accuracy,
            "an error of 2 % of the amplitude of 95 % of the rows (accuracy.amplitude_error)",
            "by harmonics (chosen by accuracy.amplitude_error, 2 % for 95 % of the rows)",
        ),
    ] {
        let place = Place::with(study);
        let check = flat(&output(&place, &["check", "study.toml"]));
        assert_eq!(check.matches(of_check).count(), 1, "{check}");
        assert_eq!(check.matches("amplitude_error").count(), 1, "{check}");
        let run = output(&place, &["run", "study.toml"]);
        // Chosen settings have a line of their own in its place.
        let line = "\ntuned receptances (no reduction basis), tuned peak within ";
        let chosen = "\nsettings chosen by an accepted numerical error of 2 %";
        let line = if *study == accuracy { chosen } else { line };
        assert!(run.contains(line), "{run}");
        let report = output(&place, &["report", "results/small", "--no-curves"]);
        assert_eq!(flat(&report).matches(of_report).count(), 1, "{report}");
        assert_eq!(
            report.matches("each row is held to ").count(),
            1,
            "{report}"
        );
        let model = output(&place, &["model", "study.toml"]);
        for text in [&check, &run, &report, &model] {
            assert!(!text.contains("tuned_receptances"), "{text}");
        }
        let line = "\ntuned receptances (no reduction basis): 18 reduced coordinates";
        assert!(model.contains(line), "{model}");
    }
    // A basis has its name.
    let named =
        format!("{GOOD}\n[reduction]\nbasis = \"stick_slide\"\nstick_modes = 2\nslide_modes = 2\n");
    let place = Place::with(&named);
    assert!(output(&place, &["check", "study.toml"]).contains("basis stick_slide"));
    assert!(output(&place, &["model", "study.toml"]).contains("\nbasis "));
    // Linear rows have no such error.
    let linear = GOOD.replace("\"slide\", 50, ", "\"slide\", ");
    let place = Place::with(&linear);
    assert!(!output(&place, &["check", "study.toml"]).contains("is held to"));
}

#[test]
fn a_comparison_takes_the_best_load_as_baseline_marks_the_floor_of_p_and_fits_80_columns() {
    let place = finished(&study());
    let request = ["compare", "results/small", "--percentile", "99"];
    let report = json(&place, &[&request[..], &["--json"]].concat());
    assert_eq!(report["baseline_choice"], "lowest");
    let amplitude = &report["quantities"][0];
    let best = &amplitude["best"][0]["lowest"];
    assert_eq!(*best, 2, "100 N is the best load of this wheel");
    for quantity in report["quantities"].as_array().expect("two") {
        let comparisons = quantity["comparisons"].as_array().expect("a list");
        assert_eq!(comparisons.len(), 3);
        for own in comparisons {
            assert_eq!(own["baseline"]["scenario"], *best);
            // No p is below what the resamples can show, and a bound is one that comes from there.
            let p = own["percentile"]["p_value"].as_f64().expect("p");
            let floor = own["percentile"]["p_value_floor"]
                .as_f64()
                .expect("a floor");
            assert!(floor > 0.0 && p >= floor, "{p}, {floor}");
            if p <= floor {
                assert_eq!(own["adjusted_p_value_is_bound"], true);
            }
        }
    }
    let text = output(&place, &request);
    assert!(widest(&text) <= 80, "{}\n{text}", widest(&text));
    for words in [
        "against 100 N per sector",
        "lowest P99 of the peak amplitude; --baseline I",
        "p <=: no resample has the other sign",
    ] {
        let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(words), "{words}\n{text}");
    }
    // Every load is worse than the best one in every resample: the p in the table is a bound.
    let marked = text.lines().filter(|line| line.contains("<= 0.0"));
    assert!(marked.count() >= 3, "{text}");
    let named = json(
        &place,
        &[&request[..], &["--baseline", "0", "--json"]].concat(),
    );
    assert_eq!(named["baseline_choice"], "named");
    let of_named = &named["quantities"][0]["comparisons"][0];
    assert_eq!(of_named["baseline"]["scenario"], 0);
    // Folders against each other fit as well.
    let text = output(&place, &["compare", "results/small", "results/small"]);
    assert!(widest(&text) <= 80, "{}\n{text}", widest(&text));
    assert!(text.contains("against the same load in A"), "{text}");
}

#[test]
fn amplitudes_have_one_unit_in_every_text_and_loads_are_named_per_sector() {
    let place = finished(&study());
    let stats = output(&place, &["stats", "results/small"]);
    let unit = "µm";
    assert!(stats.contains(&format!("tuned {unit}")), "{stats}");
    let page = {
        output(&place, &["report", "results/small", "--no-curves"]);
        std::fs::read_to_string(place.path("results/small/report.html")).expect("a page")
    };
    assert!(page.contains(&format!("tuned, {unit}")));
    for arguments in [
        "compare results/small",
        "stats results/small --tails",
        "verify results/small --scenario 1 --pattern 3",
        "optimum study.toml --between 50:200 --resolution 1",
        "estimate study.toml --solves 120 --out results/estimate",
        "response study.toml --pattern tuned --load 50 --frequencies 340:370:5 --out c.csv",
    ] {
        let text = output(&place, &arguments.split(' ').collect::<Vec<_>>());
        assert!(text.contains(unit), "{arguments}\n{text}");
        for other in [" um", " mm", " m ", "e-4", "e-5"] {
            assert!(!text.contains(other), "{arguments}: {other}\n{text}");
        }
    }
    assert!(stats.contains("at 100 N per sector"), "{stats}");
    assert!(page.contains("per sector"));
}

#[test]
fn linear_limits_show_no_share_of_slipping_pairs() {
    let place = finished(&study());
    let stats = output(&place, &["stats", "results/small"]);
    for limit in ["slide", "stuck"] {
        let row = stats
            .lines()
            .find(|line| line.trim_start().starts_with(limit));
        let cells: Vec<&str> = row.expect("a row").split_whitespace().collect();
        assert_eq!(cells[cells.len() - 2..], ["-", "-"], "{stats}");
    }
}

#[test]
fn check_says_the_study_in_words_and_remarks_on_what_is_unusual() {
    let place = Place::with(GOOD);
    let text = output(&place, &["check", "study.toml"]);
    for words in [
        "6 sectors of",
        "normal law, standard deviation 3 %",
        "macro_slip_1d: friction coefficient 0.3",
        "50 N per sector (50 N per sector is 300 N on all 6)",
        "engine order 2, 10 N on each sector: excites nodal diameter 2, travelling forwards",
        "structural loss factor 0.002",
        "harmonics 1, 3",
        "10 patterns x 3 scenarios = 30 rows, 10 of them with friction",
        "P99 will have no value: a 95 % interval needs 368 patterns",
    ] {
        let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(words), "{words}\n{text}");
    }
    assert!(widest(&text) <= 80, "{text}");
    // Engine order 8 on 6 sectors, and the load of a wheel in the place of that of a sector.
    let odd = GOOD
        .replace("engine_orders = [2]", "engine_orders = [8]")
        .replace("50, \"stuck\"", "240000, \"stuck\"");
    place.write("odd.toml", &odd);
    let report = json(&place, &["check", "odd.toml", "--json"]);
    let echo = &report["echo"];
    assert_eq!(echo["excitations"][0]["nodal_diameter"], 2);
    assert_eq!(echo["loads"][1]["wheel_load_n"], 1_440_000.0);
    let remarks: Vec<&str> = echo["remarks"]
        .as_array()
        .expect("remarks")
        .iter()
        .filter_map(|own| own["remark"].as_str())
        .collect();
    assert!(
        remarks.contains(&"aliased_engine_order") && remarks.contains(&"large_load"),
        "{remarks:?}"
    );
    let text = output(&place, &["check", "odd.toml"]);
    assert!(
        text.contains("engine order 8 on 6 sectors excites nodal diameter 2"),
        "{text}"
    );
    // What is usual has no such remarks.
    let usual = json(&place, &["check", "study.toml", "--json"]);
    let few = |own: &Value| own["remark"] == "few_patterns";
    assert!(
        usual["echo"]["remarks"]
            .as_array()
            .expect("remarks")
            .iter()
            .all(few)
    );
}

/// A bundle made by hand may have any normal.
#[test]
fn check_remarks_on_contact_pairs_in_which_nothing_can_rub() {
    let place = Place::with(GOOD);
    output(&place, &["model", "study.toml", "--export", "bundle"]);
    let (head, rest) = GOOD.split_once("[model]").expect("a model");
    let (_, rest) = rest.split_once("[contact]").expect("a contact");
    let model = "[model]\nsource = \"bundle\"\nbundle = { path = \"bundle\" }\n\n[contact]";
    place.write("study.toml", &format!("{head}{model}{rest}"));
    let words = "1 of 1 contact pairs of a sector have no displacement across their normal";
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(!flat(&output(&place, &["check", "study.toml"])).contains(words));
    // Its masses move along theta.
    let contact = place.path("bundle/contact.csv");
    let radial = std::fs::read_to_string(&contact).expect("contact.csv");
    let along = radial.replace(",-1e0,0e0,0e0,", ",0e0,1e0,0e0,");
    assert_ne!(along, radial);
    std::fs::write(&contact, along).expect("contact.csv");
    let text = output(&place, &["check", "study.toml"]);
    assert!(flat(&text).contains(words), "{text}");
    let report = json(&place, &["check", "study.toml", "--json"]);
    let remarks = report["echo"]["remarks"].as_array().expect("remarks");
    let expected = serde_json::json!({ "remark": "no_friction", "pairs": 1, "contact_pairs": 1 });
    assert!(remarks.contains(&expected), "{remarks:?}");
    // It is solved as a wheel without contact: no load changes anything.
    let run = place.run(&["run", "study.toml", "--json"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let summary: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let scenarios = summary["scenarios"].as_array().expect("a list");
    let tuned = |own: &Value| own["tuned_amplitude_m"].as_f64().expect("a peak");
    for own in scenarios {
        let ratio = tuned(own) / tuned(&scenarios[0]);
        assert!((ratio - 1.0).abs() < 1e-5, "{own}");
    }
}

/// Patterns enough for the percentile that its report opens with, and loads of one sector.
#[test]
fn the_study_of_the_readme_gives_no_cause_for_remarks() {
    let study = concat!(env!("CARGO_MANIFEST_DIR"), "/studies/quickstart.toml");
    let report = json(&Place::with(GOOD), &["check", study, "--json"]);
    assert_eq!(report["echo"]["remarks"], serde_json::json!([]));
    let patterns = report["echo"]["patterns"].as_u64();
    assert!(patterns >= Some(368), "{patterns:?}");
}

#[test]
fn explain_finds_keys_and_terms_by_words_of_their_names_and_meanings() {
    let place = Place::new();
    let friction = output(&place, &["explain", "friction"]);
    assert!(
        friction.contains("contact.friction_coefficient\n"),
        "{friction}"
    );
    // By a word of its meaning alone, in any case, and by several words.
    let revolutions = output(&place, &["explain", "Revolutions"]);
    assert!(
        revolutions.contains("contact.normal_load.speed_rpm"),
        "{revolutions}"
    );
    let both = output(&place, &["explain", "friction", "coefficient"]);
    assert!(both.contains("contact.friction_coefficient\n") && !both.contains("contact.ring\n"));
    // One word with two meanings.
    let full = output(&place, &["explain", "full"]);
    assert!(full.contains("full (column contact)") && full.contains("full (option --fidelity"));
    // Words of the headings of a summary, and of the pages about it.
    for (word, term) in [
        ("tuned", "\ntuned wheel\n"),
        ("at Hz", "peak, at Hz (summary)"),
        ("P95", "percentile P50, P95, P99"),
        ("failed", "status: ok, failed (summary)"),
        ("separated", "separation: separated (summary)"),
        ("bounds", "bounds, 95 % interval"),
        ("optimum", "optimum, lowest P95 amplitude (summary)"),
        ("bar", "bar (validation report)"),
        ("verdict", "verdict (validation report)"),
        ("stated error", "stated error, numerical error"),
        ("not estimable", "not estimable, not settled"),
        ("warning", "warning (summary)"),
        // Figures, and terms of the glossary.
        ("worst response", "worst-response (figure)"),
        ("nodal diameter", "\nnodal diameter\n"),
        ("engine order", "\nengine order\n"),
        ("Campbell", "\nCampbell diagram\n"),
        ("SAFE", "\nSAFE diagram\n"),
    ] {
        let found = format!("\n{}", output(&place, &["explain", word]));
        // What has the word in its name comes before what mentions it.
        let first = found.split("  meaning").next();
        assert!(
            first.is_some_and(|first| first.contains(term)),
            "{word}: {found}"
        );
    }
    assert_eq!(place.run(&["explain", "no-such-word"]).code, 2);
}

#[test]
fn explain_knows_the_figures_and_every_term_of_the_glossary() {
    let place = Place::new();
    for (_, name, about) in blisk::report::FIGURES {
        let text = output(&place, &["explain", name]);
        let own = format!("{name} (figure)\n  meaning   {about}; ");
        assert!(text.contains(&own), "{name}: {text}");
    }
    let terms = include_str!("../../docs/glossary.md")
        .lines()
        .filter_map(|line| line.strip_prefix("| ")?.split(" | ").next())
        .filter(|term| *term != "term" && !term.starts_with("---"));
    for term in terms {
        let known = blisk::input::terms_about(term);
        let named = |own: &blisk::input::Term| own.word.starts_with(term);
        assert!(known.iter().any(named), "{term}: {known:?}");
    }
    let text = output(&place, &["explain", "nodal diameter"]);
    let meaning = "nodal diameter\n  meaning   Spatial harmonic h of a motion around the wheel";
    assert!(text.starts_with(meaning), "{text}");
    assert!(!text.contains("]("), "{text}");
}

/// From their one declaration, which the page has too.
#[test]
fn explain_knows_the_statuses_of_rows_and_the_columns_of_tables() {
    let place = Place::new();
    let page = include_str!("../../docs/results.md");
    for status in Status::ALL {
        let (name, meaning) = (status.name(), status.meaning());
        let line = format!("| `{name}` | {meaning} |\n");
        assert!(page.contains(&line), "docs/results.md has not: {line}");
        let text = output(&place, &["explain", name]);
        let own = format!("{name} (status of a row)\n  meaning   {meaning}\n");
        // Of `ok` a term is named too.
        assert!(
            text.starts_with(&own) || text.contains(&format!("\n{own}")),
            "{text}"
        );
    }
    for (table, columns) in [
        ("responses.parquet", RESPONSE_COLUMNS),
        ("scenarios.parquet", SCENARIO_COLUMNS),
    ] {
        for column in columns {
            let text = output(&place, &["explain", column.name]);
            // A key of that name is meant first.
            let is_key = text.starts_with(&format!("{}\n", column.name));
            assert!(
                is_key || text.contains(table) && text.contains(column.description),
                "{table}: {}: {text}",
                column.name
            );
        }
    }
    let error = output(&place, &["explain", "harmonic_error"]);
    assert!(
        error.starts_with("harmonic_error (column of responses.parquet"),
        "{error}"
    );
}

#[test]
fn help_is_wrapped() {
    let place = Place::new();
    for command in [
        "run", "optimum", "compare", "verify", "tradeoff", "estimate",
    ] {
        let text = output(&place, &[command, "--help"]);
        assert!(widest(&text) <= 100, "{command}: {}", widest(&text));
    }
    let text = output(&place, &["--help"]);
    assert!(widest(&text) <= 100, "{}", widest(&text));
}
