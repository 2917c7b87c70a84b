//! Harmonics of a wheel that are taken in the tuned wheel: their residual, and the derivative that serves for it.
//!
//! Their unknowns are the relative motions of all contact rows, `u = s d`; with the correction G of the contact force
//! and the receptance R of [`super::tuned_waves`], the residual is
//!
//! ```text
//! r = k (u + s R G) / s^2,    s = 1 / max |c|,    k the stiffest spring
//! ```
//!
//! which is the mismatch of d as modal force of the stuck springs in the row c that the modes of the fundamental move
//! most: unknowns and residuals are of the size that those of the fundamental are of.
//!
//! In the derivative the contact of every sector is that of their mean, so that the waves do not couple:
//! `(I + R g)^-1` for every one of them.

use std::ops::Range;
use std::sync::Arc;

use super::system::{HarmonicSystem, SystemWorkspace};
use super::tuned_waves::WaveBuffers;
use super::wave_table::WaveTable;
use super::{ContactInterface, HarmonicBlock, PairJacobian, TunedWaves};
use crate::linalg::Complex64;

/// What a step of the fundamental counts beside one of the waves.
const FUNDAMENTAL_WEIGHT: f64 = 0.01;

/// Units of the unknowns of waves.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WaveScale {
    /// `1 / s`, 1/sqrt(kg).
    row_length: f64,
    /// k, N/m.
    spring: f64,
}

impl WaveScale {
    /// The units of a system; its fundamental is among the blocks.
    pub(super) fn of(blocks: &[HarmonicBlock], interface: &ContactInterface) -> Self {
        let fundamental = blocks.iter().find(|block| block.harmonic == 1);
        let Some(fundamental) = fundamental.filter(|_| blocks.iter().any(|b| b.waves.is_some()))
        else {
            return Self::default();
        };
        let contact = &fundamental.structure.contact().real;
        let mut squares = vec![0.0; contact.rows()];
        for mode in 0..contact.columns() {
            let column = squares.iter_mut().zip(contact.column(mode));
            column.for_each(|(square, c)| *square += c * c);
        }
        let springs = interface.stuck_springs(1.0);
        Self {
            row_length: squares.into_iter().fold(0.0, f64::max).sqrt(),
            spring: springs.into_iter().fold(0.0, f64::max),
        }
    }

    /// `k / s^2`, (rad/s)^2.
    pub(super) fn stiffness(self) -> f64 {
        self.spring * self.row_length * self.row_length
    }
}

/// R of the harmonics at one frequency, with buffers.
#[derive(Debug)]
pub(super) struct WaveWorkspace {
    omega: f64,
    /// Of every block; empty for those that are not waves.
    receptance: Vec<WaveTable>,
    buffers: WaveBuffers,
}

impl WaveWorkspace {
    /// Takes over R of another set at its frequency; `places` are those of its blocks in this one.
    pub(super) fn take_over(&mut self, other: &Self, places: &[Option<usize>]) {
        self.omega = other.omega;
        for (receptance, place) in other.receptance.iter().zip(places) {
            if let Some(place) = *place {
                self.receptance[place].clone_from(receptance);
            }
        }
    }
}

impl HarmonicSystem {
    /// Whether harmonics are taken in the tuned wheel.
    pub(super) fn has_waves(&self) -> bool {
        self.blocks.iter().any(|block| block.waves.is_some())
    }

    /// What the entries of steps count where harmonics are taken in the tuned wheel; nothing where none is. The
    /// fundamental follows the others by its whole derivative: iterates are combined by what they lack in the others.
    pub(super) fn weights_of_steps(&self) -> Vec<f64> {
        if !self.has_waves() {
            return Vec::new();
        }
        let mut weights = vec![1.0; self.unknowns()];
        let own = self.fundamental();
        weights[self.start[own]..self.start[own + 1]].fill(FUNDAMENTAL_WEIGHT);
        weights
    }

    pub(super) fn wave_workspace(&self) -> Option<WaveWorkspace> {
        let waves = self.blocks.iter().find_map(|block| block.waves.as_ref())?;
        Some(WaveWorkspace {
            omega: f64::NAN,
            receptance: vec![WaveTable::default(); self.blocks.len()],
            buffers: waves.buffers(),
        })
    }

    /// Coefficients of d.
    pub(super) fn displacement_of_waves(&self, x: &[f64], displacement: &mut [f64]) {
        for (index, block) in self.blocks.iter().enumerate() {
            if block.waves.is_some() {
                let own = &x[self.start[index]..self.start[index + 1]];
                let to = &mut displacement[self.coefficient[index] * self.rows..][..own.len()];
                for (d, u) in to.iter_mut().zip(own) {
                    *d = self.wave_scale.row_length * u;
                }
            }
        }
    }

    /// `residual += k R G / s`.
    pub(super) fn add_motion_of_waves(
        &self,
        omega: f64,
        workspace: &mut SystemWorkspace,
        residual: &mut [f64],
    ) {
        let Some(waves) = &mut workspace.waves else {
            return;
        };
        self.tune_to(omega, waves);
        let factor = self.wave_scale.spring * self.wave_scale.row_length;
        for (index, block) in self.blocks.iter().enumerate() {
            if let Some(own) = &block.waves {
                let r = &mut residual[self.start[index]..self.start[index + 1]];
                let g = &workspace.correction[self.coefficient[index] * self.rows..][..r.len()];
                let (real, imaginary) = g.split_at(self.rows);
                let table = &waves.receptance[index];
                own.add_product(table, factor, [real, imaginary], r, &mut waves.buffers);
            }
        }
    }

    /// The receptances at `omega`; not a number where there is none, so that no solution is found there.
    fn tune_to(&self, omega: f64, workspace: &mut WaveWorkspace) {
        if workspace.omega.total_cmp(&omega).is_eq() {
            return;
        }
        workspace.omega = omega;
        for (block, receptance) in self.blocks.iter().zip(&mut workspace.receptance) {
            if let Some(waves) = &block.waves {
                *receptance = waves
                    .receptance(block.harmonic, omega)
                    .unwrap_or_else(|| waves.not_a_number());
            }
        }
    }

    /// Mean over the sectors of the derivative of G by d in one harmonic, the part that is linear in complex numbers,
    /// `rows x rows` of a sector, row after row.
    fn mean_derivative(&self, index: usize, workspace: &SystemWorkspace) -> Vec<Complex64> {
        let per_sector = self.interface.per_sector();
        let rows = self.interface.geometry.row_count();
        let (count, re) = (self.transform.n_coefficients(), self.coefficient[index]);
        let harmonic = self.blocks[index].harmonic;
        let slope = |slopes: &[f64]| {
            if harmonic == 0 {
                return Complex64::new(slopes[re * count + re], 0.0);
            }
            let im = re + 1;
            let at = |i: usize, j: usize| slopes[i * count + j];
            0.5 * Complex64::new(at(re, re) + at(im, im), at(im, re) - at(re, im))
        };
        let mut mean = vec![Complex64::default(); rows * rows];
        let share = per_sector as f64 / workspace.active.len() as f64;
        let pairs = workspace.jacobians.iter().zip(&workspace.active);
        for (pair, (jacobian, _)) in pairs.enumerate().filter(|(_, (_, active))| **active) {
            let [normal, first, second] = self.interface.geometry.rows[pair % per_sector];
            let mut add = |row: Option<usize>, column: Option<usize>, slopes: &[f64]| {
                if let (Some(row), Some(column)) = (row, column) {
                    mean[row * rows + column] += share * slope(slopes);
                }
            };
            let PairJacobian {
                normal_normal,
                tangential_tangential: [by_first, by_second],
                tangential_normal: [first_by_normal, second_by_normal],
                tangential_cross,
            } = jacobian;
            if workspace.separated {
                add(normal, normal, normal_normal);
            }
            add(first, first, by_first);
            add(second, second, by_second);
            add(first, normal, first_by_normal);
            add(second, normal, second_by_normal);
            if let Some([first_by_second, second_by_first]) = tangential_cross {
                add(first, second, first_by_second);
                add(second, first, second_by_first);
            }
        }
        mean
    }
}

/// `(I + R g)^-1` of the harmonics that are waves.
#[derive(Default)]
pub(super) struct WaveFactors {
    fundamental: Range<usize>,
    blocks: Vec<WaveBlock>,
    buffers: Option<WaveBuffers>,
    step: Vec<f64>,
}

struct WaveBlock {
    waves: Arc<TunedWaves>,
    unknowns: Range<usize>,
    inverse: WaveTable,
    stiffness: f64,
}

impl WaveFactors {
    /// Unknowns of the fundamental, which is not among them.
    pub(super) fn fundamental(&self) -> Range<usize> {
        self.fundamental.clone()
    }

    /// At the point last given to [`HarmonicSystem::residual`] with derivative; false if a wave is singular.
    pub(super) fn factor(
        &mut self,
        system: &HarmonicSystem,
        omega: f64,
        workspace: &mut SystemWorkspace,
    ) -> bool {
        if let Some(waves) = &mut workspace.waves {
            system.tune_to(omega, waves);
        }
        let Some(tuned) = &workspace.waves else {
            return false;
        };
        let own = system.fundamental();
        self.fundamental = system.start[own]..system.start[own + 1];
        self.blocks.clear();
        for (index, block) in system.blocks.iter().enumerate() {
            let Some(waves) = &block.waves else {
                continue;
            };
            let mean = system.mean_derivative(index, workspace);
            let Some(inverse) = waves.inverse_with(&tuned.receptance[index], &mean) else {
                return false;
            };
            self.buffers.get_or_insert_with(|| waves.buffers());
            self.blocks.push(WaveBlock {
                waves: Arc::clone(waves),
                unknowns: system.start[index]..system.start[index + 1],
                inverse,
                stiffness: system.wave_scale.stiffness(),
            });
        }
        true
    }

    /// The steps of the waves in the place of their residuals.
    pub(super) fn solve(&mut self, residual: &mut [f64]) {
        let Some(buffers) = &mut self.buffers else {
            return;
        };
        for block in &self.blocks {
            let own = &mut residual[block.unknowns.clone()];
            if own.iter().all(|r| *r == 0.0) {
                continue;
            }
            let (real, imaginary) = own.split_at(block.waves.size());
            self.step.clear();
            self.step.resize(own.len(), 0.0);
            let factor = 1.0 / block.stiffness;
            block.waves.add_product(
                &block.inverse,
                factor,
                [real, imaginary],
                &mut self.step,
                buffers,
            );
            own.copy_from_slice(&self.step);
        }
    }
}
