//! Rows whose contacts separate are solved again, with the harmonics for it and, where rows have a basis, on the one for it.

use std::path::Path;

use blisk::campaign::{ReplayRequest, RunRequest, StoredStudy, VerifyRequest, replay, run, verify};
use blisk::linalg::SymmetricSparse;
use blisk::model::sector::{Component, Dof, SectorModel, bundle};
use blisk::population::monte_carlo::ResponseRow;
use blisk::population::table::ResponseReader;
use blisk::response::harmonic_balance::Status;
use blisk::settings::{FullSettings, Progress, ReducedEngineSource};
use blisk::study::Study;

use crate::extremes::wheels::spatial_sector;
use crate::wheels::relative;

struct Silent;

impl Progress for Silent {}

/// The sector of the battery with a stiff chain of three small masses at the tip of the blade: more
/// dofs than are kept as they are, so that there is a basis to choose.
fn longer_sector() -> SectorModel {
    let mut model = spatial_sector(5);
    let first = model.dofs.len();
    let tip = model.dofs[0].clone();
    let nodes = model.dofs.last().map_or(0, |dof| dof.node) + 1;
    let mut mass: Vec<_> = model.mass.lower_entries().collect();
    let mut stiffness: Vec<_> = model.stiffness.lower_entries().collect();
    let mut blade: Vec<_> = model.blade_stiffness.lower_entries().collect();
    for place in 0..3 {
        for (i, component) in [Component::Radial, Component::Tangential, Component::Axial]
            .into_iter()
            .enumerate()
        {
            let own = first + 3 * place + i;
            let inner = if place == 0 { i } else { own - 3 };
            mass.push((own, own, 0.005));
            for matrix in [&mut stiffness, &mut blade] {
                matrix.extend([
                    (own, own, 2.0e7),
                    (inner, inner, 2.0e7),
                    (own, inner, -2.0e7),
                ]);
            }
            model.dofs.push(Dof {
                node: nodes + place,
                component,
                ..tip.clone()
            });
        }
    }
    let n = model.dofs.len();
    model.mass = SymmetricSparse::from_lower_triplets(n, &mass);
    model.stiffness = SymmetricSparse::from_lower_triplets(n, &stiffness);
    model.blade_stiffness = SymmetricSparse::from_lower_triplets(n, &blade);
    model
}

fn study(folder: &Path, name: &str, loads: &str, reduction: &str, solver: &str) -> Study {
    let text = format!(
        r#"schema = 1
study = {{ name = "{name}", seed = 3, patterns = 4 }}
excitation = {{ engine_orders = [1], amplitude_n = 10.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ distribution = {{ kind = "normal" }} }}
sweep = {{ normal_load_n = [{loads}], standard_deviation = [0.03] }}

[model]
source = "bundle"
bundle = {{ path = "spatial" }}

[reduction]
craig_bampton_modes = 8
{reduction}

[contact]
law = "simplified_3d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e5
normal_stiffness_n_per_m = 1.6e6

[solver]
peak_tolerance = 1.0e-5
{solver}
"#
    );
    Study::parse(&folder.join("study.toml"), &text).unwrap()
}

/// Solves a study into `results`; its rows and the bytes of its table.
fn solved(study: &Study, results: &Path, threads: usize) -> (Vec<ResponseRow>, Vec<u8>) {
    let request = RunRequest {
        study,
        results,
        threads,
    };
    run(request, &ReducedEngineSource, &Silent).unwrap();
    let table = results.join("responses.parquet");
    let mut reader = ResponseReader::open(&table).unwrap();
    let mut rows = Vec::new();
    loop {
        let batch = reader.next_batch().unwrap();
        if batch.is_empty() {
            break;
        }
        rows.extend(batch);
    }
    (rows, std::fs::read(&table).unwrap())
}

/// The sets that the manifest names for rows beyond that of the load at `place`, like `0-1-2`.
fn sets_beyond(stored: &StoredStudy, place: usize) -> Vec<String> {
    let manifest = serde_json::to_value(&stored.manifest).unwrap();
    let sets = find(&manifest, "beyond").expect("beyond")["harmonics"].clone();
    let sets = sets.as_array().unwrap();
    let of_load = sets
        .iter()
        .filter(|set| set["contact"] == sets[place]["contact"]);
    let name = |set: &serde_json::Value| {
        let harmonics = set["harmonics"].as_array().unwrap().iter();
        let names: Vec<String> = harmonics.map(ToString::to_string).collect();
        names.join("-")
    };
    of_load.map(name).collect()
}

fn find<'a>(value: &'a serde_json::Value, key: &str) -> Option<&'a serde_json::Value> {
    match value {
        serde_json::Value::Object(fields) => fields
            .get(key)
            .or_else(|| fields.values().find_map(|value| find(value, key))),
        serde_json::Value::Array(values) => values.iter().find_map(|value| find(value, key)),
        _ => None,
    }
}

const LOADS: &str = "42, 44, 1000";

/// A way in which rows are solved that separate, and in which a study of its own gives the same.
struct Way {
    name: &'static str,
    reduction: &'static str,
    /// What the names of the bases begin with.
    kept: &'static str,
    again: &'static str,
}

#[test]
fn rows_that_separate_are_solved_again_and_replayed() {
    rows_that_separate(&Way {
        name: "receptances",
        reduction: "basis = \"auto\"",
        kept: "tuned_receptances",
        again: "tuned_receptances",
    });
}

/// Of all modes there are: with few of them `stick_slide` does not hold where contacts separate.
#[test]
fn rows_with_a_basis_that_separate_are_solved_again_with_more_harmonics() {
    rows_that_separate(&Way {
        name: "basis",
        reduction: "basis = \"stick_slide\"\nstick_modes = 1000\nslide_modes = 1",
        kept: "stick_slide",
        again: "stick_slide",
    });
}

fn rows_that_separate(way: &Way) {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bundle::write(&longer_sector(), &folder.join("spatial")).unwrap();
    let automatic = study(
        folder,
        way.name,
        LOADS,
        &format!("{}\nerror = 0.3", way.reduction),
        "harmonics = \"auto\"\nharmonic_tolerance = 0.2\n",
    );
    let results = folder.join("one");
    let (rows, bytes) = solved(&automatic, &results, 1);
    let (_, on_two_threads) = solved(&automatic, &folder.join("two"), 2);
    assert!(bytes == on_two_threads, "1 and 2 threads differ");

    let stored = StoredStudy::open(&results, Some(&folder.join("study.toml"))).unwrap();
    for row in &rows {
        println!(
            "{} {}: {} {} {} {:?} separated {:?}",
            row.scenario,
            row.pattern,
            row.status.name(),
            row.basis,
            row.harmonics,
            row.amplification_factor,
            row.separated_fraction
        );
    }
    let (again, kept): (Vec<&ResponseRow>, Vec<&ResponseRow>) = rows
        .iter()
        .partition(|row| row.separated_fraction > Some(0.0));
    assert!(again.len() >= 2 && kept.len() >= 2);
    for row in kept {
        assert!(row.basis.starts_with(way.kept), "{}", row.basis);
        assert_eq!(row.status, Status::Ok);
    }
    for row in &again {
        assert!(row.basis.starts_with(way.again), "{}", row.basis);
        assert_eq!(row.status, Status::Ok);
        assert!(row.harmonics.starts_with("0-1-2"), "{}", row.harmonics);
        if !row.harmonics.ends_with("-15") {
            // All harmonics need no others where they are found.
            let sets = sets_beyond(&stored, row.scenario);
            assert!(
                sets.contains(&row.harmonics),
                "{} of {sets:?}",
                row.harmonics
            );
            on_that_level(folder, &stored, row);
        }
        replayed(&stored, row);
    }
    verified(&stored, rows.len());
}

/// The row is what a study with that set, and that basis where it has one, as its own delivers; its factor is that against
/// the tuned peak of that study.
fn on_that_level(folder: &Path, stored: &StoredStudy, row: &ResponseRow) {
    let load = stored.study.contacts[row.scenario].normal_load_n().unwrap();
    let modes = row.basis.strip_prefix("stick_slide ");
    let reduction = modes.and_then(|modes| modes.split_once('+')).map_or_else(
        || "error = 0.3".to_owned(),
        |(stick, slide)| {
            format!("basis = \"stick_slide\"\nstick_modes = {stick}\nslide_modes = {slide}")
        },
    );
    let fixed = study(
        folder,
        "fixed",
        &load.to_string(),
        &reduction,
        &format!("harmonics = [{}]", row.harmonics.replace('-', ", ")),
    );
    let results = folder.join(format!("fixed-{load}-{}", row.pattern));
    let (rows, _) = solved(&fixed, &results, 1);
    let alone = StoredStudy::open(&results, Some(&folder.join("study.toml"))).unwrap();
    let (_, tuned) = alone.scenario(0).unwrap();
    let own = rows.iter().find(|own| own.pattern == row.pattern).unwrap();
    assert_eq!(own.peak_amplitude_m, row.peak_amplitude_m);
    let factor = row.peak_amplitude_m.unwrap() / tuned.amplitude_m.unwrap();
    assert!(relative(row.amplification_factor.unwrap(), factor) < 1e-15);
}

/// The row again, bit for bit, and on the full contact model with the harmonics of the row.
fn replayed(stored: &StoredStudy, row: &ResponseRow) {
    let request = ReplayRequest {
        scenario: row.scenario,
        pattern: row.pattern,
        full: Some(FullSettings::default()),
    };
    let replay = replay(stored, &ReducedEngineSource, &request).unwrap();
    assert!(replay.identical, "{:?}", replay.replayed);
    let (reference, tuned, harmonics) = replay.full.unwrap();
    let names: Vec<String> = harmonics.iter().map(ToString::to_string).collect();
    assert_eq!(names.join("-"), row.harmonics);
    let reference = (reference.amplitude_m, tuned.amplitude_m);
    let (Some(amplitude), Some(tuned)) = reference else {
        panic!("no peak on the full model: {reference:?}");
    };
    let error = relative(row.peak_amplitude_m.unwrap(), amplitude);
    let factor = relative(row.amplification_factor.unwrap(), amplitude / tuned);
    println!(
        "{} {}: against the full model {error:.1e}, factor {factor:.1e}",
        row.scenario, row.pattern
    );
    assert!(error < 0.01 && factor < 0.01, "{error} {factor}");
}

/// `verify` finds the same of every row.
fn verified(stored: &StoredStudy, rows: usize) {
    let request = VerifyRequest {
        sample: rows,
        seed: None,
        threads: 2,
    };
    let report = verify(stored, &ReducedEngineSource, request, &Silent).unwrap();
    assert_eq!(report.sampled, rows);
    assert!(
        report.different_replays.is_empty(),
        "{:?}",
        report.different_replays
    );
    assert_eq!((report.failed_rows, report.unchecked_rows), (0, 0));
    let largest = |errors: f64| errors < 0.01;
    assert!(report.separating.amplitude.max.is_some_and(largest));
    assert!(
        report
            .separating
            .amplification_factor
            .max
            .is_some_and(largest)
    );
}

/// The sector of the battery, nothing reduced, with the default settings but for those given.
fn light_study(folder: &Path, name: &str, load: f64, solver: &str) -> Study {
    let text = format!(
        r#"schema = 1
study = {{ name = "{name}", seed = 3, patterns = 2 }}
excitation = {{ engine_orders = [1], amplitude_n = 10.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ distribution = {{ kind = "normal" }} }}
sweep = {{ normal_load_n = [{load}], standard_deviation = [0.03] }}
model = {{ source = "bundle", bundle = {{ path = "spatial" }} }}
solver = {{ {solver} }}

[contact]
law = "simplified_3d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e5
normal_stiffness_n_per_m = 1.6e6
"#
    );
    Study::parse(&folder.join("study.toml"), &text).unwrap()
}

/// Under 35 N the tuned peak with 0, 1, 2 and 4 is hard to find. With it, and with automatic harmonics, rows have an amplification
/// factor.
#[test]
fn a_light_load_has_a_tuned_peak_with_a_set_and_with_automatic_harmonics() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bundle::write(&spatial_sector(5), &folder.join("spatial")).unwrap();
    let rows_of = |name: &str, solver: &str| {
        let study = light_study(folder, name, 35.0, solver);
        solved(&study, &folder.join(name), 1).0
    };
    for row in rows_of("fixed", "harmonics = [0, 1, 2, 4]") {
        assert_eq!(row.status, Status::Ok);
        assert!(row.amplification_factor.is_some());
    }
    for row in rows_of("automatic", "harmonics = \"auto\"") {
        println!("{} {:?}", row.harmonics, row.amplification_factor);
        assert_eq!(row.status, Status::Ok);
        assert!(row.harmonics.starts_with("0-1-2"), "{}", row.harmonics);
        assert!(row.amplification_factor.is_some());
    }
}

/// Default settings on the reference wheels where at least every second pair separates, against the full contact model
/// with the harmonics of the row.
#[test]
#[ignore = "minutes: `cargo test --release --test physics light_loads -- --ignored --nocapture`"]
fn light_loads_of_the_reference_wheels_agree_with_the_full_contact_model() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for (wheel, kt, loads) in [("wheel24", 1e8, "40, 80"), ("wheel8", 4e8, "100")] {
        let path = data.join(wheel);
        let text = format!(
            r#"schema = 1
study = {{ name = "{wheel}", seed = 1 }}
excitation = {{ engine_orders = [3], amplitude_n = 1.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ file = "{0}/reference/patterns.csv" }}
sweep = {{ normal_load_n = [{loads}] }}
model = {{ source = "bundle", bundle = {{ path = "{0}" }} }}

[contact]
law = "simplified_3d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = {kt:e}
normal_stiffness_n_per_m = {1:e}
"#,
            path.display(),
            2.0 * kt
        );
        let study = Study::parse(&folder.join(format!("{wheel}.toml")), &text).unwrap();
        let results = folder.join(wheel);
        let (rows, _) = solved(&study, &results, 2);
        let stored =
            StoredStudy::open(&results, Some(&folder.join(format!("{wheel}.toml")))).unwrap();
        for row in rows {
            // Half of the pairs of wheel8 open, all of wheel24's.
            assert!(row.separated_fraction >= Some(0.5));
            replayed(&stored, &row);
        }
    }
}
