//! Default settings against converged harmonics: within the error that the row states.

use blisk::response::forced_response::{ContactCondition, Harmonics};
use blisk::study::Study;

use super::support::{Case, package};

fn wheel(name: &str, loads: &str, reduction: &str, solver: &str) -> Study {
    let kt = if name == "wheel8" { 4e8 } else { 1e8 };
    let kn = 2.0 * kt;
    let text = format!(
        r#"schema = 1
study = {{ name = "{name}", seed = 1 }}
excitation = {{ engine_orders = [3], amplitude_n = 1.0 }}
damping = {{ structural_loss_factor = 0.002 }}
mistuning = {{ file = "../tests/data/{name}/reference/patterns.csv" }}
sweep = {{ normal_load_n = [{loads}] }}

[model]
source = "bundle"
bundle = {{ path = "../tests/data/{name}" }}

[reduction]
{reduction}

[contact]
law = "simplified_3d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = {kt:e}
normal_stiffness_n_per_m = {kn:e}

[solver]
{solver}
"#
    );
    Study::parse(&package("studies/reference.toml"), &text).unwrap()
}

/// Harmonics chosen for the scenario at `place`, and their remainder.
fn chosen(case: &Case, place: usize) -> (Vec<u64>, f64) {
    let choice = &case.chosen()["harmonics"][place];
    let harmonics = choice["harmonics"].as_array().unwrap().iter();
    (
        harmonics.map(|k| k.as_u64().unwrap()).collect(),
        choice["remainder"].as_f64().unwrap(),
    )
}

#[test]
fn automatic_harmonics_find_the_internal_contact_resonances() {
    // Harmonic 6 lies between a slide mode at 3658 and a stuck mode at 3719 Hz of wheel8, nodal
    // diameter 2; harmonic 8 does likewise on wheel24.
    for (name, load, harmonic) in [("wheel8", "400", 6), ("wheel24", "160", 8)] {
        let tolerance = 0.02;
        let study = wheel(
            name,
            load,
            "basis = \"stick_attachment\"",
            "harmonics = \"auto\"",
        );
        let case = Case::new(study);
        let (harmonics, remainder) = chosen(&case, 0);
        println!("{name}, {load} N: {harmonics:?}, remainder {remainder:.4}");
        assert!(harmonics.contains(&harmonic), "{harmonics:?}");
        assert!(remainder <= tolerance, "{remainder}");
    }
}

/// Peaks of lumped24 with the automatic set against the odd harmonics to 15, whose curves
/// meet an independent code (`lumped24.rs`).
#[test]
fn a_lumped_wheel_with_automatic_harmonics_is_within_its_stated_error() {
    let mut study = Study::read(&package("studies/lumped24.toml")).unwrap();
    study.solver.harmonics = Harmonics::Auto;
    let default = Case::new(study.clone());
    study.solver.harmonics = Harmonics::Set((1..=15).step_by(2).collect());
    study.solver.samples_per_period = 512;
    let converged = Case::new(study);
    let load = ContactCondition::Full {
        normal_load_n: 50.0,
    };
    let (tuned, reference) = (default.tuned(load), converged.tuned(load));
    for pattern in [0, 1] {
        let pattern = default.pattern(pattern, None);
        let row = default.row(&pattern, load, &tuned);
        let truth = converged.row(&pattern, load, &reference);
        let error = row.peak_amplitude_m.unwrap() / truth.peak_amplitude_m.unwrap() - 1.0;
        println!(
            "{}: error {error:+.5}, stated {:?}",
            row.harmonics, row.stated_error
        );
        assert!(error.abs() <= row.stated_error.unwrap());
    }
}

/// The known peaks come from another code, whose number of fixed-interface modes is not on record. Sets up to
/// harmonic 3 hardly depend on it; higher ones do (wheel8, 1 to 7: 1.278e-4 with 25 modes, 1.251e-4 with 32,
/// 1.246e-4 with 40, 1.244e-4 with 60 and 100), so that the known one lies between a coarse and a fine space.
///
/// `cargo test --release --test cases full_contact_model -- --ignored --nocapture`
#[test]
#[ignore = "minutes: the full contact model with sixteen harmonics"]
fn the_full_contact_model_meets_the_tuned_peaks_known_for_it() {
    for (name, load, set, known) in [
        ("wheel8", 400.0, vec![1], 1.356e-4),
        ("wheel8", 400.0, vec![1, 3, 5, 7], 1.322e-4),
        ("wheel8", 400.0, (1..=7).collect(), 1.264e-4),
        ("wheel8", 400.0, (1..=15).collect(), 1.209e-4),
        ("wheel24", 160.0, vec![1], 2.344e-4),
        ("wheel24", 160.0, vec![1, 3, 5, 7], 2.379e-4),
        ("wheel24", 160.0, (1..=9).collect(), 2.293e-4),
        ("wheel24", 160.0, (1..=15).collect::<Vec<u32>>(), 2.306e-4),
    ] {
        let peaks = [25, 60].map(|modes| full_model_peak(name, load, &set, modes));
        println!("{name}, {load} N, {set:?}: {peaks:?} with 25 and 60 modes for {known:e}");
        let (low, high) = (peaks[0].min(peaks[1]), peaks[0].max(peaks[1]));
        assert!(
            known > 0.995 * low && known < 1.005 * high,
            "{set:?}: {peaks:?} for {known:e}"
        );
    }
}

/// Tuned peak on the whole Craig-Bampton space: so many stick modes are asked for that with the
/// attachment vectors nothing is left out.
fn full_model_peak(name: &str, load: f64, set: &[u32], fixed_interface_modes: usize) -> f64 {
    let reduction = format!(
        "basis = \"stick_attachment\"\nstick_modes = 200\ncraig_bampton_modes = {fixed_interface_modes}"
    );
    let solver = format!("harmonics = {set:?}\nsamples_per_period = 512");
    let case = Case::new(wheel(name, &format!("{load:?}"), &reduction, &solver));
    let contact = ContactCondition::Full {
        normal_load_n: load,
    };
    case.tuned(contact).amplitude_m.unwrap()
}
