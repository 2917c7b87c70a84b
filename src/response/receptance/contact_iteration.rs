//! The motions at the contact of a mistuned wheel at one frequency: a preconditioned, accelerated iteration.
//!
//! A step is `-P r` with the inverse P of `I + A G'` for the mean tangent G' of the contact; Anderson's acceleration makes up for
//! what the mean leaves out. What is approximate stands in P alone. Where no attempt of the [`LADDER`] by these steps ends with a
//! solution, the next ones are Newton's method, and with few harmonics the last ones are Newton's method with every pair preconditioned by
//! itself besides.

use crate::linalg::gmres;
use crate::response::harmonic_balance::{ContactShares, Status};

use super::contact_equation::PreconditionedShapes::{self, FirstOfFundamental, Resonant};
use super::contact_equation::{Buffers, ContactEquation};
use super::fields::{Field, flatten, norm_squared, unflatten};
use super::pair_preconditioner::PairPreconditioner;
use super::preconditioner::Preconditioner;

/// Earlier steps that are combined.
const DEPTH: usize = 80;
/// Damping of their shares, over the tolerance that is asked for.
const DAMPING: f64 = 0.5;

/// Newton steps of an attempt at most.
const NEWTON_STEPS: usize = 40;
/// Residual of each, relative to its right-hand side, and products with the derivative at most.
const STEP_ERROR: f64 = 1e-3;
const PRODUCTS: usize = 120;
/// Share of a step from which on it is not halved.
const LEAST_FACTOR: f64 = 1.0 / 64.0;

/// Most harmonics with which pairs are preconditioned by themselves: with more the steps take too long.
const MOST_HARMONICS: usize = 6;
/// Residual of a step with pairs preconditioned by themselves, relative to its right-hand side; products of it and of the attempt.
const PAIRED_STEP_ERROR: f64 = 1e-2;
const PAIRED_PRODUCTS: usize = 250;
const PAIRED_PRODUCTS_IN_ALL: u64 = 3_500;
/// Share of such a step below which it is not tried, and share of what it promises that it has to take off.
const LEAST_PAIRED_FACTOR: f64 = 1.0 / 256.0;
const DECREASE: f64 = 0.1;

/// When preconditioners are renewed, what they take in, and how many steps are taken at most.
struct Plan {
    renewals: &'static [usize],
    iterations: usize,
    shapes: PreconditionedShapes,
}

const fn plan(renewals: &'static [usize], iterations: usize, shapes: PreconditionedShapes) -> Plan {
    Plan {
        renewals,
        iterations,
        shapes,
    }
}

/// Where an attempt begins.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// Motions that are known beside the frequency or with other harmonics.
    Known,
    /// The linear response.
    Linear,
}

/// One way to a solution.
enum Attempt {
    Accelerated(Plan),
    Newton,
    PairedNewton,
}

/// What is tried, in this order, until an attempt ends with a solution. The tangent of a known start is near; that of the linear
/// response says little, and is renewed. Harmonics above 1 near resonances that deviations split take the resonant shapes. Where pairs open,
/// their harmonics depend on each other, and pairs are preconditioned by themselves.
const LADDER: [(Start, Attempt); 12] = [
    (
        Start::Known,
        Attempt::Accelerated(plan(&[0], 100, FirstOfFundamental)),
    ),
    (
        Start::Linear,
        Attempt::Accelerated(plan(&[0, 3], 80, FirstOfFundamental)),
    ),
    (
        Start::Linear,
        Attempt::Accelerated(plan(&[0, 10, 25], 160, FirstOfFundamental)),
    ),
    (
        Start::Known,
        Attempt::Accelerated(plan(&[0, 10, 25], 160, FirstOfFundamental)),
    ),
    (
        Start::Known,
        Attempt::Accelerated(plan(&[0, 3], 80, Resonant)),
    ),
    (
        Start::Known,
        Attempt::Accelerated(plan(&[0, 10, 25], 160, Resonant)),
    ),
    (
        Start::Linear,
        Attempt::Accelerated(plan(&[0, 3], 80, Resonant)),
    ),
    (
        Start::Linear,
        Attempt::Accelerated(plan(&[0, 10, 25], 160, Resonant)),
    ),
    (Start::Known, Attempt::Newton),
    (Start::Linear, Attempt::Newton),
    (Start::Known, Attempt::PairedNewton),
    (Start::Linear, Attempt::PairedNewton),
];

/// For the errors of a solution, from that solution.
const BESIDE: Plan = plan(&[0], 120, FirstOfFundamental);

/// What decides that an attempt is over.
struct Judge {
    tolerance: f64,
    /// The residual that the attempt began with.
    first: f64,
}

impl Judge {
    /// Growth of the residual over the first one, or over the motions, at which an attempt has diverged.
    const DIVERGED: f64 = 1e3;

    /// How an attempt is lost by its residual; none while it is not.
    fn lost(&self, residual: f64) -> Option<Status> {
        if !residual.is_finite() {
            Some(Status::NonFinite)
        } else if residual > Self::DIVERGED * self.first.max(1.0) {
            Some(Status::Diverged)
        } else {
            None
        }
    }

    /// Whether the residual and the step that it leads to are within the tolerance. Forces of a pair without a periodic state prove
    /// nothing.
    fn settled(&self, residual: f64, step: f64, shares: &ContactShares) -> Option<Status> {
        let is_closed = shares.unclosed == 0.0;
        let status = if is_closed {
            Status::Ok
        } else {
            Status::Stagnated
        };
        (residual.max(step) <= self.tolerance).then_some(status)
    }
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

impl ContactEquation<'_> {
    /// Solves from the best of `starts`, or from the linear response without any, until the residual is within `tolerance`.
    pub(super) fn solve(&mut self, starts: &[Vec<f64>], tolerance: f64) -> Outcome {
        let linear = self.linear_start();
        let known = self.best_of(starts);
        let begin = |start: &Start| match start {
            Start::Known => known.as_ref(),
            Start::Linear => Some(&linear),
        };
        let attempts = LADDER.iter();
        let few = self.harmonics.len() <= MOST_HARMONICS;
        let attempts = attempts.filter(|(_, own)| few || !matches!(own, Attempt::PairedNewton));
        let attempts = attempts.filter_map(|(start, attempt)| Some((begin(start)?, attempt)));
        let mut total = Outcome::none();
        for (rung, (start, attempt)) in attempts.enumerate() {
            self.buffers.motions.clone_from(start);
            let outcome = match attempt {
                Attempt::Accelerated(plan) => self.accelerate(plan, tolerance),
                Attempt::Newton => self.newton(tolerance),
                Attempt::PairedNewton => self.paired_newton(tolerance),
            };
            total = total.followed_by(outcome, rung);
            if total.status == Status::Ok {
                break;
            }
        }
        total
    }

    /// The one of several `starts` that leaves the smallest residual; none of none.
    fn best_of(&mut self, starts: &[Vec<f64>]) -> Option<Vec<Field>> {
        let mut least = f64::INFINITY;
        let mut best = 0;
        for (place, start) in starts.iter().enumerate().filter(|_| starts.len() > 1) {
            unflatten(start, &mut self.buffers.motions);
            let (norm, _) = self.residual(false);
            if norm < least {
                (least, best) = (norm, place);
            }
        }
        unflatten(starts.get(best)?, &mut self.buffers.motions);
        Some(self.buffers.motions.clone())
    }

    /// One attempt beside `start`, which may end before the residual is within `tolerance`.
    pub(super) fn settle(&mut self, start: &[f64], tolerance: f64) -> Outcome {
        unflatten(start, &mut self.buffers.motions);
        self.accelerate(&BESIDE, tolerance)
    }

    /// Steps until the judge ends them or as many are taken as planned.
    fn accelerate(&mut self, plan: &Plan, tolerance: f64) -> Outcome {
        let mut preconditioners: Vec<Preconditioner> = Vec::new();
        let mut outcome = Outcome::none();
        let mut judge = Judge {
            tolerance,
            first: f64::INFINITY,
        };
        for iteration in 0..plan.iterations {
            let renew = plan.renewals.contains(&iteration);
            (outcome.residual, outcome.shares) = self.residual_with_tangent(renew);
            if iteration == 0 {
                judge.first = outcome.residual;
            }
            if let Some(status) = judge.lost(outcome.residual) {
                outcome.status = status;
                break;
            }
            if renew {
                preconditioners = self.preconditioners(plan.shapes);
                outcome.tangents += 1;
                self.buffers.acceleration.begin(DAMPING * tolerance);
            }
            self.precondition(&mut preconditioners);
            outcome.step = self.buffers.step_over_motion();
            if let Some(status) = judge.settled(outcome.residual, outcome.step, &outcome.shares) {
                outcome.status = status;
                break;
            }
            outcome.iterations += 1;
            self.buffers.move_on();
        }
        outcome
    }

    /// Newton's method with steps by GMRES under the preconditioner, damped while the residual would grow; all harmonics of the tangent
    /// are coupled.
    fn newton(&mut self, tolerance: f64) -> Outcome {
        self.contact.couple(true);
        let mut outcome = Outcome::none();
        let judge = Judge {
            tolerance,
            first: f64::INFINITY,
        };
        for _ in 0..NEWTON_STEPS {
            (outcome.residual, outcome.shares) = self.residual(true);
            let settled = judge.settled(outcome.residual, 0.0, &outcome.shares);
            let settled = settled.filter(|status| *status == Status::Ok);
            if let Some(status) = settled.or(judge.lost(outcome.residual)) {
                outcome.status = status;
                break;
            }
            outcome.tangents += 1;
            let mut preconditioners = self.preconditioners(FirstOfFundamental);
            let mut right = Vec::new();
            flatten(&self.buffers.residual, -1.0, &mut right);
            self.precondition_flat(&mut preconditioners, &mut right);
            let (step, products) = gmres(&right, STEP_ERROR, PRODUCTS, |direction| {
                let mut turned = self.derivative(direction);
                self.precondition_flat(&mut preconditioners, &mut turned);
                turned
            });
            outcome.iterations += products as u64;
            if !self.moves_by(&step, outcome.residual) {
                outcome.status = Status::Stagnated;
                break;
            }
        }
        self.contact.couple(false);
        outcome
    }

    fn precondition_flat(&mut self, preconditioners: &mut [Preconditioner], flat: &mut Vec<f64>) {
        unflatten(flat, &mut self.buffers.residual);
        self.precondition(preconditioners);
        flatten(&self.buffers.residual, 1.0, flat);
    }

    /// Moves by the largest of the step, its half and so on that lowers the residual below `norm`; false if none does.
    fn moves_by(&mut self, step: &[f64], norm: f64) -> bool {
        let mut before = Vec::new();
        flatten(&self.buffers.motions, 1.0, &mut before);
        let mut factor = 1.0;
        loop {
            let moved = before.iter().zip(step).map(|(u, s)| u + factor * s);
            let moved: Vec<f64> = moved.collect();
            unflatten(&moved, &mut self.buffers.motions);
            let (own, _) = self.residual(false);
            if own < norm {
                return true;
            }
            if factor < LEAST_FACTOR {
                return false;
            }
            factor *= 0.5;
        }
    }

    /// Newton's method whose steps are preconditioned by every harmonic by itself and by every pair by itself, and shortened until the
    /// preconditioned residual becomes less: measured without the preconditioner the stiffest pairs alone would count.
    fn paired_newton(&mut self, tolerance: f64) -> Outcome {
        self.contact.couple(true);
        let mut outcome = Outcome::none();
        let judge = Judge {
            tolerance,
            first: f64::INFINITY,
        };
        for _ in 0..NEWTON_STEPS {
            (outcome.residual, outcome.shares) = self.residual(true);
            let settled = judge.settled(outcome.residual, 0.0, &outcome.shares);
            let settled = settled.filter(|status| *status == Status::Ok);
            if let Some(status) = settled.or(judge.lost(outcome.residual)) {
                outcome.status = status;
                break;
            }
            outcome.tangents += 1;
            let mut by = Paired {
                harmonics: self.preconditioners(FirstOfFundamental),
                pairs: PairPreconditioner::new(self.contact, self.harmonics),
            };
            let right = self.paired_residual(&mut by);
            let (step, products) = gmres(&right, PAIRED_STEP_ERROR, PAIRED_PRODUCTS, |direction| {
                let mut turned = self.derivative(direction);
                self.precondition_paired(&mut by, &mut turned);
                turned
            });
            outcome.iterations += products as u64;
            if outcome.iterations > PAIRED_PRODUCTS_IN_ALL {
                break;
            }
            if !self.moves_by_paired(&step, &mut by, norm(&right)) {
                outcome.status = Status::Stagnated;
                break;
            }
        }
        self.contact.couple(false);
        outcome
    }

    /// What both preconditioners make of motions, in place: every harmonic by itself, then every pair by itself what that leaves.
    fn precondition_paired(&mut self, by: &mut Paired, flat: &mut Vec<f64>) {
        let mut left = flat.clone();
        self.precondition_flat(&mut by.harmonics, flat);
        let taken = self.derivative(flat);
        left.iter_mut().zip(taken).for_each(|(l, t)| *l -= t);
        self.precondition_pairs(&mut by.pairs, &mut left);
        flat.iter_mut().zip(left).for_each(|(x, l)| *x += l);
    }

    /// The step that the residual last evaluated asks for, by the preconditioners alone.
    fn paired_residual(&mut self, by: &mut Paired) -> Vec<f64> {
        let mut right = Vec::new();
        flatten(&self.buffers.residual, -1.0, &mut right);
        self.precondition_paired(by, &mut right);
        right
    }

    /// Moves by the largest of the step, its half and so on after which the preconditioned residual is below `before`; false if none
    /// is.
    fn moves_by_paired(&mut self, step: &[f64], by: &mut Paired, before: f64) -> bool {
        let mut from = Vec::new();
        flatten(&self.buffers.motions, 1.0, &mut from);
        let mut factor = 1.0;
        while factor >= LEAST_PAIRED_FACTOR {
            let moved = from.iter().zip(step).map(|(u, s)| u + factor * s);
            let moved: Vec<f64> = moved.collect();
            unflatten(&moved, &mut self.buffers.motions);
            self.residual(false);
            let left = self.paired_residual(by);
            if norm(&left) < (1.0 - DECREASE * factor) * before {
                return true;
            }
            factor *= 0.5;
        }
        false
    }
}

/// Preconditioners of a Newton step with pairs by themselves.
struct Paired {
    harmonics: Vec<Preconditioner>,
    pairs: PairPreconditioner,
}

fn norm(vector: &[f64]) -> f64 {
    crate::linalg::dot(vector, vector).sqrt()
}

impl Buffers {
    /// Norm of the preconditioned residual over that of the motions.
    fn step_over_motion(&self) -> f64 {
        let step: f64 = self.residual.iter().map(norm_squared).sum();
        let motion: f64 = self.motions.iter().map(norm_squared).sum();
        (step / motion).sqrt()
    }

    /// The next motions by the preconditioned residual and the steps before.
    fn move_on(&mut self) {
        let [x, step, next] = &mut self.flat;
        flatten(&self.motions, 1.0, x);
        flatten(&self.residual, -1.0, step);
        next.resize(x.len(), 0.0);
        self.acceleration.next(x, step, DEPTH, next);
        unflatten(next, &mut self.motions);
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
