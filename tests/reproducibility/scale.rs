//! Commands that read finished results, on many rows.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use blisk::study::Study;

use crate::folder::run_in;
use crate::mock_engine::MockSource;

/// A study with friction: one engine order, a standard deviation, five loads; `patterns` wheels.
fn study(patterns: u32) -> String {
    format!(
        "schema = 1
[study]
name = \"large\"
seed = 7
patterns = {patterns}
[model]
source = \"lumped\"
[model.lumped]
sectors = 24
blade_mass_kg = 0.25
disk_mass_kg = 1.0
ring_mass_kg = 0.03
blade_stiffness_n_per_m = 2.5e6
disk_ground_stiffness_n_per_m = 7.0e6
disk_coupling_stiffness_n_per_m = 2.5e5
ring_coupling_stiffness_n_per_m = 8.0e5
ring_disk_stiffness_n_per_m = 1.0e4
[contact]
law = \"macro_slip_1d\"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e5
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [2]
[mistuning]
distribution = {{ kind = \"normal\" }}
[sweep]
normal_load_n = [\"slide\", 50, 100, 200, \"stuck\"]
standard_deviation = [0.03]
[solver]
harmonics = [1]
[output]
patterns = false
"
    )
}

/// Makes results of `patterns` wheels in `folder/out`.
fn results(folder: &Path, patterns: u32) {
    let file = folder.join("study.toml");
    std::fs::write(&file, study(patterns)).expect("written");
    let study = Study::read(&file).expect("a study");
    run_in(&folder.join("out"), &study, 2, &MockSource::default()).expect("a run");
}

/// Time of a command on the results, s, and its peak memory, MiB (0 where the system does not say).
fn measured(folder: &Path, arguments: &[&str]) -> (f64, f64) {
    let began = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_blisk"))
        .args(arguments)
        .current_dir(folder)
        .stdout(Stdio::null())
        .spawn()
        .expect("the binary starts");
    let status = format!("/proc/{}/status", child.id());
    let mut peak_kib = 0.0;
    loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
        peak_kib = f64::max(peak_kib, kib.unwrap_or(0.0));
        if let Some(ended) = child.try_wait().expect("a child") {
            // Some rows of the engine here fail, which costs statistics (5).
            assert!(
                matches!(ended.code(), Some(0 | 5)),
                "{arguments:?}: {ended}"
            );
            return (began.elapsed().as_secs_f64(), peak_kib / 1024.0);
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Every command that reads results, within the bars of `blisk report`, on two processors.
///
/// `cargo test --release --test reproducibility -- --ignored --nocapture a_million_rows`
#[test]
#[ignore = "a million rows: some minutes"]
#[expect(clippy::print_stderr, reason = "a measurement has to be told")]
fn a_report_takes_seconds_on_1e5_rows_and_less_than_a_minute_on_a_million_rows() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (patterns, most_s, most_mib) in [(20_000, 10.0, 400.0), (200_000, 60.0, 1500.0)] {
        results(folder.path(), patterns);
        for line in ["report out", "stats out", "compare out", "status out"] {
            let arguments: Vec<&str> = line.split(' ').collect();
            let (seconds, mib) = measured(folder.path(), &arguments);
            eprintln!(
                "{} rows, blisk {line}: {seconds:.2} s, {mib:.0} MiB",
                5 * patterns
            );
            assert!(seconds <= most_s, "{line}: {seconds} s");
            assert!(mib <= most_mib, "{line}: {mib} MiB");
        }
    }
}
