//! Resonances of a linear limit of a mistuned wheel, in the modes of the tuned one near the band.
//!
//! They tell where a peak can lie and how wide it is; no amplitude of a row comes from them.

use std::f64::consts::TAU;

use crate::linalg::{Complex64, Matrix, hermitian_eigen};
use crate::model::cyclic::phase;

use super::blade_shapes::Participation;
use super::tuned_diameter::TunedDiameter;
use super::wave_force::WaveForce;

/// One resonance under one excitation, by its own mode alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resonance {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Largest amplitude over the blades, m.
    pub amplitude_m: f64,
    /// Half of the bandwidth at -3 dB, Hz.
    pub half_bandwidth_hz: f64,
}

/// Share of the highest resonance of a linear limit above which others count.
const COUNTS: f64 = 0.5;
/// Relative shift of a resonance over the largest deviation of a blade stiffness at most: half of it, and what modes that meet add.
pub const SHIFT_BY_DEVIATION: f64 = 0.6;
/// Relative margin besides.
const MARGIN: f64 = 0.05;

/// The resonances of one linear limit that count.
#[must_use]
pub fn resonances_that_count(limit: &[Resonance]) -> Vec<Resonance> {
    let heights = limit.iter().map(|resonance| resonance.amplitude_m);
    let highest = heights.fold(0.0, f64::max);
    let counts = |resonance: &&Resonance| resonance.amplitude_m > COUNTS * highest;
    limit.iter().filter(counts).copied().collect()
}

/// Relative distance from the resonances of the tuned wheel within which those of wheels with deviations up to this one are sought.
#[must_use]
pub fn reach_of_mistuning(largest_deviation: f64) -> f64 {
    SHIFT_BY_DEVIATION * largest_deviation + MARGIN
}

/// The modes of a tuned wheel with linear springs in a band, those of all waves.
#[derive(Debug)]
pub(super) struct BandModes {
    sectors: usize,
    loss_factor: f64,
    modes: Vec<BandMode>,
}

#[derive(Debug)]
struct BandMode {
    wave: usize,
    /// Place among the modes of its nodal diameter.
    place: usize,
    omega: f64,
    damping: f64,
    strain: Vec<Complex64>,
    observed: [Complex64; 3],
}

/// Modes of one mistuned wheel: angular frequencies, and a column of shares of the tuned modes each.
#[derive(Debug, Clone)]
pub(super) struct MistunedModes {
    eigenvalues: Vec<f64>,
    shares: Matrix<Complex64>,
}

impl BandModes {
    /// The modes with an angular frequency within `band`, rad/s.
    pub(super) fn new(
        diameters: &[TunedDiameter],
        strain: &Participation,
        sectors: usize,
        loss_factor: f64,
        band: (f64, f64),
    ) -> Self {
        let mut modes = Vec::new();
        for wave in 0..sectors {
            let conjugate = 2 * wave > sectors;
            let index = if conjugate { sectors - wave } else { wave };
            let diameter = &diameters[index];
            let (omegas, shapes) = &diameter.natural;
            for (place, &omega) in omegas.iter().enumerate() {
                if omega < band.0 || omega > band.1 {
                    continue;
                }
                let turned = |motion: Complex64| if conjugate { motion.conj() } else { motion };
                let shape = shapes.column(place);
                let participation = strain[index].times_vector(shape);
                let observed = diameter.observed.times_vector(shape);
                modes.push(BandMode {
                    wave,
                    place,
                    omega,
                    damping: diameter.damping_of(place),
                    strain: participation.into_iter().map(turned).collect(),
                    observed: [0, 1, 2].map(|row| turned(observed[row])),
                });
            }
        }
        Self {
            sectors,
            loss_factor,
            modes,
        }
    }

    /// The modes of the wheel with deviations of every shape and sector, shape after shape; none if they are not found.
    pub(super) fn mistuned(&self, deviations: &[f64]) -> Option<MistunedModes> {
        let sectors = self.sectors;
        let shapes = deviations.len() / sectors;
        let mut spectrum = vec![Complex64::default(); deviations.len()];
        for (shape, shape_deviations) in deviations.chunks_exact(sectors).enumerate() {
            for m in 0..sectors {
                let turned = |(n, delta): (usize, &f64)| phase(m, n, sectors).conj() * delta;
                let sum: Complex64 = shape_deviations.iter().enumerate().map(turned).sum();
                spectrum[shape * sectors + m] = sum / sectors as f64;
            }
        }
        let count = self.modes.len();
        let stiffness = Matrix::from_fn(count, count, |i, j| {
            let (a, b) = (&self.modes[i], &self.modes[j]);
            let apart = (a.wave + sectors - b.wave) % sectors;
            let of_shape = |shape: usize| {
                a.strain[shape].conj() * spectrum[shape * sectors + apart] * b.strain[shape]
            };
            let diagonal = if i == j { a.omega * a.omega } else { 0.0 };
            (0..shapes).map(of_shape).sum::<Complex64>() + diagonal
        });
        let (eigenvalues, shares) = hermitian_eigen(&stiffness).ok()?;
        Some(MistunedModes {
            eigenvalues,
            shares,
        })
    }

    /// Resonances of a mistuned wheel under an excitation, ascending.
    pub(super) fn peaks(
        &self,
        diameters: &[TunedDiameter],
        wheel: &MistunedModes,
        force: &WaveForce,
    ) -> Vec<Resonance> {
        let drives: Vec<Complex64> = self
            .modes
            .iter()
            .map(|mode| self.drive(diameters, mode, force))
            .collect();
        let peak = |(column, &eigenvalue): (usize, &f64)| {
            let shares = wheel.shares.column(column);
            let drive: Complex64 = shares.iter().zip(&drives).map(|(v, f)| v.conj() * f).sum();
            let weights = shares.iter().zip(&self.modes);
            let of_modes = |of: fn(&BandMode) -> f64| -> f64 {
                weights
                    .clone()
                    .map(|(v, mode)| v.norm_sqr() * of(mode))
                    .sum()
            };
            let tuned = of_modes(|mode| mode.omega * mode.omega);
            let damping = of_modes(|mode| mode.damping) + self.loss_factor * (eigenvalue - tuned);
            Self::peak(eigenvalue, drive.norm(), damping, self.reach(shares))
        };
        let all = wheel.eigenvalues.iter().enumerate();
        all.filter(|(_, eigenvalue)| **eigenvalue > 0.0)
            .map(peak)
            .collect()
    }

    /// Resonances of the tuned wheel under an excitation, ascending.
    pub(super) fn tuned_peaks(
        &self,
        diameters: &[TunedDiameter],
        force: &WaveForce,
    ) -> Vec<Resonance> {
        let wave = force.wave(self.sectors);
        let modes = self.modes.iter().filter(|mode| mode.wave == wave);
        modes
            .map(|mode| {
                let reach = mode
                    .observed
                    .iter()
                    .map(Complex64::norm_sqr)
                    .sum::<f64>()
                    .sqrt();
                let drive = self.drive(diameters, mode, force).norm();
                let reach = reach / (self.sectors as f64).sqrt();
                Self::peak(mode.omega * mode.omega, drive, mode.damping, reach)
            })
            .collect()
    }

    fn peak(eigenvalue: f64, drive: f64, damping: f64, reach: f64) -> Resonance {
        let omega = eigenvalue.sqrt();
        Resonance {
            frequency_hz: omega / TAU,
            amplitude_m: if damping > 0.0 {
                reach * drive / damping
            } else {
                0.0
            },
            half_bandwidth_hz: damping / (2.0 * omega) / TAU,
        }
    }

    /// `x^H f` of a mode.
    fn drive(&self, diameters: &[TunedDiameter], mode: &BandMode, force: &WaveForce) -> Complex64 {
        if mode.wave != force.wave(self.sectors) {
            return Complex64::default();
        }
        let shape = diameters[force.diameter.index].natural.1.column(mode.place);
        let turned = |v: &Complex64| {
            if force.diameter.conjugate {
                *v
            } else {
                v.conj()
            }
        };
        shape
            .iter()
            .zip(&force.modal)
            .map(|(v, f)| turned(v) * f)
            .sum()
    }

    /// Largest displacement over the blades of a mode with these shares of the tuned ones.
    fn reach(&self, shares: &[Complex64]) -> f64 {
        let sectors = self.sectors;
        let mut waves = vec![[Complex64::default(); 3]; sectors];
        for (v, mode) in shares.iter().zip(&self.modes) {
            for (sum, component) in waves[mode.wave].iter_mut().zip(&mode.observed) {
                *sum += v * component;
            }
        }
        let of_blade = |n: usize| {
            let mut displacement = [Complex64::default(); 3];
            for (h, motion) in waves.iter().enumerate() {
                let turn = phase(h, n, sectors);
                for (sum, component) in displacement.iter_mut().zip(motion) {
                    *sum += component * turn;
                }
            }
            displacement.iter().map(Complex64::norm_sqr).sum::<f64>()
        };
        let largest = (0..sectors).map(of_blade).fold(0.0, f64::max);
        (largest / sectors as f64).sqrt()
    }
}
