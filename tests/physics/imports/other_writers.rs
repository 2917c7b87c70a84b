//! Matrix files by the writers of other programs: all hold the same matrices.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use blisk::linalg::SymmetricSparse;
use blisk::model::sector::SectorModel;
use blisk::model::sector::import::import;

use super::cartesian::CartesianMatrix;
use super::writers::{self, Op4};

/// Four nodes: two on each face of an eighth of a wheel, on the planes where x, y and r, theta agree
/// up to a turn by 45 degrees.
fn import_from(keys: &str, blade: &str) -> SectorModel {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/import_formats");
    let folder = tempfile::tempdir().unwrap();
    let half = 0.5_f64.sqrt();
    let nodes = BTreeMap::from([
        (1, [1.0, 0.0, 0.0]),
        (2, [1.0, 0.0, 1.0]),
        (3, [half, half, 0.0]),
        (4, [half, half, 1.0]),
    ]);
    let deck = writers::calculix_deck(&nodes, &[("LOW", vec![1, 2]), ("HIGH", vec![3, 4])]);
    let rows = |list: &[usize]| CartesianMatrix {
        rows: list
            .iter()
            .flat_map(|&node| [0, 1, 2].map(|i| (node, i)))
            .collect(),
        lower: (0..3 * list.len()).map(|row| (row, row, 10.0)).collect(),
    };
    let blade_text = match blade {
        "op4" => writers::op4(&rows(&[2]), "K", Op4::Dense),
        "dmig" => writers::dmig(&rows(&[2]), "KAAX", true),
        "harwell_boeing" => writers::harwell_boeing(&rows(&[2]), true),
        _ => writers::matrix_market(&rows(&[2])),
    };
    for (name, text) in [
        ("mesh", deck),
        ("rows", writers::dof_table(&rows(&[1, 2, 3, 4]), true)),
        ("blade", blade_text),
        ("blade_rows", writers::dof_table(&rows(&[2]), true)),
        (
            "import.toml",
            format!(
                "code = \"calculix\"\nmatrix_format = \"{blade}\"\nname = \"four\"\nsectors = 8\n[blisk]\nmesh = \"mesh\"\n\
                 {}\ndofs = \"rows\"\nlow_face = \"LOW\"\nhigh_face = \"HIGH\"\nblade_stiffness = \"blade\"\n\
                 blade_dofs = \"blade_rows\"\n[[force]]\nnode = 2\ncomponent = \"z\"\n[[observe]]\nname = \"x\"\nnode = 2\n",
                keys.replace("DATA", data.to_str().unwrap())
            ),
        ),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    import(&folder.path().join("import.toml")).unwrap().model
}

fn worst_difference(a: &SymmetricSparse, b: &SymmetricSparse) -> f64 {
    let mut difference: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (row, column, value) in a.lower_entries() {
        *difference.entry((row, column)).or_default() += value;
    }
    for (row, column, value) in b.lower_entries() {
        *difference.entry((row, column)).or_default() -= value;
    }
    let largest = a.diagonal().into_iter().fold(0.0, f64::max);
    difference
        .values()
        .fold(0.0, |worst: f64, value| worst.max(value.abs()))
        / largest
}

#[test]
fn files_of_pyyeti_pynastran_and_scipy_hold_the_same_matrices() {
    let market = import_from(
        "stiffness = \"DATA/scipy_k.mtx\"\nmass = \"DATA/scipy_m.mtx\"",
        "matrix_market",
    );
    // One entry of each, turned by hand: node 2 of the low face has x = r and y = theta; rows 3 and 5,
    // from 0, are its x and z.
    let k = |row: usize, column: usize| {
        let entry = market
            .stiffness
            .lower_entries()
            .find(|e| (e.0, e.1) == (row, column));
        entry.unwrap().2
    };
    let text = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/import_formats/scipy_k.mtx"),
    )
    .unwrap();
    let line = text.lines().find(|line| line.starts_with("6 4 ")).unwrap();
    let written: f64 = line.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((k(5, 3) / written - 1.0).abs() < 1e-15);
    let op4 = |form: &str| {
        format!(
            "stiffness = \"DATA/pyyeti_{form}.op4\"\nstiffness_name = \"KAA\"\nmass_name = \"MAA\""
        )
    };
    for (keys, format, tolerance) in [
        (op4("dense"), "op4", 1e-15),
        (op4("nonbigmat"), "op4", 1e-15),
        (op4("bigmat"), "op4", 1e-15),
        (
            "stiffness = \"DATA/pynastran_double.pch\"".to_owned(),
            "dmig",
            1e-10,
        ),
        (
            "stiffness = \"DATA/scipy_k.rua\"\nmass = \"DATA/scipy_m.rua\"".to_owned(),
            "harwell_boeing",
            1e-15,
        ),
    ] {
        let keys = match format {
            "dmig" => format!("{keys}\nmass = \"DATA/pynastran_double.pch\""),
            _ => keys,
        };
        let model = import_from(&keys, format);
        let stiffness = worst_difference(&market.stiffness, &model.stiffness);
        let mass = worst_difference(&market.mass, &model.mass);
        assert!(stiffness < tolerance, "{keys}: {stiffness:e}");
        assert!(mass < tolerance, "{keys}: {mass:e}");
    }
}
