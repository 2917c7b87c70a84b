//! Loads by rotation, damping by nodal diameter, stress and the Campbell table from outside.

use polars::prelude::{ParquetReader, SerReader};
use serde_json::Value;

use crate::blisk::{GOOD, Place};

fn study(speeds: &str) -> String {
    GOOD.replace(
        "tangential_stiffness_n_per_m = 8.0e5\n",
        &format!(
            "tangential_stiffness_n_per_m = 8.0e5\n\
             normal_load = {{ from = \"rotation\", speed_rpm = {speeds}, ring_radius_m = 0.2 }}\n"
        ),
    )
    .replace(
        "[excitation]",
        "[nodal_diameter_damping]\ndamping_ratios = [[2, 0.002], [3, 0.001]]\n\n[excitation]",
    ) + "\n[output]\nstress_pa_per_m = 2.0e11\n"
}

/// A column of `scenarios.parquet`.
fn column(place: &Place, name: &str) -> Vec<Option<f64>> {
    let file = std::fs::File::open(place.path("results/small/scenarios.parquet")).expect("a table");
    let table = ParquetReader::new(file).finish().expect("Parquet");
    let column = table.column(name).expect(name);
    column.f64().expect("numbers").iter().collect()
}

#[test]
fn speeds_are_loads_of_a_run_and_more_of_them_are_solved_alone() {
    // m r Omega^2 = 0.03 * 0.2 * (100 pi)^2 at 3000 rpm.
    let load = 0.03 * 0.2 * (100.0 * std::f64::consts::PI).powi(2);
    let place = Place::with(&study("3000"));
    let run = place.run(&["run", "study.toml"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    for part in [
        "rotation: ring of 0.0300 kg per sector at 0.2000 m",
        "contact takes 100.0 % of its load, 1 of 1 pairs pressed; 3000 rpm: 592.2 N",
        "stress 2e11 Pa per m of amplitude: largest tuned",
    ] {
        assert!(run.stdout.contains(part), "{part}: {}", run.stdout);
    }
    let speeds = column(&place, "speed_rpm");
    assert_eq!(speeds, [None, None, None, Some(3000.0)]);
    let loads = column(&place, "normal_load_n");
    assert!((loads[3].expect("a load") / load - 1.0).abs() < 1e-8);
    let (tuned, stress) = (
        column(&place, "tuned_amplitude_m"),
        column(&place, "tuned_stress_pa"),
    );
    for (tuned, stress) in tuned.iter().zip(&stress) {
        let expected = 2.0e11 * tuned.expect("a peak");
        assert!((stress.expect("a stress") / expected - 1.0).abs() < 1e-14);
    }
    place.write("study.toml", &study("[3000, 4000]"));
    let longer = place.run(&["run", "study.toml"]);
    assert_eq!(longer.code, 0, "{}", longer.stderr);
    assert!(
        longer.stderr.contains("solved 10 rows, reused 40"),
        "{}",
        longer.stderr
    );
    let speeds = column(&place, "speed_rpm");
    assert_eq!(speeds, [None, None, None, Some(3000.0), Some(4000.0)]);
    // The report has the speeds, and amplitudes as stress.
    let report = place.run(&["report", "results/small", "--no-curves", "--json"]);
    let report: Value = serde_json::from_str(&report.stdout).expect("JSON");
    let loads = report["summary"]["scenarios"].as_array().expect("loads");
    let speeds: Vec<Option<f64>> = loads
        .iter()
        .map(|load| load["speed_rpm"].as_f64())
        .collect();
    assert_eq!(speeds, [None, None, None, Some(3000.0), Some(4000.0)]);
    let page = place.run(&["report", "results/small", "--no-curves"]);
    assert_eq!(page.code, 0, "{}", page.stderr);
    let html = std::fs::read_to_string(place.path("results/small/report.html")).expect("a page");
    let crossing = 60.0 * loads[0]["tuned_frequency_hz"].as_f64().expect("a peak") / 2.0;
    for part in [
        "load of, rpm".to_owned(),
        "crossing at, rpm".to_owned(),
        format!(">{crossing:.0}<"),
        "Stress, 2e11 Pa per m of amplitude".to_owned(),
    ] {
        assert!(html.contains(&part), "{part}");
    }
    // The folder is a study of its own: its rows are solved again from it.
    let replay = place.run(&[
        "verify",
        "results/small",
        "--scenario",
        "4",
        "--pattern",
        "3",
    ]);
    assert_eq!(replay.code, 0, "{}{}", replay.stdout, replay.stderr);
    let verified = place.run(&["verify", "study.toml", "--sample", "3"]);
    assert_eq!(verified.code, 0, "{}{}", verified.stdout, verified.stderr);
    place.write(
        "study.toml",
        &study("[4000, 3000]").replace("0.002]", "0.003]"),
    );
    assert_eq!(place.run(&["run", "study.toml"]).code, 9);
}

#[test]
fn without_a_stress_scale_there_is_no_stress() {
    let place = Place::with(GOOD);
    assert_eq!(place.run(&["run", "study.toml"]).code, 0);
    for name in ["speed_rpm", "tuned_stress_pa", "peak_stress_pa_p99"] {
        assert!(column(&place, name).iter().all(Option::is_none), "{name}");
    }
}

#[test]
fn a_campbell_table_has_the_frequencies_and_crossings_of_a_study() {
    let place = Place::with(GOOD);
    let told = place.run(&[
        "campbell",
        "study.toml",
        "--engine-orders",
        "2,4:5",
        "--json",
    ]);
    assert_eq!(told.code, 0, "{}", told.stderr);
    let report: Value = serde_json::from_str(&told.stdout).expect("JSON");
    let crossings = report["crossings"].as_array().expect("a list");
    // Orders 2 and 4 excite nodal diameter 2, order 5 nodal diameter 1; three masses, stuck and sliding.
    assert_eq!(crossings.len(), 3 * 2 * 3, "{crossings:?}");
    for crossing in crossings {
        let number = |key: &str| crossing[key].as_f64().expect("a number");
        let order = number("engine_order");
        assert!((number("frequency_hz") - order * number("speed_rpm") / 60.0).abs() < 1e-9);
        let diameter = if order > 4.5 { 1.0 } else { 2.0 };
        assert!((number("nodal_diameter") - diameter).abs() < 1e-9);
    }
    let text = place.run(&["campbell", "study.toml", "--speed-rpm", "0:1"]);
    assert!(
        text.stdout.contains("neither stress stiffening"),
        "{}",
        text.stdout
    );
    assert!(text.stdout.contains("no crossings"), "{}", text.stdout);
    // The model at two speeds, here the same one.
    assert_eq!(
        place
            .run(&["model", "study.toml", "--export", "bundle"])
            .code,
        0
    );
    let arguments = [
        "campbell",
        "study.toml",
        "--at",
        "6000=bundle",
        "--at",
        "0=bundle",
        "--json",
    ];
    let told = place.run(&arguments);
    assert_eq!(told.code, 0, "{}", told.stderr);
    let report: Value = serde_json::from_str(&told.stdout).expect("JSON");
    assert_eq!(report["speed_rpm"], serde_json::json!([0.0, 6000.0]));
    let beyond = |crossing: &Value| {
        crossing["extrapolated"] == (crossing["speed_rpm"].as_f64().expect("rpm") > 6000.0)
    };
    assert!(
        report["crossings"]
            .as_array()
            .expect("a list")
            .iter()
            .all(beyond)
    );
    for (arguments, code, part) in [
        (["--at", "0=nowhere"], 7, "nowhere"),
        (["--at", "fast=bundle"], 2, "RPM=BUNDLE"),
        (["--engine-orders", "0"], 2, "from 1 to 10000"),
        (["--speed-rpm", "9:3"], 2, "LOW:HIGH"),
        // An upper end of diagrams that are not drawn.
        (["--top-hz", "500"], 2, "--plot <FILE>|--plot-safe <FILE>"),
    ] {
        let words = ["campbell", "study.toml", arguments[0], arguments[1]];
        let refused = place.run(&words);
        assert_eq!(refused.code, code, "{arguments:?}: {}", refused.stderr);
        assert!(refused.stderr.contains(part), "{}", refused.stderr);
    }
}

#[test]
fn every_engine_order_can_have_its_own_amplitude() {
    let study = |orders: &str, amplitudes: &str| {
        GOOD.replace("engine_orders = [2]", &format!("engine_orders = {orders}"))
            .replace("amplitude_n = 10.0", &format!("amplitude_n = {amplitudes}"))
    };
    let both = Place::with(&study("[2, 1]", "[10.0, 25.0]"));
    let run = both.run(&["run", "study.toml"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let mut alone = Vec::new();
    for (order, amplitude) in [("[2]", "10.0"), ("[1]", "25.0")] {
        let place = Place::with(&study(order, amplitude));
        assert_eq!(place.run(&["run", "study.toml"]).code, 0);
        for name in ["tuned_amplitude_m", "peak_amplitude_m_mean"] {
            alone.push(column(&place, name));
        }
    }
    for (index, name) in ["tuned_amplitude_m", "peak_amplitude_m_mean"]
        .into_iter()
        .enumerate()
    {
        let expected = alone[index].iter().chain(&alone[index + 2]);
        for (found, expected) in column(&both, name).iter().zip(expected) {
            let (found, expected) = (found.expect("a value"), expected.expect("a value"));
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{name}: {found} {expected}"
            );
        }
    }
    // The same force on the full-contact model, whose amplitudes are its own.
    let verified = both.run(&["verify", "study.toml", "--sample", "4"]);
    assert_eq!(verified.code, 0, "{}{}", verified.stdout, verified.stderr);
}

#[test]
fn campbell_and_safe_diagram_are_drawn_from_a_study_without_results() {
    let place = Place::with(GOOD);
    let arguments = |more: &[&'static str]| {
        let first = ["campbell", "study.toml", "--engine-orders", "2,5"];
        [&first[..], more].concat()
    };
    let plots = ["--plot", "speed.svg", "--plot-safe", "safe.svg", "--json"];
    let drawn = place.run(&arguments(&plots));
    assert_eq!(drawn.code, 0, "{}", drawn.stderr);
    assert!(!place.path("results").exists());
    let report: Value = serde_json::from_str(&drawn.stdout).expect("JSON");
    let read = |name: &str| std::fs::read_to_string(place.path(name)).expect("a figure");
    let (speed, safe) = (read("speed.svg"), read("safe.svg"));
    for figure in [&speed, &safe] {
        assert_eq!(
            figure.matches("<polyline class=\"curve median\"").count(),
            2
        );
        assert!(figure.contains("Ends at ") && figure.contains(" --top-hz "));
    }
    // First modes are met on either figure, at the frequencies of the table.
    for crossing in report["crossings"].as_array().expect("a list") {
        if crossing["mode"] != 1 {
            continue;
        }
        let (order, contact) = (&crossing["engine_order"], &crossing["contact"]);
        let number = |key: &str| crossing[key].as_f64().expect("a number");
        let (hz, rpm) = (number("frequency_hz"), number("speed_rpm"));
        let words = format!(
            "engine order {order}, nodal diameter {}, mode 1, {}: {hz:.2} Hz at {rpm:.0} rpm",
            crossing["nodal_diameter"],
            contact.as_str().expect("a name")
        );
        assert!(speed.contains(&words), "{words}");
        if contact == "stuck" {
            let words = format!("engine order {order} at {rpm:.0} rpm: {hz:.2} Hz");
            assert!(safe.contains(&words), "{words}");
        }
    }
    assert!(safe.contains("nodal diameter 3, mode 1, slide"));
    // Where it ends is asked for.
    let higher = place.run(&arguments(&["--plot-safe", "safe.svg", "--top-hz", "5e3"]));
    assert_eq!(higher.code, 0, "{}", higher.stderr);
    assert!(read("safe.svg").contains("Ends at 5000 Hz, as asked for"));
    for wrong in [["--plot", "speed.png"], ["--top-hz", "0"]] {
        let refused = place.run(&arguments(&wrong));
        assert_eq!(refused.code, 2, "{}", refused.stderr);
        assert!(refused.stderr.contains("accepted: "), "{}", refused.stderr);
    }
}

#[test]
fn models_at_several_speeds_have_curves_over_speed_and_no_safe_diagram() {
    let place = Place::with(GOOD);
    assert_eq!(
        place.run(&["model", "study.toml", "--export", "slow"]).code,
        0
    );
    let stiffer = GOOD.replace(
        "blade_stiffness_n_per_m = 2.5e6",
        "blade_stiffness_n_per_m = 3e6",
    );
    place.write("study.toml", &stiffer);
    assert_eq!(
        place.run(&["model", "study.toml", "--export", "fast"]).code,
        0
    );
    let at = [
        "campbell",
        "study.toml",
        "--at",
        "0=slow",
        "--at",
        "9000=fast",
    ];
    let drawn = place.run(&[&at[..], &["--plot", "speed.svg"]].concat());
    assert_eq!(drawn.code, 0, "{}", drawn.stderr);
    let speed = std::fs::read_to_string(place.path("speed.svg")).expect("a figure");
    let lines = speed
        .split("<polyline class=\"curve stuck\" points=\"")
        .skip(1);
    let heights: Vec<Vec<f64>> = lines
        .map(|line| {
            let points = line.split_once('"').expect("an end").0.split(' ');
            let height = |point: &str| point.split_once(',').expect("two numbers").1.parse();
            points
                .map(|point| height(point).expect("a number"))
                .collect()
        })
        .collect();
    // Heights count downwards: no frequency falls with the speed, and that of a blade rises.
    let falls = |own: &Vec<f64>| own.windows(2).any(|pair| pair[1] > pair[0]);
    assert!(!heights.is_empty() && heights.iter().all(|own| own.len() > 10 && !falls(own)));
    assert!(heights.iter().any(|own| own[0] - own[own.len() - 1] > 2.0));
    let refused = place.run(&[&at[..], &["--plot-safe", "safe.svg"]].concat());
    assert_ne!(refused.code, 0);
    assert!(
        refused.stderr.contains("accepted: the model of the study"),
        "{}",
        refused.stderr
    );
}
