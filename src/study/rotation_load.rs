//! Normal loads by rotation as a study has them: its speeds, and the newtons that they came to.

use serde::{Deserialize, Serialize};

use crate::linalg::SymmetricSparse;
use crate::model::cyclic::{CentrifugalContact, Hoop};
use crate::model::sector::{Body, SectorModel};
use crate::report::RotationFacts;
use crate::response::forced_response::ContactCondition;

/// How the load of a sector is shared out over its pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoadShare {
    /// By the weights of the pairs, as contact stiffness is: even pressure.
    #[default]
    Weight,
    /// As the static equilibrium has it.
    Equilibrium,
}

/// `[contact.normal_load]` with `from = "rotation"`.
#[derive(Debug, Clone, PartialEq)]
pub struct RotationOptions {
    /// Speeds, revolutions per minute, as written.
    pub speeds_rpm: Vec<f64>,
    /// Whether the ring carries hoop force.
    pub hoop: Hoop,
    /// How the load is shared out.
    pub share: LoadShare,
    /// Factor on the mass of ring or damper body, in its load and in its vibration.
    pub ring_mass_factor: f64,
    /// Radius of a ring of masses and springs, m.
    pub ring_radius_m: Option<f64>,
}

/// Normal loads by rotation.
#[derive(Debug, Clone, PartialEq)]
pub struct RotationLoad {
    /// What the study says.
    pub options: RotationOptions,
    /// Normal load per sector at each speed, N.
    pub normal_loads_n: Vec<f64>,
    /// Share of each pair of a sector; none where it is that of the stiffness.
    pub load_weights: Option<Vec<f64>>,
    /// Ring or damper body under rotation, and the pairs that are pressed.
    pub contact: CentrifugalContact,
    /// Whether that is a damper body of each sector, and no ring.
    pub is_damper_body: bool,
}

impl RotationLoad {
    /// Speed that gives this load, revolutions per minute; none for a load in newtons.
    #[must_use]
    pub fn speed_rpm(&self, contact: ContactCondition) -> Option<f64> {
        let load_n = contact.normal_load_n()?;
        let loads = self.normal_loads_n.iter().zip(&self.options.speeds_rpm);
        loads
            .filter(|(known_n, _)| known_n.total_cmp(&load_n).is_eq())
            .map(|(_, &speed)| speed)
            .next()
    }

    /// Part of its centrifugal load that the contact takes; the rest is hoop force.
    #[must_use]
    pub fn contact_fraction(&self) -> f64 {
        self.contact.sector_load_kg_m() / self.contact.ring_load_kg_m
    }

    /// What it came to, for reports.
    #[must_use]
    pub fn facts(&self) -> RotationFacts {
        RotationFacts {
            speed_rpm: self.options.speeds_rpm.clone(),
            normal_load_n: self.normal_loads_n.clone(),
            is_damper_body: self.is_damper_body,
            ring_mass_kg: self.contact.ring_mass_kg,
            ring_radius_m: self.contact.ring_radius_m(),
            contact_fraction: self.contact_fraction(),
            pair_load_kg_m: self.contact.pair_loads_kg_m.clone(),
        }
    }

    /// The sector as the study has it: the mass of its ring or damper body, and the shares of the load.
    pub(super) fn applied_to(&self, mut model: SectorModel) -> SectorModel {
        model = with_ring_mass(model, self.options.ring_mass_factor);
        if let Some(weights) = &self.load_weights {
            for (pair, &weight) in model.contact_pairs.iter_mut().zip(weights) {
                pair.load_weight = Some(weight);
            }
        }
        model
    }
}

/// The model with the mass of its ring or damper body multiplied by `factor`.
pub(super) fn with_ring_mass(model: SectorModel, factor: f64) -> SectorModel {
    let scaled: Vec<_> = model
        .mass
        .lower_entries()
        .map(|(row, column, value)| {
            let on_ring = model.dofs[row].body != Body::Blisk;
            (row, column, if on_ring { factor * value } else { value })
        })
        .collect();
    SectorModel {
        mass: SymmetricSparse::from_lower_triplets(model.mass.dimension(), &scaled),
        ..model
    }
}

/// The body that its own centrifugal force presses on; none where contacts join blades or the ground alone.
pub(super) fn pressed_body(model: &SectorModel) -> Option<Body> {
    let is_there = |body: &Body| model.dofs.iter().any(|dof| dof.body == *body);
    [Body::Ring, Body::Damper].into_iter().find(is_there)
}
