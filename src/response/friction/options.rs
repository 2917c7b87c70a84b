//! What a user chooses about the contact between blisk and ring.

use serde::{Deserialize, Serialize};

/// Contact law of a node pair. What each is stands in its file, and the list of all in `laws.rs`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactLaw {
    /// Friction along the first tangent only, limit `mu N0`; normal spring bilateral where given.
    MacroSlip1d,
    /// Friction along both tangents, each by itself, limit `mu N0`; normal spring bilateral where given.
    MacroSlip2d,
    /// Variable normal load `max(0, N0 + kn g)` and two independent tangential Jenkins elements.
    Simplified3d,
    /// Variable normal load `max(0, N0 + kn g)` and both tangents coupled by the friction circle.
    Coulomb3d,
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
