//! Damping of the structure; contact springs are never damped.

use serde::{Deserialize, Serialize};

/// Damping model of the structure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Damping {
    /// `K (1 + i eta)` on harmonics k >= 1, the mistuning part of K included.
    StructuralLossFactor(f64),
    /// Viscous `2 zeta omega_r` on the tuned contact-free modes, unchanged by mistuning.
    ModalRatio(f64),
    /// Viscous `C = a M + b K` of the tuned wheel, unchanged by mistuning.
    Rayleigh {
        /// Factor a on the mass, 1/s.
        mass_per_s: f64,
        /// Factor b on the stiffness, s.
        stiffness_s: f64,
    },
}
