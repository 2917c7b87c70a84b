//! Campbell table by hand: masses and springs, aliasing, and frequencies that follow the speed.

use std::f64::consts::TAU;
use std::path::Path;

use blisk::campaign::{CampbellRequest, campbell};
use blisk::model::sector::{LumpedOptions, SectorModel, lumped};
use blisk::report::CampbellReport;
use blisk::study::{Study, load_sector_model};

use crate::sector_sources::lumped::one_dof;

const SECTORS: usize = 6;

const STUDY: &str = r#"schema = 1
[study]
name = "campbell"
seed = 7
patterns = 2
[model]
source = "lumped"
[model.lumped]
sectors = 6
blade_mass_kg = 0.25
blade_stiffness_n_per_m = 2.5e6
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [2]
[mistuning]
distribution = { kind = "normal", standard_deviation = 0.03 }
[sweep]
normal_load_n = ["free"]
"#;

const CONTACT: &str = r"[contact]
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 8.0e5
normal_stiffness_n_per_m = 8.0e5
";

fn study(text: &str) -> Study {
    Study::parse(Path::new("study.toml"), text).unwrap()
}

fn table(
    models: &[(Option<f64>, SectorModel)],
    engine_orders: &[u32],
    range_rpm: Option<[f64; 2]>,
) -> CampbellReport {
    campbell(&CampbellRequest {
        study: &study(STUDY),
        models,
        engine_orders,
        modes: 3,
        range_rpm,
    })
    .unwrap()
}

/// Frequency of nodal diameter h of a chain of blades, Hz.
fn frequency_hz(options: &LumpedOptions, h: usize) -> f64 {
    let turn = TAU * h as f64 / SECTORS as f64;
    let stiffness = options.blade_stiffness_n_per_m
        + 2.0 * options.blade_coupling_stiffness_n_per_m * (1.0 - turn.cos());
    (stiffness / options.blade_mass_kg).sqrt() / TAU
}

#[track_caller]
fn assert_close(found: f64, expected: f64) {
    assert!(
        (found / expected - 1.0).abs() < 1e-9,
        "{found} and {expected}"
    );
}

#[test]
fn every_engine_order_crosses_the_nodal_diameter_that_it_aliases_to() {
    let options = one_dof(SECTORS);
    let models = [(None, lumped::build(&options).unwrap())];
    let report = table(&models, &[1, 2, 3, 4, 5, 6, 7, 11], None);
    assert_eq!(report.modes.len(), 4);
    let expected = [
        (1, 1, false),
        (2, 2, false),
        (3, 3, false),
        (4, 2, true),
        (5, 1, true),
        (6, 0, false),
        (7, 1, false),
        (11, 1, true),
    ];
    assert_eq!(report.crossings.len(), expected.len());
    for (found, (order, h, backward)) in report.crossings.iter().zip(expected) {
        assert_eq!(
            (found.engine_order, found.nodal_diameter, found.backward),
            (order, h, backward)
        );
        let hz = frequency_hz(&options, h);
        assert_close(found.frequency_hz, hz);
        assert_close(found.speed_rpm, 60.0 * hz / f64::from(order));
        assert!(!found.extrapolated);
    }
}

/// The chain with blades that get stiffer by 0.25 m Omega^2.
fn spun(rpm: f64) -> SectorModel {
    let mut options = one_dof(SECTORS);
    let omega = TAU * rpm / 60.0;
    options.blade_stiffness_n_per_m += 0.25 * options.blade_mass_kg * omega * omega;
    lumped::build(&options).unwrap()
}

#[test]
fn between_models_the_square_of_the_frequency_follows_that_of_the_speed() {
    let rest = frequency_hz(&one_dof(SECTORS), 2);
    // f^2 = f_0^2 + 0.25 n^2 = EO^2 n^2.
    let expected = |order: f64| 60.0 * rest / (order * order - 0.25).sqrt();
    for speeds in [
        vec![0.0, 9000.0],
        vec![0.0, 8000.0, 20_000.0, 60_000.0],
        vec![3000.0, 12_000.0],
    ] {
        let models: Vec<_> = speeds.iter().map(|&rpm| (Some(rpm), spun(rpm))).collect();
        let report = table(&models, &[2, 4, 8], None);
        assert_eq!(report.crossings.len(), 3, "{report}");
        let (first, last) = (speeds[0], speeds[speeds.len() - 1]);
        for (crossing, order) in report.crossings.iter().zip([2.0, 4.0, 8.0]) {
            let rpm = expected(order);
            assert_close(crossing.speed_rpm, rpm);
            assert_close(crossing.frequency_hz, order * rpm / 60.0);
            assert_eq!(crossing.extrapolated, rpm < first || rpm > last);
        }
    }
}

#[test]
fn a_range_of_speeds_leaves_the_others_out() {
    let options = one_dof(SECTORS);
    let models = [(None, lumped::build(&options).unwrap())];
    let at = 60.0 * frequency_hz(&options, 2) / 4.0;
    let report = table(&models, &[2, 4, 8], Some([0.9 * at, 1.1 * at]));
    let crossings = report.crossings.iter();
    let orders: Vec<u32> = crossings.map(|crossing| crossing.engine_order).collect();
    assert_eq!(orders, [4]);
}

#[test]
fn frequencies_are_those_with_stuck_and_with_sliding_contact() {
    let text = STUDY
        .replace(
            "blade_mass_kg",
            "disk_mass_kg = 1.0\nring_mass_kg = 0.03\ndisk_ground_stiffness_n_per_m = 7e6\nblade_mass_kg",
        )
        .replace("[damping]", &format!("{CONTACT}[damping]"));
    let study = study(&text);
    let models = [(None, load_sector_model(&study).unwrap())];
    let report = campbell(&CampbellRequest {
        study: &study,
        models: &models,
        engine_orders: &[],
        modes: 3,
        range_rpm: None,
    })
    .unwrap();
    // The eigenvalues of a nodal diameter sum up to the trace of M^-1 K.
    let sum = |contact: &str| -> f64 {
        let modes = report.modes.iter();
        modes
            .filter(|mode| mode.contact == contact && mode.nodal_diameter == 0)
            .map(|mode| (TAU * mode.frequency_hz[0]).powi(2))
            .sum()
    };
    let (blade, ground, contact) = (2.5e6, 7e6, 8e5);
    let slide = blade / 0.25 + (blade + ground) / 1.0;
    assert!((sum("slide") / slide - 1.0).abs() < 1e-6);
    let stuck = slide + contact / 1.0 + contact / 0.03;
    assert!((sum("stuck") / stuck - 1.0).abs() < 1e-9);
    // Two modes of blade and disk, and with contact that of the ring, which is nowhere without.
    let orders = report
        .crossings
        .iter()
        .map(|crossing| crossing.engine_order);
    assert!(orders.clone().all(|order| order == 2), "{report}");
    let of = |contact: &str| {
        let crossings = report.crossings.iter();
        crossings
            .filter(|crossing| crossing.contact == contact && crossing.frequency_hz > 1.0)
            .count()
    };
    assert_eq!((of("stuck"), of("slide")), (3, 2), "{report}");
}
