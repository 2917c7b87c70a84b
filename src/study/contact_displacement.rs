//! How well a basis follows the relative displacement at the contact: an indicator of the reduction error.
//!
//! Reference is a tuned nonlinear peak of the whole Craig-Bampton sector, at the excitation
//! frequency omega, with relative displacement `d_k` at the contact rows in each harmonic k and with
//! the contact force `F_k` that the law answers to it. On the stuck base, with `G_k = F_k - k_c d_k`,
//! either space answers the *same* forces with
//!
//! ```text
//! d_k = C (Z(k omega) + C^H k_c C)^-1 (f_k - C^H G_k),    h = k EO mod N
//! ```
//!
//! which for the whole space is the solution again. The norm is that of the relative displacement,
//! pair p with its weight `w_p` of the contact surface, over all harmonics but the mean:
//!
//! ```text
//! |d|^2 = sum_{k >= 1} sum_p w_p |d_{k,p}|^2
//! indicator_{k,h} = |d_k(basis) - d_k(whole space)| / |d|
//! ```
//!
//! A mistuned wheel moves in every nodal diameter at once, under much the same forces in a sector. So
//! the same forces are also let travel as every other wave h of the wheel, where the space may lack
//! the modes; there the error is relative to the larger of `|d|` and the whole space's own answer,
//! which may be resonant. The energy norm would not do: the ring's share of the energy is tiny.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::linalg::{Complex64, LuWorkspace};
use crate::model::ReducedModel;
use crate::model::cyclic::{NodalDiameter, nodal_diameter_of};
use crate::population::monte_carlo::RowSettings;
use crate::response::forced_response::{ContactCondition, Peak};
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::{
    HarmonicTransform, PairHarmonics, Structure, TransformError, linear_response,
};
use crate::response::mistuning::StructuralModes;

/// Error of the relative displacement at the contact that a basis allows, and where it is largest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactDisplacementError {
    /// Relative to the relative displacement of the tuned peak.
    pub error: f64,
    /// Engine order.
    pub engine_order: u32,
    /// Normal load per sector, N.
    pub normal_load_n: f64,
    /// Temporal harmonic k.
    pub harmonic: u32,
    /// Nodal diameter of the wave, 0 to N/2.
    pub nodal_diameter: usize,
}

/// Errors in the waves that the tuned wheel moves in, and in all waves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactDisplacementErrors {
    /// Largest over the harmonics, each in its nodal diameter `k EO mod N`.
    pub tuned: ContactDisplacementError,
    /// Largest over the harmonics and all waves: of a mistuned wheel.
    pub mistuned: ContactDisplacementError,
}

impl ContactDisplacementErrors {
    /// The larger of either kind.
    #[must_use]
    pub fn larger(self, other: Self) -> Self {
        let larger = |a: ContactDisplacementError, b: ContactDisplacementError| {
            if b.error > a.error { b } else { a }
        };
        Self {
            tuned: larger(self.tuned, other.tuned),
            mistuned: larger(self.mistuned, other.mistuned),
        }
    }
}

/// Relative displacement and contact force of a tuned nonlinear peak in one harmonic.
#[derive(Debug, Clone)]
struct HarmonicMotion {
    harmonic: u32,
    /// `d_k` at the contact rows of a sector, m.
    displacement: Vec<Complex64>,
    /// `G_k` at the contact rows, N.
    correction: Vec<Complex64>,
}

/// A tuned nonlinear peak of the whole Craig-Bampton sector as seen from its contact.
#[derive(Debug, Clone)]
pub struct ContactMotion<'a> {
    model: &'a ReducedModel,
    settings: &'a RowSettings,
    engine_order: u32,
    normal_load_n: f64,
    omega: f64,
    harmonics: Vec<HarmonicMotion>,
    norm: f64,
}

impl<'a> ContactMotion<'a> {
    /// The contact motion of `peak`, found on `model` with `settings` and the ascending set `harmonics`;
    /// none for a linear limit, a peak that was not found, or a model without contact.
    ///
    /// # Errors
    /// If the samples per period cannot tell the harmonics apart.
    pub fn of_peak(
        model: &'a ReducedModel,
        settings: &'a RowSettings,
        harmonics: &[u32],
        engine_order: u32,
        condition: ContactCondition,
        peak: &Peak,
    ) -> Result<Option<Self>, TransformError> {
        let (Some(normal_load_n), Some((law, sector)), Some(point)) =
            (condition.normal_load_n(), settings.contact, &peak.point)
        else {
            return Ok(None);
        };
        let set: Vec<usize> = harmonics.iter().map(|&k| k as usize).collect();
        let transform = HarmonicTransform::new(&set, settings.solver.samples_per_period)?;
        let displacements = displacements(model, engine_order, harmonics, &point.solution);
        let sector = PairParameters {
            normal_load_n,
            ..sector
        };
        let corrections = corrections(
            model,
            PairHarmonics::new(law, transform.into()),
            sector,
            &displacements,
        );
        let mut motion = Self {
            model,
            settings,
            engine_order,
            normal_load_n,
            omega: TAU * point.frequency_hz,
            harmonics: harmonics
                .iter()
                .zip(displacements.into_iter().zip(corrections))
                .map(|(&harmonic, (displacement, correction))| HarmonicMotion {
                    harmonic,
                    displacement,
                    correction,
                })
                .collect(),
            norm: 0.0,
        };
        motion.norm = motion
            .harmonics
            .iter()
            .filter(|motion| motion.harmonic > 0)
            .map(|own| motion.squared_norm(&own.displacement))
            .sum::<f64>()
            .sqrt();
        Ok((motion.norm > 0.0).then_some(motion))
    }

    /// The indicator for the basis of `reduced`, of the same wheel; none if a dynamic stiffness is singular.
    #[must_use]
    pub fn errors_of(&self, reduced: &ReducedModel) -> Option<ContactDisplacementErrors> {
        let mut worst: Option<ContactDisplacementErrors> = None;
        for motion in self.harmonics.iter().filter(|motion| motion.harmonic > 0) {
            let own = nodal_diameter_of(motion.harmonic, self.engine_order, self.model.sectors);
            for wave in self.waves() {
                let whole = self.answer(self.model, motion, wave)?;
                let basis = self.answer(reduced, motion, wave)?;
                let difference: Vec<Complex64> =
                    whole.iter().zip(&basis).map(|(a, b)| a - b).collect();
                let largest = self.norm.max(self.squared_norm(&whole).sqrt());
                let difference = self.squared_norm(&difference).sqrt();
                let error = |error| ContactDisplacementError {
                    error,
                    engine_order: self.engine_order,
                    normal_load_n: self.normal_load_n,
                    harmonic: motion.harmonic,
                    nodal_diameter: wave.index,
                };
                let here = ContactDisplacementErrors {
                    tuned: error(if wave == own {
                        difference / self.norm
                    } else {
                        0.0
                    }),
                    mistuned: error(difference / largest),
                };
                worst = Some(worst.map_or(here, |worst| worst.larger(here)));
            }
        }
        worst
    }

    /// All travelling waves of the wheel.
    fn waves(&self) -> impl Iterator<Item = NodalDiameter> {
        let sectors = self.model.sectors;
        (0..sectors as u32).map(move |h| nodal_diameter_of(1, h, sectors))
    }

    /// `C (Z(k omega) + C^H k_c C)^-1 (f_k - C^H G_k)` of one wave in the basis of `model`.
    fn answer(
        &self,
        model: &ReducedModel,
        motion: &HarmonicMotion,
        wave: NodalDiameter,
    ) -> Option<Vec<Complex64>> {
        let structure =
            Structure::new(StructuralModes::of_wave(model, wave), self.settings.damping);
        let stuck = structure.contact_stiffness(&model.springs.stick);
        let wave = model.wave(wave);
        let mut force = wave.contact.adjoint_times_vector(&motion.correction);
        let excitation = if motion.harmonic == 1 {
            self.settings.amplitude_n
        } else {
            0.0
        };
        for (entry, external) in force.iter_mut().zip(wave.force.column(0)) {
            *entry = external * excitation - *entry;
        }
        let omega = f64::from(motion.harmonic) * self.omega;
        let mut workspace = LuWorkspace::new(structure.size());
        let response = linear_response(&structure, Some(&stuck), omega, &force, &mut workspace)?;
        Some(wave.contact.times_vector(&response))
    }

    /// `sum_p w_p |d_p|^2` of one harmonic, m^2.
    fn squared_norm(&self, displacement: &[Complex64]) -> f64 {
        let contact = &self.model.contact;
        contact
            .rows
            .iter()
            .zip(&contact.weights)
            .flat_map(|(rows, weight)| {
                rows.iter()
                    .flatten()
                    .map(move |&row| weight * displacement[row].norm_sqr())
            })
            .sum()
    }
}

/// `d_k = C x_k` of each harmonic from the real unknowns of the tuned harmonic balance: harmonic 0 its
/// coordinates, every other one real, then imaginary parts.
fn displacements(
    model: &ReducedModel,
    engine_order: u32,
    harmonics: &[u32],
    solution: &[f64],
) -> Vec<Vec<Complex64>> {
    let mut rest = solution;
    harmonics
        .iter()
        .map(|&harmonic| {
            let wave = model.wave(nodal_diameter_of(harmonic, engine_order, model.sectors));
            let n = wave.eigenvalues.len();
            let parts = if harmonic == 0 { 1 } else { 2 };
            let (own, after) = rest.split_at(parts * n);
            rest = after;
            let x: Vec<Complex64> = (0..n)
                .map(|i| Complex64::new(own[i], if harmonic == 0 { 0.0 } else { own[n + i] }))
                .collect();
            wave.contact.times_vector(&x)
        })
        .collect()
}

/// `G_k` of each harmonic, by the contact law.
fn corrections(
    model: &ReducedModel,
    mut law: PairHarmonics,
    sector: PairParameters,
    displacements: &[Vec<Complex64>],
) -> Vec<Vec<Complex64>> {
    let harmonics = law.transform().harmonics().to_vec();
    let coefficients = law.transform().n_coefficients();
    let mut forces = vec![vec![Complex64::default(); model.contact_rows()]; harmonics.len()];
    for (rows, &weight) in model.contact.rows.iter().zip(&model.contact.weights) {
        let mut input = vec![0.0; 3 * coefficients];
        let mut output = vec![0.0; 3 * coefficients];
        let mut place = 0;
        // Harmonic by harmonic: place of its first coefficient within a direction.
        let places: Vec<usize> = harmonics
            .iter()
            .map(|&k| {
                let own = place;
                place += if k == 0 { 1 } else { 2 };
                own
            })
            .collect();
        for (direction, row) in rows.iter().enumerate() {
            let Some(row) = *row else { continue };
            for (index, &k) in harmonics.iter().enumerate() {
                let at = direction * coefficients + places[index];
                input[at] = displacements[index][row].re;
                if k > 0 {
                    input[at + 1] = displacements[index][row].im;
                }
            }
        }
        law.evaluate(&sector.share(weight), &input, &mut output, None);
        for (direction, row) in rows.iter().enumerate() {
            let Some(row) = *row else { continue };
            for (index, &k) in harmonics.iter().enumerate() {
                let at = direction * coefficients + places[index];
                let imaginary = if k > 0 { output[at + 1] } else { 0.0 };
                forces[index][row] = Complex64::new(output[at], imaginary);
            }
        }
    }
    forces
}
