//! The studies of the built-in dampers in `studies/`, as a user runs them: every row is found, and the curve over the load is U-shaped.

use blisk::response::harmonic_balance::Status;
use blisk::study::Study;

use super::support::{Case, package};

/// Wheels of each study that are solved.
const WHEELS: u32 = 3;

/// The tuned peak and that of some wheels under every condition of a study, in its order, the linear limits at both ends.
fn assert_u_shaped(name: &str) {
    let study = Study::read(&package(&format!("studies/{name}.toml"))).unwrap();
    let conditions = study.contacts.clone();
    let standard_deviation = study.standard_deviations[0];
    let case = Case::new(study);
    let tuned: Vec<_> = conditions.iter().map(|&own| case.tuned(own)).collect();
    let mut curves: Vec<Vec<f64>> =
        vec![tuned.iter().map(|own| own.amplitude_m.unwrap()).collect()];
    for id in 0..WHEELS {
        let pattern = case.pattern(id, standard_deviation);
        let row = |(&condition, tuned)| {
            let row = case.row(&pattern, condition, tuned);
            assert_eq!(row.status, Status::Ok, "{name} {id} {condition:?}");
            row.peak_amplitude_m.unwrap()
        };
        curves.push(conditions.iter().zip(&tuned).map(row).collect());
    }
    for (wheel, curve) in curves.iter().enumerate() {
        let micrometres: Vec<String> = curve.iter().map(|a| format!("{:.1}", 1e6 * a)).collect();
        println!("{name} {wheel}: {}", micrometres.join(" "));
        let places = 0..curve.len();
        let at = places
            .min_by(|&a, &b| curve[a].total_cmp(&curve[b]))
            .unwrap();
        let falls = curve[..=at].windows(2).all(|own| own[1] < own[0]);
        let rises = curve[at..].windows(2).all(|own| own[1] > own[0]);
        assert!(falls && rises, "{name} {wheel}: {curve:?}");
        assert!(at > 0 && at + 1 < curve.len(), "{name} {wheel}: {curve:?}");
    }
}

/// `cargo test --release --test cases default_dampers -- --ignored --nocapture`
#[test]
#[ignore = "about 1 minute: the study of blades on the ground"]
fn blades_on_the_ground_have_a_best_load() {
    assert_u_shaped("blade-to-ground");
}

#[test]
#[ignore = "about 4 minutes: the study of shrouds"]
fn shrouds_have_a_best_load() {
    assert_u_shaped("shroud");
}

#[test]
#[ignore = "minutes: the study of wedges"]
fn wedges_have_a_best_load() {
    assert_u_shaped("underplatform");
}
