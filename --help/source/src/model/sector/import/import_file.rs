//! The import file: which files of another code make up the wheel, and what in them is what.

use std::path::{Path, PathBuf};

use toml::Table;

use super::contact_tables::{Contact, contacts};
use super::files::{OtherBody, RunFiles, files, missing};
use super::keys::import_keys;
use super::matrices::{MatrixFiles, MatrixFormat};
use super::source::Source;
use super::tables::{Axis, BliskTable, Code, ForceTable, MeshFormat, ObserveTable, RawFile, Units};
use crate::input::{Finding, Problem, SourceMap, check};
use crate::model::sector::error::ModelError;
use crate::model::sector::sector_model::{Body, ObservedNode};

/// An import file with its formats decided, its numbers checked and its files named.
#[derive(Debug)]
pub(super) struct ImportFile {
    pub path: PathBuf,
    map: SourceMap,
    pub name: String,
    pub sectors: usize,
    pub units: Units,
    pub axis: Axis,
    pub position_tolerance_m: Option<f64>,
    pub mesh_format: MeshFormat,
    pub blisk: BliskTable,
    pub blisk_files: RunFiles,
    /// Matrices of the blade alone; none where it is assembled here.
    pub blade_files: Option<MatrixFiles>,
    /// Ring and damper, those that there are.
    pub others: Vec<OtherBody>,
    pub contacts: Vec<Contact>,
    pub force: Vec<ForceTable>,
    pub observe: Vec<ObserveTable>,
}

impl ImportFile {
    /// Reads an import file; the error holds everything that is not accepted in it.
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let source = Source::read(path)?;
        let refused = |findings| ModelError::ImportFile {
            path: path.to_owned(),
            findings,
        };
        let map = SourceMap::new(&source.text).map_err(|finding| refused(vec![*finding]))?;
        let described = |error: toml::de::Error| refused(vec![map.describe(&error)]);
        let table: Table = source.text.parse().map_err(described)?;
        let findings = check(&map, &table, &import_keys());
        if !findings.is_empty() {
            return Err(refused(findings));
        }
        let mut raw: RawFile = toml::from_str(&source.text).map_err(described)?;
        let mut missing = Vec::new();
        let mesh_format = raw.mesh_format.unwrap_or(match raw.code {
            Code::Calculix => MeshFormat::Calculix,
            Code::Ansys => MeshFormat::Ansys,
            Code::Nastran => MeshFormat::Nastran,
        });
        let matrix_format = raw.matrix_format.unwrap_or(match raw.code {
            Code::Calculix => MatrixFormat::Calculix,
            Code::Ansys => MatrixFormat::HarwellBoeing,
            Code::Nastran => MatrixFormat::Dmig,
        });
        let contacts = contacts(&raw, &mut missing);
        together(&raw, &mut missing);
        let others = [
            (Body::Ring, raw.ring.take()),
            (Body::Damper, raw.damper.take()),
        ];
        let (blisk_files, blade_files, others) =
            files(path, matrix_format, &raw.blisk, others, &mut missing);
        if !missing.is_empty() {
            let mut findings: Vec<Finding> = missing
                .into_iter()
                .map(|(key, problem)| map.finding(&key, problem))
                .collect();
            findings.sort_by_key(|finding| finding.line);
            return Err(refused(findings));
        }
        Ok(Self {
            path: path.to_owned(),
            map,
            name: raw.name,
            sectors: raw.sectors,
            units: raw.units,
            axis: raw.axis,
            position_tolerance_m: raw.position_tolerance_m,
            mesh_format,
            blisk: raw.blisk,
            blisk_files,
            blade_files,
            others,
            contacts,
            force: raw.force,
            observe: raw.observe,
        })
    }

    /// Refuses values of the import file that do not fit what the files hold.
    pub fn refuse(&self, problems: Vec<(String, Problem)>) -> ModelError {
        let findings = problems
            .into_iter()
            .map(|(key, problem)| self.map.finding(&key, problem))
            .collect();
        ModelError::ImportFile {
            path: self.path.clone(),
            findings,
        }
    }

    /// Refuses the value of `key`, with what is accepted.
    pub fn refuse_value(&self, key: &str, reason: String) -> ModelError {
        self.refuse(vec![(key.to_owned(), Problem::Conflict { reason })])
    }

    /// The body beside the blisk.
    pub fn other(&self, body: Body) -> Option<&OtherBody> {
        self.others.iter().find(|other| other.body == body)
    }

    /// Frequency by which a body beside the blisk is grounded, Hz.
    pub fn grounding_hz(&self, body: Body) -> f64 {
        let table = self.other(body).map(|other| &other.table);
        table.and_then(|table| table.grounding_hz).unwrap_or(0.0)
    }

    /// The value of `key` as it is written.
    pub fn written(&self, key: &str) -> String {
        self.map.value(key)
    }
}

/// What keys have to do with each other.
fn together(raw: &RawFile, problems: &mut Vec<(String, Problem)>) {
    let mut conflict = |key: String, reason: &str| {
        let reason = reason.to_owned();
        problems.push((key, Problem::Conflict { reason }));
    };
    let blade = &raw.blisk;
    if blade.blade_elements.is_some()
        && (blade.blade_job.is_some() || blade.blade_stiffness.is_some())
    {
        let reason = "matrices of the blade alone are also given; accepted: one of the two";
        conflict("blisk.blade_elements".to_owned(), reason);
    }
    for (index, observed) in raw.observe.iter().enumerate() {
        if !ObservedNode::is_name(&observed.name) {
            let reason = "the name cannot be written to a bundle; accepted: no comma, quotes or line ends, no blank first or last";
            conflict(format!("observe[{index}].name"), reason);
        }
    }
    let forces = raw
        .force
        .iter()
        .map(|force| (force.node, force.set.is_some()));
    let observed = raw
        .observe
        .iter()
        .map(|node| (node.node, node.set.is_some()));
    let named = [
        ("force", forces.collect::<Vec<_>>()),
        ("observe", observed.collect()),
    ];
    for (table, places) in named {
        for (index, (node, set)) in places.into_iter().enumerate() {
            match (node, set) {
                (None, false) => problems.push(missing(
                    format!("{table}[{index}].set"),
                    "a set of the mesh, or `node` with the number of one",
                )),
                (Some(_), true) => {
                    let reason = "node and set are both given; accepted: one of them".to_owned();
                    problems.push((
                        format!("{table}[{index}].set"),
                        Problem::Conflict { reason },
                    ));
                }
                _ => {}
            }
        }
    }
}
