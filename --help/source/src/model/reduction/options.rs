//! What a user chooses about the reduction.

use serde::{Deserialize, Serialize};

/// Family of the reduction basis of each nodal diameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// [`Self::TunedReceptances`] wherever these serve; else stick modes and attachment vectors, or [`Self::StickSlide`] where these would
    /// be many.
    Auto,
    /// Modes under global sticking and global sliding contact.
    StickSlide,
    /// [`Self::Auto`], by the name that earlier versions had for what it takes where no tuned receptances serve.
    StickAttachment,
    /// No basis: rows are solved on the receptances of the tuned wheel with every contact degree of freedom.
    TunedReceptances,
}

/// Settings of the reduction, with their defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ReductionOptions {
    /// Family of the basis. Default `auto`.
    pub basis: Basis,
    /// Wanted relative error of the judged peaks, by which numbers of modes are chosen. Default 0.001.
    pub error: f64,
    /// Number of stick modes per nodal diameter; fixes the size instead of `error`.
    pub stick_modes: Option<usize>,
    /// Number of slide modes per nodal diameter (not `stick_attachment`); fixes the size instead of `error`.
    pub slide_modes: Option<usize>,
    /// Fixed-interface modes of the Craig-Bampton model per nodal diameter. Absent: so many, from
    /// [`Self::FIRST_CRAIG_BAMPTON_MODES`] on, that more of them change no tuned peak by more than
    /// [`Self::error`].
    pub craig_bampton_modes: Option<usize>,
    /// Sensitivity vectors to blade stiffness per nodal diameter. Absent: 2 where a standard
    /// deviation of the study reaches 5 %, otherwise none.
    pub sensitivity_vectors: Option<usize>,
}

impl ReductionOptions {
    /// Fixed-interface modes that are tried first.
    pub const FIRST_CRAIG_BAMPTON_MODES: usize = 25;
}

impl Default for ReductionOptions {
    fn default() -> Self {
        Self {
            basis: Basis::Auto,
            error: 1e-3,
            stick_modes: None,
            slide_modes: None,
            craig_bampton_modes: None,
            sensitivity_vectors: None,
        }
    }
}
