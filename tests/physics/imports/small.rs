//! A sector small enough to read, as files of each code.

use std::fs;
use std::path::Path;

use super::writers::{self, Op4};

/// A sector small enough to read: one brick on eight sectors, a ring brick under it, matrices that couple
/// every two nodes of a brick weakly.
pub struct Small {
    pub files: Vec<(&'static str, String)>,
}

/// Radii of the brick's faces and of the ring's, m.
const RADII: [[f64; 2]; 2] = [[1.0, 2.0], [0.5, 1.0]];

impl Small {
    fn nodes(body: usize) -> std::collections::BTreeMap<usize, [f64; 3]> {
        let mut nodes = std::collections::BTreeMap::new();
        for angle in [0.0, std::f64::consts::TAU / 8.0] {
            for z in [0.0, 1.0] {
                for radius in RADII[body] {
                    let node = 10 * body + nodes.len() + 1;
                    nodes.insert(node, [radius * angle.cos(), radius * angle.sin(), z]);
                }
            }
        }
        nodes
    }

    /// Low, high, inner and outer faces of a body.
    fn sets(body: usize) -> [Vec<usize>; 4] {
        let number = |list: [usize; 4]| list.iter().map(|n| n + 10 * body).collect();
        [
            number([1, 2, 3, 4]),
            number([5, 6, 7, 8]),
            number([1, 3, 5, 7]),
            number([2, 4, 6, 8]),
        ]
    }

    fn matrix(scale: f64, nodes: &[usize]) -> super::cartesian::CartesianMatrix {
        let rows: Vec<(usize, usize)> = nodes
            .iter()
            .flat_map(|&node| [0, 1, 2].map(|i| (node, i)))
            .collect();
        Self::matrix_of(scale, rows)
    }

    fn matrix_of(scale: f64, rows: Vec<(usize, usize)>) -> super::cartesian::CartesianMatrix {
        let mut lower = Vec::new();
        for column in 0..rows.len() {
            lower.push((column, column, scale));
            for row in column + 1..rows.len() {
                let ((a, i), (b, j)) = (rows[row], rows[column]);
                if i == j && (a < 10) == (b < 10) {
                    let share = if (row, column) == (5, 2) { 0.25 } else { 0.01 };
                    lower.push((row, column, -share * scale));
                }
            }
        }
        super::cartesian::CartesianMatrix { rows, lower }
    }

    fn all() -> Vec<usize> {
        (1..=8).chain(11..=18).collect()
    }

    fn all_nodes() -> std::collections::BTreeMap<usize, [f64; 3]> {
        Self::nodes(0).into_iter().chain(Self::nodes(1)).collect()
    }

    fn named_sets(names: [&'static str; 6]) -> Vec<(&'static str, Vec<usize>)> {
        let [low, high, inner, _] = Self::sets(0);
        let [ring_low, ring_high, _, outer] = Self::sets(1);
        names
            .into_iter()
            .zip([low, high, ring_low, ring_high, inner, outer])
            .collect()
    }

    fn import_file(code: &str, keys: &str, names: [&str; 7], contact: &str) -> String {
        format!(
            "code = \"{code}\"\nname = \"small\"\nsectors = 8\n[blisk]\nmesh = \"mesh\"\n{keys}\nlow_face = \"{}\"\n\
             high_face = \"{}\"\n[ring]\nset = \"{}\"\nlow_face = \"{}\"\nhigh_face = \"{}\"\n\
             [contact]\nblisk = \"{}\"\nring = \"{}\"\n{contact}\n[[force]]\nnode = 2\ncomponent = \"z\"\n\
             [[observe]]\nname = \"tip\"\nnode = 2\n",
            names[0], names[1], names[2], names[3], names[4], names[5], names[6]
        )
    }

    pub fn calculix() -> Self {
        Self::calculix_of(|_| true)
    }

    /// With those rows (node, direction) alone that `kept` chooses.
    pub fn calculix_of(kept: fn(&(usize, usize)) -> bool) -> Self {
        let matrix = |scale: f64| {
            let mut rows = Self::matrix(scale, &Self::all()).rows;
            rows.retain(kept);
            Self::matrix_of(scale, rows)
        };
        let names = ["LOW", "HIGH", "RLOW", "RHIGH", "IN", "OUT"];
        let mut deck = writers::calculix_deck(&Self::all_nodes(), &Self::named_sets(names));
        deck += "*ELEMENT,TYPE=C3D8,ELSET=DISK\n1,1,2,6,5,3,\n4,8,7\n*ELEMENT,TYPE=C3D8R,ELSET=RING\n2,11,12,16,15,13,14,18,17\n";
        deck += "*STEP\n*FREQUENCY,SOLVER=MATRIXSTORAGE\n*END STEP\n";
        let keys = "job = \"job\"\nblade_job = \"blade\"";
        let names = ["LOW", "HIGH", "RING", "RLOW", "RHIGH", "IN", "OUT"];
        Self {
            files: vec![
                ("mesh", deck),
                ("job.sti", writers::calculix_matrix(&matrix(100.0))),
                ("job.mas", writers::calculix_matrix(&matrix(1.0))),
                ("job.dof", writers::calculix_dofs(&matrix(1.0))),
                (
                    "blade.sti",
                    writers::calculix_matrix(&Self::matrix(50.0, &[1, 2])),
                ),
                (
                    "blade.dof",
                    writers::calculix_dofs(&Self::matrix(1.0, &[1, 2])),
                ),
                (
                    "import.toml",
                    Self::import_file("calculix", keys, names, ""),
                ),
            ],
        }
    }

    pub fn ansys() -> Self {
        Self::ansys_with(["LOW", "HIGH", "RLOW", "RHIGH", "IN", "OUT"], vec![])
    }

    /// With these sets and more.
    pub fn ansys_with(names: [&'static str; 6], more: Vec<(&'static str, Vec<usize>)>) -> Self {
        let mut sets = Self::named_sets(names);
        sets.push(("RING", (11..=18).collect()));
        sets.extend(more);
        let mut mesh = writers::ansys_cdb(&Self::all_nodes(), &sets);
        let element = |number: usize, nodes: [usize; 8]| {
            let head = [1, 1, 1, 1, 0, 0, 0, 0, 8, 0, number];
            let words = head
                .iter()
                .chain(&nodes)
                .map(|n| format!("{n:9}"))
                .collect::<Vec<_>>();
            words.concat() + "\n"
        };
        mesh += "EBLOCK,19,SOLID,         2,         2\n(19i9)\n";
        mesh += &element(1, [1, 2, 6, 5, 3, 4, 8, 7]);
        mesh += &element(2, [11, 12, 16, 15, 13, 14, 18, 17]);
        mesh += "       -1\n";
        let keys = "stiffness = \"K\"\nmass = \"M\"\ndofs = \"K.mapping\"\nblade_stiffness = \"B\"\nblade_dofs = \"B.mapping\"";
        let names = ["LOW", "HIGH", "RING", "RLOW", "RHIGH", "IN", "OUT"];
        Self {
            files: vec![
                ("mesh", mesh),
                (
                    "K",
                    writers::harwell_boeing(&Self::matrix(100.0, &Self::all()), true),
                ),
                (
                    "M",
                    writers::harwell_boeing(&Self::matrix(1.0, &Self::all()), false),
                ),
                (
                    "K.mapping",
                    writers::dof_table(&Self::matrix(1.0, &Self::all()), false),
                ),
                (
                    "B",
                    writers::harwell_boeing(&Self::matrix(50.0, &[1, 2]), true),
                ),
                (
                    "B.mapping",
                    writers::dof_table(&Self::matrix(1.0, &[1, 2]), true),
                ),
                ("import.toml", Self::import_file("ansys", keys, names, "")),
            ],
        }
    }

    pub fn nastran() -> Self {
        Self::nastran_with(vec![])
    }

    /// With more sets.
    pub fn nastran_with(more: Vec<(&'static str, Vec<usize>)>) -> Self {
        let mut mesh = Self::nastran_mesh(more);
        mesh += "CHEXA          1       1       1       2       6       5       3       4+\n+              8       7\n";
        mesh += "CHEXA,2,1,11,12,16,15,13,14\n,18,17\n";
        let mut punch = writers::dmig(&Self::matrix(100.0, &Self::all()), "KAAX", true);
        punch += &writers::dmig(&Self::matrix(1.0, &Self::all()), "MAAX", false);
        punch += &writers::dmig(&Self::matrix(50.0, &[1, 2]), "KBLADE", true);
        let keys =
            "stiffness = \"punch\"\nblade_stiffness = \"punch\"\nblade_stiffness_name = \"KBLADE\"";
        Self {
            files: vec![
                ("mesh", mesh),
                ("punch", punch),
                ("import.toml", Self::nastran_import("", keys)),
            ],
        }
    }

    pub fn op4() -> Self {
        let mesh = Self::nastran_mesh(vec![]);
        let mut both = writers::op4(&Self::matrix(100.0, &Self::all()), "KAA", Op4::Sparse);
        both += &writers::op4(&Self::matrix(1.0, &Self::all()), "MAA", Op4::Dense);
        let keys = "stiffness = \"op4\"\nstiffness_name = \"KAA\"\nmass_name = \"MAA\"\ndofs = \"dofs\"\n\
                    blade_stiffness = \"blade\"\nblade_dofs = \"blade.csv\"";
        Self {
            files: vec![
                ("mesh", mesh),
                ("op4", both),
                (
                    "dofs",
                    writers::dof_table(&Self::matrix(1.0, &Self::all()), true),
                ),
                (
                    "blade",
                    writers::op4(&Self::matrix(50.0, &[1, 2]), "KAA", Op4::BigSparse),
                ),
                (
                    "blade.csv",
                    writers::dof_table(&Self::matrix(1.0, &[1, 2]), true),
                ),
                (
                    "import.toml",
                    Self::nastran_import("\"\nmatrix_format = \"op4", keys)
                        .replace("[contact]", "[contact]\nnormal = [-1, 0, 0]"),
                ),
            ],
        }
    }

    fn nastran_mesh(more: Vec<(&'static str, Vec<usize>)>) -> String {
        let mut sets = Self::named_sets(["1", "2", "4", "5", "6", "7"]);
        sets.push(("3", (11..=18).collect()));
        sets.extend(more);
        writers::nastran_bulk(&Self::all_nodes(), &sets)
    }

    fn nastran_import(more: &str, keys: &str) -> String {
        let code = format!("nastran{more}");
        let text = Self::import_file(&code, keys, ["1", "2", "3", "4", "5", "6", "7"], "");
        text.replace("sectors = 8", "sectors = 8\nposition_tolerance_m = 1e-6")
    }

    /// The text of a file.
    pub fn text(&self, name: &str) -> &str {
        let file = self.files.iter().find(|file| file.0 == name);
        &file.unwrap().1
    }

    pub fn write(&self, folder: &Path) {
        for (name, text) in &self.files {
            fs::write(folder.join(name), text).unwrap();
        }
    }
}
