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

#[test]
#[ignore = "experiment"]
fn experiment() {
    let var = |name: &str, default: &str| std::env::var(name).unwrap_or(default.to_owned());
    let name = var("W", "wheel8");
    let loads = var("L", "400");
    let begin = std::time::Instant::now();
    let study = if name == "lumped24" {
        let mut study = Study::read(&package("studies/lumped24.toml")).unwrap();
        study.solver.harmonics = Harmonics::Auto;
        study.contacts = loads
            .split(',')
            .map(|l| ContactCondition::Full {
                normal_load_n: l.parse().unwrap(),
            })
            .collect();
        study
    } else {
        wheel(&name, &loads, &var("R", ""), &var("S", ""))
    };
    let case = Case::new(study);
    println!(
        "{name} built {:.1} s: {}",
        begin.elapsed().as_secs_f64(),
        case.basis()
    );
    println!("{}", serde_json::to_string(&case.chosen()).unwrap());
    for &contact in &case.study.contacts {
        let begin = std::time::Instant::now();
        let tuned = case.tuned(contact);
        println!(
            "{contact:?} tuned {:?} {:?} set {} sep {:?} errors {:?} {:.2} s",
            tuned.status,
            tuned.amplitude_m,
            tuned.harmonics,
            tuned.separated_fraction,
            tuned.errors,
            begin.elapsed().as_secs_f64()
        );
        if std::env::var("P").is_ok() {
            let begin = std::time::Instant::now();
            let id = if name == "lumped24" { 0 } else { 1 };
            let row = case.row(&case.pattern(id, None), contact, &tuned);
            println!(
                "  row {:?} {:?} set {} basis {} sampling {:?} harmonics {:?} stated {:?} within {:?} sep {:?} solves {} its {} {:.2} s",
                row.status,
                row.peak_amplitude_m,
                row.harmonics,
                row.basis,
                row.sampling_error,
                row.harmonic_error,
                row.stated_error,
                row.error_within_tolerance,
                row.separated_fraction,
                row.nonlinear_solves,
                row.newton_iterations,
                begin.elapsed().as_secs_f64()
            );
        }
    }
}
