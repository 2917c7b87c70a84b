//! One wheel under one excitation and contact condition, solved at any frequency.

use std::f64::consts::TAU;

use crate::linalg::Complex64;
use crate::response::friction::{PairParameters, Ring};
use crate::response::harmonic_balance::{
    ContactShares, DriftingRing, PairContact, Status, WheelContact, let_creep,
};

use super::attempts_on_receptances::{Effort, FEW_UNKNOWNS};
use super::contact_equation::{Buffers, ContactEquation};
use super::contact_forces::ContactForces;
use super::contact_iteration::Outcome;
use super::engine::{EngineWheel, Limit, ReceptanceEngine};
use super::fields::Field;
use super::motions::{between_turning, phases_ahead, turned_ahead};
use super::wave_force::WaveForce;
use super::wheel_harmonic::WheelHarmonic;

/// Solves one wheel at one frequency after the other; buffers are kept.
pub struct WheelSolver<'a> {
    engine: &'a ReceptanceEngine,
    wheel: &'a EngineWheel,
    limit: Limit,
    force: &'a WaveForce,
    set: Vec<u32>,
    contact: Option<WheelContact>,
    coarse_contact: Option<WheelContact>,
    harmonics: Vec<WheelHarmonic>,
    linear: Field,
    /// Forces on the contact besides its own.
    added_forces: Option<ContactForces>,
    /// What a free ring does under mean friction.
    ring: Ring,
    effort: Effort,
    buffers: Buffers,
    /// Tuned response to the excitation of the motions [contact, strain, observed].
    excited: Vec<Complex64>,
}

/// A solution at one frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelSolution {
    /// Motions at the contact of every harmonic, in the waves.
    pub motions: Vec<f64>,
    /// Norm of the residual over that of the motions, of which harmonic k counts by `1/k`; 0 for a linear limit.
    pub residual: f64,
    /// Shares of slipping and separated pairs.
    pub shares: ContactShares,
}

/// What a solution took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SolutionWork {
    /// Steps of the iteration.
    pub iterations: u64,
    /// Tangents taken.
    pub tangents: u64,
    /// Attempts after the first.
    pub retries: u64,
}

/// How the motions at the contact are sought at one frequency.
#[derive(Clone, Copy)]
enum Way<'a> {
    /// By all attempts, from the best of several motions, or from the linear response without any.
    From(&'a [Vec<f64>]),
    /// By one attempt beside motions.
    Beside(&'a [f64]),
}

impl SolutionWork {
    /// The sum of this work and `other`.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            iterations: self.iterations + other.iterations,
            tangents: self.tangents + other.tangents,
            retries: self.retries + other.retries,
        }
    }
}

impl<'a> WheelSolver<'a> {
    /// A solver in the harmonics `set`, ascending and with 1; `contact` is none for a linear limit.
    #[must_use]
    pub fn new(
        engine: &'a ReceptanceEngine,
        wheel: &'a EngineWheel,
        limit: Limit,
        force: &'a WaveForce,
        set: &[u32],
        contact: Option<WheelContact>,
    ) -> Self {
        let set = if contact.is_some() {
            set.to_vec()
        } else {
            vec![1]
        };
        Self {
            engine,
            wheel,
            limit,
            force,
            set,
            contact,
            coarse_contact: None,
            harmonics: Vec::new(),
            linear: Field::default(),
            added_forces: None,
            ring: Ring::Locked,
            effort: Effort::ALL,
            buffers: Buffers::default(),
            excited: Vec::new(),
        }
    }

    /// This solver with what a free ring does under mean friction; it is locked at first.
    #[must_use]
    pub fn with_ring(self, ring: Ring) -> Self {
        Self { ring, ..self }
    }

    /// Drift of the ring along its rigid motions (rotation, axial) at the solution last solved, m per period: zero at first.
    #[must_use]
    pub fn ring_drift_m(&self) -> [f64; 2] {
        let contact = self.contact.as_ref();
        contact.map_or([0.0; 2], WheelContact::ring_drift_m)
    }

    /// The drift from which that of a creeping ring is sought next.
    pub fn set_ring_drift(&mut self, drift_m: [f64; 2]) {
        for contact in self.contact.iter_mut().chain(&mut self.coarse_contact) {
            contact.set_ring_drift(drift_m);
        }
    }

    /// How far it goes at every frequency from now on.
    pub(crate) fn effort(&mut self) -> &mut Effort {
        &mut self.effort
    }

    /// This solver with derivatives from `contact`, which is its contact with fewer samples; none: from its contact itself.
    #[must_use]
    pub fn with_coarse_contact(self, contact: Option<WheelContact>) -> Self {
        Self {
            coarse_contact: contact,
            ..self
        }
    }

    /// One attempt beside `start`, of the same harmonics: motions, and the share of them that the next step would still move;
    /// none where it failed, or for a linear limit.
    pub fn settle(
        &mut self,
        frequency_hz: f64,
        start: &[f64],
        tolerance: f64,
    ) -> Option<(Vec<f64>, f64)> {
        if !self.prepare(frequency_hz) {
            return None;
        }
        let outcome = self.by_ring(Way::Beside(start), tolerance)?;
        let settled = matches!(outcome.status, Status::Ok | Status::IterationLimit);
        (settled && outcome.step < 1.0).then(|| (self.motions(), outcome.step))
    }

    /// The equation at the frequency prepared; none for a linear limit.
    fn equation(&mut self) -> Option<ContactEquation<'_>> {
        let contact = self.contact.as_mut()?;
        let sectors = self.engine.sectors();
        let fundamental = self.set.iter().position(|&k| k == 1).unwrap_or(0);
        self.buffers
            .resize(self.set.len(), contact.sector_rows(), sectors);
        Some(ContactEquation {
            transform: &self.engine.transform,
            contact,
            coarse_contact: self.coarse_contact.as_mut(),
            harmonics: &mut self.harmonics,
            linear: &self.linear,
            added_forces: self.added_forces.as_ref(),
            fundamental,
            wave: self.force.wave(sectors),
            buffers: &mut self.buffers,
        })
    }

    fn motions(&self) -> Vec<f64> {
        let fields = self.buffers.motions.iter();
        let parts = fields.flat_map(|field| field.re.iter().chain(&field.im));
        parts.copied().collect()
    }

    /// Solves at a frequency, Hz, from the one of `starts` (as [`WheelSolution::motions`]) that has the smallest residual, or from
    /// the linear response without any.
    ///
    /// # Errors
    /// How the last attempt ended.
    pub fn solve(
        &mut self,
        frequency_hz: f64,
        starts: &[Vec<f64>],
        tolerance: f64,
    ) -> (Result<WheelSolution, Status>, SolutionWork) {
        let mut work = SolutionWork::default();
        if !self.prepare(frequency_hz) {
            return (Err(Status::SingularJacobian), work);
        }
        let Some(outcome) = self.by_ring(Way::From(starts), tolerance) else {
            let solution = WheelSolution {
                motions: Vec::new(),
                residual: 0.0,
                shares: ContactShares::default(),
            };
            return (Ok(solution), work);
        };
        work.iterations = outcome.iterations;
        work.tangents = outcome.tangents;
        work.retries = outcome.retries;
        let solved = (outcome.status == Status::Ok).then(|| WheelSolution {
            motions: self.motions(),
            residual: outcome.residual,
            shares: outcome.shares,
        });
        (solved.ok_or(outcome.status), work)
    }

    /// Solves at the frequency prepared, with what the ring does; none for a linear limit.
    fn by_ring(&mut self, way: Way<'_>, tolerance: f64) -> Option<Outcome> {
        if self.ring == Ring::Locked || self.contact.is_none() {
            return self.at_drift(way, tolerance);
        }
        let mut ring = CreepingRing {
            solver: self,
            way,
            tolerance,
            motions: None,
            outcome: None,
        };
        let status = let_creep(&mut ring);
        let outcome = ring.outcome?;
        Some(Outcome { status, ..outcome })
    }

    /// Solves at the frequency prepared and the present drift of the ring; none for a linear limit.
    fn at_drift(&mut self, way: Way<'_>, tolerance: f64) -> Option<Outcome> {
        let effort = self.effort;
        let mut equation = self.equation()?;
        Some(match way {
            Way::From(starts) => equation.solve(starts, tolerance, effort),
            Way::Beside(start) => equation.settle(start, tolerance),
        })
    }

    /// Receptances, deviations and linear response at a frequency; false where one is singular.
    fn prepare(&mut self, frequency_hz: f64) -> bool {
        let tuned = self.engine.tuned_wheel(self.limit);
        let transform = &self.engine.transform;
        let sectors = self.engine.sectors();
        let contact_rows = tuned.diameters[0].spring_count();
        for (place, &harmonic) in self.set.iter().enumerate() {
            let Some(tables) = tuned.tables(harmonic) else {
                return false;
            };
            if self.harmonics.len() == place {
                let wheel_harmonic = WheelHarmonic::new(sectors, contact_rows, tables.shapes);
                self.harmonics.push(wheel_harmonic);
            }
            let wheel_harmonic = &mut self.harmonics[place];
            let s = angular(harmonic, frequency_hz);
            let filled = tables
                .receptances
                .at(&tuned.diameters, s, &mut wheel_harmonic.receptance);
            let deviations = self.wheel.deviations(tables.shapes).into_iter();
            let loss = self.engine.loss_factor;
            let deviations = deviations.map(|delta| damped(delta, loss, harmonic));
            if filled.is_none() || !wheel_harmonic.mistune(transform, deviations) {
                return false;
            }
            if harmonic == 1 {
                let diameter = &tuned.diameters[self.force.diameter.index];
                let motions = tables.receptances.motions(self.force.diameter.index);
                let conjugate = self.force.diameter.conjugate;
                let Some(excited) =
                    diameter.response(TAU * frequency_hz, motions, &self.force.modal, conjugate)
                else {
                    return false;
                };
                self.excited = excited;
                self.linear = Field::zeros(contact_rows, sectors);
                let wave = self.force.wave(sectors);
                wheel_harmonic.excite(transform, wave, &self.excited, &mut self.linear);
            }
        }
        true
    }

    /// Complex displacement r, theta, z of the observed node, blade after blade, of the harmonic at a place of the set, at the
    /// frequency and solution last solved.
    pub fn observed(&mut self, place: usize) -> Vec<Complex64> {
        let sectors = self.engine.sectors();
        let wave = self.force.wave(sectors);
        let rows = self.engine.tuned_wheel(self.limit).diameters[0].spring_count();
        let none = Field::zeros(rows, sectors);
        let force = if self.contact.is_some() {
            &self.buffers.forces[place]
        } else {
            &none
        };
        let excited = (self.set[place] == 1).then_some((wave, &*self.excited));
        let field = self.harmonics[place].observed(&self.engine.transform, force, excited);
        let stride = field.re.len() / 3;
        (0..sectors)
            .flat_map(|n| [0, 1, 2].map(|row| field.at(row * stride + n)))
            .collect()
    }

    /// Mean friction force on the ring at the motions of a solution, N per sector; none for a linear limit.
    pub fn mean_friction_n(&mut self, motions: &[f64]) -> Option<[f64; 2]> {
        self.equation()?.place(motions);
        Some(self.contact.as_mut()?.mean_friction_n())
    }

    /// From now on these forces, in the harmonics of the solver, act on the contact besides its own.
    pub fn add_forces(&mut self, added: ContactForces) {
        self.added_forces = Some(added);
    }

    /// Contact forces at the solution last solved, with those of [`Self::add_forces`] added.
    #[must_use]
    pub fn contact_forces(&self) -> ContactForces {
        ContactForces {
            harmonics: self.set.clone(),
            fields: self.buffers.forces.clone(),
        }
    }

    /// The contact's own forces at the motions of a solution, without those of [`Self::add_forces`]; none for a linear limit.
    pub fn contact_forces_at(&mut self, motions: &[f64]) -> Option<ContactForces> {
        self.equation()?.evaluate_forces(motions);
        Some(self.contact_forces())
    }

    /// State of every contact pair at the solution last solved; none for a linear limit.
    pub fn contact_states(&mut self) -> Option<Vec<PairContact>> {
        Some(self.contact.as_mut()?.contact_states())
    }

    /// Motion of every contact row in every harmonic at the solution last solved, sector after sector; none for a linear limit.
    #[must_use]
    pub fn contact_motion(&self) -> Option<Vec<(u32, Vec<Complex64>)>> {
        let contact = self.contact.as_ref()?;
        let rows = contact.sector_rows() * contact.sectors();
        let mut parts = contact.motion().chunks_exact(rows.max(1));
        self.set
            .iter()
            .map(|&harmonic| {
                let re = parts.next()?;
                let im = if harmonic == 0 {
                    None
                } else {
                    Some(parts.next()?)
                };
                let row =
                    |(row, &re): (usize, &f64)| Complex64::new(re, im.map_or(0.0, |im| im[row]));
                Some((harmonic, re.iter().enumerate().map(row).collect()))
            })
            .collect()
    }

    /// Motions a `share` of the way from those of one solution to those of another, along which every sector turns with its phase.
    #[must_use]
    pub fn between_turning(&self, low: &[f64], high: &[f64], share: f64) -> Vec<f64> {
        between_turning(&self.engine.transform, low, high, &self.set, share)
    }

    /// Phases of harmonic 1, rad, by which every sector of the motions `to` of a solution is ahead of that of `from`.
    #[must_use]
    pub fn phases_ahead(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        phases_ahead(&self.engine.transform, from, to, &self.set)
    }

    /// Motions of a solution whose sectors are ahead by phases of harmonic 1, rad.
    #[must_use]
    pub fn turned_ahead(&self, motions: &[f64], phases: &[f64]) -> Vec<f64> {
        turned_ahead(&self.engine.transform, motions, &self.set, phases)
    }

    /// Contact forces whose sectors are ahead by phases of harmonic 1, rad.
    #[must_use]
    pub fn forces_ahead(&self, forces: &ContactForces, phases: &[f64]) -> ContactForces {
        forces.turned_ahead(&self.engine.transform, phases)
    }

    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.engine.sectors()
    }

    /// Whether the contact is solved for; else the solution is a linear limit.
    #[must_use]
    pub fn is_nonlinear(&self) -> bool {
        self.contact.is_some()
    }

    /// Whether its contact has few unknowns; a linear limit has none.
    pub(crate) fn has_few_unknowns(&self) -> bool {
        let contact = self.contact.as_ref();
        contact.is_some_and(|contact| contact.motion().len() <= FEW_UNKNOWNS)
    }

    /// The harmonics, ascending.
    #[must_use]
    pub fn harmonics(&self) -> &[u32] {
        &self.set
    }
}

/// A wheel at the frequency prepared, whose ring creeps.
struct CreepingRing<'a, 'b, 'c> {
    solver: &'a mut WheelSolver<'b>,
    /// How the first solution is sought.
    way: Way<'c>,
    tolerance: f64,
    /// The motions last solved, from which the next ones are sought.
    motions: Option<Vec<f64>>,
    /// How the last solution ended, with the work of all.
    outcome: Option<Outcome>,
}

impl DriftingRing for CreepingRing<'_, '_, '_> {
    fn pairs(&self) -> &[PairParameters] {
        { self.solver.contact.as_ref() }.map_or(&[], WheelContact::pairs)
    }

    fn free_motions(&self) -> [bool; 2] {
        let contact = self.solver.contact.as_ref();
        contact.map_or([false; 2], WheelContact::free_ring_motions)
    }

    fn drift_m(&self) -> [f64; 2] {
        self.solver.ring_drift_m()
    }

    fn set_drift(&mut self, drift_m: [f64; 2]) {
        self.solver.set_ring_drift(drift_m);
    }

    fn mean_friction_n(&mut self) -> [f64; 2] {
        let motions = self.motions.as_deref().unwrap_or_default();
        let friction = self.solver.mean_friction_n(motions);
        friction.unwrap_or([f64::NAN; 2])
    }

    fn solve(&mut self) -> Status {
        let known = self.motions.take();
        let way = match (self.way, &known) {
            (Way::From(_), Some(known)) => Way::From(std::slice::from_ref(known)),
            (Way::Beside(_), Some(known)) => Way::Beside(known),
            (way, None) => way,
        };
        let found = self.solver.at_drift(way, self.tolerance);
        let found = found.map(|found| found.after(self.outcome));
        let status = match (self.way, found) {
            (_, None) => Status::SingularJacobian,
            // What is left of a solution beside another one is told by its step.
            (Way::Beside(_), Some(found)) if found.status == Status::IterationLimit => Status::Ok,
            (_, Some(found)) => found.status,
        };
        self.outcome = found;
        if status == Status::Ok {
            self.motions = Some(self.solver.motions());
        }
        status
    }
}

/// Angular frequency of a harmonic.
fn angular(harmonic: u32, frequency_hz: f64) -> f64 {
    f64::from(harmonic) * TAU * frequency_hz
}

/// A deviation as it enters the dynamic stiffness of a harmonic: with the structural loss factor, of which the static
/// harmonic 0 has none.
fn damped(deviation: f64, loss_factor: f64, harmonic: u32) -> Complex64 {
    let loss = if harmonic == 0 { 0.0 } else { loss_factor };
    Complex64::new(deviation, deviation * loss)
}
