//! Peaks of mistuned wheels with many resonances in their band, against dense sweeps.

#![expect(
    clippy::print_stdout,
    reason = "what is measured is shown by `--nocapture`"
)]

use serde_json::Value;

use super::blisk::Place;

/// 36 sectors whose disk joins the blades strongly: resonances from 345 to 370 Hz, some of which the tuned wheel does not answer in, so
/// that friction, which takes nine tenths off the highest, leaves them as they are.
pub(super) const WHEEL: &str = r#"schema = 1
[study]
name = "lumped36"
seed = 36
patterns = 50
[model]
source = "lumped"
[model.lumped]
sectors = 36
blade_mass_kg = 0.2
blade_stiffness_n_per_m = 1.2e6
disk_mass_kg = 1.0
disk_ground_stiffness_n_per_m = 1e7
disk_coupling_stiffness_n_per_m = 5e6
ring_mass_kg = 0.1
ring_coupling_stiffness_n_per_m = 1e7
ring_disk_stiffness_n_per_m = 1e4
[contact]
law = "macro_slip_1d"
friction_coefficient = 0.2
tangential_stiffness_n_per_m = 5e6
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [4]
amplitude_n = 1.0
[mistuning]
distribution = { kind = "normal", standard_deviation = 0.04 }
[sweep]
normal_load_n = [10, 30, 60, 100]
[solver]
"#;

/// What a dense sweep of some rows of a study found.
struct Swept {
    /// Share by which a delivered peak is lower at most.
    largest: f64,
    /// Rows that are lower by more than 0.1 %.
    beaten: usize,
    /// Rows that are lower by more than they state.
    beyond_stated: usize,
}

/// Solves a study and sweeps so many of its rows.
fn swept(study: &str, rows: &str) -> Swept {
    let place = Place::with(study);
    let run = place.run(&["run", "study.toml", "--out", "out"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let sweep = ["verify", "out", "--dense-sweep", "--sample", rows, "--json"];
    let found: Value = serde_json::from_str(&place.run(&sweep).stdout).expect("JSON");
    assert_eq!(found["swept"].to_string(), rows);
    assert_eq!(found["failed_points"], 0);
    let count = |key: &str| found[key].as_array().expect("a list").len();
    let swept = Swept {
        largest: found["under_read"]["max"].as_f64().expect("a number"),
        beaten: count("missed"),
        beyond_stated: count("beyond_stated"),
    };
    println!(
        "{}: {} of {rows} rows beaten by 0.1 %, at most {:.1e}; {} by more than stated",
        found["name"], swept.beaten, swept.largest, swept.beyond_stated
    );
    swept
}

#[test]
fn no_peak_hides_where_a_mode_sticks_that_friction_leaves_alone() {
    let found = swept(&format!("{WHEEL}harmonics = [1]\n"), "100");
    assert_eq!(found.beaten, 0, "{}", found.largest);
}

/// Harmonic 3 takes a quarter off some tops and nothing off others.
#[test]
fn the_highest_top_of_all_harmonics_is_found_where_another_one_is_that_of_the_first() {
    let Swept {
        largest, beaten, ..
    } = swept(WHEEL, "100");
    assert!(beaten <= 10 && largest < 0.005, "{beaten} by {largest}");
}

/// A file of this repository below `studies/` with so many patterns.
fn shipped(name: &str, patterns: u32) -> String {
    let file = format!("{}/studies/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    with_patterns(&std::fs::read_to_string(&file).expect(&file), patterns)
}

fn with_patterns(study: &str, patterns: u32) -> String {
    let line = study.lines().find(|line| line.starts_with("patterns = "));
    study.replace(line.expect("patterns"), &format!("patterns = {patterns}"))
}

/// The file that `blisk init` writes, with so many patterns.
fn initial(patterns: u32) -> String {
    let place = Place::new();
    let init = place.run(&["init", "--out", "study.toml"]);
    assert_eq!(init.code, 0, "{}", init.stderr);
    let study = std::fs::read_to_string(place.path("study.toml")).expect("a study");
    with_patterns(&study, patterns)
}

/// The search looks at a fraction of the band: no sweep of it may find more than a row states, nor more than this share.
fn hides_no_peak(study: &str, rows: &str, most: f64) {
    let found = swept(study, rows);
    assert_eq!(found.beyond_stated, 0, "{}", found.largest);
    assert!(found.largest < most, "{}", found.largest);
}

#[test]
fn no_peak_hides_on_the_built_in_wheel_at_default_settings() {
    hides_no_peak(&initial(5), "16", 0.003);
    hides_no_peak(&shipped("quickstart", 3), "16", 0.003);
}

#[test]
#[ignore = "a quarter of an hour: shipped studies at their default settings"]
fn no_peak_hides_on_shipped_studies_at_default_settings() {
    hides_no_peak(&initial(12), "60", 0.003);
    hides_no_peak(&shipped("quickstart", 12), "60", 0.003);
    hides_no_peak(&shipped("contact-uncertainty", 10), "30", 0.003);
    hides_no_peak(&shipped("shroud", 6), "12", 0.005);
    hides_no_peak(&shipped("blade-to-ground", 6), "12", 0.003);
    hides_no_peak(&shipped("underplatform", 4), "4", 0.003);
}
