//! Default settings against converged harmonics: within the error that the row states.

use blisk::model::reduction::ReductionOptions;
use blisk::population::monte_carlo::{HARMONIC_SAFETY, ScenarioError, stated_error};
use blisk::response::forced_response::{ContactCondition, Harmonics, SolverOptions};
use blisk::settings::{FullModel, FullRow, FullSettings};
use blisk::study::{Study, load_sector_model};

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
            "basis = \"stick_slide\"\nstick_modes = 6\nslide_modes = 6\ncraig_bampton_modes = 25",
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

/// The known peaks come from another code, whose models have 25 fixed-interface modes where their number is on record
/// (tests/data/*/reference). They are met to 0.5 % with as many, but for two sets with high harmonics on wheel8: there the number
/// of modes decides (1 to 7: 1.278e-4 with 25, 1.251e-4 with 32, 1.244e-4 with 60 and 100; 1 to 15: 1.219e-4 and, with
/// 60, 1.264e-4), and it is not on record for them. What is seen with 25 is their bar: it may not become worse.
///
/// `cargo test --release --test cases full_contact_model -- --ignored --nocapture`
#[test]
#[ignore = "about 2 minutes: the full contact model with sixteen harmonics"]
fn the_full_contact_model_meets_the_tuned_peaks_known_for_it() {
    let mut missed = Vec::new();
    for (name, load, set, known, bar) in [
        ("wheel8", 400.0, vec![1], 1.356e-4, 0.005),
        ("wheel8", 400.0, vec![1, 3, 5, 7], 1.322e-4, 0.005),
        ("wheel8", 400.0, (1..=7).collect(), 1.264e-4, 0.0115),
        ("wheel8", 400.0, (1..=15).collect(), 1.209e-4, 0.0085),
        ("wheel24", 160.0, vec![1], 2.344e-4, 0.005),
        ("wheel24", 160.0, vec![1, 3, 5, 7], 2.379e-4, 0.005),
        ("wheel24", 160.0, (1..=9).collect(), 2.293e-4, 0.005),
        (
            "wheel24",
            160.0,
            (1..=15).collect::<Vec<u32>>(),
            2.306e-4,
            0.005,
        ),
    ] {
        let error = full_model_peak(name, load, &set, 25) / known - 1.0;
        let line = format!("{name}, {load} N, {set:?}: {error:+.5} from {known:e}, bar {bar}");
        println!("{line}");
        if error.abs() > bar {
            missed.push(line);
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}

/// Tuned peak on the whole Craig-Bampton space: so many stick modes are asked for that nothing is left out.
fn full_model_peak(name: &str, load: f64, set: &[u32], fixed_interface_modes: usize) -> f64 {
    let reduction = format!(
        "basis = \"stick_slide\"\nstick_modes = 200\nslide_modes = 1\ncraig_bampton_modes = {fixed_interface_modes}"
    );
    let solver = format!("harmonics = {set:?}\nsamples_per_period = 512");
    let case = Case::new(wheel(name, &format!("{load:?}"), &reduction, &solver));
    let contact = ContactCondition::Full {
        normal_load_n: load,
    };
    case.tuned(contact).amplitude_m.unwrap()
}

/// A peak of the program at its default settings beside the truth.
struct Compared {
    line: String,
    within: bool,
}

/// A study at its default settings, and the full contact model of it with harmonics and fixed-interface
/// modes that change its peaks by less than 0.1 % when raised by half.
struct Truth<'a> {
    study: &'a Study,
    harmonics: &'a [u32],
    fixed_interface_modes: usize,
}

impl Truth<'_> {
    /// Compares the tuned peak and those of `patterns` at every load.
    fn compare(&self, loads: &[f64], patterns: &[u32]) -> Vec<Compared> {
        let default = Case::new(self.study.clone());
        let mut study = self.study.clone();
        study.reduction.craig_bampton_modes = Some(self.fixed_interface_modes);
        let sector = load_sector_model(&study).unwrap();
        let full = FullModel::build(&study, &sector, &FullSettings::default()).unwrap();
        let settings = full.settings(self.harmonics).unwrap();
        let deviation = study.standard_deviations[0];
        let facts = default.reduction();
        let of_model = |key: &str| facts[key].as_f64();
        let basis = facts["tuned_peak_errors"]
            .as_array()
            .unwrap()
            .last()
            .unwrap()["error"]
            .as_f64();
        let mut compared = Vec::new();
        for (place, &normal_load_n) in loads.iter().enumerate() {
            let contact = ContactCondition::Full { normal_load_n };
            let scenario = default.scenario(contact);
            let row = FullRow {
                scenario: &scenario,
                pattern: None,
                settings: &settings,
                tuned_hz: None,
                expected_hz: None,
            };
            let truth = full.peak(row);
            let tuned = default.tuned(contact);
            let of_scenario = ScenarioError {
                basis: basis.unwrap() + of_model("craig_bampton_error").unwrap(),
                harmonics: chosen(&default, place).1,
            };
            let errors = tuned.errors.unwrap();
            let stated = stated_error(
                &errors,
                &of_scenario,
                HARMONIC_SAFETY,
                study.solver.peak_tolerance,
            );
            let name = format!(
                "{} {normal_load_n} N, {} modes",
                study.name, facts["craig_bampton_modes"]
            );
            compared.push(Compared::new(
                &format!("{name}, tuned, {}", tuned.harmonics),
                tuned.amplitude_m.unwrap() / truth.amplitude_m.unwrap() - 1.0,
                stated,
            ));
            for &id in patterns {
                let pattern = default.pattern(id, deviation);
                let own = default.row(&pattern, contact, &tuned);
                let truth = full.peak(FullRow {
                    pattern: Some(&pattern),
                    tuned_hz: truth.frequency_hz,
                    ..row
                });
                compared.push(Compared::new(
                    &format!(
                        "{name}, pattern {id}, {}, separated {:?}",
                        own.harmonics, own.separated_fraction
                    ),
                    own.peak_amplitude_m.unwrap() / truth.amplitude_m.unwrap() - 1.0,
                    own.stated_error.unwrap(),
                ));
            }
        }
        compared
    }
}

impl Compared {
    fn new(name: &str, error: f64, stated: f64) -> Self {
        let line = format!(
            "{name}: error {:+.3} %, stated {:.3} %",
            100.0 * error,
            100.0 * stated
        );
        println!("{line}");
        Self {
            line,
            within: error.abs() <= stated,
        }
    }
}

/// At least 95 % of the figures lie within the error stated with them.
fn assert_covered(compared: &[Compared]) {
    let outside: Vec<&str> = compared
        .iter()
        .filter(|own| !own.within)
        .map(|own| own.line.as_str())
        .collect();
    println!(
        "{} of {} within",
        compared.len() - outside.len(),
        compared.len()
    );
    assert!(20 * outside.len() <= compared.len(), "{outside:?}");
}

fn default_wheel(name: &str, loads: &[f64]) -> Study {
    let loads: Vec<String> = loads.iter().map(f64::to_string).collect();
    let mut study = wheel(name, &loads.join(", "), "", "");
    name.clone_into(&mut study.name);
    study
}

fn default_model(loads: &[f64]) -> Study {
    let mut study = Study::read(&package("studies/quickstart.toml")).unwrap();
    study.reduction = ReductionOptions::default();
    study.solver = SolverOptions::default();
    study.contacts = loads
        .iter()
        .map(|&normal_load_n| ContactCondition::Full { normal_load_n })
        .collect();
    study
}

const ALL: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// `cargo test --release --test cases stated_errors -- --ignored --nocapture`
#[test]
#[ignore = "half a minute: the choice of harmonics with 57 fixed-interface modes"]
fn default_settings_state_what_fixed_interface_modes_and_harmonics_leave_out() {
    // With 25 modes the tuned peak at 400 N is 3.7 % off, harmonics 0 to 15 and 86 modes beside it.
    let loads = [400.0];
    let compared = Truth {
        study: &default_wheel("wheel8", &loads),
        harmonics: &ALL,
        fixed_interface_modes: 86,
    }
    .compare(&loads, &[]);
    assert!(compared.iter().all(|own| own.within));
}

#[test]
fn fixed_interface_modes_follow_the_tuned_peak_and_a_fixed_number_states_what_it_leaves_out() {
    let facts = |modes: &str| {
        let reduction =
            format!("basis = \"stick_slide\"\nstick_modes = 6\nslide_modes = 6\n{modes}");
        Case::new(wheel("wheel8", "400", &reduction, "harmonics = [1]")).reduction()
    };
    // Harmonics 0 to 15: 1.2192e-4 m with 25 modes, 1.2641e-4 with 57, 1.2662e-4 with 130.
    let fixed = facts("craig_bampton_modes = 25");
    let error = fixed["craig_bampton_error"].as_f64().unwrap();
    assert!((0.03..0.045).contains(&error), "{error}");
    let chosen = facts("");
    assert_eq!(chosen["craig_bampton_modes"], 57, "{chosen}");
    let error = chosen["craig_bampton_error"].as_f64().unwrap();
    assert!((5e-4..3e-3).contains(&error), "{error}");
}

/// Tuned figures at many loads, light ones with separation included.
///
/// `cargo test --release --test cases stated_errors -- --ignored --nocapture`
#[test]
#[ignore = "minutes: three wheels at default settings"]
fn default_settings_are_within_the_stated_error_of_tuned_wheels() {
    let mut compared = Vec::new();
    for (name, loads) in [
        (
            "wheel8",
            &[100.0, 200.0, 300.0, 400.0, 600.0, 800.0, 1600.0, 3200.0][..],
        ),
        ("wheel24", &[160.0, 240.0, 320.0, 640.0, 1280.0, 2560.0]),
    ] {
        let truth = Truth {
            study: &default_wheel(name, loads),
            harmonics: &ALL,
            fixed_interface_modes: 86,
        };
        compared.extend(truth.compare(loads, &[]));
    }
    let loads = [240.0, 320.0, 480.0, 800.0, 1600.0, 4000.0];
    let truth = Truth {
        study: &default_model(&loads),
        harmonics: &ALL,
        fixed_interface_modes: 57,
    };
    compared.extend(truth.compare(&loads, &[]));
    assert_covered(&compared);
}
