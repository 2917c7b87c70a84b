//! `blisk import` from outside: a bundle that a study reads, exit codes, JSON.

use std::path::{Path, PathBuf};

use crate::blisk::Place;

fn wheel() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/calculix_wheel/wheel_speed.toml")
}

/// The wheel at speed has an indefinite stiffness without contact; with contact it is solved.
const STUDY: &str = r#"schema = 1
[study]
name = "imported"
seed = 1
patterns = 2
[model]
source = "bundle"
[model.bundle]
path = "bundle"
[reduction]
basis = "stick_slide"
stick_modes = 3
slide_modes = 3
[contact]
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 2.0e7
normal_stiffness_n_per_m = 4.0e7
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [2]
amplitude_n = 1.0
[mistuning]
distribution = { kind = "normal", standard_deviation = 0.01 }
[sweep]
normal_load_n = ["slide", 100, "stuck"]
[solver]
harmonics = [1]
"#;

#[test]
fn a_wheel_of_calculix_goes_from_its_files_to_results() {
    let place = Place::with(STUDY);
    let file = wheel();
    let arguments = [
        "import",
        file.to_str().expect("UTF-8"),
        "--out",
        "bundle",
        "--frequencies",
        "3",
    ];
    let ended = place.run(&arguments);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stderr.contains("wrote the sector bundle bundle"),
        "{}",
        ended.stderr
    );
    for part in [
        "24 sectors",
        "288 dofs",
        "6000.000 rpm",
        "6 pairs",
        "by nodal diameter",
    ] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
    let frequencies =
        std::fs::read_to_string(place.path("bundle/frequencies.csv")).expect("written");
    assert_eq!(frequencies.lines().count(), 1 + 13 * 3);
    let ended = place.run(&["run", "study.toml", "--out", "results"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stdout.contains("6 rows ok, 0 failed"),
        "{}",
        ended.stdout
    );
}

#[test]
fn an_import_reports_as_json_and_prints_equations() {
    let place = Place::new();
    let file = wheel();
    let file = file.to_str().expect("UTF-8");
    let ended = place.run(&["import", file, "--out", "bundle", "--json"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    let report: serde_json::Value = serde_json::from_str(&ended.stdout).expect("JSON");
    assert_eq!(report["contact"]["pairs"], 6);
    assert_eq!(report["bodies"][1]["body"], "ring");
    let ended = place.run(&["import", file, "--equations", "ring"]);
    assert_eq!(ended.code, 0, "{}", ended.stderr);
    assert!(
        ended.stdout.starts_with("*NSET,NSET=RING_CYCLIC"),
        "{}",
        ended.stdout
    );
}

#[test]
fn a_refused_import_ends_with_the_code_of_its_cause() {
    let place = Place::new();
    for (name, content, code, message) in [
        (
            "bad.toml",
            "code = \"calculix\"\nname = 1\n",
            4,
            "bad.toml:2",
        ),
        (
            "files.toml",
            "code = \"calculix\"\nname = \"x\"\nsectors = 3\n[blisk]\njob = \"absent\"\nlow_face = \"A\"\nhigh_face = \"B\"\n\
             [[force]]\nnode = 1\ncomponent = \"z\"\n[[observe]]\nname = \"x\"\nnode = 1\n",
            7,
            "absent.inp",
        ),
    ] {
        place.write(name, content);
        let ended = place.run(&["import", name, "--out", "bundle"]);
        assert_eq!(ended.code, code, "{}", ended.stderr);
        assert!(ended.stderr.contains(message), "{}", ended.stderr);
        assert!(!place.path("bundle").exists());
    }
    assert_eq!(place.run(&["import", "bad.toml"]).code, 2);
    assert_eq!(place.run(&["import", "none.toml", "--out", "b"]).code, 7);
}
