//! A lumped wheel stated three ways: by keys of a study, as a bundle, and as files of a finite-element code.

use std::fs;
use std::path::Path;

use blisk::model::reduction::BasisChoice;
use blisk::model::sector::import::import;
use blisk::model::sector::{Body, SectorModel, bundle};
use blisk::population::monte_carlo::ResponseRow;
use blisk::response::forced_response::SolverOptions;
use blisk::response::friction::{ContactLaw, PairParameters};
use blisk::response::harmonic_balance::{Damping, Status};
use blisk::study::{Study, load_sector_model};

use super::cartesian::CartesianMatrix;
use super::small::Small;
use super::writers;
use crate::extremes::wheels::{under, uneven};
use crate::wheels::{Wheel, full, pattern, relative};

const SECTORS: usize = 6;
/// Blade, disk and wedge, and the disk of the next sector: the order of the masses, and of the nodes of the mesh from 1.
const STUDY: &str = r#"schema = 1
[study]
name = "wedge"
seed = 1
patterns = 1
[model]
source = "lumped"
[model.lumped]
sectors = 6
force = "blade"
mass = [
    { name = "blade", mass_kg = 0.25 },
    { name = "disk", mass_kg = 1.0 },
    { name = "wedge", mass_kg = 0.01, body = "damper" },
]
spring = [
    { between = ["blade", "disk"], stiffness_n_per_m = 2.5e6, mistuned = true },
    { between = ["disk", "ground"], stiffness_n_per_m = 7e6 },
    { between = ["disk", "next.disk"], stiffness_n_per_m = 1e6 },
    { between = ["wedge", "ground"], stiffness_n_per_m = 1e3 },
]
contact = [{ between = ["blade", "wedge"] }, { between = ["next.blade", "wedge"] }]
[contact]
law = "macro_slip_1d"
friction_coefficient = 0.3
tangential_stiffness_n_per_m = 4e5
[damping]
structural_loss_factor = 0.002
[excitation]
engine_orders = [2]
amplitude_n = 10.0
[mistuning]
distribution = { kind = "normal", standard_deviation = 0.01 }
[sweep]
normal_load_n = [30]
"#;

/// The mesh has no elements, every node moves along the axis alone, and the wedge lies where the masses of a study do: between
/// both blades, neither of which it touches in space.
const IMPORT: &str = r#"code = "calculix"
matrix_format = "matrix_market"
name = "lumped"
sectors = 6
[blisk]
mesh = "mesh"
stiffness = "K.mtx"
mass = "M.mtx"
dofs = "dofs.csv"
blade_stiffness = "blade.mtx"
blade_dofs = "blade.csv"
low_face = "DISK"
high_face = "DISK_HIGH"
[damper]
set = "WEDGE"
[[contact]]
first = "blisk.BLADE"
second = "damper.WEDGE"
normal = [0, 1, 0]
tolerance_m = 2.0
[[contact]]
first = "next.blisk.BLADE"
second = "damper.WEDGE"
normal = [0, -1, 0]
tolerance_m = 2.0
[[force]]
set = "BLADE"
component = "z"
[[observe]]
name = "blade"
set = "BLADE"
"#;

/// Springs between nodes from 1, or a node and the ground, along the axis; nodes that none touches have no row.
fn matrix(nodes: &[usize], springs: &[(usize, Option<usize>, f64)]) -> CartesianMatrix {
    let place = |node: usize| nodes.iter().position(|&own| own == node).unwrap();
    let mut sums = std::collections::BTreeMap::new();
    for &(a, b, stiffness) in springs {
        *sums.entry((place(a), place(a))).or_insert(0.0) += stiffness;
        if let Some(b) = b {
            *sums.entry((place(b), place(b))).or_insert(0.0) += stiffness;
            let (low, high) = (place(a).min(place(b)), place(a).max(place(b)));
            *sums.entry((low, high)).or_insert(0.0) -= stiffness;
        }
    }
    CartesianMatrix {
        rows: nodes.iter().map(|&node| (node, 2)).collect(),
        lower: sums
            .into_iter()
            .map(|((low, high), value)| (high, low, value))
            .collect(),
    }
}

/// The wheel as files of a finite-element code.
fn write_files(folder: &Path) {
    let stiffness = matrix(
        &[1, 2, 3, 4],
        &[
            (1, Some(2), 2.5e6),
            (2, None, 7e6),
            (2, Some(4), 1e6),
            (3, None, 1e3),
        ],
    );
    let mass = matrix(
        &[1, 2, 3, 4],
        &[(1, None, 0.25), (2, None, 1.0), (3, None, 0.01)],
    );
    let blade = matrix(&[1, 2], &[(1, Some(2), 2.5e6)]);
    writers::matrix_market_run(folder, &stiffness, &mass, &blade);
    let (sin, cos) = (std::f64::consts::TAU / SECTORS as f64).sin_cos();
    let nodes = [
        (1, [1.0, 0.0, 0.0]),
        (2, [1.0, 0.0, 0.1]),
        (3, [1.0, 0.0, 0.2]),
        (4, [cos, sin, 0.1]),
    ];
    let sets = [
        ("BLADE", vec![1]),
        ("DISK", vec![2]),
        ("WEDGE", vec![3]),
        ("DISK_HIGH", vec![4]),
    ];
    let mesh = writers::calculix_deck(&nodes.into(), &sets);
    fs::write(folder.join("mesh"), mesh).unwrap();
    fs::write(folder.join("import.toml"), IMPORT).unwrap();
}

/// The same files in memory.
pub fn wedge() -> Small {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let names = [
        "import.toml",
        "mesh",
        "K.mtx",
        "M.mtx",
        "blade.mtx",
        "dofs.csv",
        "blade.csv",
    ];
    let read = |name| (name, fs::read_to_string(folder.path().join(name)).unwrap());
    Small {
        files: names.map(read).to_vec(),
    }
}

fn row(sector: &SectorModel, load_n: f64) -> ResponseRow {
    row_under(ContactLaw::MacroSlip1d, sector, load_n)
}

fn row_under(law: ContactLaw, sector: &SectorModel, load_n: f64) -> ResponseRow {
    let contact = PairParameters {
        normal_load_n: 0.0,
        normal_stiffness_n_per_m: if law.has_variable_load() { 8e5 } else { 0.0 },
        tangential_stiffness_n_per_m: 4e5,
        friction_coefficient: 0.3,
    };
    let damping = Damping::Rayleigh {
        mass_per_s: 0.0,
        stiffness_s: 6e-6,
    };
    let mut wheel = Wheel::of(sector, law, contact, damping, BasisChoice::CraigBampton);
    wheel.amplitude_n = 10.0;
    let settings = SolverOptions {
        samples_per_period: 768,
        peak_tolerance: 1e-6,
        residual_tolerance: 1e-9,
        ..SolverOptions::default()
    };
    let solver = wheel.solver(&[1, 3, 5, 7, 9, 11, 13, 15], settings);
    let scenario = under(2, full(load_n));
    let tuned = solver.tuned(&scenario);
    let mut rows = solver.rows(&pattern(&uneven(SECTORS, 0.03)), &[(&scenario, &tuned)]);
    let row = rows.remove(0);
    assert_eq!(row.status, Status::Ok);
    row
}

/// Nodes that are held along the normal have no motion that could change the load: laws with a variable one come to
/// that with a constant one.
#[test]
fn nodes_with_tangential_components_alone_have_a_constant_normal_load() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let imported = import(&folder.path().join("import.toml")).unwrap();
    let contact = imported.report.contact.as_ref().unwrap();
    assert_eq!(contact.constant_load_pairs, Some(2));
    let text = imported.report.to_string();
    assert!(
        text.contains("2 pairs have no displacement along their normal"),
        "{text}"
    );
    for load_n in [5.0, 30.0, 100.0] {
        let expected = row(&imported.model, load_n);
        assert!(expected.slipping_fraction.unwrap() > 0.0);
        for law in [ContactLaw::Simplified3d, ContactLaw::Coulomb3d] {
            let found = row_under(law, &imported.model, load_n);
            let error = relative(
                found.peak_amplitude_m.unwrap(),
                expected.peak_amplitude_m.unwrap(),
            );
            // The peak search is to 1e-6; coulomb_3d is marched over 768 samples.
            assert!(error < 2e-4, "{law:?} at {load_n} N: {error:e}");
            assert!(found.separated_fraction.is_none_or(|share| share == 0.0));
        }
    }
    // Along the normal they move: no such remark.
    let path = folder.path().join("import.toml");
    let axial = IMPORT
        .replace("[0, 1, 0]", "[0, 1, 1]")
        .replace("[0, -1, 0]", "[0, -1, 1]");
    fs::write(&path, axial).unwrap();
    let imported = import(&path).unwrap();
    let contact = imported.report.contact.as_ref().unwrap();
    assert_eq!(contact.constant_load_pairs, None);
    assert_eq!(contact.pairs_without_friction, None);
}

/// Along the normal alone there is nothing to rub: the import says so of every such pair.
#[test]
fn nodes_that_move_along_the_normal_alone_have_no_friction() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let path = folder.path().join("import.toml");
    // The first contact alone: its nodes move along z.
    for (normal, expected) in [("[0, 0, 1]", Some(1)), ("[0, 1e-5, 1]", None)] {
        let along = IMPORT.replacen("[0, 1, 0]", normal, 1);
        assert_ne!(along, IMPORT);
        fs::write(&path, along).unwrap();
        let imported = import(&path).unwrap();
        let contact = imported.report.contact.as_ref().unwrap();
        assert_eq!(contact.pairs_without_friction, expected, "{normal}");
        assert_eq!(contact.constant_load_pairs, Some(1));
        let text = imported.report.to_string();
        let said = "1 pairs have no displacement across their normal";
        assert_eq!(text.contains(said), expected.is_some(), "{text}");
    }
}

#[test]
fn a_lumped_wheel_is_the_same_by_keys_as_a_bundle_and_as_an_import() {
    let study = Study::parse(Path::new("study.toml"), STUDY).unwrap();
    let by_keys = load_sector_model(&study).unwrap();
    let folder = tempfile::tempdir().unwrap();
    bundle::write(&by_keys, &folder.path().join("bundle")).unwrap();
    let as_bundle = bundle::read(&folder.path().join("bundle")).unwrap();
    write_files(folder.path());
    let imported = import(&folder.path().join("import.toml")).unwrap();
    assert_eq!(imported.report.bodies[1].body, "damper");
    assert_eq!(imported.report.contact.as_ref().unwrap().surfaces.len(), 2);
    assert!(
        imported
            .model
            .dofs
            .iter()
            .any(|dof| dof.body == Body::Damper)
    );
    bundle::write(&imported.model, &folder.path().join("imported")).unwrap();
    let as_import = bundle::read(&folder.path().join("imported")).unwrap();
    assert_eq!(as_import, imported.model);
    for load_n in [5.0, 30.0, 100.0] {
        let expected = row(&by_keys, load_n);
        let slipping = expected.slipping_fraction.unwrap();
        println!(
            "{load_n} N: {:.6e} m, slipping {slipping:.2}",
            expected.peak_amplitude_m.unwrap()
        );
        assert!(slipping > 0.0);
        for (name, model) in [("bundle", &as_bundle), ("import", &as_import)] {
            let found = row(model, load_n);
            for (value, other) in [
                (found.peak_amplitude_m, expected.peak_amplitude_m),
                (found.peak_frequency_hz, expected.peak_frequency_hz),
            ] {
                let error = relative(value.unwrap(), other.unwrap());
                println!("  {name}: {error:.1e}");
                assert!(error < 1e-9, "{name}, {load_n} N: {error:e}");
            }
            assert_eq!(found.peak_blade, expected.peak_blade, "{name}, {load_n} N");
        }
    }
}
