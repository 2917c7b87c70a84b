//! A wheel of `CalculiX`, at rest and at speed, against its own cyclic symmetry runs.

use std::fs;
use std::path::{Path, PathBuf};

use blisk::model::cyclic::contact_free_frequencies_hz;
use blisk::model::sector::import::{BladeSource, Imported, calculix_equations, import};
use blisk::model::sector::{Body, ModelError};

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/calculix_wheel")
}

/// Imports the wheel of `state` after a change of its import file; paths in it are made absolute.
pub fn import_changed(state: &str, change: impl Fn(String) -> String) -> Imported {
    try_import_changed(state, change).unwrap()
}

pub fn try_import_changed(
    state: &str,
    change: impl Fn(String) -> String,
) -> Result<Imported, ModelError> {
    let text = fs::read_to_string(folder().join(format!("wheel_{state}.toml"))).unwrap();
    let absolute = format!("job = \"{}/", folder().display());
    let text = change(text.replace("job = \"", &absolute));
    let temporary = tempfile::tempdir().unwrap();
    let path = temporary.path().join("import.toml");
    fs::write(&path, text).unwrap();
    import(&path)
}

/// Frequencies by `CalculiX`, Hz, of one nodal diameter, both bodies, ascending; seven digits. Each
/// body has its five lowest: the list ends where one of them does.
fn reference(state: &str, nodal_diameter: usize) -> Vec<f64> {
    let text = fs::read_to_string(folder().join("frequencies.csv")).unwrap();
    let of_body = |body: &str| -> Vec<f64> {
        text.lines()
            .skip(1)
            .map(|line| line.split(',').collect::<Vec<_>>())
            .filter(|row| row[..2] == [state, body] && row[2] == nodal_diameter.to_string())
            .map(|row| row[4].parse().unwrap())
            .collect()
    };
    let (blisk, ring) = (of_body("blisk"), of_body("ring"));
    let end = blisk[blisk.len() - 1].min(ring[ring.len() - 1]);
    let mut frequencies: Vec<f64> = [blisk, ring].concat();
    frequencies.retain(|&hz| hz <= end);
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

#[test]
fn frequencies_agree_with_cyclic_symmetry_runs_at_rest_and_at_speed() {
    for state in ["rest", "speed"] {
        // The grounding of the ring is this program's.
        let imported = import_changed(state, |text| text.replace("grounding_hz = 5.0\n", ""));
        let frequencies = contact_free_frequencies_hz(&imported.model, 10).unwrap();
        assert_eq!(frequencies.len(), 13);
        let (mut worst, mut count) = (0.0_f64, 0);
        for (h, own) in frequencies.iter().enumerate() {
            // Rigid motions of the ring are rounding on both sides.
            let elastic = |hz: &&f64| hz.abs() > 10.0;
            let other = reference(state, h);
            let other: Vec<&f64> = other.iter().filter(elastic).collect();
            let own: Vec<&f64> = own.iter().filter(elastic).take(other.len()).collect();
            assert_eq!(own.len(), other.len());
            for (own, other) in own.iter().zip(&other) {
                worst = worst.max((*own / *other - 1.0).abs());
                count += 1;
            }
        }
        println!("{state}: {count} frequencies, worst relative difference {worst:.1e}");
        assert!(count >= 70, "{count}");
        // 0.01 % is what is promised; the reference has seven digits.
        assert!(worst < 2e-6, "{state}: {worst:e}");
    }
}

#[test]
fn rotation_is_in_the_matrices() {
    let [rest, speed] = ["rest", "speed"].map(|state| import_changed(state, |text| text));
    let lowest = |imported: &Imported, h: usize| {
        let frequencies = contact_free_frequencies_hz(&imported.model, 6).unwrap();
        *frequencies[h].iter().find(|hz| hz.abs() > 10.0).unwrap()
    };
    let change = lowest(&speed, 6) / lowest(&rest, 6) - 1.0;
    assert!(change > 0.005, "stiffening by {change:e}");
    // A ring without springs against translation: lambda = -omega^2 in the rotating frame, and the
    // grounding by (2 pi 5 Hz)^2.
    let hz = contact_free_frequencies_hz(&speed.model, 1).unwrap()[1][0];
    assert!(
        (hz + (100.0_f64.powi(2) - 25.0).sqrt()).abs() < 1e-3,
        "{hz}"
    );
    let facts = |imported: &Imported| {
        let body = &imported.report.bodies[0];
        (body.prestressed, body.rotation_rad_per_s)
    };
    assert_eq!(facts(&rest), (Some(false), None));
    let (prestressed, rotation) = facts(&speed);
    assert_eq!(prestressed, Some(true));
    assert!((rotation.unwrap() * 30.0 / std::f64::consts::PI - 6000.0).abs() < 1e-3);
}

#[test]
fn the_report_tells_how_well_the_parts_meet() {
    let report = import_changed("rest", |text| text).report;
    for body in &report.bodies {
        assert!(body.worst_face_mismatch_m < 1e-12);
    }
    assert_eq!((report.bodies[0].dofs, report.bodies[1].dofs), (288, 48));
    // Ring of plane faces: 7800 kg/m^3 times the area of the polygons in the cylinders.
    let polygons = [6.5_f64, 2.0, 6.5]
        .map(|angle| angle.to_radians().sin())
        .iter()
        .sum::<f64>();
    let mass = 7800.0 * 0.01 * 0.5 * (0.15_f64.powi(2) - 0.144_f64.powi(2)) * polygons;
    assert!(
        (report.bodies[1].mass_kg / mass - 1.0).abs() < 1e-9,
        "{mass}"
    );
    assert!(report.bodies[1].rigid_shift_residual.unwrap() < 1e-12);
    let contact = report.contact.unwrap();
    let chords = [6.5_f64, 2.0, 6.5].map(|angle| 0.3 * (0.5 * angle.to_radians()).sin());
    let area = 0.01 * chords.iter().sum::<f64>();
    assert!(
        (contact.area_m2 / area - 1.0).abs() < 1e-9,
        "{}",
        contact.area_m2
    );
    assert_eq!((contact.pairs, contact.ring_nodes_without_pair), (6, 0));
    assert!(contact.worst_normal_angle_deg < 1e-5);
}

#[test]
fn contact_weights_are_the_areas_round_the_nodes_and_normals_point_into_the_ring() {
    let model = import_changed("rest", |text| text).model;
    let chords = [6.5_f64, 2.0, 6.5].map(|angle| (0.5 * angle.to_radians()).sin());
    // Half of the face on either side of a node, over two rows of nodes; the low face has the high
    // face's share as well.
    let shares = [
        chords[2] + chords[0],
        chords[0] + chords[1],
        chords[1] + chords[2],
    ];
    let total: f64 = shares.iter().sum();
    let angle = |node: usize| {
        let dof = model.dofs.iter().find(|dof| dof.node == node).unwrap();
        dof.position_m[1].atan2(dof.position_m[0]).to_degrees()
    };
    for pair in &model.contact_pairs {
        let at = [0.0, 6.5, 8.5]
            .iter()
            .position(|a: &f64| (a - angle(pair.first.node().unwrap())).abs() < 1e-6);
        let expected = shares[at.unwrap()] / total / 2.0;
        assert!((pair.weight - expected).abs() < 1e-9, "{pair:?}");
        assert!(
            pair.normal[0] < -0.99 && pair.normal[2].abs() < 1e-9,
            "{pair:?}"
        );
    }
}

#[test]
fn a_blade_assembled_here_is_that_of_calculix() {
    let text = |blade: &str| {
        format!(
            "code = \"calculix\"\nname = \"arc\"\nsectors = 24\n[blisk]\njob = \"{0}/arc\"\n\
             low_face = \"RING_LOW\"\nhigh_face = \"RING_HIGH\"\n{blade}\n\
             [[force]]\nset = \"RING_OUTER\"\ncomponent = \"r\"\n[[observe]]\nname = \"x\"\nnode = 2\n",
            folder().display()
        )
    };
    let read = |blade: &str| {
        let temporary = tempfile::tempdir().unwrap();
        let path = temporary.path().join("import.toml");
        fs::write(&path, text(blade)).unwrap();
        import(&path).unwrap()
    };
    let assembled = read("blade_elements = \"middle\"");
    let job = format!("blade_job = \"{}/arc_middle\"", folder().display());
    let stored = read(&job);
    assert_eq!(assembled.report.blade_source, BladeSource::Elements);
    assert_eq!(stored.report.blade_source, BladeSource::Matrices);
    let own: Vec<_> = assembled.model.blade_stiffness.lower_entries().collect();
    let other: std::collections::HashMap<(usize, usize), f64> = stored
        .model
        .blade_stiffness
        .lower_entries()
        .map(|(row, column, value)| ((row, column), value))
        .collect();
    assert_eq!(own.len(), 60 * 61 / 2, "all entries of one brick");
    let diagonal = stored.model.blade_stiffness.diagonal();
    for (row, column, value) in own {
        let difference = value - other.get(&(row, column)).copied().unwrap_or(0.0);
        let scale = (diagonal[row] * diagonal[column]).sqrt();
        assert!(
            difference.abs() < 1e-11 * scale,
            "{row} {column}: {value} {difference}"
        );
    }
}

/// The equations in the folder are those that the runs at speed were made with.
#[test]
fn equations_for_the_static_step_are_those_that_calculix_ran_with() {
    for (body, name) in [(Body::Blisk, "blisk"), (Body::Ring, "ring")] {
        let written = calculix_equations(&folder().join("wheel_rest.toml"), body).unwrap();
        let stored = fs::read_to_string(folder().join(format!("{name}_equations.inc"))).unwrap();
        assert_eq!(written.trim_end(), stored.trim_end());
    }
}
