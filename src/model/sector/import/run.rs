//! The files of one run of another code: mesh and matrices, as numbers of the wheel.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::cylindrical::Node;
use super::import_file::{FilesTable, ImportFile, MeshFormat};
use super::matrices::{self, Matrices};
use super::mesh::Mesh;
use super::problem::{ImportProblem, body_name};
use super::source::refuse;
use super::{ansys, deck, nastran};
use crate::model::sector::error::ModelError;
use crate::model::sector::sector_model::Body;

/// Largest node number accepted: numbers of a second file are raised above it.
const MOST_NODE_NUMBER: usize = 999_999_999;

/// A mesh read for one body, or for both.
#[derive(Debug)]
pub(super) struct Run {
    pub body: Body,
    pub files: FilesTable,
    pub mesh_path: PathBuf,
    pub mesh: Mesh,
    /// Added to the node numbers of the file, so that two files do not collide.
    pub offset: usize,
    /// Nodes of the ring by the numbers of the file.
    ring_nodes: BTreeSet<usize>,
}

impl Run {
    /// The runs of an import file: that of the blisk, and that of the ring if it has one of its own.
    pub fn read_meshes(file: &ImportFile) -> Result<Vec<Self>, ModelError> {
        let mut runs: Vec<Self> = Vec::new();
        for body in [Body::Blisk, Body::Ring] {
            let Some(files) = file.files(body) else {
                continue;
            };
            let mesh_path = file.mesh_path(body_name(body), &files)?;
            let mesh = match file.mesh_format {
                MeshFormat::Calculix => deck::read(&mesh_path),
                MeshFormat::Ansys => ansys::read(&mesh_path),
                MeshFormat::Nastran => nastran::read(&mesh_path),
            }?;
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
            let largest = |run: &Self| run.mesh.nodes.keys().next_back().copied().unwrap_or(0);
            let ring_nodes = match body {
                Body::Ring => mesh.nodes.keys().copied().collect(),
                Body::Blisk => BTreeSet::new(),
            };
            runs.push(Self {
                body,
                files,
                offset: runs.first().map_or(0, |run| round_up(largest(run))),
                mesh_path,
                mesh,
                ring_nodes,
            });
        }
        if let (Some(ring), [both]) = (&file.ring, runs.as_mut_slice()) {
            let Some(set) = &ring.set else {
                let accepted =
                    "the set of the ring's nodes or elements, or `ring.mesh` and its matrices";
                return Err(file.missing("ring.set", accepted));
            };
            both.ring_nodes = both.set("ring.set", set)?;
        }
        Ok(runs)
    }

    /// Nodes of a set by the numbers of the file.
    pub fn set(&self, key: &str, name: &str) -> Result<BTreeSet<usize>, ModelError> {
        self.mesh
            .nodes_of(name)
            .ok_or_else(|| self.unknown(key, name))
    }

    pub fn unknown(&self, key: &str, name: &str) -> ModelError {
        refuse(
            &self.mesh_path,
            ImportProblem::SetUnknown {
                key: key.to_owned(),
                name: name.to_owned(),
                accepted: self.mesh.set_names(),
            },
        )
    }

    /// Whether the run holds a body.
    pub fn holds(&self, body: Body) -> bool {
        match body {
            Body::Blisk => self.body == Body::Blisk,
            Body::Ring => !self.ring_nodes.is_empty(),
        }
    }

    pub fn body_of(&self, node: usize) -> Body {
        if self.ring_nodes.contains(&node) {
            Body::Ring
        } else {
            Body::Blisk
        }
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
        let prefix = format!("{}.", body_name(self.body));
        let files = file.matrix_files(&prefix, &self.files)?;
        let mut matrices = matrices::read(&files)?;
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
                let (first, second) = (a - self.offset, b - self.offset);
                return Err(refuse(
                    &files.stiffness,
                    ImportProblem::BodiesCoupled { first, second },
                ));
            }
        }
        Ok(matrices)
    }

    /// Turns rows of the files to rows of the wheel.
    pub fn place_rows(
        &self,
        file: &ImportFile,
        rows: &mut matrices::Rows,
    ) -> Result<(), ImportProblem> {
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
