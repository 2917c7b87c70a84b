//! The contact of a wheel along a periodic motion: what a small disturbance does to every pair in every step of a period.

use std::f64::consts::TAU;

use super::contact_tangent::{FrictionChange, StepChange, step_change};
use crate::linalg::Complex64;
use crate::response::friction::{PairMemory, march};
use crate::response::harmonic_balance::ContactInterface;

/// Periods in which sliders find their places on the motion.
const SLIDER_PERIODS: usize = 3;

/// A periodic motion of the contact rows of a wheel, sector after sector: `u(t) = Re sum_k u_k e^{i k omega t}`.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactMotion {
    /// Harmonics k with the complex amplitudes of every row, m.
    pub harmonics: Vec<(u32, Vec<Complex64>)>,
}

impl ContactMotion {
    /// The rows at `turn` of a period, m.
    fn at(&self, turn: f64, rows: usize) -> Vec<f64> {
        let mut u = vec![0.0; rows];
        for (harmonic, amplitudes) in &self.harmonics {
            let phase = Complex64::from_polar(1.0, TAU * (f64::from(*harmonic) * turn).fract());
            for (u, amplitude) in u.iter_mut().zip(amplitudes) {
                *u += (amplitude * phase).re;
            }
        }
        u
    }
}

/// The pairs of a wheel along one period.
#[derive(Debug)]
pub(super) struct ContactPath {
    /// Contact rows of a sector.
    pub(super) sector_rows: usize,
    /// Rows of every pair of a sector.
    pub(super) pair_rows: Vec<[Option<usize>; 3]>,
    /// Tangential stiffness of every pair of the wheel, N/m.
    pub(super) tangential: Vec<f64>,
    /// Changes of the contact over a step: step after step, in it pair after pair of the wheel.
    changes: Vec<StepChange>,
    /// Whether a tangent of a pair sticks throughout the period, or is none, t1 then t2, pair after pair.
    pub(super) held: Vec<bool>,
    pub(super) steps: usize,
}

impl ContactPath {
    /// Along `motion` in so many steps.
    pub(super) fn new(
        interface: &ContactInterface,
        motion: &ContactMotion,
        sectors: usize,
        steps: usize,
    ) -> Self {
        let sector_rows = interface.geometry.row_count();
        let per_sector = interface.per_sector();
        let pairs = sectors * per_sector;
        let rows = sectors * sector_rows;
        let path: Vec<Vec<f64>> = (0..steps)
            .map(|step| motion.at(step as f64 / steps as f64, rows))
            .collect();
        let mut changes = vec![StepChange::default(); steps * pairs];
        let mut held = vec![false; 2 * pairs];
        for pair in 0..pairs {
            let parameters = interface.pair(pair);
            let first = pair / per_sector * sector_rows;
            let places = interface.geometry.rows[pair % per_sector];
            let at = |step: usize| places.map(|row| row.map_or(0.0, |row| path[step][first + row]));
            let mut memory = PairMemory::at_rest(parameters);
            // The slider stands where the mean displacement leaves it relaxed.
            for step in 0..steps {
                for (mean, u) in memory.displacement_m.iter_mut().zip(at(step)) {
                    *mean += u / steps as f64;
                }
            }
            for period in 0..SLIDER_PERIODS {
                for step in 1..=steps {
                    let after = march(interface.law, parameters, &memory, at(step % steps));
                    if period + 1 == SLIDER_PERIODS {
                        changes[(step - 1) * pairs + pair] =
                            step_change(interface.law, parameters, &memory, &after);
                    }
                    memory = after;
                }
            }
            for tangent in 0..2 {
                let sticks = |step: usize| {
                    changes[step * pairs + pair].friction[tangent] == FrictionChange::Stick
                };
                held[2 * pair + tangent] = places[1 + tangent].is_none() || (0..steps).all(sticks);
            }
        }
        Self {
            sector_rows,
            pair_rows: interface.geometry.rows.clone(),
            tangential: (0..pairs)
                .map(|pair| interface.pair(pair).tangential_stiffness_n_per_m)
                .collect(),
            changes,
            held,
            steps,
        }
    }

    /// Number of pairs of the wheel.
    pub(super) fn pairs(&self) -> usize {
        self.tangential.len()
    }

    /// The pairs of a sector in a step.
    pub(super) fn of_sector(&self, step: usize, sector: usize) -> &[StepChange] {
        let per_sector = self.pair_rows.len();
        &self.changes[step * self.pairs() + sector * per_sector..][..per_sector]
    }

    /// The pairs at the instant between two periods: forces by displacements and sliders alone.
    pub(super) fn at_rest(&self) -> Vec<StepChange> {
        let last = &self.changes[(self.steps - 1) * self.pairs()..];
        let held = |change: &StepChange| StepChange {
            friction: change.friction.map(|tangent| match tangent {
                FrictionChange::None => FrictionChange::None,
                FrictionChange::Stick | FrictionChange::Moves(_) => FrictionChange::Stick,
            }),
            ..*change
        };
        last.iter().map(held).collect()
    }
}
