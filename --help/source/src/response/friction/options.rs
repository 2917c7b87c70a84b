//! What a user chooses about the contact between blisk and ring.

use serde::{Deserialize, Serialize};

/// Contact law of a node pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactLaw {
    /// Friction along the first tangent only, limit `mu N0`; normal spring bilateral where given.
    #[serde(rename = "macro_slip_1d")]
    MacroSlip1d,
    /// Friction along both tangents, each by itself, limit `mu N0`; normal spring bilateral where given.
    #[serde(rename = "macro_slip_2d")]
    MacroSlip2d,
    /// Variable normal load `max(0, N0 + kn g)` and two independent tangential Jenkins elements.
    #[serde(rename = "simplified_3d")]
    Simplified3d,
    /// Variable normal load `max(0, N0 + kn g)` and both tangents coupled by the friction circle.
    #[serde(rename = "coulomb_3d")]
    Coulomb3d,
}

impl ContactLaw {
    /// Whether the normal load follows the normal displacement.
    #[must_use]
    pub fn has_variable_load(self) -> bool {
        match self {
            Self::MacroSlip1d | Self::MacroSlip2d => false,
            Self::Simplified3d | Self::Coulomb3d => true,
        }
    }

    /// Name in a study.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MacroSlip1d => "macro_slip_1d",
            Self::MacroSlip2d => "macro_slip_2d",
            Self::Simplified3d => "simplified_3d",
            Self::Coulomb3d => "coulomb_3d",
        }
    }

    /// Tangents along which there is friction, and a spring of the linear limits: t1, or both.
    #[must_use]
    pub fn tangents(self) -> usize {
        match self {
            Self::MacroSlip1d => 1,
            Self::MacroSlip2d | Self::Simplified3d | Self::Coulomb3d => 2,
        }
    }

    /// Springs along n, t1, t2 of a pair with these stiffnesses, N/m.
    #[must_use]
    pub fn springs(self, normal_n_per_m: f64, tangential_n_per_m: f64) -> [f64; 3] {
        let second = match self.tangents() {
            1 => 0.0,
            _ => tangential_n_per_m,
        };
        [normal_n_per_m, tangential_n_per_m, second]
    }
}

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
    /// Law of the study in whose place `law` is taken to keep an accepted error; never in a file.
    #[serde(skip)]
    pub in_place_of: Option<ContactLaw>,
}

fn default_law() -> ContactLaw {
    ContactLaw::Simplified3d
}
