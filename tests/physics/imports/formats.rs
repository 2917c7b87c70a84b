//! The reference wheel written in each format and imported again is the same wheel.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use blisk::linalg::SymmetricSparse;
use blisk::model::sector::import::{BladeSource, import};
use blisk::model::sector::{Body, SectorModel};

use super::cartesian::{CartesianMatrix, cartesian, faces, nodes, wheel8};
use super::writers;

/// The wheel's files, in Cartesian directions.
pub struct Wheel {
    pub model: SectorModel,
    pub stiffness: CartesianMatrix,
    pub mass: CartesianMatrix,
    pub blade: CartesianMatrix,
    /// Sets by name: names of Nastran are numbers.
    sets: Vec<(&'static str, &'static str, Vec<usize>)>,
}

impl Wheel {
    pub fn new() -> Self {
        let model = wheel8();
        let ring: BTreeSet<usize> = model
            .dofs
            .iter()
            .filter(|dof| dof.body == Body::Ring)
            .map(|dof| dof.node + 1)
            .collect();
        let [low, high] = faces(&model, Body::Blisk);
        let [ring_low, ring_high] = faces(&model, Body::Ring);
        let side = |node: fn(&blisk::model::sector::ContactPair) -> usize| {
            let mut nodes: Vec<usize> = model
                .contact_pairs
                .iter()
                .map(|pair| node(pair) + 1)
                .collect();
            nodes.sort_unstable();
            nodes
        };
        let sets = vec![
            ("LOW", "1", low),
            ("HIGH", "2", high),
            ("RING", "3", ring.into_iter().collect()),
            ("RING_LOW", "4", ring_low),
            ("RING_HIGH", "5", ring_high),
            ("LANDING", "6", side(|pair| pair.first.node().unwrap())),
            ("RING_OUT", "7", side(|pair| pair.second.node().unwrap())),
        ];
        // The ring's grounding is part of K here.
        Self {
            stiffness: cartesian(&model, model.stiffness.entries(), true),
            mass: cartesian(&model, model.mass.entries(), true),
            blade: cartesian(&model, model.blade_stiffness.entries(), false),
            model,
            sets,
        }
    }

    pub fn sets(&self, numbers: bool) -> Vec<(&'static str, Vec<usize>)> {
        self.sets
            .iter()
            .map(|(name, number, nodes)| (if numbers { *number } else { *name }, nodes.clone()))
            .collect()
    }

    /// The import file; `code` and `blisk` are the keys that differ between formats.
    pub fn import_file(&self, code: &str, blisk: &str, numbers: bool) -> String {
        let name = |at: usize| {
            if numbers {
                self.sets[at].1
            } else {
                self.sets[at].0
            }
        };
        let mut text = format!(
            "{code}\nname = \"wheel8\"\nsectors = 8\n\n[blisk]\n{blisk}\nlow_face = \"{}\"\nhigh_face = \"{}\"\n\n\
             [ring]\nset = \"{}\"\nlow_face = \"{}\"\nhigh_face = \"{}\"\n\n\
             [contact]\nblisk = \"{}\"\nring = \"{}\"\nweights = \"equal\"\nnormal = [-1.0, 0.0, 0.0]\n",
            name(0),
            name(1),
            name(2),
            name(3),
            name(4),
            name(5),
            name(6),
        );
        for (dof, force) in &self.model.force {
            let own = &self.model.dofs[*dof];
            write!(
                text,
                "\n[[force]]\nnode = {}\ncomponent = \"{}\"\nre = {:e}\nim = {:e}\n",
                own.node + 1,
                own.component,
                force.re,
                force.im
            )
            .unwrap();
        }
        for observed in &self.model.observed {
            write!(
                text,
                "\n[[observe]]\nname = \"{}\"\nnode = {}\n",
                observed.name,
                observed.node + 1
            )
            .unwrap();
        }
        text
    }

    /// Imports from `folder` and compares with the original.
    fn assert_imported(&self, folder: &Path, tolerance: f64) {
        let imported = import(&folder.join("import.toml")).unwrap();
        let (model, original) = (&imported.model, &self.model);
        assert_eq!(imported.report.blade_source, BladeSource::Matrices);
        assert_eq!(model.sectors, original.sectors);
        assert_eq!(model.dofs.len(), original.dofs.len());
        let dof_of: BTreeMap<_, usize> = model
            .dofs
            .iter()
            .enumerate()
            .map(|(index, dof)| ((dof.node, dof.component), index))
            .collect();
        let place: Vec<usize> = original
            .dofs
            .iter()
            .map(|dof| dof_of[&(dof.node + 1, dof.component)])
            .collect();
        for (dof, &at) in original.dofs.iter().zip(&place) {
            assert_eq!(dof.body, model.dofs[at].body);
            for i in 0..3 {
                assert!((dof.position_m[i] - model.dofs[at].position_m[i]).abs() < 1e-9);
            }
        }
        for (own, other, name) in [
            (&model.stiffness, &original.stiffness, "K"),
            (&model.mass, &original.mass, "M"),
            (&model.blade_stiffness, &original.blade_stiffness, "K_blade"),
        ] {
            assert_same(own, other, &place, tolerance, name);
        }
        let pairs =
            |model: &SectorModel, place: &dyn Fn(usize) -> usize| -> BTreeSet<(usize, usize)> {
                model
                    .cyclic_pairs
                    .iter()
                    .map(|&(low, high)| (place(low), place(high)))
                    .collect()
            };
        assert_eq!(pairs(model, &|dof| dof), pairs(original, &|dof| place[dof]));
        let contacts = |model: &SectorModel, offset: usize| -> BTreeSet<(usize, usize)> {
            model
                .contact_pairs
                .iter()
                .map(|pair| {
                    (
                        pair.first.node().unwrap() + offset,
                        pair.second.node().unwrap() + offset,
                    )
                })
                .collect()
        };
        assert_eq!(contacts(model, 0), contacts(original, 1));
        for pair in &model.contact_pairs {
            assert!((pair.weight - 1.0 / original.contact_pairs.len() as f64).abs() < 1e-15);
        }
        let mut force: Vec<_> = original
            .force
            .iter()
            .map(|&(dof, force)| (place[dof], force))
            .collect();
        force.sort_by_key(|&(dof, _)| dof);
        assert_eq!(model.force, force);
        assert_eq!(model.observed.len(), original.observed.len());
        assert_eq!(model.observed[0].node, original.observed[0].node + 1);
    }
}

/// Mesh and import file of a format.
fn write_mesh(folder: &Path, mesh: &str, import_file: &str) {
    fs::write(folder.join("mesh"), mesh).unwrap();
    fs::write(folder.join("import.toml"), import_file).unwrap();
}

/// Entries equal to `tolerance` of the geometric mean of the diagonal.
fn assert_same(
    own: &SymmetricSparse,
    other: &SymmetricSparse,
    place: &[usize],
    tolerance: f64,
    name: &str,
) {
    let diagonal = own.diagonal();
    let mut difference: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (row, column, value) in own.lower_entries() {
        *difference.entry((row, column)).or_default() += value;
    }
    for (row, column, value) in other.lower_entries() {
        let (row, column) = (place[row].max(place[column]), place[row].min(place[column]));
        *difference.entry((row, column)).or_default() -= value;
    }
    let mut worst = 0.0_f64;
    for ((row, column), value) in difference {
        worst = worst.max(value.abs() / (diagonal[row] * diagonal[column]).sqrt());
    }
    assert!(worst < tolerance, "{name}: {worst:e}");
}

#[test]
fn calculix_files_give_the_wheel_back() {
    let wheel = Wheel::new();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    write("wheel.sti", writers::calculix_matrix(&wheel.stiffness));
    write("wheel.mas", writers::calculix_matrix(&wheel.mass));
    write("wheel.dof", writers::calculix_dofs(&wheel.stiffness));
    write("blade.sti", writers::calculix_matrix(&wheel.blade));
    write("blade.dof", writers::calculix_dofs(&wheel.blade));
    let deck = writers::calculix_deck(&nodes(&wheel.model), &wheel.sets(false));
    let keys = "mesh = \"mesh\"\njob = \"wheel\"\nblade_job = \"blade\"";
    write_mesh(
        folder.path(),
        &deck,
        &wheel.import_file("code = \"calculix\"", keys, false),
    );
    wheel.assert_imported(folder.path(), 1e-12);
}

#[test]
fn ansys_files_give_the_wheel_back() {
    let wheel = Wheel::new();
    let mesh = writers::ansys_cdb(&nodes(&wheel.model), &wheel.sets(false));
    let keys = "mesh = \"mesh\"\nstiffness = \"K\"\nmass = \"M\"\ndofs = \"K.mapping\"\n\
                blade_stiffness = \"blade\"\nblade_dofs = \"blade.mapping\"";
    for (symmetric, code) in [
        (Some(true), "code = \"ansys\""),
        (Some(false), "code = \"ansys\""),
        (None, "code = \"ansys\"\nmatrix_format = \"matrix_market\""),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
        let matrix = |matrix: &CartesianMatrix| match symmetric {
            Some(symmetric) => writers::harwell_boeing(matrix, symmetric),
            None => writers::matrix_market(matrix),
        };
        write("K", matrix(&wheel.stiffness));
        write("M", matrix(&wheel.mass));
        write("blade", matrix(&wheel.blade));
        write("K.mapping", writers::dof_table(&wheel.stiffness, false));
        write("blade.mapping", writers::dof_table(&wheel.blade, true));
        write_mesh(folder.path(), &mesh, &wheel.import_file(code, keys, false));
        wheel.assert_imported(folder.path(), 1e-13);
    }
}

#[test]
fn nastran_files_give_the_wheel_back() {
    let wheel = Wheel::new();
    let mesh = writers::nastran_bulk(&nodes(&wheel.model), &wheel.sets(true));
    // Grid points have ten digits.
    let tolerance = 1e-7;
    for large in [true, false] {
        let folder = tempfile::tempdir().unwrap();
        let mut punch = writers::dmig(&wheel.stiffness, "KAAX", large);
        punch += &writers::dmig(&wheel.mass, "MAAX", large);
        punch += &writers::dmig(&wheel.blade, "KBLADE", large);
        fs::write(folder.path().join("wheel.pch"), punch).unwrap();
        let keys = "mesh = \"mesh\"\nstiffness = \"wheel.pch\"\nblade_stiffness = \"wheel.pch\"\n\
                    blade_stiffness_name = \"KBLADE\"";
        let code = "code = \"nastran\"\nposition_tolerance_m = 1e-6";
        write_mesh(folder.path(), &mesh, &wheel.import_file(code, keys, true));
        wheel.assert_imported(folder.path(), tolerance);
    }
    for form in [
        writers::Op4::Dense,
        writers::Op4::Sparse,
        writers::Op4::BigSparse,
    ] {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
        let both =
            writers::op4(&wheel.stiffness, "KAA", form) + &writers::op4(&wheel.mass, "MAA", form);
        write("wheel.op4", both);
        write("blade.op4", writers::op4(&wheel.blade, "KAA", form));
        write("dofs.csv", writers::dof_table(&wheel.stiffness, true));
        write("blade.csv", writers::dof_table(&wheel.blade, true));
        let keys = "mesh = \"mesh\"\nstiffness = \"wheel.op4\"\nstiffness_name = \"KAA\"\nmass_name = \"maa\"\n\
                    dofs = \"dofs.csv\"\nblade_stiffness = \"blade.op4\"\nblade_dofs = \"blade.csv\"";
        let code = "code = \"nastran\"\nmatrix_format = \"op4\"\nposition_tolerance_m = 1e-6";
        write_mesh(folder.path(), &mesh, &wheel.import_file(code, keys, true));
        wheel.assert_imported(folder.path(), tolerance);
    }
}

#[test]
fn millimetres_and_another_axis_give_the_same_wheel() {
    let wheel = Wheel::new();
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    // Axis of rotation x: the wheel's (x, y, z) are the file's (y, z, x). Units mm, t, N.
    let turned = |matrix: &CartesianMatrix| {
        let direction = |i: usize| [1, 2, 0][i];
        CartesianMatrix {
            rows: matrix
                .rows
                .iter()
                .map(|&(node, i)| (node, direction(i)))
                .collect(),
            lower: matrix
                .lower
                .iter()
                .map(|&(i, j, value)| (i, j, 1e-3 * value))
                .collect(),
        }
    };
    write(
        "wheel.sti",
        writers::calculix_matrix(&turned(&wheel.stiffness)),
    );
    write("wheel.mas", writers::calculix_matrix(&turned(&wheel.mass)));
    write(
        "wheel.dof",
        writers::calculix_dofs(&turned(&wheel.stiffness)),
    );
    write("blade.sti", writers::calculix_matrix(&turned(&wheel.blade)));
    write("blade.dof", writers::calculix_dofs(&turned(&wheel.blade)));
    let placed = nodes(&wheel.model)
        .into_iter()
        .map(|(node, [x, y, z])| (node, [1e3 * z, 1e3 * x, 1e3 * y]))
        .collect();
    let deck = writers::calculix_deck(&placed, &wheel.sets(false));
    let keys = "mesh = \"mesh\"\njob = \"wheel\"\nblade_job = \"blade\"";
    let code = "code = \"calculix\"\nunits = \"mm-t-s\"\naxis = \"x\"";
    write_mesh(folder.path(), &deck, &wheel.import_file(code, keys, false));
    wheel.assert_imported(folder.path(), 1e-12);
}
