//! The equation of the motions at the contact of a mistuned wheel at one frequency.
//!
//! In every harmonic k of the set
//!
//! ```text
//! r_k(u) = u_k - u_lin,k + A_k G_k(u)
//! ```
//!
//! with the answer A of the wheel to contact forces ([`super::wheel_harmonic`]) and the correction G of the contact forces to
//! those of stuck springs, all harmonics together.

use crate::response::harmonic_balance::{ContactShares, WheelContact};

use super::acceleration::Acceleration;
use super::contact_forces::ContactForces;
use super::contact_places::Places;
use super::fields::{Field, SectorTransform, flatten, norm_squared, padded, unflatten};
use super::pair_preconditioner::PairPreconditioner;
use super::preconditioner::Preconditioner;
use super::wave_preconditioner::WavePreconditioner;
use super::wheel_harmonic::WheelHarmonic;
use super::whole_preconditioner::WholePreconditioner;

/// What a preconditioner takes in.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Preconditioned {
    /// The mean tangent, and the blade shapes of every harmonic that are not nearly static.
    Resonant,
    /// The mean tangent, and the first blade shape, of harmonic 1.
    FirstOfFundamental,
    /// The mean tangent of low harmonics, the first blade shape of harmonic 1, and high harmonics coupled.
    HighCoupled,
    /// The whole derivative.
    Whole,
}

/// The preconditioner of a step.
pub(super) enum StepPreconditioner {
    /// Every harmonic by itself.
    Harmonics(Vec<Preconditioner>),
    /// Low harmonics by themselves, high ones together.
    HighCoupled(Vec<Preconditioner>, Box<WavePreconditioner>),
    /// All harmonics together.
    Whole(Box<WholePreconditioner>),
}

/// The equation of one wheel at one frequency.
pub(super) struct ContactEquation<'a> {
    pub(super) transform: &'a SectorTransform,
    pub(super) contact: &'a mut WheelContact,
    /// The contact with fewer samples, from which derivatives are taken; none: they are taken from `contact`.
    pub(super) coarse_contact: Option<&'a mut WheelContact>,
    /// A harmonic of the set each, in its order.
    pub(super) harmonics: &'a mut [WheelHarmonic],
    /// `u_lin` of harmonic 1, at this place of the set.
    pub(super) linear: &'a Field,
    /// Forces on the contact besides its own, a field per harmonic.
    pub(super) added_forces: Option<&'a ContactForces>,
    pub(super) fundamental: usize,
    /// The wave of the excitation.
    pub(super) wave: usize,
    pub(super) buffers: &'a mut Buffers,
}

/// Vectors of the iteration.
#[derive(Default)]
pub(super) struct Buffers {
    pub(super) motions: Vec<Field>,
    pub(super) residual: Vec<Field>,
    /// Correction of the contact forces at the motions last evaluated, waves. A residual adds the forces of the equation besides its own to it; a
    /// product with the derivative leaves `G' v` here.
    pub(super) forces: Vec<Field>,
    sectors: Field,
    pub(super) acceleration: Acceleration,
    pub(super) flat: [Vec<f64>; 3],
}

impl Buffers {
    /// Makes room for so many harmonics and contact rows of a sector.
    pub(super) fn resize(&mut self, harmonics: usize, rows: usize, sectors: usize) {
        let entries = rows * padded(sectors);
        let fits = |fields: &Vec<Field>| {
            fields.len() == harmonics && fields.iter().all(|field| field.re.len() == entries)
        };
        if !fits(&self.motions) {
            let fields = || vec![Field::zeros(rows, sectors); harmonics];
            (self.motions, self.residual, self.forces) = (fields(), fields(), fields());
            self.sectors = Field::zeros(rows, sectors);
            self.acceleration.resize(2 * harmonics * entries);
        }
    }
}

impl ContactEquation<'_> {
    /// The motions of the linear response.
    pub(super) fn linear_start(&self) -> Vec<Field> {
        let mut start = vec![Field::default(); self.harmonics.len()];
        for (place, motion) in start.iter_mut().enumerate() {
            motion.clone_from(self.linear);
            if place != self.fundamental {
                motion.fill(0.0);
            }
        }
        start
    }

    /// Gives the contact the motions, which may be those of an earlier solution.
    pub(super) fn place(&mut self, motions: &[f64]) {
        unflatten(motions, &mut self.buffers.motions);
        self.give_motions();
    }

    /// Evaluates the contact's own forces at the motions of a solution; they are left in the buffers.
    pub(super) fn evaluate_forces(&mut self, motions: &[f64]) {
        self.place(motions);
        self.contact.evaluate(false);
        let places = Places::of(self.contact);
        for place in 0..places.harmonics.len() {
            self.correct_forces(&places, place);
        }
    }

    /// The correction last evaluated in one harmonic, over the waves; left in the buffers.
    fn correct_forces(&mut self, places: &Places, place: usize) {
        let Buffers {
            forces, sectors, ..
        } = &mut *self.buffers;
        let correction = self.contact.correction();
        places.to_waves(
            self.transform,
            place,
            correction,
            sectors,
            &mut forces[place],
        );
    }

    /// Gives the contact the motions of every sector.
    fn give_motions(&mut self) {
        let places = Places::of(self.contact);
        let Buffers {
            motions, sectors, ..
        } = &mut *self.buffers;
        let to = self.contact.motion_mut();
        places.to_sectors(self.transform, motions, sectors, to);
    }

    /// Norm of the residual at the motions, relative to them, with the derivative of the contact where that is wanted.
    pub(super) fn residual(&mut self, derivative: bool) -> (f64, ContactShares) {
        let places = Places::of(self.contact);
        self.give_motions();
        let shares = self.contact.evaluate(derivative);
        let motion = self.weighed(&self.buffers.motions);
        for place in 0..places.harmonics.len() {
            self.correct_forces(&places, place);
            let Buffers {
                motions,
                residual,
                forces,
                ..
            } = &mut *self.buffers;
            if let Some(added) = self.added_forces {
                forces[place].add(1.0, &added.fields[place]);
            }
            residual[place].clone_from(&motions[place]);
            if place == self.fundamental {
                residual[place].add(-1.0, self.linear);
            }
            self.harmonics[place].add_answer(self.transform, &forces[place], &mut residual[place]);
        }
        let residual = self.weighed(&self.buffers.residual);
        ((residual / motion).sqrt(), shares)
    }

    /// Takes the tangent of the contact at the motions last evaluated into a preconditioner; by the mean, where what couples harmonics is
    /// singular.
    pub(super) fn preconditioner(&mut self, takes_in: Preconditioned) -> StepPreconditioner {
        let whole = takes_in == Preconditioned::Whole;
        let whole =
            whole.then(|| WholePreconditioner::new(self.transform, self.contact, self.harmonics));
        if let Some(whole) = whole.flatten() {
            return StepPreconditioner::Whole(Box::new(whole));
        }
        let harmonics = self.preconditioners(takes_in);
        let couples = takes_in == Preconditioned::HighCoupled;
        let high =
            couples.then(|| WavePreconditioner::new(self.contact, self.harmonics, self.wave));
        match high.flatten() {
            Some(high) => StepPreconditioner::HighCoupled(harmonics, Box::new(high)),
            None => StepPreconditioner::Harmonics(harmonics),
        }
    }

    /// Takes the mean tangent of the contact at the motions last evaluated into the preconditioner of every harmonic.
    pub(super) fn preconditioners(&self, takes_in: Preconditioned) -> Vec<Preconditioner> {
        let pairs = self.contact.pair_rows();
        let harmonics = self.harmonics.iter().enumerate();
        let contact: &WheelContact = self.coarse_contact.as_deref().unwrap_or(self.contact);
        harmonics
            .map(|(place, harmonic)| {
                let tangent = contact.mean_tangent(place);
                let shapes = match takes_in {
                    Preconditioned::Resonant => harmonic.resonant_shapes(),
                    Preconditioned::FirstOfFundamental
                    | Preconditioned::HighCoupled
                    | Preconditioned::Whole => {
                        harmonic.first_shapes(usize::from(place == self.fundamental))
                    }
                };
                Preconditioner::new(harmonic, self.transform, &tangent, pairs, &shapes)
            })
            .collect()
    }

    /// The residual turned into a step by a preconditioner, but for its sign.
    pub(super) fn precondition_by(&mut self, by: &mut StepPreconditioner) {
        let whole = match by {
            StepPreconditioner::Harmonics(harmonics) => return self.precondition(harmonics),
            StepPreconditioner::HighCoupled(harmonics, high) => {
                let residual = self.buffers.residual.clone();
                self.precondition(harmonics);
                return high.apply(&residual, &mut self.buffers.residual);
            }
            StepPreconditioner::Whole(whole) => whole,
        };
        let places = Places::of(self.contact);
        let Buffers {
            residual, sectors, ..
        } = &mut *self.buffers;
        places.to_sectors(self.transform, residual, sectors, &mut whole.unknowns);
        whole.apply();
        for (place, field) in residual.iter_mut().enumerate() {
            places.to_waves(self.transform, place, &whole.unknowns, sectors, field);
        }
    }

    /// The residual turned into a step by the preconditioners of the harmonics, but for its sign.
    pub(super) fn precondition(&mut self, preconditioners: &mut [Preconditioner]) {
        let residual = self.buffers.residual.iter_mut();
        for (preconditioner, residual) in preconditioners.iter_mut().zip(residual) {
            preconditioner.apply(self.transform, residual);
        }
    }

    /// Motions in the order of the unknowns as fields over the waves, and of every sector in the order of the contact.
    fn of_sectors(&mut self, flat: &[f64]) -> (Vec<Field>, Vec<f64>) {
        let places = Places::of(self.contact);
        let mut fields = self.buffers.motions.clone();
        unflatten(flat, &mut fields);
        let mut motions = vec![0.0; self.contact.motion().len()];
        let sectors = &mut self.buffers.sectors;
        places.to_sectors(self.transform, &fields, sectors, &mut motions);
        (fields, motions)
    }

    /// What every pair by itself makes of motions, in place.
    pub(super) fn precondition_pairs(&mut self, by: &mut PairPreconditioner, flat: &mut Vec<f64>) {
        let places = Places::of(self.contact);
        let (mut fields, mut motions) = self.of_sectors(flat);
        by.apply(&mut motions);
        for (place, field) in fields.iter_mut().enumerate() {
            let sectors = &mut self.buffers.sectors;
            places.to_waves(self.transform, place, &motions, sectors, field);
        }
        flatten(&fields, 1.0, flat);
    }

    /// Norm of the preconditioned residual over that of the motions.
    pub(super) fn step_over_motion(&self) -> f64 {
        (self.weighed(&self.buffers.residual) / self.weighed(&self.buffers.motions)).sqrt()
    }

    /// Norm of the preconditioned residual.
    pub(super) fn step_size(&self) -> f64 {
        self.weighed(&self.buffers.residual).sqrt()
    }

    /// Squared norm of a field per harmonic, of which harmonic k counts by `1/k`: forces that jump have harmonics that fall so, and so
    /// does what a motion in a harmonic changes of the others.
    fn weighed(&self, fields: &[Field]) -> f64 {
        let set = self.contact.transform().harmonics().iter();
        let squares = fields.iter().zip(set);
        let squares = squares.map(|(field, &k)| norm_squared(field) / (k.max(1) * k.max(1)) as f64);
        squares.sum()
    }

    /// [`Self::residual`]; the derivative is that of the contact with fewer samples, if there is one.
    pub(super) fn residual_with_tangent(&mut self, wanted: bool) -> (f64, ContactShares) {
        let apart = wanted && self.coarse_contact.is_some();
        let found = self.residual(wanted && !apart);
        if let Some(coarse) = self.coarse_contact.as_mut().filter(|_| apart) {
            coarse.motion_mut().copy_from_slice(self.contact.motion());
            coarse.evaluate(true);
        }
        found
    }

    /// `J v` at the motions last evaluated with derivative: `v + A G' v`.
    pub(super) fn derivative(&mut self, direction: &[f64]) -> Vec<f64> {
        let places = Places::of(self.contact);
        let (mut fields, change) = self.of_sectors(direction);
        let mut force = vec![0.0; change.len()];
        self.contact.add_derivative(&change, &mut force);
        for (place, field) in fields.iter_mut().enumerate() {
            let Buffers {
                forces, sectors, ..
            } = &mut *self.buffers;
            places.to_waves(self.transform, place, &force, sectors, &mut forces[place]);
            self.harmonics[place].add_answer(self.transform, &forces[place], field);
        }
        let mut flat = Vec::new();
        flatten(&fields, 1.0, &mut flat);
        flat
    }
}
