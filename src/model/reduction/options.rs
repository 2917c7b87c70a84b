//! What a user chooses about the reduction.

use serde::{Deserialize, Serialize};

/// Family of the reduction basis of each nodal diameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// The smallest basis whose tuned nonlinear peak meets [`ReductionOptions::error`].
    Auto,
    /// Modes under global sticking and global sliding contact.
    StickSlide,
    /// Stick modes and one attachment vector per contact direction.
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
    /// Wanted relative error of the tuned nonlinear peak, used by `auto`. Default 0.001.
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
