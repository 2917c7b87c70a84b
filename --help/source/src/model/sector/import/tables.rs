//! The tables of an import file as they are written.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::matrices::MatrixFormat;

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

/// The file as written; [`super::keys`] has been held against it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawFile {
    pub code: Code,
    pub name: String,
    pub sectors: usize,
    #[serde(default)]
    pub units: Units,
    #[serde(default)]
    pub axis: Axis,
    pub position_tolerance_m: Option<f64>,
    pub mesh_format: Option<MeshFormat>,
    pub matrix_format: Option<MatrixFormat>,
    pub blisk: BliskTable,
    pub ring: Option<BodyTable>,
    pub damper: Option<BodyTable>,
    pub contact: Option<ContactTables>,
    pub force: Vec<ForceTable>,
    pub observe: Vec<ObserveTable>,
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

/// A body beside the blisk: a ring, or a damper, which has no faces.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyTable {
    pub mesh: Option<PathBuf>,
    pub job: Option<PathBuf>,
    pub stiffness: Option<PathBuf>,
    pub mass: Option<PathBuf>,
    pub dofs: Option<PathBuf>,
    pub stiffness_name: Option<String>,
    pub mass_name: Option<String>,
    pub low_face: Option<String>,
    pub high_face: Option<String>,
    /// Nodes or elements of the body, where it stands in the blisk's files.
    pub set: Option<String>,
    pub grounding_hz: Option<f64>,
}

impl BodyTable {
    /// Whether the body has files of its own.
    pub fn has_files(&self) -> bool {
        self.mesh.is_some() || self.job.is_some() || self.stiffness.is_some()
    }
}

/// How the contact surfaces are paired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Pairing {
    /// Node to node.
    #[default]
    Nodes,
    /// The nodes of a ring projected on the blisk's faces.
    Projection,
}

/// How much each contact pair counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Weights {
    /// By the area that each node stands for.
    #[default]
    Area,
    /// Every pair has the same weight.
    Equal,
}

/// `[contact]`, or `[[contact]]`.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum ContactTables {
    One(ContactTable),
    More(Vec<ContactTable>),
}

/// Either `blisk` and `ring` or `first` and `second` are given.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ContactTable {
    pub blisk: Option<String>,
    pub ring: Option<String>,
    pub first: Option<String>,
    pub second: Option<String>,
    pub tolerance_m: Option<f64>,
    #[serde(default)]
    pub pairing: Pairing,
    #[serde(default)]
    pub weights: Weights,
    /// Share of all its pairs together, relative to the other contacts.
    pub weight: Option<f64>,
    /// Outward normal of the first side's surface (r, theta, z), where the mesh has no elements.
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
