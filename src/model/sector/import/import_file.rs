//! The import file: which files of another code make up the wheel, and what in them is what.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::matrices::{MatrixFiles, MatrixFormat};
use super::problem::ImportProblem;
use super::source::{Source, refuse};
use crate::model::sector::error::ModelError;
use crate::model::sector::line_problem::LineProblem;
use crate::model::sector::sector_model::{Body, MAX_SECTORS};

/// The code the files come from; decides the formats unless they are named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Code {
    Calculix,
    Ansys,
    Nastran,
}

/// Format of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum MeshFormat {
    /// A deck of `CalculiX` or Abaqus.
    Calculix,
    /// A `.cdb` of Ansys (`CDWRITE`).
    Ansys,
    /// Nastran bulk data.
    Nastran,
}

/// Units of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub(super) enum Units {
    /// m, kg, N.
    #[default]
    #[serde(rename = "m-kg-s")]
    Si,
    /// mm, t, N.
    #[serde(rename = "mm-t-s")]
    Millimetre,
}

impl Units {
    /// Metres of the unit of length.
    pub fn length(self) -> f64 {
        match self {
            Self::Si => 1.0,
            Self::Millimetre => 1e-3,
        }
    }

    /// N/m of the unit of stiffness, which is also kg of the unit of mass.
    pub fn stiffness_and_mass(self) -> f64 {
        match self {
            Self::Si => 1.0,
            Self::Millimetre => 1e3,
        }
    }

    /// Pa of the unit of stress, which is N/mm^2 or N/m^2; and kg/m^3 of that of density.
    pub fn stress_and_density(self) -> [f64; 2] {
        match self {
            Self::Si => [1.0, 1.0],
            Self::Millimetre => [1e6, 1e12],
        }
    }
}

/// Axis of rotation in the coordinates of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Axis {
    X,
    Y,
    #[default]
    Z,
}

impl Axis {
    /// Where each direction of the files goes, so that the axis of rotation becomes z.
    pub fn places(self) -> [usize; 3] {
        match self {
            Self::X => [2, 0, 1],
            Self::Y => [1, 2, 0],
            Self::Z => [0, 1, 2],
        }
    }

    /// Unit vector in the coordinates of the files.
    pub fn vector(self) -> [f64; 3] {
        match self {
            Self::X => [1.0, 0.0, 0.0],
            Self::Y => [0.0, 1.0, 0.0],
            Self::Z => [0.0, 0.0, 1.0],
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    code: Code,
    name: String,
    sectors: usize,
    #[serde(default)]
    units: Units,
    #[serde(default)]
    axis: Axis,
    position_tolerance_m: Option<f64>,
    mesh_format: Option<MeshFormat>,
    matrix_format: Option<MatrixFormat>,
    blisk: BliskTable,
    ring: Option<RingTable>,
    contact: Option<ContactTable>,
    #[serde(default)]
    force: Vec<ForceTable>,
    #[serde(default)]
    observe: Vec<ObserveTable>,
}

/// Files of one body.
#[derive(Debug, Clone, Default, Deserialize)]
pub(super) struct FilesTable {
    pub mesh: Option<PathBuf>,
    pub job: Option<PathBuf>,
    pub stiffness: Option<PathBuf>,
    pub mass: Option<PathBuf>,
    pub dofs: Option<PathBuf>,
    pub stiffness_name: Option<String>,
    pub mass_name: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BliskTable {
    pub mesh: Option<PathBuf>,
    pub job: Option<PathBuf>,
    pub stiffness: Option<PathBuf>,
    pub mass: Option<PathBuf>,
    pub dofs: Option<PathBuf>,
    pub stiffness_name: Option<String>,
    pub mass_name: Option<String>,
    pub low_face: String,
    pub high_face: String,
    pub blade_elements: Option<String>,
    pub blade_job: Option<PathBuf>,
    pub blade_stiffness: Option<PathBuf>,
    pub blade_dofs: Option<PathBuf>,
    pub blade_stiffness_name: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RingTable {
    pub mesh: Option<PathBuf>,
    pub job: Option<PathBuf>,
    pub stiffness: Option<PathBuf>,
    pub mass: Option<PathBuf>,
    pub dofs: Option<PathBuf>,
    pub stiffness_name: Option<String>,
    pub mass_name: Option<String>,
    pub low_face: String,
    pub high_face: String,
    /// Nodes or elements of the ring, where it stands in the blisk's files.
    pub set: Option<String>,
    pub grounding_hz: Option<f64>,
}

/// How the contact surfaces are paired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Pairing {
    /// Node to node.
    #[default]
    Nodes,
    /// The ring's nodes projected on the blisk's faces.
    Projection,
}

/// How much each contact pair counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Weights {
    /// By the area that each node stands for.
    #[default]
    Area,
    /// The same for every pair.
    Equal,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactTable {
    pub blisk: String,
    pub ring: String,
    pub tolerance_m: Option<f64>,
    #[serde(default)]
    pub pairing: Pairing,
    #[serde(default)]
    pub weights: Weights,
    /// Outward normal of the blisk's surface (r, theta, z), where the mesh has no elements.
    pub normal: Option<[f64; 3]>,
}

/// Direction of a force.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub(super) enum ForceDirection {
    #[serde(rename = "r")]
    Radial,
    #[serde(rename = "t")]
    Tangential,
    #[serde(rename = "z")]
    Axial,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ForceTable {
    pub node: Option<usize>,
    pub set: Option<String>,
    pub component: ForceDirection,
    #[serde(default = "one")]
    pub re: f64,
    #[serde(default)]
    pub im: f64,
}

fn one() -> f64 {
    1.0
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObserveTable {
    pub name: String,
    pub node: Option<usize>,
    pub set: Option<String>,
}

/// An import file with its formats decided and its numbers checked.
#[derive(Debug)]
pub(super) struct ImportFile {
    pub path: PathBuf,
    pub name: String,
    pub sectors: usize,
    pub units: Units,
    pub axis: Axis,
    pub position_tolerance_m: Option<f64>,
    pub mesh_format: MeshFormat,
    pub matrix_format: MatrixFormat,
    pub blisk: BliskTable,
    pub ring: Option<RingTable>,
    pub contact: Option<ContactTable>,
    pub force: Vec<ForceTable>,
    pub observe: Vec<ObserveTable>,
}

impl ImportFile {
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let source = Source::read(path)?;
        let raw: RawFile = toml::from_str(&source.text).map_err(|error| {
            let offset = error.span().map_or(0, |span| span.start);
            let before = source.text.get(..offset).unwrap_or("");
            let message = error.message().replace('\n', " ");
            let last = source.text.lines().count().max(1);
            source.refuse(
                (1 + before.matches('\n').count()).min(last),
                LineProblem::Toml { message },
            )
        })?;
        let file = Self {
            path: path.to_owned(),
            name: raw.name,
            sectors: raw.sectors,
            units: raw.units,
            axis: raw.axis,
            position_tolerance_m: raw.position_tolerance_m,
            mesh_format: raw.mesh_format.unwrap_or(match raw.code {
                Code::Calculix => MeshFormat::Calculix,
                Code::Ansys => MeshFormat::Ansys,
                Code::Nastran => MeshFormat::Nastran,
            }),
            matrix_format: raw.matrix_format.unwrap_or(match raw.code {
                Code::Calculix => MatrixFormat::Calculix,
                Code::Ansys => MatrixFormat::HarwellBoeing,
                Code::Nastran => MatrixFormat::Dmig,
            }),
            blisk: raw.blisk,
            ring: raw.ring,
            contact: raw.contact,
            force: raw.force,
            observe: raw.observe,
        };
        file.check()?;
        Ok(file)
    }

    fn check(&self) -> Result<(), ModelError> {
        if self.sectors == 0 || self.sectors > MAX_SECTORS {
            let accepted = format!("a whole number from 1 to {MAX_SECTORS}");
            return Err(self.value("sectors", &self.sectors, accepted));
        }
        let grounding = self.ring.as_ref().and_then(|ring| ring.grounding_hz);
        let tolerance = self
            .contact
            .as_ref()
            .and_then(|contact| contact.tolerance_m);
        for (key, value) in [
            ("position_tolerance_m", self.position_tolerance_m),
            ("contact.tolerance_m", tolerance),
            ("ring.grounding_hz", grounding),
        ] {
            if let Some(value) = value
                && !(value.is_finite() && value >= 0.0)
            {
                return Err(self.value(key, &value, "a finite number of 0 or more".to_owned()));
            }
        }
        if self.contact.is_some() != self.ring.is_some() {
            let (key, accepted) = if self.ring.is_some() {
                ("contact", "the surfaces that touch, as there is a [ring]")
            } else {
                ("ring", "the files of the ring, as there is a [contact]")
            };
            return Err(self.missing(key, accepted));
        }
        if self.force.is_empty() {
            return Err(self.missing(
                "force",
                "at least one [[force]] with set or node, and component",
            ));
        }
        if self.observe.is_empty() {
            return Err(self.missing(
                "observe",
                "at least one [[observe]] with name, and set or node",
            ));
        }
        Ok(())
    }

    pub fn value(&self, key: &str, found: &impl ToString, accepted: String) -> ModelError {
        refuse(
            &self.path,
            ImportProblem::Value {
                key: key.to_owned(),
                found: found.to_string(),
                accepted,
            },
        )
    }

    pub fn missing(&self, key: &str, accepted: &str) -> ModelError {
        refuse(
            &self.path,
            ImportProblem::KeyMissing {
                key: key.to_owned(),
                accepted: accepted.to_owned(),
            },
        )
    }

    /// A path of the import file, which is relative to its folder.
    fn beside(&self, path: &Path) -> PathBuf {
        self.path
            .parent()
            .unwrap_or_else(|| Path::new(""))
            .join(path)
    }

    /// The files of a body; none where the ring stands in the blisk's.
    pub fn files(&self, body: Body) -> Option<FilesTable> {
        let table = match body {
            Body::Blisk => FilesTable {
                mesh: self.blisk.mesh.clone(),
                job: self.blisk.job.clone(),
                stiffness: self.blisk.stiffness.clone(),
                mass: self.blisk.mass.clone(),
                dofs: self.blisk.dofs.clone(),
                stiffness_name: self.blisk.stiffness_name.clone(),
                mass_name: self.blisk.mass_name.clone(),
            },
            Body::Ring => {
                let ring = self.ring.as_ref()?;
                if ring.mesh.is_none() && ring.job.is_none() && ring.stiffness.is_none() {
                    return None;
                }
                FilesTable {
                    mesh: ring.mesh.clone(),
                    job: ring.job.clone(),
                    stiffness: ring.stiffness.clone(),
                    mass: ring.mass.clone(),
                    dofs: ring.dofs.clone(),
                    stiffness_name: ring.stiffness_name.clone(),
                    mass_name: ring.mass_name.clone(),
                }
            }
        };
        Some(table)
    }

    /// The mesh file: the one named, or the deck of the `CalculiX` job.
    pub fn mesh_path(&self, prefix: &str, files: &FilesTable) -> Result<PathBuf, ModelError> {
        match (&files.mesh, &files.job) {
            (Some(mesh), _) => Ok(self.beside(mesh)),
            (None, Some(job)) => Ok(self.beside(&with_suffix(job, "inp"))),
            (None, None) => {
                let key = format!("{prefix}.mesh");
                Err(self.missing(&key, "the file with nodes, elements and sets"))
            }
        }
    }

    /// The matrix files of a body.
    pub fn matrix_files(
        &self,
        prefix: &str,
        files: &FilesTable,
    ) -> Result<MatrixFiles, ModelError> {
        let calculix = self.matrix_format == MatrixFormat::Calculix;
        let path = |own: &Option<PathBuf>, suffix: &str, key: &str| match (own, &files.job) {
            (Some(own), _) => Ok(self.beside(own)),
            (None, Some(job)) if calculix => Ok(self.beside(&with_suffix(job, suffix))),
            (None, _) if key == "dofs" && self.matrix_format == MatrixFormat::Dmig => {
                Ok(PathBuf::new())
            }
            (None, _) => {
                let accepted = if calculix {
                    "a file, or the key job with the name of the CalculiX job"
                } else {
                    "a file"
                };
                Err(self.missing(&format!("{prefix}{key}"), accepted))
            }
        };
        Ok(MatrixFiles {
            format: self.matrix_format,
            stiffness: path(&files.stiffness, "sti", "stiffness")?,
            // A punch file holds both.
            mass: match (&files.mass, &files.stiffness) {
                (None, Some(both))
                    if matches!(self.matrix_format, MatrixFormat::Dmig | MatrixFormat::Op4) =>
                {
                    self.beside(both)
                }
                _ => path(&files.mass, "mas", "mass")?,
            },
            dofs: path(&files.dofs, "dof", "dofs")?,
            stiffness_name: files.stiffness_name.clone(),
            mass_name: files.mass_name.clone(),
        })
    }

    /// The files of the blade's stiffness, where a run of its own wrote it.
    pub fn blade_files(&self) -> Result<Option<MatrixFiles>, ModelError> {
        let blisk = &self.blisk;
        if blisk.blade_job.is_none() && blisk.blade_stiffness.is_none() {
            return Ok(None);
        }
        let files = FilesTable {
            mesh: None,
            job: blisk.blade_job.clone(),
            stiffness: blisk.blade_stiffness.clone(),
            // The mass of the blade alone is not needed; the file is never opened.
            mass: blisk.blade_stiffness.clone(),
            dofs: blisk.blade_dofs.clone().or_else(|| blisk.dofs.clone()),
            stiffness_name: blisk.blade_stiffness_name.clone(),
            mass_name: None,
        };
        self.matrix_files("blisk.blade_", &files).map(Some)
    }
}

/// The name of a file of a job; a dot in the name of the job is no suffix.
fn with_suffix(job: &Path, suffix: &str) -> PathBuf {
    let mut name = job.as_os_str().to_owned();
    name.push(".");
    name.push(suffix);
    PathBuf::from(name)
}
