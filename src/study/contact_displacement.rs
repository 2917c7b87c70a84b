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

use crate::linalg::{Complex64, LuWorkspace};
use crate::model::ReducedModel;
use crate::model::cyclic::{NodalDiameter, nodal_diameter_of};
use crate::model::reduction::{ContactDisplacementError, ContactDisplacementErrors};
use crate::population::monte_carlo::RowSettings;
use crate::response::forced_response::{ContactCondition, Peak};
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::{
    HarmonicTransform, PairHarmonics, Structure, TransformError, linear_response,
};
use crate::response::mistuning::StructuralModes;

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

    /// The indicator for the basis of `reduced`, of the same wheel, over its harmonics but the mean; none if a
    /// dynamic stiffness is singular.
    #[must_use]
    pub fn errors_of(&self, reduced: &ReducedModel) -> Option<ContactDisplacementErrors> {
        let mut worst: Option<ContactDisplacementErrors> = None;
        let motions = self.harmonics.iter();
        for motion in motions.filter(|motion| motion.harmonic > 0) {
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
                    any_nodal_diameter: error(difference / largest),
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
            self.settings.amplitude_n * model.force_factor(self.engine_order)
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
    for (rows, pair) in model.contact.rows.iter().zip(sector.pairs(&model.contact)) {
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
        law.evaluate(&pair, &input, &mut output, None);
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

#[cfg(test)]
mod tests {
    use std::error::Error;
    use std::sync::Arc;

    use super::*;
    use crate::model::reduction::{BasisChoice, ContactStiffness, Reduction};
    use crate::model::sector::{ParametricOptions, parametric};
    use crate::population::monte_carlo::RowSolver;
    use crate::response::forced_response::SolverOptions;
    use crate::response::friction::{ContactLaw, Ring};
    use crate::response::harmonic_balance::Damping;
    use crate::response::mistuning::Projection;

    const HARMONICS: [u32; 2] = [1, 3];

    fn settings() -> RowSettings {
        let sector = PairParameters {
            normal_load_n: 0.0,
            normal_stiffness_n_per_m: 2e8,
            tangential_stiffness_n_per_m: 2e8,
            friction_coefficient: 0.3,
        };
        RowSettings {
            harmonics: HARMONICS.to_vec(),
            contact: Some((ContactLaw::Simplified3d, sector)),
            ring: Ring::Locked,
            in_place_of: None,
            damping: Damping::StructuralLossFactor(0.002),
            amplitude_n: 1.0,
            projection: Projection::Exact,
            solver: SolverOptions::default(),
        }
    }

    #[test]
    fn the_same_forces_give_the_solution_in_the_whole_space_and_less_error_in_larger_bases()
    -> Result<(), Box<dyn Error>> {
        let options = ParametricOptions {
            sectors: 7,
            ..ParametricOptions::default()
        };
        let sector = parametric::build(&options)?;
        let stiffness = ContactStiffness {
            normal_n_per_m: 2e8,
            tangential_1_n_per_m: 2e8,
            tangential_2_n_per_m: 2e8,
        };
        let reduction = Reduction::new(&sector, stiffness, 25, 0)?;
        let whole = reduction.tuned(BasisChoice::CraigBampton)?;
        let settings = settings();
        // Engine order 5 of 7 sectors: conjugate waves of nodal diameters 2 and 1.
        let condition = ContactCondition::Full {
            normal_load_n: 200.0,
        };
        let solver = RowSolver::new(Arc::new(whole.clone()), settings.clone())?;
        let peak = solver.tuned_peak(5, condition);
        let motion = ContactMotion::of_peak(&whole, &settings, &HARMONICS, 5, condition, &peak)?
            .ok_or("a nonlinear peak")?;
        let point = peak.point.as_ref().ok_or("a point")?;
        assert!(point.shares.slipping > 0.5);
        for (own, share) in motion.harmonics.iter().zip([0.5, 1e-4]) {
            let wave = nodal_diameter_of(own.harmonic, 5, 7);
            let answer = motion.answer(&whole, own, wave).ok_or("regular")?;
            let difference: Vec<Complex64> = answer
                .iter()
                .zip(&own.displacement)
                .map(|(a, b)| a - b)
                .collect();
            assert!(motion.squared_norm(&own.displacement).sqrt() > share * motion.norm);
            assert!(motion.squared_norm(&difference).sqrt() < 1e-6 * motion.norm);
        }
        let mut errors = Vec::new();
        for choice in [
            BasisChoice::StickSlide { stick: 2, slide: 2 },
            BasisChoice::StickSlide { stick: 8, slide: 8 },
            BasisChoice::StickAttachment { stick: 14 },
            BasisChoice::StickAttachment { stick: 1000 },
        ] {
            let found = motion.errors_of(&reduction.tuned(choice)?);
            errors.push(found.ok_or("regular")?);
        }
        for pair in errors.windows(2) {
            assert!(pair[1].tuned.error < pair[0].tuned.error, "{errors:?}");
            assert!(pair[1].any_nodal_diameter.error < pair[0].any_nodal_diameter.error);
        }
        for error in &errors {
            assert!(error.any_nodal_diameter.error >= 0.9 * error.tuned.error);
        }
        assert!(errors[0].tuned.error > 1e-2 && errors[3].any_nodal_diameter.error < 1e-6);
        Ok(())
    }
}
