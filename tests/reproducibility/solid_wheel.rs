//! The real engine on a wheel of solid elements: bytes for any number of threads.

use std::path::Path;

use blisk::campaign::{RunRequest, merge, run, run_shard};
use blisk::population::table::{Manifest, Shard};
use blisk::settings::ReducedEngineSource;
use blisk::study::Study;

use crate::folder::{Silent, bytes};

/// The built-in wheel, coarse and of six blades, under friction and stuck.
fn study(patterns: u32, reduction: &str) -> Study {
    study_that_looks_at(patterns, reduction, 0)
}

/// The same that looks at the stability of so many rows round every percentile.
fn study_that_looks_at(patterns: u32, reduction: &str, stability: u32) -> Study {
    let text = format!(
        r#"schema = 1
study = {{ name = "solid", seed = 11, patterns = {patterns} }}
excitation = {{ engine_orders = [1] }}
damping = {{ structural_loss_factor = 0.004 }}
mistuning = {{ distribution = {{ kind = "normal" }} }}
sweep = {{ normal_load_n = [20, 320, "stuck"], standard_deviation = [0.03] }}

[model]
source = "parametric"
parametric = {{ sectors = 6, disk_radial_elements = 1, passage_elements = 1, blade_radial_elements = 2 }}

[reduction]
{reduction}

[contact]
law = "simplified_3d"
friction_coefficient = 0.15
tangential_stiffness_n_per_m = 1.0e8
normal_stiffness_n_per_m = 1.0e8

[solver]
harmonics = [1, 3]
samples_per_period = 64
peak_tolerance = 5e-3

[output]
stability = {stability}
"#
    );
    Study::parse(Path::new("solid.toml"), &text).expect("a good study")
}

fn results(study: &Study, threads: usize) -> Vec<Vec<u8>> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let request = RunRequest {
        study,
        results: folder.path(),
        threads,
    };
    let outcome = run(request, &ReducedEngineSource, &Silent).expect("the run");
    let rows = study.scenarios().len() as u64 * u64::from(study.patterns);
    assert_eq!(outcome.rows_solved, rows);
    bytes(folder.path())
}

const STICK_SLIDE: &str = "basis = \"stick_slide\"\nstick_modes = 2\nslide_modes = 2";
const TUNED_RECEPTANCES: &str = "basis = \"tuned_receptances\"";

fn same_for_any_threads(patterns: u32, reduction: &str, numbers: &[usize]) {
    let study = study(patterns, reduction);
    let expected = results(&study, 1);
    for &threads in numbers {
        assert!(results(&study, threads) == expected, "{threads} threads");
    }
}

#[test]
fn a_wheel_of_solid_elements_has_the_same_bytes_for_any_number_of_threads() {
    same_for_any_threads(12, STICK_SLIDE, &[3]);
    same_for_any_threads(12, TUNED_RECEPTANCES, &[3]);
}

/// Whatever way a study is solved, the same rows are looked at, and the same is found.
#[test]
fn stability_is_looked_at_in_the_same_rows_however_a_study_is_solved() {
    let study = study_that_looks_at(8, TUNED_RECEPTANCES, 1);
    let request = |study, results, threads| RunRequest {
        study,
        results,
        threads,
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    run(
        request(&study, folder.path(), 1),
        &ReducedEngineSource,
        &Silent,
    )
    .expect("the run");
    let expected = bytes(folder.path());
    let manifest = Manifest::read(folder.path()).expect("read").expect("there");
    let mut known = 0;
    for entry in &manifest.scenarios {
        let found = entry.stability.expect("looked at");
        // Of eight patterns only the median has a value.
        assert_eq!(found.rows, 1);
        let told = found.stable + found.unstable + u64::from(found.tuned.is_some());
        // A linear limit has no contact whose motion could be left.
        assert!(told == 0 || entry.contact.normal_load_n().is_some());
        known += told;
    }
    assert!(known >= 2);
    assert!(results(&study, 2) == expected);

    // First without, of fewer patterns.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let fewer = study_that_looks_at(5, TUNED_RECEPTANCES, 0);
    run(
        request(&fewer, folder.path(), 1),
        &ReducedEngineSource,
        &Silent,
    )
    .expect("the run");
    let without = study_that_looks_at(8, TUNED_RECEPTANCES, 0);
    run(
        request(&without, folder.path(), 2),
        &ReducedEngineSource,
        &Silent,
    )
    .expect("the run");
    assert!(bytes(folder.path()) != expected);
    run(
        request(&study, folder.path(), 1),
        &ReducedEngineSource,
        &Silent,
    )
    .expect("the run");
    assert!(bytes(folder.path()) == expected);

    // In shards.
    let folder = tempfile::tempdir().expect("a temporary folder");
    for number in [1, 2] {
        let shard = Shard { number, count: 2 };
        let request = request(&study, folder.path(), 1);
        run_shard(request, shard, &ReducedEngineSource, &Silent).expect("a shard");
    }
    let shards = [folder.path().to_owned()];
    merge(&shards, folder.path(), None, &ReducedEngineSource).expect("merged");
    assert!(bytes(folder.path()) == expected);
}

#[test]
#[ignore = "500 patterns under 3 scenarios, eight times: about 8 minutes"]
fn a_wheel_of_solid_elements_has_the_same_bytes_for_any_number_of_threads_long() {
    same_for_any_threads(500, STICK_SLIDE, &[2, 3, 4, 7, 8, 16, 64]);
}
