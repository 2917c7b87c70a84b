//! Measured wheels of `mistuning.file`: what is said where they are too few for a percentile.

use serde_json::Value;

use crate::blisk::{GOOD, Place};
use crate::report_page::left_in_words;

/// `wheels` wheels of a file, whose ids are multiples of ten.
fn of_file(wheels: u32) -> Place {
    let study = GOOD
        .replace("patterns = 10\n", "")
        .replace(
            "distribution = { kind = \"normal\" }",
            "file = \"wheels.csv\"",
        )
        .replace("standard_deviation = [0.03]\n", "");
    let place = Place::with(&study);
    let line = |entry: u32| {
        let (wheel, blade) = (entry / 6, entry % 6);
        let deviation = f64::from((wheel * 37 + blade * 101) % 41) / 800.0 - 0.025;
        format!("{},{blade},{deviation}\n", 10 * wheel)
    };
    let lines: Vec<String> = (0..6 * wheels).map(line).collect();
    let table = format!("pattern,blade,deviation\n{}", lines.concat());
    place.write("wheels.csv", &table);
    place
}

fn output(place: &Place, arguments: &[&str]) -> String {
    let ended = place.run(arguments);
    assert_eq!(ended.code, 0, "{arguments:?}: {}", ended.stderr);
    ended.stdout
}

#[test]
fn few_measured_wheels_are_read_one_by_one_instead_of_drawing_more() {
    let place = of_file(3);
    let check = output(&place, &["check", "study.toml"]);
    let check = check.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        check.contains(
            "a 95 % interval needs 72 wheels, mistuning.file holds 3; read the peak of each wheel, which blisk report DIR prints"
        ),
        "{check}"
    );
    let run = output(&place, &["run", "study.toml"]);
    assert!(
        run.contains("at least 72 wheels, mistuning.file holds 3; read the peak of each wheel"),
        "{run}"
    );
    let report = output(&place, &["report", "results/small", "--no-curves"]);
    for text in [&run, &report] {
        assert!(!text.contains("study.patterns"), "{text}");
    }
    assert!(report.contains("A 95 % interval needs 368 wheels, mistuning.file holds 3"));
    // What it prints is what replay finds.
    let (_, of_wheels) = report
        .split_once("How large is the peak amplitude of each wheel of mistuning.file?")
        .expect("the question");
    let line = of_wheels
        .lines()
        .find(|line| line.contains("Peaks at 50 N: "))
        .expect("the load");
    for wheel in ["0", "10", "20"] {
        let arguments = [
            "verify",
            "results/small",
            "--scenario",
            "1",
            "--pattern",
            wheel,
            "--json",
        ];
        let row: Value = serde_json::from_str(&output(&place, &arguments)).expect("JSON");
        let peak_m = find(&row, "peak_amplitude_m").expect("a peak");
        let (_, shown) = line
            .split_once(&format!("wheel {wheel} "))
            .expect("the wheel");
        let shown: f64 = { shown.split_whitespace().next() }
            .and_then(|number| number.parse().ok())
            .expect("a number");
        let error = shown * 1e-6 / peak_m - 1.0;
        assert!(error.abs() < 1e-3, "wheel {wheel}: {shown} and {peak_m}");
        let factor = find(&row, "amplification_factor").expect("a factor");
        let blade = find(&row, "peak_blade").expect("a blade");
        let beside = format!("µm (amplification {factor:.3}, blade {blade})");
        let (_, own) = line
            .split_once(&format!("wheel {wheel} "))
            .expect("the wheel");
        let own = own.split_once(')').expect("an end").0;
        assert!(format!("{own})").ends_with(&beside), "{own}: {beside}");
    }
}

/// The first number under `name` in a tree.
fn find(value: &Value, name: &str) -> Option<f64> {
    match value {
        Value::Object(fields) => {
            let own = fields.get(name).and_then(Value::as_f64);
            own.or_else(|| fields.values().find_map(|field| find(field, name)))
        }
        Value::Array(entries) => entries.iter().find_map(|entry| find(entry, name)),
        _ => None,
    }
}

#[test]
fn one_measured_wheel_has_peaks_and_nothing_is_said_of_percentiles() {
    let place = of_file(1);
    // Harmonics that the wheel needs, so that there is nothing else to warn of.
    let study = std::fs::read_to_string(place.path("study.toml")).expect("a study");
    assert!(study.contains("harmonics = [1, 3]"));
    place.write("study.toml", &study.replace("harmonics = [1, 3]", ""));
    let check = output(&place, &["check", "study.toml"]);
    let run = output(&place, &["run", "study.toml"]);
    let report = output(&place, &["report", "results/small", "--no-curves"]);
    for text in [&check, &run, &report] {
        assert!(
            !text.contains("warning") && !text.contains("P95") && !text.contains("95 % interval"),
            "{text}"
        );
    }
    // The load with the lowest peak of this wheel is said, as its line has it.
    let peak_of = |line: &str| -> Option<f64> {
        let mut cells = line.split_whitespace();
        let label = cells.next()?;
        ["slide", "50", "stuck"].contains(&label).then_some(())?;
        cells.nth(2)?.parse().ok()
    };
    let peaks: Vec<f64> = run.lines().filter_map(peak_of).collect();
    assert_eq!(peaks.len(), 3, "{run}");
    let lowest = peaks.into_iter().fold(f64::INFINITY, f64::min);
    let (_, said) =
        { run.split_once("lowest peak of the wheel (engine order 2): ") }.expect("it is said");
    let said: f64 = { said.split_whitespace().next() }
        .and_then(|number| number.parse().ok())
        .expect("a number");
    assert!((said / lowest - 1.0).abs() < 1e-3, "{said}: {run}");
    // The summary has the peak and its factor, as the row has them.
    let arguments = [
        "verify",
        "results/small",
        "--scenario",
        "1",
        "--pattern",
        "0",
        "--json",
    ];
    let row: Value = serde_json::from_str(&output(&place, &arguments)).expect("JSON");
    let line = { run.lines() }.find(|line| line.trim_start().starts_with("50 "));
    let cells: Vec<&str> = line.expect("the load").split_whitespace().collect();
    let header = { run.lines() }
        .find(|line| line.contains("load N"))
        .expect("a header");
    assert!(
        header.contains("peak µm") && header.contains("amplification"),
        "{header}"
    );
    for (place, name, unit) in [
        (3, "peak_amplitude_m", 1e-6),
        (4, "amplification_factor", 1.0),
    ] {
        let shown: f64 = cells[place].parse().expect("a number");
        let own = find(&row, name).expect("a number");
        assert!(
            (shown * unit / own - 1.0).abs() < 1e-3,
            "{name}: {shown} and {own}"
        );
    }
    // The printed answer has the numerical error of the peak, as the page has it.
    let page = std::fs::read_to_string(place.path("results/small/report.html")).expect("a page");
    let (_, answer) =
        { report.split_once("How much of that peak is numerical error?\n  At most ") }
            .expect("the answer");
    let (bound, rest) = answer
        .split_once(" % of the peak at 50 N: it lies between ")
        .expect("a bound");
    let (_, of_page) = page
        .split_once("Numerical error of the peak<")
        .expect("the number");
    let (_, of_page) = of_page.split_once("at most ").expect("a bound");
    assert!(
        of_page.starts_with(&format!("{bound}\u{a0}%")),
        "{bound}: {}",
        &of_page[..40]
    );
    let (low, rest) = rest.split_once(" and ").expect("two ends");
    let (high, _) = rest.split_once(" µm.").expect("an end");
    let own = 1e6 * find(&row, "peak_amplitude_m").expect("a peak");
    let numbers = ["report", "results/small", "--no-curves", "--json"];
    let numbers: Value = serde_json::from_str(&output(&place, &numbers)).expect("JSON");
    let stated = &numbers["groups"][0]["errors"][1]["rows"]["stated"]["largest"];
    let stated = stated.as_f64().expect("an error");
    for (shown, expected) in [(low, own / (1.0 + stated)), (high, own / (1.0 - stated))] {
        let shown: f64 = shown.parse().expect("a number");
        assert!((shown / expected - 1.0).abs() < 1e-3, "{shown} {expected}");
    }
    assert!(page.contains("Normal load per sector with the lowest peak of the wheel"));
    assert!(page.contains("No problem found"));
}

#[test]
fn a_few_measured_wheels_open_the_report_with_the_highest_of_them() {
    let place = of_file(3);
    let study = std::fs::read_to_string(place.path("study.toml")).expect("a study");
    let loads = "[\"slide\", 50, \"stuck\"]";
    assert!(study.contains(loads));
    place.write("study.toml", &study.replace(loads, "[50, 100, 200]"));
    output(&place, &["run", "study.toml"]);
    let arguments = [
        "report",
        "results/small",
        "--no-curves",
        "--json",
        "--out",
        "page.html",
    ];
    let numbers: Value = serde_json::from_str(&output(&place, &arguments)).expect("JSON");
    let group = &numbers["groups"][0];
    // By the peaks of the report, which `verify` finds as well: the test above.
    let measured = group["measured"].as_array().expect("a list");
    let peak = |own: &Value| own["peak_amplitude_m"].as_f64().expect("a peak");
    let highest = |load: u64| {
        let wheels = measured.iter().filter(move |own| own["scenario"] == load);
        wheels
            .max_by(|a, b| peak(a).total_cmp(&peak(b)))
            .expect("wheels")
    };
    let best = (0..3).min_by(|a, b| peak(highest(*a)).total_cmp(&peak(highest(*b))));
    let best = best.expect("loads");
    let wheel = highest(best);
    let load = [50, 100, 200][usize::try_from(best).expect("a load")];
    let error = &group["errors"][usize::try_from(best).expect("a load")];
    let error = error["rows"]["stated"]["largest"]
        .as_f64()
        .expect("an error");
    let page = std::fs::read_to_string(place.path("page.html")).expect("a page");
    let page = page.replace('\u{a0}', " ");
    let number = |label: &str, unit: &str| -> f64 {
        let (_, rest) = page
            .split_once(label)
            .unwrap_or_else(|| panic!("no {label}"));
        let (_, rest) = rest.split_once("<p class=\"value\">").expect("a value");
        let value = rest.split_once(unit).expect("a unit").0;
        let value = value.trim().trim_start_matches("at most ");
        value.trim().parse().expect("a number")
    };
    let label = "Normal load per sector with the smallest worst peak";
    let shown = number(&format!("Worst peak of the 3 wheels at {load} N"), "µm<");
    assert!((1e-6 * shown / peak(wheel) - 1.0).abs() < 1e-3, "{shown}");
    let shown = number(&format!("Numerical error of the peaks at {load} N"), "%<");
    // The error is relative to the truth, and what is shown to the peak.
    let of_peak = error / (1.0 - error);
    assert!(
        (0.01 * shown / of_peak - 1.0).abs() < 0.06,
        "{shown} {error}"
    );
    let of = format!(
        "Worst peak of the 3 wheels at {load} N, wheel {}<",
        wheel["pattern"]
    );
    assert!(page.contains(&of), "{of}");
    assert!(page.contains("for these 3 wheels alone, no confidence for others"));
    // Loads that the errors of the peaks leave open stand beside it.
    let of_load = |own: u64| {
        let error = &group["errors"][usize::try_from(own).expect("a load")];
        error["rows"]["stated"]["largest"]
            .as_f64()
            .expect("an error")
    };
    // The error is relative to the truth.
    let top = peak(wheel) / (1.0 - of_load(best));
    let others = (0..3).filter(|own| *own != best);
    let open = others.filter(|own| peak(highest(*own)) / (1.0 + of_load(*own)) < top);
    let left: Vec<f64> = std::iter::once(best)
        .chain(open)
        .map(|own| [50.0, 100.0, 200.0][usize::try_from(own).expect("a load")])
        .collect();
    let (_, value) = page.split_once(label).expect("the load");
    let value = value.split_once("<p class=\"value\">").expect("a value").1;
    let value = value.split_once("</p>").expect("an end").0;
    assert_eq!(value, left_in_words(&left, &[50.0, 100.0, 200.0]));
    let health = page.contains("Not decided: ");
    assert_eq!(health, left.len() > 1);
    assert!(page.contains("smallest worst peak: "), "the pointer");
    // The main figure has a mark for each wheel under each load.
    let (_, figure) = page
        .split_once("<figure id=\"amplitude-0\">")
        .expect("the figure");
    let figure = figure.split_once("</figure>").expect("an end").0;
    assert_eq!(figure.matches("<title>wheel ").count(), 9, "{figure}");
    marks_stand_apart(figure, 9);
}

/// The marks of a load stand side by side, so far apart that the bar of one reaches no other: how many bars there are.
fn marks_stand_apart(figure: &str, wheels: usize) -> usize {
    let number = |element: &str, name: &str| -> f64 {
        let (_, rest) = element
            .rsplit_once(&format!(" {name}=\""))
            .expect("the place");
        rest.split('"')
            .next()
            .and_then(|own| own.parse().ok())
            .expect("a number")
    };
    let marks: Vec<&str> = figure.split("<title>wheel ").collect();
    let marks = &marks[..marks.len() - 1];
    let places: Vec<f64> = marks.iter().map(|before| number(before, "cx")).collect();
    assert_eq!(places.len(), wheels, "{figure}");
    // Half the width of a bar, and of a mark.
    let reach = 5.5 + 4.0;
    for (place, at) in places.iter().enumerate() {
        let mut others = places.iter().enumerate().filter(|own| own.0 != place);
        assert!(others.all(|own| (own.1 - at).abs() > reach), "{places:?}");
    }
    let bars = figure
        .split('<')
        .filter(|own| own.contains("class=\"bound doubt\""));
    let bars: Vec<f64> = bars
        .map(|bar| f64::midpoint(number(bar, "x1"), number(bar, "x2")))
        .collect();
    for bar in &bars {
        let near = places.iter().filter(|at| (*at - bar).abs() < reach);
        assert_eq!(near.count(), 1, "{bar}: {places:?}");
    }
    bars.len()
}

/// Loads that the errors of the peaks leave open have bars, each on the mark of the worst wheel alone.
#[test]
fn bars_of_numerical_error_stand_on_one_wheel_each() {
    let place = of_file(3);
    let study = std::fs::read_to_string(place.path("study.toml")).expect("a study");
    let loads = "[\"slide\", 50, \"stuck\"]";
    place.write("study.toml", &study.replace(loads, "[50, 52, 54]"));
    output(&place, &["run", "study.toml"]);
    output(&place, &["plot", "results/small", "amplitude"]);
    let figure = std::fs::read_to_string(place.path("amplitude.svg")).expect("a figure");
    // Each of a line and two caps.
    let lines = marks_stand_apart(&figure, 9);
    assert!(lines >= 6 && lines.is_multiple_of(3), "{lines}: {figure}");
}

#[test]
fn many_measured_wheels_are_left_to_the_table() {
    let place = of_file(13);
    let run = output(&place, &["run", "study.toml"]);
    assert!(
        run.contains("mistuning.file holds 13; read the peak of each wheel in responses.parquet")
    );
    let report = output(&place, &["report", "results/small", "--no-curves"]);
    assert!(!report.contains("numerical error?"), "{report}");
    assert!(!report.contains("Peaks at "), "{report}");
    assert!(report.contains("mistuning.file holds 13"), "{report}");
}

#[test]
fn drawn_wheels_are_told_to_be_more() {
    let place = Place::with(GOOD);
    let run = output(&place, &["run", "study.toml"]);
    assert!(run.contains("at least 72 patterns; raise study.patterns"));
    let report = output(&place, &["report", "results/small", "--no-curves"]);
    assert!(report.contains("raise study.patterns") && !report.contains("Peaks at "));
}

#[test]
fn a_target_for_a_percentile_of_few_measured_wheels_asks_for_wheels() {
    let place = of_file(3);
    let study = std::fs::read_to_string(place.path("study.toml")).expect("a study");
    place.write(
        "study.toml",
        &format!("{study}\n[stop]\npercentile = 95\nrelative_width = 0.1\n"),
    );
    let check = place.run(&["check", "study.toml"]);
    assert_eq!(check.code, 3);
    assert!(
        check.stderr.contains(
            "P95 of 3 patterns has no interval; accepted: a mistuning.file of 72 wheels or more"
        ),
        "{}",
        check.stderr
    );
}

/// Of wheels too few for a percentile the peaks are compared, against the load where the worst of them is lowest.
#[test]
fn a_comparison_of_few_measured_wheels_is_one_of_their_peaks_and_says_so() {
    for (wheels, said, of_baseline) in [
        (
            1,
            "P95 has no value, it needs 72 patterns: the one pattern is compared",
            "the load with the lowest peak amplitude, since patterns are too few for P95",
        ),
        (
            3,
            "P95 has no value, it needs 72 patterns: the largest of the patterns is compared, which is no statistic",
            "the load with the lowest of the largest peak amplitude, since patterns are too few for P95",
        ),
    ] {
        let place = of_file(wheels);
        output(&place, &["run", "study.toml"]);
        let request = ["compare", "results/small"];
        let text = output(&place, &request);
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in [said, of_baseline, "against 50 N per sector: "] {
            assert!(words.contains(part), "{part}: {text}");
        }
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
        // As the report has the peaks, which `verify` finds as well.
        let report = ["report", "results/small", "--no-curves", "--json"];
        let report: Value = serde_json::from_str(&output(&place, &report)).expect("JSON");
        let measured = report["groups"][0]["measured"].as_array().expect("a list");
        let worst = |scenario: u64| {
            let own = measured.iter().filter(|own| own["scenario"] == scenario);
            let peaks = own.map(|own| own["peak_amplitude_m"].as_f64().expect("a peak"));
            peaks.fold(0.0, f64::max)
        };
        let found = output(&place, &[&request[..], &["--json"]].concat());
        let found: Value = serde_json::from_str(&found).expect("JSON");
        assert_eq!(found["baseline_choice"], "lowest_of_largest");
        let comparisons = found["quantities"][0]["comparisons"].as_array();
        let comparisons = comparisons.expect("a list");
        assert_eq!(comparisons.len(), 2);
        for own in comparisons {
            let scenarios = [&own["baseline"]["scenario"], &own["candidate"]["scenario"]];
            let scenarios = scenarios.map(|own| own.as_u64().expect("an index"));
            assert_eq!(scenarios[0], 1, "50 N is the best load of these wheels");
            let own = own["largest"].as_array().expect("two");
            for (scenario, own) in scenarios.into_iter().zip(own) {
                let own = own.as_f64().expect("a number");
                assert!((own / worst(scenario) - 1.0).abs() < 1e-12, "{scenario}");
            }
            let line = text.lines().find(|line| {
                let name =
                    ["slide", "50", "stuck"][usize::try_from(scenarios[1]).expect("an index")];
                line.trim_start().starts_with(name)
            });
            let cells: Vec<&str> = line.expect("its line").split_whitespace().collect();
            for (cell, expected) in [
                (1, 1e6 * worst(scenarios[1])),
                (2, worst(scenarios[1]) / worst(scenarios[0])),
            ] {
                let shown: f64 = cells[cell].parse().expect("a number");
                assert!((shown / expected - 1.0).abs() < 1e-3, "{shown} {expected}");
            }
        }
    }
    // Between folders both sides stand.
    let place = of_file(3);
    output(&place, &["run", "study.toml"]);
    let text = output(&place, &["compare", "results/small", "results/small"]);
    assert!(
        text.contains("largest A") && text.contains("it needs 72"),
        "{text}"
    );
}

/// A search over loads takes a percentile: of few wheels it says what answers in its place.
#[test]
fn a_search_of_few_measured_wheels_names_the_way_out() {
    for (wheels, why, which) in [
        (
            1,
            "one wheel has no percentile to search; ",
            "the load with the lowest peak of this wheel",
        ),
        (
            3,
            "P95 of 3 wheels has no interval; ",
            "the load under which the worst of these wheels is lowest",
        ),
    ] {
        let place = of_file(wheels);
        let ended = place.run(&["optimum", "study.toml", "--between", "40:400"]);
        assert_eq!((ended.code, ended.stdout.as_str()), (2, ""), "{wheels}");
        let error = ended.stderr.split_whitespace().collect::<Vec<_>>();
        let error = error.join(" ");
        for words in [
            why,
            "accepted: a mistuning.file of 72 wheels or more; ",
            which,
            "list loads in sweep.normal_load_n, `blisk run study.toml` and read it in `blisk report DIR`",
            "take mistuning.distribution in the place of mistuning.file, with study.patterns from 72 on",
        ] {
            assert!(error.contains(words), "{words}: {error}");
        }
        assert!(!place.path("results").exists());
    }
}

#[test]
fn the_key_of_measured_wheels_is_found_by_that_word() {
    let place = Place::with(GOOD);
    assert!(output(&place, &["explain", "measured"]).contains("mistuning.file"));
}
