//! Contact of the tuned wheel in one harmonic: what its relative motions answer to forces on them.
//!
//! Harmonics beside the fundamental are a few percent of a response, and most of them far from resonance. What counts
//! in them is the compliance of the contact, up to frequencies that a small basis does not reach; the deviations of
//! the blades change it little. So they may be taken in the tuned wheel with all its modes. Its waves do
//! not couple, and only the relative motions d of the contact rows are left as unknowns: with the contact-free modes
//! of nodal diameter h,
//!
//! ```text
//! H = sum_m c_m c_m^H / (lambda_m - (k omega)^2 + i D_m(k omega)),    R = (I + H k_c)^-1 H
//! d + R G(d) = 0
//! ```
//!
//! where R is the receptance of the contact with stuck springs and G the correction of the contact force, both
//! in waves `d_h = sum_n d_n e^{-i h n alpha}` over the sectors n.

use std::sync::Arc;

use rustfft::{Fft, FftPlanner};

use super::Damping;
use super::structure::Structure;
use super::wave_table::{ModalSums, Products, WaveTable};
use crate::linalg::{Complex64, LuWorkspace, Matrix, SmallComplex, vectorized};
use crate::model::ReducedModel;
use crate::model::cyclic::NodalDiameter;
use crate::response::mistuning::StructuralModes;

/// The tuned wheel as its contact feels it; shared by all wheels of a study.
pub struct TunedWaves {
    sectors: usize,
    /// Contact rows of a sector.
    rows: usize,
    /// Stuck springs of the rows, N/m.
    springs: Vec<f64>,
    /// Nodal diameters 0..=N/2.
    waves: Vec<Structure>,
    /// R of harmonic 0.
    at_rest: WaveTable,
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

/// Buffers of one thread.
#[derive(Debug)]
pub(super) struct WaveBuffers {
    /// One value per row and sector, then per row and wave.
    values: Vec<Complex64>,
    /// The same in two parts.
    parts: [Vec<f64>; 2],
    scratch: Vec<Complex64>,
}

impl std::fmt::Debug for TunedWaves {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TunedWaves")
            .field("sectors", &self.sectors)
            .field("rows", &self.rows)
            .finish_non_exhaustive()
    }
}

impl TunedWaves {
    /// The waves of a model, which is best one that leaves nothing out; none if the contact is not held at rest.
    #[must_use]
    pub fn new(model: &ReducedModel, damping: Damping) -> Option<Self> {
        let (sectors, rows) = (model.sectors, model.springs.stick.len());
        let waves = (0..model.nodal_diameters.len()).map(|index| {
            let wave = NodalDiameter {
                index,
                conjugate: false,
            };
            Structure::new(StructuralModes::of_wave(model, wave), damping)
        });
        let mut planner = FftPlanner::new();
        let mut waves = Self {
            sectors,
            rows,
            springs: model.springs.stick.clone(),
            waves: waves.collect(),
            at_rest: WaveTable::default(),
            forward: planner.plan_fft_forward(sectors),
            inverse: planner.plan_fft_inverse(sectors),
        };
        waves.at_rest = waves.spread(|wave| waves.receptance_at_rest(wave))?;
        Some(waves)
    }

    /// Contact rows of the wheel: the unknowns of a harmonic.
    #[must_use]
    pub fn size(&self) -> usize {
        self.sectors * self.rows
    }

    /// A table without a number in it.
    pub(super) fn not_a_number(&self) -> WaveTable {
        WaveTable::filled(f64::NAN, self.rows * self.size())
    }

    pub(super) fn buffers(&self) -> WaveBuffers {
        let scratch = self.forward.get_inplace_scratch_len();
        WaveBuffers {
            values: vec![Complex64::default(); self.size()],
            parts: [vec![0.0; self.size()], vec![0.0; self.size()]],
            scratch: vec![
                Complex64::default();
                scratch.max(self.inverse.get_inplace_scratch_len())
            ],
        }
    }

    /// R of a harmonic at angular frequency `omega`. None where the stuck wheel has an undamped resonance.
    pub(super) fn receptance(&self, harmonic: u32, omega: f64) -> Option<WaveTable> {
        if harmonic == 0 {
            return Some(self.at_rest.clone());
        }
        self.spread(|wave| self.receptance_in_motion(wave, f64::from(harmonic) * omega))
    }

    /// `(I + R g)^-1` of every wave; `g` is `rows x rows`, row after row.
    pub(super) fn inverse_with(
        &self,
        receptance: &WaveTable,
        g: &[Complex64],
    ) -> Option<WaveTable> {
        let (n, sectors) = (self.rows, self.sectors);
        let mut all = WaveTable::filled(0.0, n * n * sectors);
        let mut system = SmallComplex::new(n, n);
        for h in 0..sectors {
            let of = |i: usize, j: usize| receptance.at((i * n + j) * sectors + h);
            for (i, j) in (0..n * n).map(|at| (at / n, at % n)) {
                let product: Complex64 = (0..n).map(|l| of(i, l) * g[l * n + j]).sum();
                let own = Complex64::from(if i == j { 1.0 } else { 0.0 });
                system.set(i, j, own + product);
                system.set_right(i, j, own);
            }
            if !system.solve() {
                return None;
            }
            for (i, j) in (0..n * n).map(|at| (at / n, at % n)) {
                all.set((i * n + j) * sectors + h, system.solution(i, j));
            }
        }
        Some(all)
    }

    /// The circulant `table` times contact coefficients of one harmonic: real and imaginary parts, sector after sector;
    /// times `factor` into `sum`.
    pub(super) fn add_product(
        &self,
        table: &WaveTable,
        factor: f64,
        [real, imaginary]: [&[f64]; 2],
        sum: &mut [f64],
        buffers: &mut WaveBuffers,
    ) {
        let (rows, sectors) = (self.rows, self.sectors);
        let WaveBuffers {
            values,
            parts: [re, im],
            scratch,
        } = buffers;
        for (row, values) in values.chunks_exact_mut(sectors).enumerate() {
            for (n, value) in values.iter_mut().enumerate() {
                let at = n * rows + row;
                *value = Complex64::new(real[at], imaginary.get(at).copied().unwrap_or(0.0));
            }
        }
        self.forward.process_with_scratch(values, scratch);
        for ((re, im), value) in re.iter_mut().zip(im.iter_mut()).zip(&*values) {
            (*re, *im) = (value.re, value.im);
        }
        vectorized(Products {
            table,
            sectors,
            parts: [re, im],
            into: values,
        });
        self.inverse.process_with_scratch(values, scratch);
        let (real, imaginary) = sum.split_at_mut(self.size());
        let factor = factor / sectors as f64;
        for (row, product) in values.chunks_exact(sectors).enumerate() {
            for (n, value) in product.iter().enumerate() {
                let at = n * rows + row;
                real[at] += factor * value.re;
                if let Some(imaginary) = imaginary.get_mut(at) {
                    *imaginary += factor * value.im;
                }
            }
        }
    }

    /// A matrix of every nodal diameter, `rows x rows` column-major, laid out over all waves: that of `N - h` is the
    /// transpose of that of h, since the structure is reciprocal.
    fn spread(
        &self,
        mut of: impl FnMut(&Structure) -> Option<Vec<Complex64>>,
    ) -> Option<WaveTable> {
        let (n, sectors) = (self.rows, self.sectors);
        let mut all = WaveTable::filled(0.0, n * n * sectors);
        for (h, wave) in self.waves.iter().enumerate() {
            let matrix = of(wave)?;
            let mirrored = (sectors - h) % sectors;
            for (at, entry) in matrix.iter().enumerate() {
                let (j, i) = (at / n, at % n);
                all.set((j * n + i) * sectors + mirrored, *entry);
                all.set((i * n + j) * sectors + h, *entry);
            }
        }
        Some(all)
    }

    fn receptance_in_motion(&self, wave: &Structure, k_omega: f64) -> Option<Vec<Complex64>> {
        let n = self.rows;
        // Real and imaginary parts apart, so that the loops over rows become vector operations.
        let (mut free_re, mut free_im) = (vec![0.0; n * n], vec![0.0; n * n]);
        vectorized(ModalSums {
            wave,
            k_omega,
            sums: [&mut free_re, &mut free_im],
        });
        let mut system = SmallComplex::new(n, n);
        for (i, j) in (0..n * n).map(|at| (at / n, at % n)) {
            let free = Complex64::new(free_re[j * n + i], free_im[j * n + i]);
            let own = if i == j { 1.0 } else { 0.0 };
            system.set(i, j, free * self.springs[j] + own);
            system.set_right(i, j, free);
        }
        if !system.solve() {
            return None;
        }
        let entries = (0..n * n).map(|at| system.solution(at % n, at / n));
        let stuck: Vec<Complex64> = entries.collect();
        stuck.iter().all(|r| r.is_finite()).then_some(stuck)
    }

    /// `C (diag(lambda) + C^H k_c C)^-1 C^H`: free motions of the ring have no receptance of their own.
    fn receptance_at_rest(&self, wave: &Structure) -> Option<Vec<Complex64>> {
        let (n, size) = (self.rows, wave.size());
        let contact = wave.contact();
        let c = |i: usize, mode: usize| {
            let imaginary = contact.imaginary.as_ref();
            Complex64::new(
                contact.real[(i, mode)],
                imaginary.map_or(0.0, |imaginary| imaginary[(i, mode)]),
            )
        };
        let mut lu = LuWorkspace::new(size);
        for (at, entry) in lu.matrix_mut().iter_mut().enumerate() {
            let (j, i) = (at / size, at % size);
            let springs = self.springs.iter().enumerate();
            *entry = springs.map(|(l, k)| c(l, i).conj() * *k * c(l, j)).sum();
            if i == j {
                *entry += wave.eigenvalues()[i];
            }
        }
        if !lu.factor() {
            return None;
        }
        let mut right = Matrix::from_fn(size, n, |mode, i| c(i, mode).conj());
        lu.solve_columns(&mut right);
        let entries = (0..n * n).map(|at| {
            let (j, i) = (at / n, at % n);
            (0..size).map(|mode| c(i, mode) * right[(mode, j)]).sum()
        });
        Some(entries.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::mistuning::ModalRows;

    const SPRINGS: [f64; 2] = [3.0, 0.5];

    /// Three modes, of which one is a free motion, and two contact rows.
    fn wave(damping: Damping) -> Structure {
        let rows =
            |phase: f64| Matrix::from_fn(2, 3, |i, j| (phase + (1 + i + 2 * j) as f64).sin());
        let rows = |phase: f64| ModalRows {
            real: rows(phase),
            imaginary: Some(rows(phase + 0.7)),
        };
        let modes = StructuralModes {
            eigenvalues: vec![0.0, 2.0, 5.0],
            tuned_eigenvalues: vec![0.0, 2.0, 5.0],
            added_damping_per_s: vec![0.01, 0.02, 0.03],
            rotation: None,
            contact: rows(0.2),
            observed: rows(0.1),
            sectors: 1,
        };
        Structure::new(modes, damping)
    }

    fn waves() -> TunedWaves {
        let mut planner = FftPlanner::new();
        TunedWaves {
            sectors: 1,
            rows: 2,
            springs: SPRINGS.to_vec(),
            waves: vec![wave(Damping::ModalRatio(0.02))],
            at_rest: WaveTable::default(),
            forward: planner.plan_fft_forward(1),
            inverse: planner.plan_fft_inverse(1),
        }
    }

    /// Put into the equation of motion, `Z x = C^H (e - k_c d)` and `d = C x` under a unit force e.
    #[test]
    fn the_receptance_solves_the_equation_of_motion() {
        let waves = waves();
        let wave = &waves.waves[0];
        let contact = wave.contact();
        let c = |i: usize, mode: usize| {
            let imaginary = contact.imaginary.as_ref().expect("complex rows");
            Complex64::new(contact.real[(i, mode)], imaginary[(i, mode)])
        };
        for (k_omega, receptance) in [
            (1.3, waves.receptance_in_motion(wave, 1.3)),
            (0.0, waves.receptance_at_rest(wave)),
        ] {
            let receptance = receptance.expect("a regular matrix");
            for force_row in 0..2 {
                let motion = |row: usize| receptance[force_row * 2 + row];
                let modal = |mode: usize| -> Complex64 {
                    let force = (0..2).map(|row| {
                        let unit = if row == force_row { 1.0 } else { 0.0 };
                        c(row, mode).conj() * (unit - SPRINGS[row] * motion(row))
                    });
                    let z = Complex64::new(
                        wave.eigenvalues()[mode] - k_omega * k_omega,
                        if k_omega > 0.0 {
                            wave.damping_diagonal(mode, k_omega)
                        } else {
                            0.0
                        },
                    );
                    force.sum::<Complex64>() / z
                };
                if k_omega > 0.0 {
                    for row in 0..2 {
                        let moved: Complex64 = (0..3).map(|mode| c(row, mode) * modal(mode)).sum();
                        assert!((moved - motion(row)).norm() < 1e-12, "{row}: {moved}");
                    }
                } else {
                    // Nothing but the springs holds the free motion: the forces on it are in balance.
                    let unbalanced: Complex64 = (0..2)
                        .map(|row| {
                            let unit = if row == force_row { 1.0 } else { 0.0 };
                            c(row, 0).conj() * (unit - SPRINGS[row] * motion(row))
                        })
                        .sum();
                    assert!(unbalanced.norm() < 1e-12, "{unbalanced}");
                }
            }
        }
    }
}
