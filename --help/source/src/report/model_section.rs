//! The model behind a study as a report shows it: what it is made of, its frequencies, and where it touches.

use serde::Serialize;

use super::{CampbellReport, StudyEcho};
use crate::model::sector::Body;

/// The model of a study, or why a report has none.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum ShownModel {
    /// The model is shown.
    Shown(Box<ModelSection>),
    /// The model is not shown, and why.
    NotShown {
        /// Why.
        reason: String,
    },
}

impl ShownModel {
    /// The model, where it is shown.
    #[must_use]
    pub fn section(&self) -> Option<&ModelSection> {
        match self {
            Self::Shown(section) => Some(section),
            Self::NotShown { .. } => None,
        }
    }
}

/// The model of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelSection {
    /// The study in words.
    pub echo: StudyEcho,
    /// Its contact law; none for a model without contact.
    pub contact: Option<ContactFacts>,
    /// Masses of its bodies.
    pub masses: Vec<BodyMass>,
    /// Natural frequencies of the tuned wheel, and where the engine orders of the study meet them.
    pub campbell: CampbellReport,
    /// Where the parts of a sector are.
    pub sector: SectorPicture,
}

/// The contact law of a study with its parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactFacts {
    /// Name of the law.
    pub law: &'static str,
    /// Coefficient of friction mu.
    pub friction_coefficient: f64,
    /// Tangential stiffness kt of a sector, N/m.
    pub tangential_stiffness_n_per_m: f64,
    /// Normal stiffness kn of a sector, N/m; none where the normal load is constant.
    pub normal_stiffness_n_per_m: Option<f64>,
}

/// Mass of a body in one sector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BodyMass {
    /// The body.
    pub body: Body,
    /// Mass that can move of the body in one sector, kg; the whole wheel has N times that.
    pub sector_kg: f64,
}

/// Positions in the frame of sector 0, m; z is the axis of rotation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SectorPicture {
    /// Every node of the sector, those of both cyclic faces included; too many for the JSON of a report.
    #[serde(skip)]
    pub nodes: Vec<PictureNode>,
    /// Whether the nodes are masses that move along one line each, whose places say nothing of their shape.
    #[serde(skip)]
    pub is_of_masses: bool,
    /// Pairs of places in `nodes`: springs between masses, neighbours in a mesh.
    #[serde(skip)]
    pub links: Vec<(usize, usize)>,
    /// Contact pairs.
    pub contacts: Vec<ContactPlace>,
    /// Nodes on which the excitation acts.
    pub forced_m: Vec<[f64; 3]>,
    /// Observed nodes; the first has the peak amplitude.
    pub observed_m: Vec<[f64; 3]>,
}

/// A node of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureNode {
    /// Its body.
    pub body: Body,
    /// Its position, m.
    pub position_m: [f64; 3],
}

/// A contact pair of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactPlace {
    /// Position of its first side, m.
    pub first_m: [f64; 3],
    /// Position of its second side, m; none: it is the ground.
    pub second_m: Option<[f64; 3]>,
    /// Share of the sector's contact stiffness.
    pub weight: f64,
}
