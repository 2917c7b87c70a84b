//! What a user chooses about the contact between blisk and ring.

use serde::{Deserialize, Serialize};

use super::{ContactLaw, PairParameters};

/// What a free ring does under mean friction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ring {
    /// Something holds the ring: mean friction has no effect.
    #[default]
    Locked,
    /// The ring drifts along its rigid motions so that friction has no mean along them.
    Creeping,
}

/// Contact law and its parameters; stiffnesses are per sector and shared out by pair weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactOptions {
    /// Contact law. Default `simplified_3d`.
    #[serde(default = "default_law")]
    pub law: ContactLaw,
    /// Coefficient of friction mu.
    pub friction_coefficient: f64,
    /// Tangential contact stiffness per sector, N/m.
    pub tangential_stiffness_n_per_m: f64,
    /// Normal contact stiffness per sector, N/m; optional under a constant normal load only.
    pub normal_stiffness_n_per_m: Option<f64>,
    /// What a free ring does under mean friction. Default `locked`.
    #[serde(default)]
    pub ring: Ring,
}

impl ContactOptions {
    /// The parameters of a whole sector under the normal load `normal_load_n`, to be shared out
    /// over its pairs.
    #[must_use]
    pub fn sector_parameters(&self, normal_load_n: f64) -> PairParameters {
        PairParameters {
            normal_load_n,
            normal_stiffness_n_per_m: self.normal_stiffness_n_per_m.unwrap_or(0.0),
            tangential_stiffness_n_per_m: self.tangential_stiffness_n_per_m,
            friction_coefficient: self.friction_coefficient,
        }
    }
}

fn default_law() -> ContactLaw {
    ContactLaw::Simplified3d
}
