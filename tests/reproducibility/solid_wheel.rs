//! The real engine on a wheel of solid elements: bytes for any number of threads.

use std::path::Path;

use blisk::study::{ReducedEngineSource, RunRequest, Study, run};

use crate::folder::{Silent, bytes};

/// The built-in wheel, coarse and of six blades, under friction and stuck.
fn study(patterns: u32, reduction: &str) -> Study {
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

#[test]
#[ignore = "500 patterns under 3 scenarios, eight times: about 8 minutes"]
fn a_wheel_of_solid_elements_has_the_same_bytes_for_any_number_of_threads_long() {
    same_for_any_threads(500, STICK_SLIDE, &[2, 3, 4, 7, 8, 16, 64]);
}
