//! The programs of `examples/`, each run, with what it prints held against something else.

use std::process::Command;

use blisk::sector::Complex64;

#[allow(dead_code)] // Its `main`, which cargo compiles as a program.
#[path = "../../examples/measured_wheel.rs"]
mod measured_wheel;
#[allow(dead_code)]
#[path = "../../examples/own_matrices.rs"]
mod own_matrices;
#[allow(dead_code)]
#[path = "../../examples/progress.rs"]
mod progress;

/// The numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    let parts = line.split([' ', ':', ',']);
    parts.filter_map(|part| part.parse().ok()).collect()
}

fn assert_close(found: f64, expected: f64, tolerance: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error <= tolerance, "{found} is not {expected}: {error:e}");
}

/// Solves `a x = b` by elimination with exchange of rows.
fn solved(mut a: Vec<Vec<Complex64>>, mut b: Vec<Complex64>) -> Vec<Complex64> {
    let n = b.len();
    for column in 0..n {
        let largest = |row: &usize| (a[*row][column].norm() * 1e12) as u64;
        let pivot = (column..n).max_by_key(largest).unwrap();
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..n {
            let factor = a[row][column] / a[column][column];
            let (above, below) = a.split_at_mut(row);
            for (value, own) in below[0].iter_mut().zip(&above[column]).skip(column) {
                *value -= factor * own;
            }
            b[row] = b[row] - factor * b[column];
        }
    }
    for row in (0..n).rev() {
        let known: Complex64 = (row + 1..n).map(|other| a[row][other] * b[other]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    b
}

/// Largest amplitude, m, and its frequency, Hz, of the chain of `own_matrices` with every third blade 4 % stiffer.
fn peak_of_chain() -> (f64, f64) {
    let (sectors, mass, blade, coupling) = (12, 0.05, 5.0e5, 4.0e4);
    let lossy = Complex64::new(1.0, 0.002);
    let mut peak = (0.0, 0.0);
    for step in 0..6000 {
        let hz = 495.0 + 0.02 * f64::from(step);
        let omega = std::f64::consts::TAU * hz;
        let mut a = vec![vec![Complex64::new(0.0, 0.0); sectors]; sectors];
        for n in 0..sectors {
            let stiffer = if n % 3 == 0 { 0.04 } else { 0.0 };
            a[n][n] += lossy * (blade * (1.0 + stiffer) + 2.0 * coupling) - mass * omega * omega;
            a[n][(n + 1) % sectors] -= lossy * coupling;
            a[(n + 1) % sectors][n] -= lossy * coupling;
        }
        let phase = |n: usize| Complex64::cis(2.0 * std::f64::consts::TAU * n as f64 / 12.0);
        let x = solved(a, (0..sectors).map(phase).collect());
        let largest = x.iter().map(|own| own.norm()).fold(0.0, f64::max);
        if largest > peak.0 {
            peak = (largest, hz);
        }
    }
    peak
}

#[test]
fn own_matrices_give_the_closed_form_and_the_solution_in_physical_coordinates() {
    let mut out = Vec::new();
    own_matrices::told(&mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    let lines: Vec<Vec<f64>> = text.lines().map(numbers).collect();
    // Nodal diameter 2 alone answers engine order 2: |x| = F / (eta k_2), k_2 = k + 2 k_c (1 - cos(2 alpha)).
    let stiffness = 5.0e5 + 2.0 * 4.0e4 * (1.0 - (std::f64::consts::TAU / 6.0).cos());
    assert_close(lines[0][0], 1.0 / (0.002 * stiffness), 1e-3);
    let (peak_m, hz) = peak_of_chain();
    assert_close(lines[1][0], peak_m, 2e-3);
    assert!(
        (lines[1][1] - hz).abs() < 0.1,
        "{} Hz is not {hz} Hz",
        lines[1][1]
    );
    // The 95th percentile is above 1, and below what no wheel of 12 blades exceeds (Whitehead 1966).
    let &[_, _, lower, upper] = &lines[2][lines[2].len() - 4..] else {
        panic!("{text}");
    };
    assert!(
        1.0 < lower && lower < upper && upper < 0.5 * (1.0 + 12.0_f64.sqrt()),
        "{text}"
    );
}

/// The study file that says what `measured_wheel` does.
fn study_of_measured_wheel() -> String {
    let loads: Vec<String> = measured_wheel::LOADS_N.iter().map(f64::to_string).collect();
    format!(
        "schema = 1\n\
         study = {{ name = \"measured\", seed = 0 }}\n\
         mistuning = {{ file = \"wheel.csv\" }}\n\
         sweep = {{ normal_load_n = [{}] }}\n\
         excitation = {{ engine_orders = [3], amplitude_n = 10.0 }}\n\
         damping = {{ structural_loss_factor = 0.002 }}\n\
         solver = {{ harmonics = [1, 3] }}\n\
         [contact]\n\
         law = \"macro_slip_1d\"\n\
         friction_coefficient = 0.3\n\
         tangential_stiffness_n_per_m = 8.0e5\n\
         [model]\n\
         source = \"lumped\"\n\
         [model.lumped]\n\
         sectors = 8\n\
         blade_mass_kg = 0.25\n\
         disk_mass_kg = 1.0\n\
         ring_mass_kg = 0.03\n\
         blade_stiffness_n_per_m = 2.5e6\n\
         disk_ground_stiffness_n_per_m = 7.0e6\n\
         disk_coupling_stiffness_n_per_m = 2.5e5\n\
         ring_coupling_stiffness_n_per_m = 8.0e5\n\
         ring_disk_stiffness_n_per_m = 1.0e4\n",
        loads.join(", ")
    )
}

/// Output of the command line.
fn command(folder: &std::path::Path, arguments: &[&str]) -> String {
    let mut blisk = Command::new(env!("CARGO_BIN_EXE_blisk"));
    let ended = blisk.current_dir(folder).args(arguments).output().unwrap();
    let message = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success(), "{arguments:?}: {message}");
    String::from_utf8(ended.stdout).unwrap()
}

#[test]
fn a_measured_wheel_has_the_peaks_of_the_command_line() {
    let mut out = Vec::new();
    measured_wheel::told(&mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    let place = tempfile::tempdir().unwrap();
    let entry = |(blade, deviation): (usize, f64)| format!("0,{blade},{deviation}\n");
    let lines: Vec<String> = measured_wheel::deviations()
        .into_iter()
        .enumerate()
        .map(entry)
        .collect();
    let wheel = format!("pattern,blade,deviation\n{}", lines.concat());
    std::fs::write(place.path().join("wheel.csv"), wheel).unwrap();
    std::fs::write(place.path().join("study.toml"), study_of_measured_wheel()).unwrap();
    command(place.path(), &["run", "study.toml", "--out", "results"]);
    assert_eq!(
        text.lines().count(),
        measured_wheel::LOADS_N.len(),
        "{text}"
    );
    for (scenario, line) in text.lines().enumerate() {
        let number = scenario.to_string();
        let arguments = [
            "replay",
            "results",
            "--scenario",
            &number,
            "--pattern",
            "0",
            "--json",
        ];
        let replay: serde_json::Value =
            serde_json::from_str(&command(place.path(), &arguments)).unwrap();
        let stored = &replay["delivered"];
        let found = numbers(line);
        assert_close(found[1], stored["peak_amplitude_m"].as_f64().unwrap(), 1e-6);
        assert_close(
            found[2],
            stored["amplification_factor"].as_f64().unwrap(),
            1e-4,
        );
    }
}

#[test]
fn a_listener_hears_of_every_row_and_the_tables_are_those_of_the_command_line() {
    let study = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/readers/small.toml");
    let place = tempfile::tempdir().unwrap();
    let mut out = Vec::new();
    progress::told(&study, &place.path().join("library"), &mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    // 12 patterns under 3 contact conditions.
    for line in [
        "solving rows",
        "36 of 36 rows",
        "writing tables",
        "36 rows solved",
    ] {
        assert!(
            text.lines().any(|own| own == line),
            "no line {line:?} in {text}"
        );
    }
    command(
        place.path(),
        &["run", study.to_str().unwrap(), "--out", "command"],
    );
    for table in ["responses.parquet", "scenarios.parquet", "summary.txt"] {
        let read = |folder: &str| std::fs::read(place.path().join(folder).join(table)).unwrap();
        assert_eq!(read("library"), read("command"), "{table}");
    }
}
