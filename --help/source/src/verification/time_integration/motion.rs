//! A harmonic-balance solution as a motion of the whole wheel: where the march starts, and the
//! state of its sliders.

use std::f64::consts::TAU;

use super::contact_rows::ContactRows;
use super::state::{MarchedWheel, WheelState};
use crate::linalg::Complex64;
use crate::model::cyclic::nodal_diameter_of;
use crate::response::forced_response::{Excited, Point};
use crate::response::friction::PairMemory;
use crate::response::harmonic_balance::Structure;
use crate::response::mistuning::{StructuralModes, WheelBasis};

/// Periods in which sliders find their places on the motion of a harmonic-balance solution.
const SLIDER_PERIODS: usize = 3;

/// Modal amplitudes of the whole wheel: `q(t) = q_0 + sum_k Re(q_k e^{i k omega t})`.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    harmonics: Vec<(u32, Vec<Complex64>)>,
}

impl Motion {
    /// The solution of a wheel.
    #[must_use]
    pub fn of_wheel(excited: &Excited, point: &Point) -> Self {
        Self {
            harmonics: amplitudes(excited, point),
        }
    }

    /// The travelling waves of a tuned wheel in the coordinates of `modes`, the modes of that wheel.
    #[must_use]
    pub fn of_waves(
        basis: &WheelBasis,
        modes: &StructuralModes,
        engine_order: u32,
        excited: &Excited,
        point: &Point,
    ) -> Self {
        let sectors = basis.model().sectors;
        let harmonics = amplitudes(excited, point)
            .into_iter()
            .map(|(harmonic, wave)| {
                let diameter = nodal_diameter_of(harmonic, engine_order, sectors);
                let tuned = basis.travelling_wave(diameter, &wave);
                // The rotation is orthogonal: coordinates turn as forces do.
                (harmonic, modes.modal_force(&tuned))
            })
            .collect();
        Self { harmonics }
    }

    /// Motion of every contact row of the wheel in every harmonic, m, sector after sector.
    #[must_use]
    pub fn contact_rows(&self, structure: &Structure) -> Vec<(u32, Vec<Complex64>)> {
        let rows = &structure.contact().real;
        let harmonics = self.harmonics.iter().map(|(harmonic, amplitudes)| {
            let parts = [|z: &Complex64| z.re, |z: &Complex64| z.im]
                .map(|part| rows.times_vector(&amplitudes.iter().map(part).collect::<Vec<f64>>()));
            let [re, im] = parts;
            let both = re.into_iter().zip(im);
            (
                *harmonic,
                both.map(|(re, im)| Complex64::new(re, im)).collect(),
            )
        });
        harmonics.collect()
    }

    /// Position and velocity at `turn` of a period, modal.
    fn at(&self, turn: f64, omega: f64) -> (Vec<f64>, Vec<f64>) {
        let size = self.harmonics.first().map_or(0, |(_, q)| q.len());
        let (mut position, mut velocity) = (vec![0.0; size], vec![0.0; size]);
        for (harmonic, amplitudes) in &self.harmonics {
            let k = f64::from(*harmonic);
            let phase = Complex64::from_polar(1.0, TAU * (k * turn).fract());
            for (mode, amplitude) in amplitudes.iter().enumerate() {
                let turned = amplitude * phase;
                position[mode] += turned.re;
                velocity[mode] -= k * omega * turned.im;
            }
        }
        (position, velocity)
    }

    /// The state at phase zero, its sliders set by marching the law along this motion.
    ///
    /// In harmonic balance the mean tangential displacement is no input of the law and its force is
    /// `kt u_0`: friction has no mean but that. The same here: a constant force on every tangential
    /// row takes the mean friction of this motion away and puts `kt u_0` in its place. The law
    /// itself is not touched: the ring is free to creep, but what would drive it is balanced.
    #[must_use]
    pub fn start(&self, wheel: &MarchedWheel<'_>, samples_per_period: usize) -> WheelState {
        let rows = &wheel.structure.contact().real;
        let contact = ContactRows::new(wheel.interface, rows.rows());
        let path: Vec<Vec<f64>> = (0..samples_per_period)
            .map(|sample| {
                let turn = sample as f64 / samples_per_period as f64;
                rows.times_vector(&self.at(turn, wheel.omega).0)
            })
            .collect();
        let mean: Vec<f64> = (0..rows.rows())
            .map(|row| path.iter().map(|u| u[row]).sum::<f64>() / samples_per_period as f64)
            .collect();
        let mut pairs = contact.at_rest();
        let mut after: Vec<PairMemory> = pairs.clone();
        let mut force = vec![0.0; rows.rows()];
        let mut friction = vec![0.0; rows.rows()];
        // At first the sliders stand where the mean displacement leaves the springs relaxed.
        for (index, pair) in pairs.iter_mut().enumerate() {
            pair.displacement_m = contact.gather(index, &mean);
        }
        for period in 0..SLIDER_PERIODS {
            for sample in 1..=samples_per_period {
                let u = &path[sample % samples_per_period];
                contact.march(&pairs, u, &mut after, &mut force);
                std::mem::swap(&mut pairs, &mut after);
                if period + 1 == SLIDER_PERIODS {
                    for (sum, force) in friction.iter_mut().zip(&force) {
                        *sum += force / samples_per_period as f64;
                    }
                }
            }
        }
        let mut balance_n = vec![0.0; rows.rows()];
        for row in contact.tangential_rows() {
            balance_n[row] = contact.springs()[row] * mean[row] - friction[row];
        }
        let (position, velocity) = self.at(0.0, wheel.omega);
        WheelState {
            position,
            velocity,
            pairs,
            balance_n,
        }
    }
}

/// Complex modal amplitudes of every harmonic of a point.
fn amplitudes(excited: &Excited, point: &Point) -> Vec<(u32, Vec<Complex64>)> {
    let mut rest = point.solution.as_slice();
    excited
        .blocks
        .iter()
        .map(|block| {
            let size = block.structure.size();
            let (re, after) = rest.split_at(size);
            let (im, after) = if block.harmonic == 0 {
                (&[][..], after)
            } else {
                after.split_at(size)
            };
            rest = after;
            let parts = re.iter().enumerate();
            let amplitudes =
                parts.map(|(mode, &re)| Complex64::new(re, im.get(mode).copied().unwrap_or(0.0)));
            (block.harmonic, amplitudes.collect())
        })
        .collect()
}
