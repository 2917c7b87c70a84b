//! Disturbances of a period: the one that multipliers are sought from, and those in which every state is periodic.

use super::period_map::{Moving, PeriodMap};
use crate::linalg::{Matrix, dot, hermitian_eigen};

/// Modes below this share of the excitation's frequency are rigid motions of what nothing holds.
const RIGID: f64 = 1e-3;
/// Share of the motion along what holds it, squared, below which nothing holds a rigid motion.
const FREE: f64 = 1e-10;

impl PeriodMap {
    /// A scaled state with some of everything but sliders that stay, the same for every wheel of this size.
    pub(super) fn disturbance(&self) -> Vec<f64> {
        let mut seed = 0_u64;
        let mut state: Vec<f64> = (0..self.size())
            .map(|_| {
                // SplitMix64 (Steele, Lea & Flood 2014).
                seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let mut bits = seed;
                bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                bits ^= bits >> 31;
                (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
            })
            .collect();
        let sliders = self.size() - self.contact.held.len();
        for (slider, held) in state[sliders..].iter_mut().zip(&self.contact.held) {
            if *held {
                *slider = 0.0;
            }
        }
        state
    }

    /// Scaled unit states that a period leaves as they are: rigid motions of what no spring and no tangent that sticks
    /// throughout holds, the sliders along.
    pub(super) fn neutral(&self, omega: f64) -> Vec<Vec<f64>> {
        let limit = (RIGID * omega).powi(2);
        let mut moved: Vec<Moving> = Vec::new();
        for (h, wave) in self.waves.iter().enumerate() {
            let rigid = wave.eigenvalues.iter().enumerate();
            for (mode, _) in rigid.filter(|(_, lambda)| **lambda <= limit) {
                let parts = if wave.real { 1 } else { 2 };
                for part in 0..parts {
                    let mut moving = self.unpacked(&vec![0.0; self.size()]);
                    moving.position[h][part * wave.size() + mode] = 1.0;
                    self.observe(&mut moving);
                    moved.push(moving);
                }
            }
        }
        let (held, all): (Vec<Vec<f64>>, Vec<f64>) =
            moved.iter().map(|moving| self.held_motion(moving)).unzip();
        let holding = Matrix::from_fn(held.len(), held.len(), |i, j| {
            dot(&held[i], &held[j]) / (all[i] * all[j]).sqrt().max(f64::MIN_POSITIVE)
        });
        let Ok((shares, vectors)) = hermitian_eigen(&holding) else {
            return Vec::new();
        };
        let mut free: Vec<Vec<f64>> = Vec::new();
        for (at, _) in shares
            .iter()
            .enumerate()
            .filter(|(_, share)| **share <= FREE)
        {
            let mut state = vec![0.0; self.size()];
            for ((entry, moving), all) in vectors.column(at).iter().zip(&mut moved).zip(&all) {
                self.take_sliders_along(moving);
                let weight = entry / all.sqrt().max(f64::MIN_POSITIVE);
                for (sum, x) in state.iter_mut().zip(self.packed(moving)) {
                    *sum += weight * x;
                }
            }
            for other in &free {
                let share = dot(other, &state);
                state
                    .iter_mut()
                    .zip(other)
                    .for_each(|(x, o)| *x -= share * o);
            }
            let norm = dot(&state, &state).sqrt();
            for x in &mut state {
                *x /= norm;
            }
            free.push(state);
        }
        free
    }

    /// Motions of a state that something holds, normal ones and those of tangents that stick throughout, and the square of all
    /// motions at the contact.
    fn held_motion(&self, moving: &Moving) -> (Vec<f64>, f64) {
        let (_, motions) = self.channels();
        let pairs = self.contact.pair_rows.len();
        let mut held = Vec::new();
        let mut all = 0.0;
        for (sector, motion) in moving.motion.chunks_exact(motions.max(1)).enumerate() {
            for (place, rows) in self.contact.pair_rows.iter().enumerate() {
                for (direction, row) in rows.iter().enumerate() {
                    let Some(row) = *row else { continue };
                    all += motion[row] * motion[row];
                    let tangent = 2 * (sector * pairs + place) + direction;
                    if direction == 0 || self.contact.held[tangent - 1] {
                        held.push(motion[row]);
                    }
                }
            }
        }
        (held, all)
    }

    fn take_sliders_along(&self, moving: &mut Moving) {
        let (_, motions) = self.channels();
        let pairs = self.contact.pair_rows.len();
        for (sector, motion) in moving.motion.chunks_exact(motions.max(1)).enumerate() {
            for (place, rows) in self.contact.pair_rows.iter().enumerate() {
                for tangent in 0..2 {
                    if let Some(row) = rows[1 + tangent] {
                        let slider = 2 * (sector * pairs + place) + tangent;
                        if !self.contact.held[slider] {
                            moving.sliders[slider] = motion[row];
                        }
                    }
                }
            }
        }
    }
}
