//! A structure under one excitation: a mistuned wheel, or the travelling waves of the tuned wheel.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::linear_peaks::LinearModes;
use super::options::ContactCondition;
use crate::linalg::{Complex64, LuWorkspace};
use crate::model::ReducedModel;
use crate::model::cyclic::nodal_diameter_of;
use crate::response::harmonic_balance::{
    ContactStiffnessMatrix, Damping, HarmonicBlock, Structure, linear_response,
};
use crate::response::mistuning::{ContactFactors, StructuralModes, WheelBasis};
use crate::response::receptance::Resonance;

/// One linear structure with both linear contact stiffnesses.
#[derive(Debug, Clone)]
pub struct LinearStructure {
    /// Contact-free modes and damping.
    pub structure: Arc<Structure>,
    /// Sticking contact springs.
    pub stuck: Arc<ContactStiffnessMatrix>,
    /// Sliding contact springs.
    pub slide: Arc<ContactStiffnessMatrix>,
}

impl LinearStructure {
    fn new(
        modes: StructuralModes,
        model: &ReducedModel,
        factors: &ContactFactors,
        damping: Damping,
    ) -> Self {
        let structure = Structure::new(modes, damping);
        let stiffness = |sector: &[f64]| {
            let springs = factors.springs(sector, &model.contact.rows);
            Arc::new(structure.contact_stiffness(&springs))
        };
        Self {
            stuck: stiffness(&model.springs.stick),
            slide: stiffness(&model.springs.slide),
            structure: Arc::new(structure),
        }
    }

    /// Linear contact stiffness of a condition; none without contact springs or where all are zero. The full law
    /// starts from the stuck springs.
    #[must_use]
    pub fn contact(&self, condition: ContactCondition) -> Option<&ContactStiffnessMatrix> {
        let stiffness = match condition {
            ContactCondition::Full { .. } | ContactCondition::Stuck => &self.stuck,
            ContactCondition::Slide => &self.slide,
            ContactCondition::Free => return None,
        };
        // Springs that are all zero are none: where a law has no stiffness once it slides.
        let acts = stiffness.springs.iter().any(|&spring| spring != 0.0);
        acts.then_some(&**stiffness)
    }
}

/// Linear modes under stick, slide and without contact, of one structure.
#[derive(Debug, Clone)]
pub struct LimitModes {
    stuck: Option<LinearModes>,
    slide: Option<LinearModes>,
    free: Option<LinearModes>,
}

/// A wheel or its tuned waves, with everything that does not depend on the excitation.
#[derive(Debug, Clone)]
pub struct Wheel {
    linear: LinearStructure,
    modes: LimitModes,
}

/// Which linear limits a study needs the modes of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LimitsWanted {
    /// Sticking contact.
    pub stuck: bool,
    /// Sliding contact.
    pub slide: bool,
    /// No contact.
    pub free: bool,
}

impl LimitsWanted {
    /// The linear limits that the given conditions need.
    pub fn of<'a>(conditions: impl IntoIterator<Item = &'a ContactCondition>) -> Self {
        let mut wanted = Self::default();
        for condition in conditions {
            match condition {
                ContactCondition::Full { .. } => {
                    wanted.stuck = true;
                    wanted.slide = true;
                }
                ContactCondition::Stuck => wanted.stuck = true,
                ContactCondition::Slide => wanted.slide = true,
                ContactCondition::Free => wanted.free = true,
            }
        }
        wanted
    }
}

impl LimitModes {
    fn new(linear: &LinearStructure, wanted: LimitsWanted) -> Self {
        let modes = |condition| LinearModes::new(&linear.structure, linear.contact(condition));
        Self {
            stuck: wanted
                .stuck
                .then(|| modes(ContactCondition::Stuck))
                .flatten(),
            slide: wanted
                .slide
                .then(|| modes(ContactCondition::Slide))
                .flatten(),
            free: wanted.free.then(|| modes(ContactCondition::Free)).flatten(),
        }
    }

    /// Resonances of the linear models between which the answer of a condition lies: stuck and
    /// slide for the full law, else those of the limit itself.
    fn peaks(
        &self,
        condition: ContactCondition,
        structure: &Structure,
        force: &[Complex64],
    ) -> Vec<Vec<Resonance>> {
        let limits = match condition {
            ContactCondition::Full { .. } => vec![&self.stuck, &self.slide],
            ContactCondition::Stuck => vec![&self.stuck],
            ContactCondition::Slide => vec![&self.slide],
            ContactCondition::Free => vec![&self.free],
        };
        limits
            .into_iter()
            .flatten()
            .map(|modes| modes.peaks(structure, force))
            .collect()
    }
}

impl Wheel {
    /// A mistuned wheel with the modes of the limits that are wanted; `factors` are those of its
    /// contact.
    #[must_use]
    pub fn mistuned(
        modes: StructuralModes,
        model: &ReducedModel,
        factors: &ContactFactors,
        damping: Damping,
        wanted: LimitsWanted,
    ) -> Self {
        let linear = LinearStructure::new(modes, model, factors, damping);
        Self {
            modes: LimitModes::new(&linear, wanted),
            linear,
        }
    }
}

/// A structure under one engine order: what the solution of a row starts from.
#[derive(Debug, Clone)]
pub struct Excited {
    /// Structure of the fundamental harmonic.
    pub linear: LinearStructure,
    /// One block per harmonic of the set.
    pub blocks: Vec<HarmonicBlock>,
    /// Modal force of the fundamental harmonic, N / sqrt(kg).
    pub force: Vec<Complex64>,
    modes: LimitModes,
}

impl Excited {
    /// A mistuned wheel under a modal force, with one block per harmonic.
    #[must_use]
    pub fn wheel(wheel: &Wheel, modal_force: Vec<Complex64>, harmonics: &[u32]) -> Self {
        let blocks = harmonics
            .iter()
            .map(|&harmonic| HarmonicBlock {
                harmonic,
                structure: Arc::clone(&wheel.linear.structure),
                stuck: Arc::clone(&wheel.linear.stuck),
            })
            .collect();
        Self {
            linear: wheel.linear.clone(),
            blocks,
            force: modal_force,
            modes: wheel.modes.clone(),
        }
    }

    /// The tuned wheel as one sector: temporal harmonic k in nodal diameter `k EO mod N` alone.
    /// `factors` are those of the pairs of one sector, alike in all.
    #[must_use]
    pub fn tuned(
        model: &ReducedModel,
        factors: &ContactFactors,
        engine_order: u32,
        amplitude_n: f64,
        damping: Damping,
        harmonics: &[u32],
        wanted: LimitsWanted,
    ) -> Self {
        let wave = |harmonic| nodal_diameter_of(harmonic, engine_order, model.sectors);
        let structure = |harmonic| {
            LinearStructure::new(
                StructuralModes::of_wave(model, wave(harmonic)),
                model,
                factors,
                damping,
            )
        };
        let linear = structure(1);
        let blocks = harmonics
            .iter()
            .map(|&harmonic| {
                let excited = if harmonic == 1 {
                    linear.clone()
                } else {
                    structure(harmonic)
                };
                HarmonicBlock {
                    harmonic,
                    structure: excited.structure,
                    stuck: excited.stuck,
                }
            })
            .collect();
        let force = model.wave(wave(1)).force;
        let amplitude_n = amplitude_n * model.force_factor(engine_order);
        Self {
            modes: LimitModes::new(&linear, wanted),
            linear,
            blocks,
            force: force.column(0).iter().map(|f| f * amplitude_n).collect(),
        }
    }

    /// Copy of this structure with viscous damping that is equal to its damping at the angular frequency
    /// `omega`, rad/s, see [`Structure::with_viscous_damping`].
    #[must_use]
    pub fn with_viscous_damping(&self, omega: f64) -> Self {
        let mut excited = self.clone();
        let viscous = |structure: &Structure| Arc::new(structure.with_viscous_damping(omega));
        excited.linear.structure = viscous(&self.linear.structure);
        for block in &mut excited.blocks {
            // The harmonics of a wheel share one structure.
            block.structure = if Arc::ptr_eq(&block.structure, &self.linear.structure) {
                Arc::clone(&excited.linear.structure)
            } else {
                viscous(&block.structure)
            };
        }
        excited
    }

    /// Resonances of the linear limits that bound `condition`.
    #[must_use]
    pub fn linear_peaks(&self, condition: ContactCondition) -> Vec<Vec<Resonance>> {
        self.modes
            .peaks(condition, &self.linear.structure, &self.force)
    }

    /// Linear response at a frequency, Hz, with the springs of `condition`, stuck ones for the full law; `factors` are of
    /// the size of the structure. None if the matrix is singular.
    pub(super) fn linear_response(
        &self,
        condition: ContactCondition,
        frequency_hz: f64,
        factors: &mut LuWorkspace<Complex64>,
    ) -> Option<Vec<Complex64>> {
        linear_response(
            &self.linear.structure,
            self.linear.contact(condition),
            TAU * frequency_hz,
            &self.force,
            factors,
        )
    }
}

/// Modal force on a mistuned wheel, of `f e^{i EO n alpha}` scaled by `amplitude_n`.
#[must_use]
pub fn wheel_force(
    basis: &WheelBasis,
    modes: &StructuralModes,
    engine_order: u32,
    amplitude_n: f64,
) -> Vec<Complex64> {
    let mut force = modes.modal_force(&basis.force(engine_order));
    for f in &mut force {
        *f *= amplitude_n;
    }
    force
}
