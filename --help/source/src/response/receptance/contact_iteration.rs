//! The motions at the contact of a mistuned wheel at one frequency: a preconditioned, accelerated iteration.
//!
//! In every harmonic k of the set
//!
//! ```text
//! r_k(u) = u_k - u_lin,k + A_k G_k(u)
//! ```
//!
//! with the answer A of the wheel to contact forces ([`super::wheel_harmonic`]) and the correction G of the contact forces to
//! those of stuck springs, all harmonics together. A step is `-P r` with the inverse P of `I + A G'` for the mean tangent G'
//! of the contact; Anderson's acceleration makes up for what the mean leaves out. What is approximate stands in P alone.

use std::f64::consts::TAU;

use crate::linalg::{Complex64, gmres};
use crate::response::harmonic_balance::{ContactShares, Status, WheelContact};

use super::acceleration::Acceleration;
use super::contact_forces::ContactForces;
use super::contact_places::Places;
use super::fields::{Field, SectorTransform, flatten, norm_squared, padded, unflatten};
use super::preconditioner::Preconditioner;
use super::wheel_harmonic::WheelHarmonic;

/// Earlier steps that are combined.
const DEPTH: usize = 80;
/// Damping of their shares, over the tolerance that is asked for.
const DAMPING: f64 = 0.5;

/// Growth of the residual over the first one, or over the motions, at which an attempt has diverged.
const DIVERGED: f64 = 1e3;

/// When tangents are renewed, and how many steps are taken at most.
struct Plan {
    renewals: &'static [usize],
    iterations: usize,
    shapes: PreconditionedShapes,
}

/// Blade shapes that a preconditioner takes in.
#[derive(Clone, Copy)]
enum PreconditionedShapes {
    /// The shapes of every harmonic that are not nearly static.
    Resonant,
    /// The first shape, of harmonic 1.
    FirstOfFundamental,
}

/// From motions that are known beside the frequency or with other harmonics.
const WARM: Plan = Plan {
    renewals: &[0],
    iterations: 100,
    shapes: PreconditionedShapes::FirstOfFundamental,
};
/// From the linear response, whose tangent says little.
const COLD: Plan = Plan {
    renewals: &[0, 3],
    iterations: 80,
    shapes: PreconditionedShapes::FirstOfFundamental,
};
/// Where both fail.
const SLOW: Plan = Plan {
    renewals: &[0, 10, 25],
    iterations: 160,
    shapes: PreconditionedShapes::FirstOfFundamental,
};

/// Where all of these fail: harmonics above 1 near resonances that deviations split.
const RESONANT: [Plan; 2] = [
    Plan {
        renewals: &[0, 3],
        iterations: 80,
        shapes: PreconditionedShapes::Resonant,
    },
    Plan {
        renewals: &[0, 10, 25],
        iterations: 160,
        shapes: PreconditionedShapes::Resonant,
    },
];

/// For the errors of a solution, from that solution.
const BESIDE: Plan = Plan {
    renewals: &[0],
    iterations: 120,
    shapes: PreconditionedShapes::FirstOfFundamental,
};

/// Newton steps of the last attempt at most.
const NEWTON_STEPS: usize = 40;
/// Residual of each, relative to its right-hand side.
const STEP_ERROR: f64 = 1e-3;

/// The equation of one wheel at one frequency.
pub(super) struct ContactEquation<'a> {
    pub(super) transform: &'a SectorTransform,
    pub(super) contact: &'a mut WheelContact,
    /// The contact with fewer samples, from which tangents are taken; none: they are taken from `contact`.
    pub(super) tangents: Option<&'a mut WheelContact>,
    /// A harmonic of the set each, in its order.
    pub(super) harmonics: &'a mut [WheelHarmonic],
    /// `u_lin` of harmonic 1, at this place of the set.
    pub(super) linear: &'a Field,
    /// Forces on the contact besides its own, a field per harmonic.
    pub(super) load: Option<&'a ContactForces>,
    pub(super) fundamental: usize,
    pub(super) buffers: &'a mut Buffers,
}

/// Vectors of the iteration.
#[derive(Default)]
pub(super) struct Buffers {
    pub(super) motions: Vec<Field>,
    residual: Vec<Field>,
    /// Correction of the contact forces at the motions last evaluated, waves.
    pub(super) forces: Vec<Field>,
    sectors: Field,
    acceleration: Acceleration,
    flat: [Vec<f64>; 3],
}

/// How an iteration ended; the motions are left in the buffers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outcome {
    pub(super) status: Status,
    pub(super) iterations: u64,
    /// Tangents taken.
    pub(super) tangents: u64,
    /// Attempts after the first.
    pub(super) retries: u64,
    /// Norm of the residual over that of the motions.
    pub(super) residual: f64,
    /// Norm of the step that was left over that of the motions.
    pub(super) step: f64,
    pub(super) shares: ContactShares,
}

impl Buffers {
    /// Makes room for so many harmonics and contact rows of a sector.
    pub(super) fn resize(&mut self, harmonics: usize, rows: usize, sectors: usize) {
        let entries = rows * padded(sectors);
        let fits = |fields: &Vec<Field>| {
            fields.len() == harmonics && fields.iter().all(|own| own.re.len() == entries)
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
    /// Takes the one of several `starts` for the motions that leaves the smallest residual.
    fn begin(&mut self, starts: &[Vec<f64>]) {
        let mut least = f64::INFINITY;
        let mut best = 0;
        for (place, start) in starts.iter().enumerate().filter(|_| starts.len() > 1) {
            unflatten(start, &mut self.buffers.motions);
            let (norm, _) = self.residual(false);
            if norm < least {
                (least, best) = (norm, place);
            }
        }
        unflatten(&starts[best], &mut self.buffers.motions);
    }

    /// Solves from the best of `starts`, or from the linear response without any, until the residual is within `tolerance`.
    pub(super) fn solve(&mut self, starts: &[Vec<f64>], tolerance: f64) -> Outcome {
        let cold = self.linear_start();
        if starts.is_empty() {
            self.buffers.motions.clone_from(&cold);
        } else {
            self.begin(starts);
        }
        let start = self.buffers.motions.clone();
        let mut total = Outcome::none();
        let is_warm = !starts.is_empty();
        let warm = is_warm.then_some((&WARM, &start));
        let plans = [(&COLD, &cold), (&SLOW, &cold)];
        let again = is_warm.then_some((&SLOW, &start));
        let plans = warm.into_iter().chain(plans).chain(again);
        let begins = is_warm.then_some(&start).into_iter().chain([&cold]);
        let resonant = begins.flat_map(|begin| RESONANT.iter().map(move |plan| (plan, begin)));
        let plans = plans.chain(resonant);
        for (rung, (plan, begin)) in plans.enumerate() {
            if rung > 0 {
                self.buffers.motions.clone_from(begin);
            }
            let outcome = self.accelerate(plan, tolerance);
            total = total.followed_by(outcome, rung);
            if total.status == Status::Ok {
                return total;
            }
        }
        self.contact.couple(true);
        let begins = [Some(&start), is_warm.then_some(&cold)];
        for begin in begins.into_iter().flatten() {
            self.buffers.motions.clone_from(begin);
            let outcome = self.newton(tolerance);
            total = total.followed_by(outcome, 1);
            if total.status == Status::Ok {
                break;
            }
        }
        self.contact.couple(false);
        total
    }

    /// One attempt beside `start`, which may end before the residual is within `tolerance`.
    pub(super) fn settle(&mut self, start: &[f64], tolerance: f64) -> Outcome {
        unflatten(start, &mut self.buffers.motions);
        self.accelerate(&BESIDE, tolerance)
    }

    /// The motions of the linear response.
    fn linear_start(&self) -> Vec<Field> {
        let mut start = vec![Field::default(); self.harmonics.len()];
        for (place, own) in start.iter_mut().enumerate() {
            own.clone_from(self.linear);
            if place != self.fundamental {
                own.fill(0.0);
            }
        }
        start
    }

    fn accelerate(&mut self, plan: &Plan, tolerance: f64) -> Outcome {
        let mut preconditioners: Vec<Preconditioner> = Vec::new();
        let mut outcome = Outcome::none();
        self.buffers.acceleration.begin(DAMPING * tolerance);
        let mut first = f64::INFINITY;
        for iteration in 0..plan.iterations {
            let renew = plan.renewals.contains(&iteration);
            let apart = renew && self.tangents.is_some();
            (outcome.residual, outcome.shares) = self.residual(renew && !apart);
            if let Some(tangents) = self.tangents.as_mut().filter(|_| apart) {
                tangents.motion_mut().copy_from_slice(self.contact.motion());
                tangents.evaluate(true);
            }
            if iteration == 0 {
                first = outcome.residual;
            }
            if !outcome.residual.is_finite() {
                outcome.status = Status::NonFinite;
                break;
            }
            if outcome.residual > DIVERGED * first.max(1.0) {
                outcome.status = Status::Diverged;
                break;
            }
            if renew {
                preconditioners = self.preconditioners(plan.shapes);
                outcome.tangents += 1;
                self.buffers.acceleration.begin(DAMPING * tolerance);
            }
            for (own, residual) in preconditioners.iter_mut().zip(&mut self.buffers.residual) {
                own.apply(self.transform, residual);
            }
            let step: f64 = self.buffers.residual.iter().map(norm_squared).sum();
            let motion: f64 = self.buffers.motions.iter().map(norm_squared).sum();
            outcome.step = (step / motion).sqrt();
            if outcome.residual.max(outcome.step) <= tolerance {
                // Forces of a pair without a periodic state prove nothing.
                let closed = outcome.shares.unclosed == 0.0;
                outcome.status = if closed {
                    Status::Ok
                } else {
                    Status::Stagnated
                };
                break;
            }
            outcome.iterations += 1;
            let Buffers {
                motions,
                residual,
                acceleration,
                flat: [x, step, next],
                ..
            } = &mut *self.buffers;
            flatten(motions, 1.0, x);
            flatten(residual, -1.0, step);
            next.resize(x.len(), 0.0);
            acceleration.next(x, step, DEPTH, next);
            unflatten(next, motions);
        }
        outcome
    }

    fn preconditioners(&self, shapes: PreconditionedShapes) -> Vec<Preconditioner> {
        let pairs = self.contact.pair_rows();
        let harmonics = self.harmonics.iter().enumerate();
        let contact: &WheelContact = self.tangents.as_deref().unwrap_or(self.contact);
        harmonics
            .map(|(place, harmonic)| {
                let tangent = contact.mean_tangent(place);
                let shapes = match shapes {
                    PreconditionedShapes::Resonant => harmonic.resonant_shapes(),
                    PreconditionedShapes::FirstOfFundamental => {
                        harmonic.first_shapes(usize::from(place == self.fundamental))
                    }
                };
                Preconditioner::new(harmonic, self.transform, &tangent, pairs, &shapes)
            })
            .collect()
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

    /// Residual at the motions, relative to them, with the derivative of the contact where that is wanted.
    fn residual(&mut self, derivative: bool) -> (f64, ContactShares) {
        let places = Places::of(self.contact);
        self.give_motions();
        let shares = self.contact.evaluate(derivative);
        let mut square = 0.0;
        let motion: f64 = self.buffers.motions.iter().map(norm_squared).sum();
        for place in 0..places.harmonics.len() {
            self.correct_forces(&places, place);
            let Buffers {
                motions,
                residual,
                forces,
                ..
            } = &mut *self.buffers;
            if let Some(load) = self.load {
                forces[place].add(1.0, &load.fields[place]);
            }
            residual[place].clone_from(&motions[place]);
            if place == self.fundamental {
                residual[place].add(-1.0, self.linear);
            }
            self.harmonics[place].add_answer(self.transform, &forces[place], &mut residual[place]);
            square += norm_squared(&residual[place]);
        }
        ((square / motion).sqrt(), shares)
    }

    /// Newton's method with steps by GMRES under the preconditioner, damped while the residual would grow.
    fn newton(&mut self, tolerance: f64) -> Outcome {
        let mut outcome = Outcome::none();
        for _ in 0..NEWTON_STEPS {
            (outcome.residual, outcome.shares) = self.residual(true);
            if outcome.residual <= tolerance && outcome.shares.unclosed == 0.0 {
                outcome.status = Status::Ok;
                return outcome;
            }
            if !outcome.residual.is_finite() {
                outcome.status = Status::NonFinite;
                return outcome;
            }
            outcome.tangents += 1;
            let mut preconditioners =
                self.preconditioners(PreconditionedShapes::FirstOfFundamental);
            let mut precondition = |equation: &mut Self, flat: &mut Vec<f64>| {
                unflatten(flat, &mut equation.buffers.residual);
                let residual = equation.buffers.residual.iter_mut();
                for (own, residual) in preconditioners.iter_mut().zip(residual) {
                    own.apply(equation.transform, residual);
                }
                flatten(&equation.buffers.residual, 1.0, flat);
            };
            let mut right = Vec::new();
            flatten(&self.buffers.residual, -1.0, &mut right);
            precondition(self, &mut right);
            let (step, products) = gmres(&right, STEP_ERROR, |direction| {
                let mut turned = self.derivative(direction);
                precondition(self, &mut turned);
                turned
            });
            outcome.iterations += products as u64;
            let before = self.buffers.motions.clone();
            let mut factor = 1.0;
            let accepted = loop {
                let mut moved = Vec::new();
                flatten(&before, 1.0, &mut moved);
                moved
                    .iter_mut()
                    .zip(&step)
                    .for_each(|(u, s)| *u += factor * s);
                unflatten(&moved, &mut self.buffers.motions);
                let (norm, _) = self.residual(false);
                if norm < outcome.residual {
                    break true;
                }
                if factor < 1.0 / 64.0 {
                    break false;
                }
                factor *= 0.5;
            };
            if !accepted {
                outcome.status = Status::Stagnated;
                return outcome;
            }
        }
        outcome
    }

    /// `J v` at the motions last evaluated with derivative: `v + A G' v`.
    fn derivative(&mut self, direction: &[f64]) -> Vec<f64> {
        let places = Places::of(self.contact);
        let mut fields = self.buffers.motions.clone();
        unflatten(direction, &mut fields);
        let mut change = vec![0.0; self.contact.motion().len()];
        let sectors = &mut self.buffers.sectors;
        places.to_sectors(self.transform, &fields, sectors, &mut change);
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

impl Outcome {
    /// Of an attempt that has taken no step.
    fn none() -> Self {
        Self {
            status: Status::IterationLimit,
            iterations: 0,
            tangents: 0,
            retries: 0,
            residual: f64::INFINITY,
            step: f64::INFINITY,
            shares: ContactShares::default(),
        }
    }

    /// The work of both, and how the second ended.
    fn followed_by(self, next: Self, rung: usize) -> Self {
        Self {
            iterations: self.iterations + next.iterations,
            tangents: self.tangents + next.tangents,
            retries: self.retries + u64::from(rung > 0),
            ..next
        }
    }
}

/// Angular frequency of a harmonic.
pub(super) fn angular(harmonic: u32, frequency_hz: f64) -> f64 {
    f64::from(harmonic) * TAU * frequency_hz
}

/// A deviation as it enters the dynamic stiffness of a harmonic: with the structural loss factor, of which the static
/// harmonic 0 has none.
pub(super) fn damped(deviation: f64, loss_factor: f64, harmonic: u32) -> Complex64 {
    let loss = if harmonic == 0 { 0.0 } else { loss_factor };
    Complex64::new(deviation, deviation * loss)
}
