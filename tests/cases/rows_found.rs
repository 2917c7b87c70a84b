//! Rows of populations at the settings that the program chooses: how many have a peak.

use std::collections::BTreeMap;
use std::path::Path;

use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::ContactCondition;
use blisk::response::friction::ContactLaw;
use blisk::response::harmonic_balance::Status;
use blisk::study::Study;
use rayon::prelude::*;

use super::support::{Case, package};

/// The study with its solver settings left to the program.
fn at_default_settings(file: &str, loads_n: &[f64]) -> Study {
    let path = package(file);
    let text = std::fs::read_to_string(&path).unwrap();
    parsed(&path, &text, loads_n)
}

/// [`at_default_settings`] under a law, with patterns drawn at 3 % in the place of those of a file.
fn at_drawn_patterns(file: &str, law: ContactLaw, loads_n: &[f64]) -> Study {
    let path = package(file);
    let text = std::fs::read_to_string(&path).unwrap();
    let lines = text.lines().map(|line| match line {
        line if line.starts_with("file = \"") => "distribution = { kind = \"normal\" }".to_owned(),
        line if line.starts_with("law = ") => format!("law = \"{}\"", law.name()),
        "seed = 1" => "seed = 500\npatterns = 125".to_owned(),
        "[sweep]" => "[sweep]\nstandard_deviation = [0.03]".to_owned(),
        line => line.to_owned(),
    });
    parsed(&path, &lines.collect::<Vec<_>>().join("\n"), loads_n)
}

fn parsed(path: &Path, text: &str, loads_n: &[f64]) -> Study {
    let (physics, _) = text.split_once("\n[solver]").unwrap_or((text, ""));
    let lines = physics.lines().map(|line| {
        if line.starts_with("normal_load_n") && !loads_n.is_empty() {
            format!("normal_load_n = {loads_n:?}")
        } else {
            line.to_owned()
        }
    });
    Study::parse(path, &lines.collect::<Vec<_>>().join("\n")).unwrap()
}

/// Rows with friction of the first `patterns` patterns, with their contact.
fn rows_of(study: Study, patterns: u32) -> Vec<(ContactCondition, ResponseRow)> {
    let loads = study.contacts.clone().into_iter();
    let loads: Vec<_> = loads
        .filter(|load| load.normal_load_n().is_some())
        .collect();
    let standard_deviation = study.standard_deviations[0];
    let case = Case::new(study);
    let tuned: Vec<_> = loads.iter().map(|&load| case.tuned(load)).collect();
    let rows = (0..patterns).into_par_iter().flat_map_iter(|id| {
        let pattern = case.pattern(id, standard_deviation);
        let rows = loads.iter().zip(&tuned);
        let rows = rows.map(|(&load, tuned)| (load, case.row(&pattern, load, tuned)));
        rows.collect::<Vec<_>>()
    });
    rows.collect()
}

/// Rows with friction of the first `patterns` patterns without a peak, and all of them; states are printed by load and harmonics.
fn without_a_peak(study: Study, patterns: u32) -> [usize; 2] {
    let rows = rows_of(study, patterns);
    let mut counts = BTreeMap::new();
    for (load, row) in &rows {
        let of = (format!("{load:?}, {}", row.harmonics), row.status.name());
        *counts.entry(of).or_insert(0) += 1;
    }
    for ((of, status), count) in counts {
        println!("{of}: {count} {status}");
    }
    let lost = rows.iter().filter(|(_, row)| row.status != Status::Ok);
    [lost.count(), rows.len()]
}

/// With both tangents on the friction circle, all rows are found with all harmonics and at the first attempt.
#[test]
fn rows_with_the_friction_circle_are_found_at_once() {
    let file = "studies/validation/wheel24.toml";
    let study = at_drawn_patterns(file, ContactLaw::Coulomb3d, &[160.0, 640.0]);
    for (load, row) in rows_of(study, 6) {
        let name = format!("pattern {}, {load:?}", row.pattern);
        assert_eq!(row.status, Status::Ok, "{name}");
        assert!(row.harmonics.ends_with("-15"), "{name}: {}", row.harmonics);
        assert_eq!(row.retries, 0, "{name}");
    }
}

#[test]
#[ignore = "minutes: five hundred rows"]
fn five_hundred_rows_of_two_wheels_with_the_friction_circle_are_found() {
    let wheels = [
        ("wheel24", [160.0, 320.0, 640.0, 1280.0]),
        ("wheel8", [400.0, 800.0, 1600.0, 3200.0]),
    ];
    for (wheel, loads_n) in wheels {
        let file = format!("studies/validation/{wheel}.toml");
        let study = at_drawn_patterns(&file, ContactLaw::Coulomb3d, &loads_n);
        let [lost, rows] = without_a_peak(study, 63);
        assert_eq!(rows, 252);
        assert!(100 * lost <= rows, "{wheel}: {lost}");
    }
}

/// `.ci/long rows_found`
#[test]
#[ignore = "minutes: ten thousand rows"]
fn ten_thousand_rows_of_the_lumped_wheel_are_found() {
    let file = "studies/validation/lumped24-population.toml";
    let study = at_default_settings(file, &[25.0, 50.0, 75.0, 150.0, 300.0]);
    let [lost, rows] = without_a_peak(study, 2000);
    assert_eq!(rows, 10_000);
    assert!(1000 * lost <= rows, "{lost}");
}

#[test]
#[ignore = "minutes: two thousand rows"]
fn two_thousand_rows_of_the_quickstart_are_found() {
    let [lost, rows] = without_a_peak(at_default_settings("studies/quickstart.toml", &[]), 334);
    assert_eq!(rows, 2004);
    assert!(1000 * lost <= rows, "{lost}");
}

/// Loads far below the best one, where most pairs separate.
#[test]
#[ignore = "minutes: five hundred rows whose contacts open"]
fn five_hundred_rows_of_two_wheels_at_light_loads_are_found() {
    let wheels = [("wheel24", [80.0, 40.0]), ("wheel8", [200.0, 100.0])];
    let counts = wheels.map(|(wheel, loads_n)| {
        let file = format!("studies/validation/{wheel}.toml");
        let study = at_drawn_patterns(&file, ContactLaw::Simplified3d, &loads_n);
        without_a_peak(study, 125)
    });
    let [lost, rows] = [0, 1].map(|place| counts[0][place] + counts[1][place]);
    assert_eq!(rows, 500);
    assert!(100 * lost <= 2 * rows, "{lost}");
}
