//! What rotation makes of ring or damper body: its load, and what of it the contact takes.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Normal loads by rotation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RotationFacts {
    /// Speeds, revolutions per minute.
    pub speed_rpm: Vec<f64>,
    /// Normal load per sector at each, N.
    pub normal_load_n: Vec<f64>,
    /// Whether it presses a damper body of each sector, and no ring.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_damper_body: bool,
    /// Mass of a sector's ring or damper body, kg.
    pub ring_mass_kg: f64,
    /// Radius at which that mass has its centrifugal load, m.
    pub ring_radius_m: f64,
    /// Sum of the normal loads over that centrifugal load; the rest is hoop force.
    pub contact_fraction: f64,
    /// Normal load of each pair in the equilibrium over the square of the angular velocity, kg m.
    pub pair_load_kg_m: Vec<f64>,
}

impl RotationFacts {
    /// The speed that a normal load is that of, revolutions per minute; none for one written in newtons.
    #[must_use]
    pub fn speed_of(&self, normal_load_n: f64) -> Option<f64> {
        let loads = self.normal_load_n.iter().zip(&self.speed_rpm);
        loads
            .filter(|(own, _)| own.total_cmp(&normal_load_n).is_eq())
            .map(|(_, &speed)| speed)
            .next()
    }

    /// Speeds with their loads, in words.
    #[must_use]
    pub fn loads(&self) -> String {
        let loads = self.speed_rpm.iter().zip(&self.normal_load_n);
        let told: Vec<String> = loads
            .map(|(speed, load)| format!("{speed} rpm: {load:.1} N"))
            .collect();
        told.join(", ")
    }
}

impl fmt::Display for RotationFacts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pressed = self.pair_load_kg_m.iter().filter(|load| **load > 0.0);
        write!(
            f,
            "rotation: {} of {:.4} kg per sector at {:.4} m, contact takes {:.1} % of its load, {} of {} pairs pressed; {}",
            if self.is_damper_body {
                "damper body"
            } else {
                "ring"
            },
            self.ring_mass_kg,
            self.ring_radius_m,
            100.0 * self.contact_fraction,
            pressed.count(),
            self.pair_load_kg_m.len(),
            self.loads()
        )
    }
}
