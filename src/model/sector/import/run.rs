//! The files of one run of another code: mesh and matrices, as numbers of the wheel.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::couplings::Couplings;
use super::cylindrical::Node;
use super::files::{OtherBody, RunFiles};
use super::import_file::ImportFile;
use super::matrices::{self, Matrices, Rows};
use super::mesh::Mesh;
use super::problem::{ImportProblem, body_name};
use super::source::refuse;
use super::tables::MeshFormat;
use super::{ansys, deck, foreign, nastran};
use crate::input::{Problem, nearest};
use crate::linalg::SymmetricSparse;
use crate::model::sector::error::ModelError;
use crate::model::sector::error_place::Matrix;
use crate::model::sector::sector_model::Body;

/// Largest node number accepted: numbers of a second file are raised above it.
const MOST_NODE_NUMBER: usize = 999_999_999;

/// A mesh read for one body, or for several.
#[derive(Debug)]
pub(super) struct Run {
    pub body: Body,
    pub files: RunFiles,
    pub mesh_path: PathBuf,
    pub mesh: Mesh,
    /// Added to the node numbers of the file, so that two files do not collide.
    pub offset: usize,
    /// Nodes of the bodies beside the blisk by the numbers of the file.
    others: BTreeMap<Body, BTreeSet<usize>>,
}

/// A mesh without a node: most often one of another code than the import file says.
fn no_nodes(format: MeshFormat, path: &Path) -> ImportProblem {
    let (name, what) = match format {
        MeshFormat::Calculix => ("calculix", "a deck of CalculiX or Abaqus with *NODE"),
        MeshFormat::Ansys => ("ansys", "a .cdb of Ansys with NBLOCK (CDWRITE)"),
        MeshFormat::Nastran => ("nastran", "bulk data of Nastran with GRID"),
    };
    let is = foreign::what_is(path).map_or_else(String::new, |kind| format!(", it is {kind}"));
    ImportProblem::Value {
        key: "mesh_format".to_owned(),
        found: format!("\"{name}\", but the file has no node in it{is}"),
        accepted: format!("{what}, or the mesh_format of this file: calculix, ansys or nastran"),
    }
}

impl Run {
    /// The runs of an import file: that of the blisk, and those of ring and damper if they have some of their own.
    pub fn read_meshes(file: &ImportFile) -> Result<Vec<Self>, ModelError> {
        let mut runs: Vec<Self> = Vec::new();
        let others_with_files = file.others.iter();
        let others_with_files =
            others_with_files.filter_map(|other| Some((other.body, other.files.as_ref()?)));
        for (body, files) in
            std::iter::once((Body::Blisk, &file.blisk_files)).chain(others_with_files)
        {
            let mesh_path = files.mesh.clone();
            let mesh = match file.mesh_format {
                MeshFormat::Calculix => deck::read(&mesh_path),
                MeshFormat::Ansys => ansys::read(&mesh_path),
                MeshFormat::Nastran => nastran::read(&mesh_path),
            }?;
            if mesh.nodes.is_empty() {
                return Err(refuse(&mesh_path, no_nodes(file.mesh_format, &mesh_path)));
            }
            if let Some(&largest) = mesh.nodes.keys().next_back()
                && largest > MOST_NODE_NUMBER
            {
                let problem = ImportProblem::Value {
                    key: "the largest node number".to_owned(),
                    found: largest.to_string(),
                    accepted: format!("at most {MOST_NODE_NUMBER}"),
                };
                return Err(refuse(&mesh_path, problem));
            }
            let largest = |run: &Self| {
                let largest_node = run.mesh.nodes.keys().next_back().copied().unwrap_or(0);
                largest_node + run.offset
            };
            let others = match body {
                Body::Ring | Body::Damper => {
                    BTreeMap::from([(body, mesh.nodes.keys().copied().collect())])
                }
                Body::Blisk => BTreeMap::new(),
            };
            runs.push(Self {
                body,
                files: files.clone(),
                offset: runs.last().map_or(0, |run| round_up(largest(run))),
                mesh_path,
                mesh,
                others,
            });
        }
        for other in file.others.iter().filter(|other| other.files.is_none()) {
            let name = other.table.set.as_deref().unwrap_or_default();
            let nodes = runs[0].set(name);
            runs[0].others.insert(other.body, nodes);
        }
        known_sets(file, &runs)?;
        Ok(runs)
    }

    /// Whether a node of the wheel stands in the mesh.
    pub fn has_node(&self, node: usize) -> bool {
        let file_node = node.checked_sub(self.offset);
        file_node.is_some_and(|file_node| self.mesh.nodes.contains_key(&file_node))
    }

    /// Nodes of a set by the numbers of the file; [`known_sets`] has found it.
    pub fn set(&self, name: &str) -> BTreeSet<usize> {
        self.mesh.nodes_of(name).unwrap_or_default()
    }

    /// Elements of a set.
    pub fn element_set(&self, name: &str) -> BTreeSet<usize> {
        let sets = &self.mesh.element_sets;
        sets.get(&name.to_ascii_uppercase())
            .cloned()
            .unwrap_or_default()
    }

    /// Whether the run holds a body.
    pub fn holds(&self, body: Body) -> bool {
        self.body == body || self.others.contains_key(&body)
    }

    /// The run that holds a body; that of the blisk if none does.
    pub fn of(runs: &[Self], body: Body) -> &Self {
        let run = runs.iter().find(|run| run.holds(body));
        run.unwrap_or(&runs[0])
    }

    pub fn body_of(&self, node: usize) -> Body {
        let mut others = self.others.iter();
        let other = others.find(|(_, nodes)| nodes.contains(&node));
        other.map_or(Body::Blisk, |(&body, _)| body)
    }

    /// Nodes of the wheel: numbers with the offset, positions in m with the axis along z.
    pub fn nodes(&self, file: &ImportFile) -> BTreeMap<usize, Node> {
        self.mesh
            .nodes
            .iter()
            .map(|(&number, &position)| {
                let node = Node {
                    position_m: position_m(file, position),
                    body: self.body_of(number),
                };
                (number + self.offset, node)
            })
            .collect()
    }

    /// Matrices with rows by the numbers and directions of the wheel; scaled to SI by the caller.
    pub fn matrices(&self, file: &ImportFile) -> Result<Matrices, ModelError> {
        let files = &self.files.matrices;
        let mut matrices = matrices::read(files)?;
        let path = if files.dofs.as_os_str().is_empty() {
            &files.stiffness
        } else {
            &files.dofs
        };
        self.place_rows(file, &mut matrices.rows)
            .map_err(|problem| refuse(path, problem))?;
        for (row, column, value) in matrices.stiffness.lower_entries() {
            let (a, b) = (matrices.rows[row].0, matrices.rows[column].0);
            let body = |node: usize| self.body_of(node - self.offset);
            if value != 0.0 && body(a) != body(b) {
                let problem = ImportProblem::BodiesCoupled {
                    first: a - self.offset,
                    second: b - self.offset,
                    bodies: [body(a).min(body(b)), body(a).max(body(b))],
                };
                return Err(refuse(&files.stiffness, problem));
            }
        }
        let rows = &matrices.rows;
        self.require_couplings(
            Matrix::Stiffness,
            &files.stiffness,
            rows,
            &matrices.stiffness,
        )?;
        self.require_couplings(Matrix::Mass, &files.mass, rows, &matrices.mass)?;
        Ok(matrices)
    }

    /// Refuses a matrix that does not couple the nodes of the mesh's elements.
    pub fn require_couplings(
        &self,
        kind: Matrix,
        path: &Path,
        rows: &Rows,
        matrix: &SymmetricSparse,
    ) -> Result<(), ModelError> {
        let file_rows: Rows = rows
            .iter()
            .map(|&(node, direction)| (node - self.offset, direction))
            .collect();
        Couplings::new(&file_rows, matrix)
            .require(kind, &self.mesh)
            .map_err(|problem| refuse(path, problem))
    }

    /// Turns rows of the files to rows of the wheel.
    pub fn place_rows(&self, file: &ImportFile, rows: &mut Rows) -> Result<(), ImportProblem> {
        let places = file.axis.places();
        for (index, (node, direction)) in rows.iter_mut().enumerate() {
            if !self.mesh.nodes.contains_key(node) {
                let row = index + 1;
                return Err(ImportProblem::RowOfUnknownNode { row, node: *node });
            }
            *node += self.offset;
            *direction = places[*direction];
        }
        Ok(())
    }
}

/// A name of a set: its key, the runs that may have it, what stands before it in the file, and itself.
type Asked<'a> = (String, &'a [Run], String, &'a str);

/// A name with nothing before it.
fn asked_set<'a>(key: String, runs: &'a [Run], name: &'a str) -> Asked<'a> {
    (key, runs, String::new(), name)
}

/// Refuses names of sets that no mesh has, all at once, each with the nearest name there is.
fn known_sets(file: &ImportFile, runs: &[Run]) -> Result<(), ModelError> {
    let first = &runs[..1];
    let mut asked = vec![
        asked_set("blisk.low_face".to_owned(), first, &file.blisk.low_face),
        asked_set("blisk.high_face".to_owned(), first, &file.blisk.high_face),
    ];
    for OtherBody { body, table, .. } in &file.others {
        let run = std::slice::from_ref(Run::of(runs, *body));
        for (name, set) in [
            ("low_face", &table.low_face),
            ("high_face", &table.high_face),
            ("set", &table.set),
        ] {
            if let Some(set) = set {
                asked.push(asked_set(format!("{}.{name}", body_name(*body)), run, set));
            }
        }
    }
    for contact in &file.contacts {
        for (key, surface) in contact.surfaces() {
            let run = std::slice::from_ref(Run::of(runs, surface.body));
            let prefix = contact.prefix_of(surface);
            asked.push((key.to_owned(), run, prefix, &surface.set));
        }
    }
    let forced = file.force.iter().map(|force| force.set.as_deref());
    let observed = file.observe.iter().map(|node| node.set.as_deref());
    for (table, sets) in [
        ("force", forced.collect::<Vec<_>>()),
        ("observe", observed.collect()),
    ] {
        for (index, set) in sets.into_iter().enumerate() {
            if let Some(set) = set {
                asked.push(asked_set(format!("{table}[{index}].set"), runs, set));
            }
        }
    }
    let mut problems = Vec::new();
    for (key, runs, prefix, name) in asked {
        if runs.iter().all(|run| run.mesh.nodes_of(name).is_none()) {
            let names = runs.iter().flat_map(|run| run.mesh.set_names());
            // `damper.SET, SET being` a set of its mesh.
            let what = match prefix.as_str() {
                "" => "a set of".to_owned(),
                prefix => format!("{prefix}SET, SET being a set of"),
            };
            let meant = (prefix.as_str(), name);
            problems.push(unknown(file, key, meant, &what, runs, names.collect()));
        } else if runs.iter().all(|run| run.set(name).is_empty()) {
            let accepted = match key.as_str() {
                "ring.set" => "the nodes or elements of the ring",
                "damper.set" => "the nodes or elements of the damper",
                _ => "a set with nodes or elements",
            };
            let reason = format!("the set is empty; accepted: {accepted}");
            problems.push((key, Problem::Conflict { reason }));
        }
    }
    if let (Some(name), None) = (&file.blisk.blade_elements, &file.blade_files) {
        let sets = &runs[0].mesh.element_sets;
        if !sets.contains_key(&name.to_ascii_uppercase()) {
            let (key, names) = ("blisk.blade_elements".to_owned(), sets.keys().cloned());
            problems.push(unknown(
                file,
                key,
                ("", name),
                "an element set of",
                first,
                names.collect(),
            ));
        }
    }
    if problems.is_empty() {
        problems.extend(shared_node(file, &runs[0]));
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(file.refuse(problems))
    }
}

/// A node that is in the sets of ring and damper.
fn shared_node(file: &ImportFile, run: &Run) -> Option<(String, Problem)> {
    let of = |body: Body| {
        let table = &file.other(body)?.table;
        Some(run.set(table.set.as_deref()?))
    };
    let (ring, damper) = (of(Body::Ring)?, of(Body::Damper)?);
    let node = ring.intersection(&damper).next()?;
    let reason = format!("node {node} is in ring.set, too; accepted: sets without a common node");
    Some(("damper.set".to_owned(), Problem::Conflict { reason }))
}

/// A set that is not in the meshes of `runs`; in the file it stands after a prefix.
fn unknown(
    file: &ImportFile,
    key: String,
    (prefix, name): (&str, &str),
    what: &str,
    runs: &[Run],
    names: BTreeSet<String>,
) -> (String, Problem) {
    let paths: Vec<String> = runs
        .iter()
        .map(|run| run.mesh_path.display().to_string())
        .collect();
    let names: Vec<String> = names.into_iter().collect();
    let listed = if names.is_empty() {
        "none: the mesh has no sets".to_owned()
    } else {
        names.join(", ")
    };
    let problem = Problem::NotAccepted {
        value: file.written(&key),
        accepted: format!("{what} {}: {listed}", paths.join(" or ")),
        suggestion: nearest(&name.to_ascii_uppercase(), &names)
            .map(|name| format!("\"{prefix}{name}\"")),
    };
    (key, problem)
}

/// A position in m, with the axis of rotation along z.
fn position_m(file: &ImportFile, position: [f64; 3]) -> [f64; 3] {
    let mut placed = [0.0; 3];
    for (value, place) in position.into_iter().zip(file.axis.places()) {
        placed[place] = value * file.units.length();
    }
    placed
}

/// The next power of ten above `number`: node numbers of the second file stay readable.
pub(super) fn round_up(number: usize) -> usize {
    let mut power: usize = 10;
    while power <= number {
        power *= 10;
    }
    power
}
