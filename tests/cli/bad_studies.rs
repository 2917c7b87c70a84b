//! Bad study files: each is refused with exit code 3, its line, the key, the value, what is accepted.

use crate::bad_study_table::CASES;
use crate::blisk::{GOOD, Place};

#[test]
fn every_bad_study_is_refused_with_line_key_value_and_what_is_accepted() {
    let place = Place::new();
    let lines: Vec<String> = (0..6).map(|blade| format!("0,{blade},0.01")).collect();
    place.write(
        "p.csv",
        &format!("pattern,blade,deviation\n{}\n", lines.join("\n")),
    );
    let mut missed = Vec::new();
    for (old, new, fragments) in CASES {
        assert!(GOOD.contains(old), "{old} is not in the study");
        place.write("study.toml", &GOOD.replacen(old, new, 1));
        let ended = place.run(&["check", "study.toml"]);
        let told = ended.stderr;
        if ended.code != 3 || !told.contains("study.toml:") {
            missed.push(format!("{new:?} exits with {}: {told}", ended.code));
        }
        for fragment in fragments
            .iter()
            .filter(|&fragment| !told.contains(fragment))
        {
            missed.push(format!("{new:?}: no {fragment:?} in {told}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn everything_that_is_wrong_is_told_at_once_in_the_order_of_lines() {
    let study = GOOD
        .replace("patterns = 10", "patterns = 0")
        .replace("0.002", "-1")
        .replace("[1, 3]", "[3]");
    let ended = Place::with(&study).run(&["check", "study.toml"]);
    assert_eq!(ended.code, 3);
    let places: Vec<usize> = ["study.patterns", "damping.structural", "solver.harmonics"]
        .iter()
        .map(|key| ended.stderr.find(key).expect(key))
        .collect();
    assert!(places.is_sorted(), "{}", ended.stderr);
}

#[test]
fn what_is_wrong_is_underlined_in_its_line() {
    for (good, bad, shown) in [
        (
            "friction_coefficient = 0.3",
            "friction_coefficient =  11",
            "24 | friction_coefficient =  11\n     |                         ^^\n",
        ),
        ("seed = 7", "sed = 7", "5 | sed = 7\n    | ^^^\n"),
        (
            "engine_orders = [2]",
            "engine_orders = [2] # of the stator\nmodes = 4",
            "32 | modes = 4\n     | ^^^^^\n",
        ),
        (
            "kind = \"normal\"",
            "kind = \"gauss\"",
            "35 | distribution = { kind = \"gauss\" }\n     |                         ^^^^^^^\n",
        ),
        (
            "blade_mass_kg = 0.25",
            "blade_mass_kg = -1",
            "13 | blade_mass_kg = -1\n     |                 ^^\n",
        ),
    ] {
        assert!(GOOD.contains(good), "{good}");
        let ended = Place::with(&GOOD.replacen(good, bad, 1)).run(&["check", "study.toml"]);
        assert_eq!(ended.code, 3);
        assert!(ended.stderr.contains(shown), "{shown}{}", ended.stderr);
    }
    // What is missing has no part of a line.
    let ended = Place::with(&GOOD.replace("seed = 7\n", "")).run(&["check", "study.toml"]);
    assert!(!ended.stderr.contains('^'), "{}", ended.stderr);
}

#[test]
fn contact_of_study_and_model_must_agree() {
    let without_ring = GOOD
        .replace("ring_mass_kg = 0.03\n", "")
        .replace("ring_coupling_stiffness_n_per_m = 8.0e5\n", "")
        .replace("ring_disk_stiffness_n_per_m = 1.0e4\n", "");
    let no_contact = |study: &str| {
        let start = study.find("[contact]").expect("a contact");
        let end = study.find("[damping]").expect("damping");
        format!("{}{}", &study[..start], &study[end..])
    };
    let free = |study: &str| study.replace("[\"slide\", 50, \"stuck\"]", "[\"free\"]");
    let cases = [
        (without_ring.clone(), "sweep.normal_load_n"),
        (
            free(&without_ring),
            "the model has no contact; accepted: no [contact]",
        ),
        (no_contact(GOOD), "contact is missing"),
    ];
    for (study, fragment) in cases {
        let ended = Place::with(&study).run(&["check", "study.toml"]);
        assert_eq!(ended.code, 3, "{}", ended.stdout);
        assert!(ended.stderr.contains(fragment), "{}", ended.stderr);
    }
    for good in [
        no_contact(&free(&without_ring)),
        free(GOOD),
        no_contact(&free(GOOD)),
    ] {
        let ended = Place::with(&good).run(&["check", "study.toml"]);
        assert_eq!(ended.code, 0, "{}", ended.stderr);
    }
}

#[test]
fn a_bad_file_of_patterns_is_refused_with_its_line() {
    let study = GOOD
        .replace("distribution = { kind = \"normal\" }", "file = \"p.csv\"")
        .replace("standard_deviation = [0.03]\n", "");
    let place = Place::with(&study);
    let cases = [
        ("pattern,blade,deviation\n0,0,0\n", "blade 1"),
        ("pattern,blade,deviation\n0,9,0\n", "p.csv:2: blade = 9"),
        (
            "pattern,blade,deviation\n0,0,-1\n",
            "p.csv:2: deviation = -1",
        ),
    ];
    for (content, fragment) in cases {
        place.write("study.toml", &study.replace("patterns = 10\n", ""));
        place.write("p.csv", content);
        let ended = place.run(&["check", "study.toml"]);
        assert_eq!(ended.code, 3, "{}", ended.stdout);
        assert!(ended.stderr.contains(fragment), "{}", ended.stderr);
    }
    let lines: Vec<String> = (0..6).map(|blade| format!("0,{blade},0.01")).collect();
    place.write(
        "p.csv",
        &format!("pattern,blade,deviation\n{}\n", lines.join("\n")),
    );
    place.write("study.toml", &study);
    let ended = place.run(&["check", "study.toml"]);
    assert_eq!(ended.code, 3);
    assert!(
        ended
            .stderr
            .contains("study.patterns = 10 is not accepted; accepted: absent, or 1"),
        "{}",
        ended.stderr
    );
}

/// Checks of lists whose time grows with the square of their length take minutes here, and a message of 100,000
/// findings, each with its line, more memory than there is.
#[test]
fn lists_of_a_hundred_thousand_are_checked_at_once() {
    let list = |value: &dyn Fn(u32) -> String| {
        let values: Vec<String> = (0..100_000).map(value).collect();
        values.join(", ")
    };
    let different = list(&|place| (place + 1).to_string());
    let small = list(&|place| format!("{:e}", 1e-6 * f64::from(place + 1)));
    let same = list(&|_| "50".to_owned());
    let loads = "\"slide\", 50, \"stuck\"";
    let deviations = "standard_deviation = [0.03]";
    let in_time = |study: String| {
        let place = Place::with(&study);
        let began = std::time::Instant::now();
        let check = place.run(&["check", "study.toml"]);
        // Under a second on an idle machine; the square took minutes.
        assert!(began.elapsed().as_secs() < 10, "{:?}", began.elapsed());
        check
    };
    let good = in_time(GOOD.replace(loads, &different));
    assert_eq!(good.code, 0, "{}", good.stderr);
    assert!(good.stdout.contains("100000 scenarios"), "{}", good.stdout);
    let good = in_time(GOOD.replace(deviations, &format!("standard_deviation = [{small}]")));
    assert_eq!(good.code, 0, "{}", good.stderr);
    let bad = in_time(GOOD.replace(loads, &same));
    assert_eq!(bad.code, 3);
    assert!(bad.stderr.contains("and 99899 more"), "{}", bad.stderr);
    assert!(bad.stderr.len() < 200_000, "{}", bad.stderr.len());
}

#[test]
fn a_law_along_one_tangent_is_refused_where_a_pair_does_not_move_along_it() {
    let place = Place::with(GOOD);
    let exported = place.run(&["model", "study.toml", "--export", "bundle"]);
    assert_eq!(exported.code, 0, "{}", exported.stderr);
    // Masses that move along the axis: the second tangent of a surface whose normal is radial.
    let dofs = std::fs::read_to_string(place.path("bundle/dofs.csv")).expect("a table");
    place.write("bundle/dofs.csv", &dofs.replace(",t,", ",z,"));
    let of_bundle = GOOD.split("[model]").next().expect("a head").to_owned()
        + "[model]\nsource = \"bundle\"\n[model.bundle]\npath = \"bundle\"\n[contact]"
        + GOOD.split("[contact]").nth(1).expect("the rest");
    place.write("along.toml", &of_bundle);
    for command in ["check", "run"] {
        let refused = place.run(&[command, "along.toml"]);
        assert_eq!(refused.code, 3, "{}", refused.stderr);
        let text = refused
            .stderr
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        for part in [
            "contact.law",
            "macro_slip_1d",
            "contact pair 0 (node 1 on node 2) does not move along its first tangent",
            "accepted: \"macro_slip_2d\"",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
    // By the other law the wheel is that of the study, turned by a right angle.
    let two = of_bundle.replace("macro_slip_1d", "macro_slip_2d");
    place.write("along.toml", &two);
    let rows = |study: &str, results: &str| {
        let run = place.run(&["run", study, "--out", results]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let stats = place.run(&["stats", results, "--csv"]);
        assert_eq!(stats.code, 0, "{}", stats.stderr);
        stats.stdout
    };
    let numbers = |text: &str| -> Vec<f64> {
        let cells = text.split([',', '\n']);
        cells.filter_map(|cell| cell.parse().ok()).collect()
    };
    let (turned, own) = (rows("along.toml", "turned"), rows("study.toml", "own"));
    let pairs: Vec<(f64, f64)> = numbers(&turned).into_iter().zip(numbers(&own)).collect();
    assert!(pairs.len() > 20, "{own}");
    for (turned, own) in pairs {
        assert!((turned - own).abs() <= 1e-6 * own.abs(), "{turned} {own}");
    }
}
