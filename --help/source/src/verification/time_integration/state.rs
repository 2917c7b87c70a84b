//! The wheel that is marched, and its state at one instant.

use super::contact_rows::ContactRows;
use crate::linalg::Complex64;
use crate::response::friction::PairMemory;
use crate::response::harmonic_balance::{ContactInterface, Structure};

/// What is marched: a whole wheel with its contact law under one excitation.
#[derive(Debug, Clone, Copy)]
pub struct MarchedWheel<'a> {
    /// Structure with a damping that has a time-domain form, all sectors, real rows.
    pub structure: &'a Structure,
    /// Law and pairs of one sector, the normal load included.
    pub interface: &'a ContactInterface,
    /// Modal force of the excitation, `n_modes`.
    pub force: &'a [Complex64],
    /// Angular frequency of the excitation, rad/s.
    pub omega: f64,
}

/// Everything that the motion after an instant depends on, besides the phase of the excitation.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelState {
    /// Modal positions, `n_modes`.
    pub position: Vec<f64>,
    /// Modal velocities, per second, `n_modes`.
    pub velocity: Vec<f64>,
    /// Memory of every pair, sector after sector.
    pub pairs: Vec<PairMemory>,
    /// Constant force added to the contact force of every contact row, N; see
    /// [`super::Motion::start`].
    pub balance_n: Vec<f64>,
}

impl WheelState {
    /// The wheel at rest, nothing balanced.
    #[must_use]
    pub fn at_rest(wheel: &MarchedWheel<'_>) -> Self {
        let rows = wheel.structure.contact().real.rows();
        Self {
            position: vec![0.0; wheel.structure.size()],
            velocity: vec![0.0; wheel.structure.size()],
            pairs: ContactRows::new(wheel.interface, rows).at_rest(),
            balance_n: vec![0.0; rows],
        }
    }
}
