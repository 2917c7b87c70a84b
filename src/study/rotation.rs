//! Normal loads by rotation: from speeds to newtons, and what of the ring is pressed how hard.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::sector_model::sector_of;
use super::{Problem, Study, StudyError};
use crate::linalg::SymmetricSparse;
use crate::model::cyclic::{CentrifugalContact, CentrifugalError, Hoop, centrifugal_contact};
use crate::model::sector::{Body, SectorModel};
use crate::report::RotationFacts;
use crate::response::forced_response::ContactCondition;

/// Table of the study that asks for it.
const KEY: &str = "contact.normal_load";
/// Significant digits of the loads: rounding of the equilibrium is no key of a row.
const DIGITS: usize = 9;

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
    /// Factor on the ring's mass, in its load and in its vibration.
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
    /// The ring under rotation, and the pairs that are pressed.
    pub contact: CentrifugalContact,
}

impl RotationOptions {
    /// As the study file has it.
    fn resolved(&self) -> Value {
        let mut value = json!({
            "from": "rotation",
            "speed_rpm": self.speeds_rpm,
            "ring_mass_factor": self.ring_mass_factor,
        });
        if let Some(radius_m) = self.ring_radius_m {
            value["ring_radius_m"] = json!(radius_m);
        } else {
            value["hoop"] = json!(self.hoop);
            value["share"] = json!(self.share);
        }
        value
    }
}

impl RotationLoad {
    /// As the study file has it.
    pub(super) fn resolved(&self) -> Value {
        self.options.resolved()
    }

    /// Speed that gives this load, revolutions per minute; none for a load in newtons.
    #[must_use]
    pub fn speed_rpm(&self, contact: ContactCondition) -> Option<f64> {
        let load_n = contact.normal_load_n()?;
        let loads = self.normal_loads_n.iter().zip(&self.options.speeds_rpm);
        loads
            .filter(|(own, _)| own.total_cmp(&load_n).is_eq())
            .map(|(_, &speed)| speed)
            .next()
    }

    /// Part of the ring's centrifugal load that the contact takes; the rest is hoop force.
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
            ring_mass_kg: self.contact.ring_mass_kg,
            ring_radius_m: self.contact.ring_radius_m(),
            contact_fraction: self.contact_fraction(),
            pair_load_kg_m: self.contact.pair_loads_kg_m.clone(),
        }
    }

    /// The sector as the study has it: the mass of its ring, and the shares of the load.
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

impl Study {
    /// The study with the normal loads of the speeds of `options` after those written in newtons.
    ///
    /// # Errors
    /// The model is refused, or rotation presses no ring of it on.
    pub(super) fn pressed_by(self, options: Option<RotationOptions>) -> Result<Self, StudyError> {
        let Some(options) = options else {
            return Ok(self);
        };
        let model = with_ring_mass(sector_of(&self)?, options.ring_mass_factor);
        let contact = self.ring_under_rotation(&model, &options)?;
        let whole = contact.sector_load_kg_m();
        if whole <= 0.0 {
            return Err(self.no_rotation(
                KEY,
                "rotation does not press the ring on: the blisk gives way further than the ring, or the ring \
                 lies outside; accepted: hoop = \"split\", or newtons in sweep.normal_load_n",
            ));
        }
        let mut study = self;
        let mut normal_loads_n = Vec::new();
        let loads = study.contacts.iter().filter_map(|own| own.normal_load_n());
        let mut seen: BTreeSet<u64> = loads.map(f64::to_bits).collect();
        for speed_rpm in &options.speeds_rpm {
            let omega = TAU * speed_rpm / 60.0;
            let normal_load_n = rounded(whole * omega * omega);
            let condition = ContactCondition::Full { normal_load_n };
            if !seen.insert(normal_load_n.to_bits()) {
                let reason = format!(
                    "{speed_rpm} rpm is the load {normal_load_n} N, which the sweep has already; accepted: once"
                );
                return Err(study.no_rotation("contact.normal_load.speed_rpm", &reason));
            }
            normal_loads_n.push(normal_load_n);
            study.contacts.push(condition);
        }
        let load_weights = (options.share == LoadShare::Equilibrium).then(|| {
            contact
                .pair_loads_kg_m
                .iter()
                .map(|load| load / whole)
                .collect()
        });
        study.rotation = Some(RotationLoad {
            options,
            normal_loads_n,
            load_weights,
            contact,
        });
        Ok(study)
    }

    fn ring_under_rotation(
        &self,
        model: &SectorModel,
        options: &RotationOptions,
    ) -> Result<CentrifugalContact, StudyError> {
        let stiffness = self
            .contact
            .as_ref()
            .and_then(|contact| contact.normal_stiffness_n_per_m);
        let equilibrium = centrifugal_contact(model, stiffness.unwrap_or(0.0), options.hoop);
        match (equilibrium, options.ring_radius_m) {
            (Err(CentrifugalError::NoRadialMotion), Some(radius_m)) => {
                Ok(ring_of_masses(model, radius_m))
            }
            (Err(CentrifugalError::NoRadialMotion), None) => Err(self.missing(
                "contact.normal_load.ring_radius_m",
                "a number above 0 in m, because the ring of this model has no radial degree of freedom; or \
                 newtons in sweep.normal_load_n",
            )),
            (Err(CentrifugalError::NoContact), _) => Err(self.no_rotation(
                KEY,
                "the model has no contact; accepted: no [contact], and normal_load_n = [\"free\"]",
            )),
            (_, Some(_)) => Err(self.no_rotation(
                "contact.normal_load.ring_radius_m",
                "the model says where its ring lies; accepted: no ring_radius_m",
            )),
            (_, None) if stiffness.is_none() => Err(self.missing(
                "contact.normal_stiffness_n_per_m",
                "a finite number above 0, in N/m: the equilibrium of the ring under rotation needs it",
            )),
            (Err(error), None) => {
                let reason = format!("{error}; accepted: newtons in sweep.normal_load_n");
                Err(self.no_rotation(KEY, &reason))
            }
            (Ok(contact), None) => Ok(contact),
        }
    }

    fn no_rotation(&self, key: &str, reason: &str) -> StudyError {
        self.refused(
            key,
            Problem::Conflict {
                reason: reason.to_owned(),
            },
        )
    }

    fn missing(&self, key: &str, accepted: &str) -> StudyError {
        self.refused(
            key,
            Problem::Missing {
                accepted: accepted.to_owned(),
            },
        )
    }

    fn refused(&self, key: &str, problem: Problem) -> StudyError {
        StudyError::Invalid {
            path: self.path.clone(),
            findings: vec![self.map.finding(key, problem)],
        }
    }
}

/// A ring of one mass per sector at a radius, in which nothing carries hoop force: `N0 = m r Omega^2`.
fn ring_of_masses(model: &SectorModel, radius_m: f64) -> CentrifugalContact {
    let on_ring: Vec<f64> = model
        .dofs
        .iter()
        .map(|dof| f64::from(dof.body != Body::Blisk))
        .collect();
    let moved = model.mass.multiply(&on_ring);
    let ring_mass_kg: f64 = on_ring.iter().zip(&moved).map(|(a, b)| a * b).sum();
    let ring_load_kg_m = ring_mass_kg * radius_m;
    CentrifugalContact {
        pair_loads_kg_m: model
            .contact_pairs
            .iter()
            .map(|pair| pair.weight * ring_load_kg_m)
            .collect(),
        ring_mass_kg,
        ring_load_kg_m,
    }
}

/// The model with the mass of its ring multiplied by `factor`.
fn with_ring_mass(model: SectorModel, factor: f64) -> SectorModel {
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

/// To [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}
