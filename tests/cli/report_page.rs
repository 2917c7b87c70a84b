//! The page of a report: what its first screen says, the model, links, cells, and the table for spreadsheets.

use serde_json::Value;

use crate::blisk::{GOOD, Place};
use crate::forgery::forge;

/// Friction between both linear limits, enough patterns for a P95 and not for a P99.
fn study() -> String {
    GOOD.replace("patterns = 10", "patterns = 80").replace(
        "[\"slide\", 50, \"stuck\"]",
        "[\"slide\", 50, 100, 200, \"stuck\"]",
    )
}

/// With so many harmonics that numerical error hides no load.
fn accurate() -> String {
    study().replace("harmonics = [1, 3]", "harmonics = [1, 3, 5, 7]")
}

/// Blades that lose their stiffness in some patterns, and two groups.
fn with_failures() -> String {
    study()
        .replace(
            "standard_deviation = [0.03]",
            "standard_deviation = [0.05, 0.5]",
        )
        .replace("[\"slide\", 50, 100, 200, \"stuck\"]", "[\"slide\", 50]")
}

/// The page and the numbers of a study that ends with `code`.
fn reported(study: &str, code: i32) -> (Place, String, Value) {
    let place = Place::with(study);
    let run = place.run(&["run", "study.toml"]);
    assert_eq!(run.code, code, "{}", run.stderr);
    let ended = place.run(&[
        "report",
        "results/small",
        "--no-curves",
        "--json",
        "--out",
        "report.html",
    ]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let page = std::fs::read_to_string(place.path("report.html")).expect("a page");
    let numbers = serde_json::from_str(&ended.stdout).expect("JSON");
    (place, page, numbers)
}

/// The text of the element that begins with `head`, up to `end`, its spaces those of a keyboard.
fn between<'a>(page: &'a str, head: &str, end: &str) -> &'a str {
    let (_, rest) = page
        .split_once(head)
        .unwrap_or_else(|| panic!("no {head} in the page"));
    rest.split_once(end).expect("an end").0
}

/// Label, value and notes of the large numbers of the first group.
fn big_numbers(page: &str) -> Vec<[String; 3]> {
    let section = between(page, "id=\"answer-0\"", "</section>");
    section
        .split("<div class=\"number")
        .filter(|number| number.starts_with("\">") || number.starts_with(" look\">"))
        .map(|number| {
            let number = number.replace('\u{a0}', " ");
            let part = |class: &str| {
                between(&number, &format!("<p class=\"{class}\">"), "</p>").to_owned()
            };
            let notes: Vec<&str> = number
                .split("<p class=\"note\">")
                .skip(1)
                .map(|note| note.split_once("</p>").expect("an end").0)
                .collect();
            [part("label"), part("value"), notes.join("; ")]
        })
        .collect()
}

/// Whether the cards of the three numbers of a section ask to be looked at.
fn looks(section: &str) -> [bool; 3] {
    let cards = section.split("<div class=\"number").skip(1);
    let cards = cards.filter(|card| !card.starts_with('s'));
    let found: Vec<bool> = cards.map(|card| card.starts_with(" look\">")).collect();
    found.try_into().expect("three cards")
}

/// Ends of a range, `A to B unit`, in a note.
fn numbers_in(text: &str) -> Vec<f64> {
    text.split(|c: char| !(c.is_ascii_digit() || c == '.'))
        .filter_map(|word| word.parse().ok())
        .collect()
}

#[test]
fn the_first_screen_has_load_percentile_and_numerical_error_of_the_tables() {
    let (_place, page, report) = reported(&study(), 0);
    let [load, percentile, _] = &big_numbers(&page)[..] else {
        panic!("three numbers: {page}");
    };
    let group = &report["groups"][0];
    let lowest = group["choices"][1]["lowest"].as_u64().expect("a scenario") as usize;
    let scenario = &report["summary"]["scenarios"][lowest];
    assert_eq!(load[0], "Normal load per sector with the lowest P95");
    assert_eq!(
        load[1],
        format!("{} N", scenario["normal_load_n"].as_f64().expect("a load"))
    );
    // Which other loads could be as good is that of the comparison.
    let could = group["choices"][1]["best"]["loads"]
        .as_array()
        .expect("a list");
    let others = could
        .iter()
        .filter(|own| own["could_be_best"] == true)
        .count()
        - 1;
    assert_eq!(
        load[2].contains("may be as good"),
        others > 0,
        "{}",
        load[2]
    );
    // The choice is as coarse as the loads that were calculated: the next ones in newtons are named.
    let loads = report["summary"]["scenarios"].as_array().expect("a list");
    let newtons = || loads.iter().filter_map(|own| own["normal_load_n"].as_f64());
    let own = scenario["normal_load_n"].as_f64().expect("a load");
    let lower = newtons().filter(|load| *load < own).reduce(f64::max);
    let higher = newtons().filter(|load| *load > own).reduce(f64::min);
    let next = match (lower, higher) {
        (Some(lower), Some(higher)) => {
            format!("neighbours studied: {lower} N and {higher} N")
        }
        (Some(lower), None) => format!("neighbour studied: {lower} N, none higher"),
        (None, higher) => format!(
            "neighbour studied: {} N, none lower",
            higher.expect("another load")
        ),
    };
    assert!(load[2].contains(&next), "{next}: {}", load[2]);
    let is_enclosed = lower.is_some() && higher.is_some();
    assert_eq!(group["choices"][1]["enclosed"], is_enclosed);
    let first = between(&page, "id=\"answer-0\"", "</section>");
    let [of_load, ..] = looks(first);
    assert!(is_enclosed && !of_load, "{first}");
    for sign in ["add higher loads", "add lower loads"] {
        assert!(!first.contains(sign), "{sign}");
    }
    // Of two loads that were calculated one is lower, with 95 % confidence unless others could be as low.
    let sure = "95 % sure that no other load studied has a lower P95";
    assert_eq!(load[2].contains(sure), others == 0, "{}", load[2]);
    // The other percentiles are a link away, which has the name of the section for a reader on paper.
    let link = "P99 needs 368 patterns; <a href=\"#numbers-0\">all percentiles</a>";
    assert!(percentile[2].contains(link), "{}", percentile[2]);
    // 80 patterns give no P99: the page says so, and how many do.
    assert_eq!(
        percentile[0],
        format!("P95 of the peak amplitude at {own} N")
    );
    assert!(
        percentile[2].contains("P99 needs 368 patterns"),
        "{}",
        percentile[2]
    );
    let of_p95 = &group["errors"][lowest]["percentiles"][1];
    let um = |value: &Value| 1e6 * value.as_f64().expect("an amplitude");
    let shown = numbers_in(&percentile[1])[0];
    let value = um(&of_p95["percentile"]["value"]);
    assert!((shown / value - 1.0).abs() < 1e-3, "{shown} {value}");
    let bounds = &numbers_in(percentile[2].split_once("interval").expect("an interval").1)[..2];
    for (shown, end) in bounds.iter().zip(["lower", "upper"]) {
        let bound = um(&of_p95["percentile"][end]);
        assert!((shown / bound - 1.0).abs() < 1e-3, "{shown} {bound}");
    }
    // The main figure stands beside them, and what the answers rest on is folded.
    let section = between(&page, "id=\"answer-0\"", "</section>");
    assert!(section.contains("<figure id=\"amplitude-0\">"));
    assert!(section.contains("<details class=\"answer\"><summary>"));
    assert!(!section.contains("<details open"));
    assert_eq!(page.matches("<figure id=\"amplitude-0\">").count(), 1);
}

#[test]
fn the_first_screen_says_which_of_the_two_errors_matters_more() {
    let (_place, page, report) = reported(&study(), 0);
    let [_, percentile, error] = &big_numbers(&page)[..] else {
        panic!("three numbers: {page}");
    };
    let group = &report["groups"][0];
    let lowest = group["choices"][1]["lowest"].as_u64().expect("a scenario") as usize;
    let scenario = &report["summary"]["scenarios"][lowest];
    let of_p95 = &group["errors"][lowest]["percentiles"][1];
    let um = |value: &Value| 1e6 * value.as_f64().expect("an amplitude");
    let value = um(&of_p95["percentile"]["value"]);
    let bounds = ["lower", "upper"].map(|end| um(&of_p95["percentile"][end]));
    // The larger side of what the rows state.
    let (low, high) = (um(&of_p95["lowest"]), um(&of_p95["highest"]));
    let largest = 100.0 * (1.0 - low / value).max(high / value - 1.0);
    let shown = numbers_in(&error[1])[0];
    assert!((shown / largest - 1.0).abs() < 0.06, "{shown} {largest}");
    // The interval beside it in percent, and one verdict on both.
    let interval = bounds[1] - bounds[0];
    let shares = numbers_in(error[2].split_once(" than statistics (").expect("shares").1);
    let sides = [value - bounds[0], bounds[1] - value].map(|side| 100.0 * side / value);
    for (shown, side) in shares.iter().zip(sides) {
        assert!(
            (shown / side - 1.0).abs() < 0.06,
            "{shown} {side}: {}",
            error[2]
        );
    }
    let verdicts = if (high - low) > interval {
        ["larger than statistics", "to be surer: more accuracy first"]
    } else {
        [
            "smaller than statistics",
            "to be surer: more patterns first",
        ]
    };
    for verdict in verdicts {
        assert!(error[2].contains(verdict), "{}", error[2]);
    }
    // Both together, and the percentile beside the tuned wheel.
    let with = percentile[2].split_once("with numerical error ");
    let with = &numbers_in(with.expect("both").1)[..2];
    for (shown, both) in with
        .iter()
        .zip([bounds[0] * low / value, bounds[1] * high / value])
    {
        assert!((shown / both - 1.0).abs() < 1e-3, "{shown} {both}");
    }
    let tuned = um(&scenario["tuned_amplitude_m"]);
    let ratio = percentile[2]
        .split_once(" times the tuned wheel")
        .expect("a ratio");
    let ratio = numbers_in(ratio.0).pop().expect("a ratio");
    assert!(
        (ratio * tuned / value - 1.0).abs() < 1e-3,
        "{ratio} {tuned}"
    );
    assert_eq!(error[0], "Numerical error of that P95");
}

#[test]
fn a_load_by_the_median_alone_is_none_to_design_for() {
    let few = accurate().replace("patterns = 80", "patterns = 20");
    let (_place, page, report) = reported(&few, 0);
    let [load, percentile, _] = &big_numbers(&page)[..] else {
        panic!("three numbers: {page}");
    };
    assert!(percentile[0].starts_with("P50 of the peak amplitude at "));
    // What is large is no load: the number of newtons stands below it, and nothing points at it in the figure.
    assert_eq!(load[..2], ["Normal load per sector", "No design load yet"]);
    let told = between(&page, "<p class=\"told\">", "</p>").replace('\u{a0}', " ");
    let lowest = report["groups"][0]["choices"][2]["lowest"].as_u64();
    let scenarios = &report["summary"]["scenarios"];
    let newtons = &scenarios[lowest.expect("a scenario") as usize]["normal_load_n"];
    let newtons = newtons.as_f64().expect("a load");
    assert_eq!(told, format!("lowest P50: at {newtons} N"));
    assert_eq!(page.matches("<div class=\"number look\">").count(), 1);
    assert!(load[2].contains("no P95 is known"), "{}", load[2]);
    assert!(!load[2].contains("confident"), "{}", load[2]);
    let figure = between(&page, "<figure id=\"amplitude-0\">", "</figure>");
    for pointer in [
        "class=\"aim\"",
        "mark lowest",
        "mark could",
        "Pointer above",
    ] {
        assert!(!figure.contains(pointer), "{pointer}");
    }
    // The question that fewer patterns answer comes first.
    let [p95, p99] = ["(P95)", "(P99)"].map(|own| page.find(own).expect("a question"));
    assert!(p95 < p99);
    let health = between(&page, "<div class=\"health look\">", "</div>");
    assert!(page.contains("Not known yet: needs 72 patterns"));
    let words = "Too few patterns for a design load.";
    assert!(health.contains(words), "{health}");
    // A P95 has no such word.
    let (_place, page, _) = reported(&study(), 0);
    assert!(!page.contains("No design load") && !page.contains(words));
}

#[test]
fn a_load_at_the_end_of_those_studied_is_the_first_warning() {
    for (loads, own, beyond, advice) in [
        (
            "[20, 30]",
            "30 N",
            "above 30 N",
            "30 N is the highest load studied: add higher loads",
        ),
        (
            "[300, 600]",
            "300 N",
            "below 300 N",
            "300 N is the lowest load studied: add lower loads",
        ),
        (
            "[\"slide\", 100]",
            "100 N",
            "another one",
            "100 N is the only load studied: add lower and higher loads",
        ),
        (
            "[\"slide\", 5000, \"stuck\"]",
            "slide",
            "below 5000 N",
            "slide has the lowest P95: add lower loads",
        ),
    ] {
        let ends = study().replace("[\"slide\", 50, 100, 200, \"stuck\"]", loads);
        let (_place, page, report) = reported(&ends, 0);
        let page = page.replace('\u{a0}', " ");
        assert_eq!(report["groups"][0]["choices"][1]["enclosed"], false);
        let [load, ..] = &big_numbers(&page)[..] else {
            panic!("three numbers: {page}");
        };
        let side = match beyond.split_once(' ') {
            Some(("above", _)) if own.ends_with(" N") => " or higher",
            Some(("below", _)) if own.ends_with(" N") => " or lower",
            _ => "",
        };
        assert_eq!(load[1], format!("{own}{side}"));
        let [of_load, of_percentile, _] = looks(between(&page, "id=\"answer-0\"", "</section>"));
        assert!(of_load && !of_percentile);
        // The card of the load says so before how sure the load is the lowest.
        let (studied, _) = advice.split_once(": ").expect("what to do");
        let none_there = format!("no load {beyond} was studied");
        let open = load[2].find(if side.is_empty() {
            studied
        } else {
            &none_there
        });
        let sure = load[2].find("95 % ");
        assert!(
            open.is_some_and(|open| sure.is_none_or(|sure| open < sure)),
            "{}",
            load[2]
        );
        let health = between(&page, "<div class=\"health look\">", "</div>");
        assert!(
            health.contains(&format!("The best load may be {beyond}.")),
            "{health}"
        );
        let first = health.split("<li>").nth(1).expect("a finding");
        assert_eq!(first.split_once("</li>").expect("an end").0, advice);
        // What to do about it stands first among the warnings too, which are no others in the tables.
        let all = between(&page, "<ul class=\"warnings\">", "</ul>");
        let first = between(all, "<li>", "</li>");
        assert!(
            first.contains("to sweep.normal_load_n and run again"),
            "{first}"
        );
        let warnings = report["summary"]["warnings"].as_array().expect("a list");
        assert_eq!(all.matches("<li>").count(), warnings.len() + 1);
    }
}

/// What numerical error could hide by the numbers of the report: loads that are higher on the same patterns, and lower
/// where every row is wrong by all that it states.
fn hidden_loads(report: &Value) -> Vec<String> {
    let group = &report["groups"][0];
    let choice = &group["choices"][1];
    let lowest = choice["lowest"].as_u64().expect("a scenario") as usize;
    let of = |scenario: usize, side: &str| {
        let error = &group["errors"][scenario]["percentiles"][1];
        error[side].as_f64().expect("a bound")
    };
    let loads = choice["best"]["loads"].as_array().expect("a list");
    let higher = { loads.iter() }.filter(|own| own["could_be_best"] == false);
    let scenarios = higher.map(|own| own["scenario"].as_u64().expect("a scenario"));
    scenarios
        .map(|own| own as usize)
        .filter(|own| of(*own, "lowest") < of(lowest, "highest"))
        .map(|own| {
            let newtons = report["summary"]["scenarios"][own]["normal_load_n"].as_f64();
            format!("{} N", newtons.expect("a load"))
        })
        .collect()
}

/// What the first screen says of the loads that are `left` of those `studied`, both in newtons.
pub fn left_in_words(left: &[f64], studied: &[f64]) -> String {
    let places: Vec<usize> = (0..studied.len())
        .filter(|&place| left.contains(&studied[place]))
        .collect();
    let (first, last) = (places[0], places[places.len() - 1]);
    let end = studied.len() - 1;
    let in_words = |place: usize| match studied[place] {
        load if place == 0 => format!("{load} N or lower"),
        load if place == end => format!("{load} N or higher"),
        load => format!("{load} N"),
    };
    if first == last {
        return in_words(first);
    }
    let all: Vec<String> = places.iter().map(|&own| studied[own].to_string()).collect();
    let (last, others) = all.split_last().expect("loads");
    format!("not decided: {} or {last} N", others.join(", "))
}

#[test]
fn the_first_screen_says_where_numerical_error_could_hide_a_better_load() {
    // Two harmonics are far from what friction takes: rows state errors by which close loads cannot be told apart. The
    // other study has many harmonics, and loads far from each other.
    let coarse = study().replace("[\"slide\", 50, 100, 200, \"stuck\"]", "[70, 100, 200]");
    let enclosed = coarse.replace("[70, 100, 200]", "[20, 70, 100, 400]");
    let cases: [(String, bool, &[f64]); 3] = [
        (coarse, true, &[70.0, 100.0, 200.0]),
        (enclosed, true, &[20.0, 70.0, 100.0, 400.0]),
        (accurate(), false, &[50.0, 100.0, 200.0]),
    ];
    for (study, hides, studied) in cases {
        let (_place, page, report) = reported(&study, 0);
        let page = page.replace('\u{a0}', " ");
        let [load, _, error] = &big_numbers(&page)[..] else {
            panic!("three numbers: {page}");
        };
        let hidden = hidden_loads(&report);
        assert_eq!(!hidden.is_empty(), hides, "{hidden:?}");
        let loads = hidden.join(", ");
        let section = between(&page, "id=\"answer-0\"", "</section>");
        let health = between(section, "<div class=\"health", "</div>");
        let on_card = format!("numerical error: {loads} may be as good");
        let in_box = format!("numerical error: {loads} may be as good; solve more accurately");
        for (text, said) in [(load[2].as_str(), on_card), (health, in_box)] {
            assert_eq!(text.contains(&said), hides, "{said}: {text}");
        }
        // The large number has the loads that are left, and the box says the same.
        let scenario = report["groups"][0]["choices"][1]["lowest"].as_u64();
        let scenario = scenario.expect("a scenario") as usize;
        let own = { &report["summary"]["scenarios"][scenario]["normal_load_n"] }.as_f64();
        let own = own.expect("a load");
        let number = |load: &String| load.trim_end_matches(" N").parse().expect("a load");
        let left: Vec<f64> = std::iter::once(own)
            .chain(hidden.iter().map(number))
            .collect();
        assert_eq!(load[1], left_in_words(&left, studied));
        assert_eq!(health.contains("Not decided: "), hides, "{health}");
        // The figure has bars with numerical error at these loads, and no others.
        let (_, figure) = section.split_once("<figure").expect("the figure");
        let figure = figure.split_once("</figure>").expect("an end").0;
        let bars = figure.matches("class=\"bound doubt\"").count();
        let drawn = if hides { 3 * (1 + hidden.len()) } else { 0 };
        assert_eq!(bars, drawn, "{figure}");
        assert_eq!(figure.contains("numerical error is not drawn"), !hides);
        // So they do in the answer in words.
        let answer = between(section, "<span class=\"verdict\">", "</span>");
        let open = answer.starts_with("Numerical error leaves it open: P95 = ");
        assert_eq!(open, hides, "{answer}");
        for load in &hidden {
            assert!(answer.contains(&format!(" µm at {load}")), "{answer}");
        }
        // The error is yellow where its bounds are the wider ones.
        let lowest = report["groups"][0]["choices"][1]["lowest"]
            .as_u64()
            .expect("a scenario");
        let of = &report["groups"][0]["errors"][lowest as usize]["percentiles"][1];
        let width = |own: &Value, [low, high]: [&str; 2]| {
            own[high].as_f64().expect("a bound") - own[low].as_f64().expect("a bound")
        };
        let widths = [
            width(of, ["lowest", "highest"]),
            width(&of["percentile"], ["lower", "upper"]),
        ];
        let [.., of_error] = looks(section);
        assert_eq!(of_error, widths[0] > widths[1], "{}", error[2]);
    }
}

#[test]
fn the_first_screen_says_that_other_settings_have_loads_of_their_own() {
    let both = study().replace(
        "standard_deviation = [0.03]",
        "standard_deviation = [0.03, 0.04]",
    );
    let (_place, page, report) = reported(&both, 0);
    assert_eq!(report["groups"].as_array().expect("a list").len(), 2);
    let [load, ..] = &big_numbers(&page)[..3] else {
        panic!("three numbers: {page}");
    };
    assert!(
        load[2].contains("<a href=\"#answer-1\">for the other setting see below</a>"),
        "{}",
        load[2]
    );
}

#[test]
fn a_load_of_a_speed_has_four_digits_and_its_speed() {
    let of_speed = study()
        .replace(
            "tangential_stiffness_n_per_m = 8.0e5",
            "tangential_stiffness_n_per_m = 8.0e5\n\
             normal_load = { from = \"rotation\", speed_rpm = [800, 1000], ring_radius_m = 0.2 }",
        )
        .replace("normal_load_n = [\"slide\", 50, 100, 200, \"stuck\"]\n", "");
    let (_place, page, report) = reported(&of_speed, 0);
    let [load, ..] = &big_numbers(&page)[..] else {
        panic!("three numbers: {page}");
    };
    let lowest = report["groups"][0]["choices"][1]["lowest"]
        .as_u64()
        .expect("a scenario");
    let scenario = &report["summary"]["scenarios"][lowest as usize];
    let newtons = scenario["normal_load_n"].as_f64().expect("a load");
    let shown = numbers_in(&load[1])[0];
    // It is the last of the speeds: a higher load may be better.
    let own = load[1].strip_suffix(" or higher").expect("an open end");
    assert!(
        (shown / newtons - 1.0).abs() < 1e-3 && own.len() <= 8,
        "{load:?}"
    );
    let speed = scenario["speed_rpm"].as_f64().expect("a speed");
    assert!(
        load[2].contains(&format!("load at {speed} rpm")),
        "{load:?}"
    );
    // Loads follow from speeds, and have one rounding on the first screen.
    let section = between(&page, "id=\"answer-0\"", "</section>").replace('\u{a0}', " ");
    let end = format!("{own} is the highest load studied: add higher speeds");
    assert!(section.contains(&end), "{section}");
    assert!(
        section.contains(&format!("{own} per sector ({speed} rpm): P95 = ")),
        "{section}"
    );
    assert!(page.contains("to contact.normal_load.speed_rpm and run again"));
    let (before_figure, after) = section.split_once("<figure").expect("a figure");
    let answers = after.split_once("</figure>").expect("an end").1;
    for text in [before_figure, answers] {
        assert!(!text.contains(&format!("{newtons} N")), "{newtons}");
    }
}

#[test]
fn the_first_screen_says_whether_anything_is_wrong() {
    // No warning: enough patterns for all percentiles of the summary are not cheap, so that few rows and a wide
    // tolerance say it of a study without friction.
    let quiet = study().replace("patterns = 80", "patterns = 400").replace(
        "[\"slide\", 50, 100, 200, \"stuck\"]",
        "[\"slide\", \"stuck\"]",
    );
    let (_place, page, report) = reported(&quiet, 0);
    assert_eq!(report["summary"]["warnings"], serde_json::json!([]));
    assert!(page.contains("<div class=\"health good\">"));
    assert!(page.contains("No problem found: all 400 wheels have a result under every load"));
    assert!(!page.contains("#warnings"));

    let (_place, page, report) = reported(&study(), 0);
    let warnings = report["summary"]["warnings"]
        .as_array()
        .expect("a list")
        .len();
    assert!(warnings > 0);
    let health = between(&page, "<div class=\"health look\">", "</div>");
    assert_eq!(health.matches("<li>").count(), warnings.min(4), "{health}");
    assert!(
        health.contains("P99 has no value: it needs 368 patterns"),
        "{health}"
    );
    // The title says what follows; how many rows have a result stands in the header.
    let title = "<strong>Some rows are less accurate than asked for.</strong>";
    assert!(health.contains(title), "{health}");
    assert!(between(&page, "<header>", "</header>").contains("all 400 rows have a result"));

    let (_place, page, report) = reported(&with_failures(), 5);
    let health = between(&page, "<div class=\"health bad\">", "</div>");
    let rows = &report["summary"]["rows"];
    let failed = format!(
        "{} of {} rows have no result",
        rows["failed"], rows["planned"]
    );
    // The failures are of the second deviation: nothing else stands in this card.
    let verdict = between(health, "<strong>", "</strong>").replace('\u{a0}', " ");
    assert_eq!(
        verdict,
        format!(
            "Standard deviation 50 %: no percentile at any load. The {} above is not affected.",
            big_numbers(&page)[0][1]
        )
    );
    assert!(!health.contains("P99"), "{health}");
    assert_eq!(page.matches("<div class=\"health").count(), 2);
    let own = between(&page, "<div class=\"health look\">", "</div>");
    assert!(own.contains("P99"), "{own}");
    // What costs a percentile comes first.
    let first = health.split("<li>").nth(1).expect("a finding");
    assert!(first.contains("too many rows failed"), "{health}");
    // A reader knows no scenario by its number.
    assert!(
        first.contains("at all loads (standard deviation 50"),
        "{health}"
    );
    assert!(!page.contains("scenarios 2, 3"), "a scenario by its number");
    let all = between(&page, "<section id=\"warnings\">", "</section>");
    assert!(all.contains(&failed), "{all}");
}

#[test]
fn every_link_of_the_page_leads_to_a_part_of_it() {
    for (study, code) in [(study(), 0), (with_failures(), 5)] {
        let (_place, page, report) = reported(&study, code);
        let mut ids: Vec<&str> = page
            .split(" id=\"")
            .skip(1)
            .map(|rest| rest.split_once('"').expect("an end").0)
            .collect();
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "an id stands twice");
        let links: Vec<&str> = page
            .split(" href=\"")
            .skip(1)
            .map(|rest| rest.split_once('"').expect("an end").0)
            .filter(|link| *link != "data:,")
            .collect();
        assert!(links.len() >= 5, "{links:?}");
        for link in &links {
            let target = link.strip_prefix('#').expect("a link inside of the page");
            assert!(ids.contains(&target), "{link}");
        }
        // What is not good has its section.
        let is_good = page.contains("<div class=\"health good\">");
        assert_eq!(is_good, !ids.contains(&"warnings"));
        // Of several groups each has a link with its answer.
        let groups = report["groups"].as_array().expect("a list").len();
        let contents = between(&page, "<nav ", "</nav>");
        let answers = contents.matches("#answer-").count();
        assert_eq!(answers, if groups > 1 { groups } else { 0 }, "{contents}");
        let unknown = contents.matches(": not known<").count();
        let none = { report["groups"].as_array().expect("a list").iter() }
            .filter(|group| {
                let choices = group["choices"].as_array().expect("a list");
                choices.iter().all(|choice| choice["lowest"].is_null())
            })
            .count();
        assert_eq!(unknown, none, "{contents}");
    }
}

#[test]
fn no_cell_of_the_page_is_empty() {
    for (study, code) in [(study(), 0), (with_failures(), 5)] {
        let (_place, page, _) = reported(&study, code);
        for (tag, end) in [("<td>", "</td>"), ("<th>", "</th>")] {
            let mut cells = page.split(tag).skip(1);
            let empty = cells.find(|rest| {
                let (cell, _) = rest.split_once(end).expect("an end");
                cell.trim().is_empty() || cell.trim() == "–"
            });
            assert!(empty.is_none(), "a cell without a word: {empty:?}");
        }
    }
    let (_place, page, _) = reported(&study(), 0);
    assert!(page.contains("<span title=\"needs 368 patterns\">–</span>"));
}

/// Values of the facts of the section of the model, by name.
fn fact<'a>(page: &'a str, name: &str) -> &'a str {
    let section = between(page, "<section id=\"model\">", "</section>");
    between(section, &format!("<tr><td>{name}</td><td>"), "</td>")
}

#[test]
fn the_model_on_the_page_is_that_of_the_study() {
    let (place, page, report) = reported(&study(), 0);
    assert_eq!(fact(&page, "sectors"), "6");
    assert_eq!(
        fact(&page, "mass of the ring"),
        "0.03000 kg per sector, 0.1800 kg on the wheel"
    );
    assert!(fact(&page, "mass of disk and blade").starts_with("1.250 kg per sector, 7.500 kg"));
    assert_eq!(fact(&page, "friction coefficient μ"), "0.3");
    assert_eq!(
        fact(&page, "tangential contact stiffness kt"),
        "8e5 N/m per sector"
    );
    assert_eq!(
        fact(&page, "normal contact stiffness kn"),
        "none: the normal load is constant"
    );
    assert_eq!(fact(&page, "damping"), "structural loss factor 0.002");
    // Frequencies are those of `blisk campbell`.
    let campbell = place.run(&["campbell", "study.toml", "--json"]);
    let campbell: Value = serde_json::from_str(&campbell.stdout).expect("JSON");
    assert_eq!(report["model"]["campbell"], campbell);
    for contact in ["stuck", "slide"] {
        let first = campbell["modes"]
            .as_array()
            .expect("a list")
            .iter()
            .find(|mode| {
                mode["contact"] == contact && mode["nodal_diameter"] == 2 && mode["mode"] == 1
            });
        let hz = first.expect("a mode")["frequency_hz"][0]
            .as_f64()
            .expect("Hz");
        let name = format!("frequencies, nodal diameter 2, {contact}");
        assert!(fact(&page, &name).starts_with(&format!("{hz:.2}")));
    }
    assert_eq!(
        report["model"]["sector"]["contacts"]
            .as_array()
            .expect("a list")
            .len(),
        1
    );
}

/// Where the lowest load and those that may be as low are shown: marks without width, since areas looked like an
/// interval of the load.
#[test]
fn the_main_figure_points_at_the_lowest_load_and_at_those_that_may_be_as_low() {
    let (_place, page, report) = reported(&study(), 0);
    let figure = between(&page, "<figure id=\"amplitude-0\">", "</figure>");
    let choice = &report["groups"][0]["choices"][1];
    let lowest = choice["lowest"].as_u64().expect("a scenario");
    let scenarios = report["summary"]["scenarios"].as_array().expect("a list");
    for (index, scenario) in scenarios.iter().enumerate() {
        let load = match scenario["normal_load_n"].as_f64() {
            Some(newtons) => newtons.to_string(),
            None => scenario["contact"].as_str().expect("a name").to_owned(),
        };
        let is_lowest = index as u64 == lowest;
        let could = choice["best"]["loads"].as_array().expect("a list").iter();
        let mut could = could.filter(|own| own["could_be_best"] == true);
        let could = could.any(|own| own["scenario"]["scenario"] == index);
        let shown = |words: &str| figure.contains(&format!("<title>{words}: {load}</title>"));
        assert_eq!(shown("lowest P95"), is_lowest, "{load}");
        assert_eq!(shown("P95 may be as low"), could && !is_lowest, "{load}");
    }
    // A line of no width goes down to the lowest, between the breaks beside both linear limits.
    let at = |class: &str, name: &str| -> Vec<f64> {
        let (class, name) = (format!("class=\"{class}\""), format!(" {name}=\""));
        let elements = figure.split(&class).skip(1);
        let values = elements.map(|rest| between(rest, &name, "\"").parse());
        values.map(|value| value.expect("a number")).collect()
    };
    let (from, to, gaps) = (at("aim", "x1"), at("aim", "x2"), at("gap", "x"));
    assert_eq!((from.len(), gaps.len()), (1, 2));
    assert!((from[0] - to[0]).abs() < 1e-9 && gaps[0] < from[0] && from[0] < gaps[1]);
}

/// Ends of the drawn lines of a class, `[x, y]` each.
fn polylines(drawing: &str, class: &str) -> Vec<Vec<[f64; 2]>> {
    drawing
        .split(&format!("<polyline class=\"{class}\" points=\""))
        .skip(1)
        .map(|rest| {
            let (points, _) = rest.split_once('"').expect("an end");
            points
                .split(' ')
                .map(|point| {
                    let (x, y) = point.split_once(',').expect("two numbers");
                    [x, y].map(|own| own.parse().expect("a number"))
                })
                .collect()
        })
        .collect()
}

#[test]
fn campbell_and_safe_diagram_and_the_sector_are_drawn() {
    let (place, page, report) = reported(&study(), 0);
    for figure in ["sector", "campbell", "safe"] {
        assert!(
            page.contains(&format!("<figure id=\"{figure}-0\">")),
            "{figure}"
        );
        let ended = place.run(&["plot", "results/small", figure]);
        assert_eq!(ended.code, 0, "{figure}: {}", ended.stderr);
    }
    let drawing = |name: &str| std::fs::read_to_string(place.path(name)).expect("a figure");
    let campbell = drawing("campbell.svg");
    assert!(campbell.contains("without centrifugal stiffening"));
    // Engine order 2 excites nodal diameter 2 alone: every line of a frequency is horizontal, that of the order rises.
    let frequencies = polylines(&campbell, "curve stuck");
    assert!(!frequencies.is_empty());
    for line in &frequencies {
        assert!((line[0][1] - line[1][1]).abs() < 1e-9 && line[1][0] > line[0][0]);
    }
    let orders = polylines(&campbell, "curve median");
    assert_eq!(orders.len(), 1);
    assert!(orders[0][1][1] < orders[0][0][1] && orders[0][1][0] > orders[0][0][0]);
    // A diamond per load lies on the line of the order.
    let scenarios = report["summary"]["scenarios"].as_array().expect("a list");
    let loads = scenarios.len();
    assert_eq!(campbell.matches(" rpm</title></polygon>").count(), loads);
    // SAFE: the line of the order folds at half the number of sectors, between nodal diameters 0 and 3.
    let safe = drawing("safe.svg");
    let impulse = &polylines(&safe, "curve median")[0];
    assert!(impulse.len() >= 2);
    for pair in impulse.windows(2) {
        assert!(pair[1][1] < pair[0][1], "frequencies rise along the line");
    }
    let modes = report["model"]["campbell"]["modes"]
        .as_array()
        .expect("a list");
    let diameters: Vec<u64> = modes
        .iter()
        .filter_map(|mode| mode["nodal_diameter"].as_u64())
        .collect();
    assert_eq!(diameters.iter().max(), Some(&3));
    for diameter in 0..=3 {
        assert!(
            safe.contains(&format!("nodal diameter {diameter}, mode 1, stuck")),
            "{diameter}"
        );
    }
    // Both say where they end and why, and how to see more.
    for figure in [&campbell, &safe] {
        assert!(figure.contains(" Hz, about 1.6 times the highest tuned peak.<"));
        assert!(figure.contains("Modes 1 to 3. For more: blisk campbell STUDY.toml with"));
        assert!(figure.contains(" FILE.svg --top-hz HZ --modes N.<"));
    }
    let sector = drawing("sector.svg");
    assert_eq!(sector.matches("class=\"touch\" cx").count(), 1);
    assert!(sector.contains("It has one contact pair."));
}

/// A line that folds at every unit of such an axis takes for ever.
#[test]
fn a_frequency_at_the_end_of_the_left_in_words_numbers_is_drawn_or_left_out_at_once() {
    let (place, ..) = reported(&study(), 0);
    for hz in [1e308, 1e-308] {
        forge(&place.path("results/small/manifest.json"), |manifest| {
            let scenarios = manifest["scenarios"].as_array_mut().expect("a list");
            for (index, scenario) in scenarios.iter_mut().enumerate() {
                // One ordinary peak keeps the axis of frequencies ordinary.
                let own = if index == 0 { 400.0 } else { hz };
                scenario["tuned_frequency_hz"] = own.into();
            }
        });
        let began = std::time::Instant::now();
        let ended = place.run(&["report", "results/small", "--no-curves"]);
        assert!(matches!(ended.code, 0 | 8), "{hz:e} Hz: {}", ended.stderr);
        assert!(began.elapsed().as_secs() < 60, "{hz:e} Hz");
    }
}

#[test]
fn a_report_without_the_inputs_has_no_model_and_says_why() {
    let place = Place::with(&study());
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    let of_file = GOOD
        .replace("patterns = 10\n", "")
        .replace(
            "distribution = { kind = \"normal\" }",
            "file = \"patterns.csv\"",
        )
        .replace("standard_deviation = [0.03]\n", "")
        .replace("name = \"small\"", "name = \"file\"");
    place.write("study.toml", &of_file);
    let table =
        "pattern,blade,deviation\n0,0,0.01\n0,1,0.0\n0,2,-0.01\n0,3,0.02\n0,4,0.0\n0,5,0.01\n";
    place.write("patterns.csv", table);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    place.write("patterns.csv", &table.replace("0.02", "0.03"));
    assert_eq!(place.run(&["report", "results/file"]).code, 0);
    let page = std::fs::read_to_string(place.path("results/file/report.html")).expect("a page");
    assert!(page.contains("The model is not shown: "));
    assert!(!page.contains("campbell-0"));
    let plot = place.run(&["plot", "results/file", "safe"]);
    assert_eq!(plot.code, 2);
    assert!(plot.stderr.contains("mistuning.file"), "{}", plot.stderr);
}

/// Rows of a table of comma-separated values, by column.
fn table(text: &str) -> Vec<std::collections::BTreeMap<&str, &str>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), names.len(), "{line}");
            names.iter().copied().zip(cells).collect()
        })
        .collect()
}

#[test]
fn statistics_are_one_table_for_a_spreadsheet() {
    let (place, _, report) = reported(&study(), 0);
    let ended = place.run(&["stats", "results/small", "--csv"]);
    assert_eq!((ended.code, ended.stderr.as_str()), (0, ""));
    assert!(ended.stdout.is_ascii() && !ended.stdout.contains('"'));
    let rows = table(&ended.stdout);
    let scenarios = report["summary"]["scenarios"].as_array().expect("a list");
    assert_eq!(rows.len(), scenarios.len());
    for (row, scenario) in rows.iter().zip(scenarios) {
        let same = |name: &str, value: &Value| {
            let cell = row[name];
            match value.as_f64() {
                Some(value) => assert!(
                    cell.parse::<f64>()
                        .is_ok_and(|own| own.total_cmp(&value).is_eq()),
                    "{name}: {cell} {value}"
                ),
                None => assert_eq!(cell, "", "{name}"),
            }
        };
        same("normal_load_n", &scenario["normal_load_n"]);
        same("tuned_frequency_hz", &scenario["tuned_frequency_hz"]);
        same("rows_ok", &scenario["rows"]["ok"]);
        for quantity in ["peak_amplitude_m", "amplification_factor"] {
            for found in scenario[quantity]["percentiles"]
                .as_array()
                .expect("a list")
            {
                if ![5.0, 50.0, 95.0, 99.0].contains(&found["percent"].as_f64().expect("a percent"))
                {
                    continue;
                }
                let name = format!("{quantity}_p{}", found["percent"]);
                let name = name.trim_end_matches(".0");
                same(name, &found["value"]);
                same(&format!("{name}_lower"), &found["lower"]);
                same(&format!("{name}_upper"), &found["upper"]);
            }
        }
        assert_eq!(
            row["contact"],
            scenario["contact"].as_str().expect("a name")
        );
    }
    // One table alone.
    for other in ["--json", "--tails"] {
        assert_eq!(
            place.run(&["stats", "results/small", "--csv", other]).code,
            2
        );
    }
    // Exit codes are those of the summary.
    let (place, ..) = reported(&with_failures(), 5);
    let ended = place.run(&["stats", "results/small", "--csv"]);
    assert_eq!(ended.code, 5);
    assert_eq!(table(&ended.stdout).len(), 4);
}

/// A built-in wheel of as few elements as can be, under a linear limit.
fn built_in(damper: &str) -> String {
    format!(
        r#"schema = 1

[study]
name = "small"
seed = 7
patterns = 1

[model]
source = "parametric"

[model.parametric]
sectors = 4
{damper}
disk_radial_elements = 1
disk_axial_elements = 1
rim_axial_elements = 1
flange_axial_elements = 1
passage_elements = 1
blade_thickness_elements = 1
blade_radial_elements = 1

[reduction]
craig_bampton_modes = 6

[contact]
law = "macro_slip_2d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e6

[damping]
structural_loss_factor = 0.002

[excitation]
engine_orders = [1]
amplitude_n = 1.0

[mistuning]
distribution = {{ kind = "normal" }}

[sweep]
normal_load_n = ["stuck"]
standard_deviation = [0.03]

[solver]
harmonics = [1]
"#
    )
}

#[test]
fn the_page_says_which_damper_there_is() {
    for (damper, words, body) in [
        ("damper = \"ring\"", "a friction ring damper", Some("ring")),
        (
            "damper = \"underplatform\"",
            "wedges as underplatform dampers",
            Some("wedge"),
        ),
        (
            "damper = \"underplatform\"\ndamper_shape = \"cylinder\"",
            "cylinders as underplatform dampers",
            Some("cylinder"),
        ),
        (
            "damper = \"shroud\"",
            "shrouds that rub on one another",
            None,
        ),
        (
            "damper = \"blade_to_ground\"",
            "platforms that rub on the ground",
            None,
        ),
    ] {
        let (_, page, _) = reported(&built_in(damper), 0);
        let header = between(&page, "<header>", "</header>");
        assert!(
            header.contains(&format!("bladed disks with {words}: 1 patterns")),
            "{damper}: {header}"
        );
        for word in ["ring", "wedge", "cylinder"] {
            let is_named = page.contains(&format!("mass of the {word}"));
            assert_eq!(is_named, body == Some(word), "{damper}: {word}");
        }
    }
    // A wheel of masses names its bodies by itself.
    let (_, page, _) = reported(GOOD, 0);
    assert!(page.contains("bladed disks with a friction ring damper: 10 patterns"));
}
