//! The motions at the contact of a mistuned wheel at one frequency: a preconditioned, accelerated iteration.
//!
//! A step is `-P r` with the inverse P of `I + A G'` for the mean tangent G' of the contact; Anderson's acceleration makes up for
//! what the mean leaves out. What is approximate stands in P alone. Attempts by Newton's method can precede and follow, in the order of
//! `attempts_on_receptances.rs`. Each ends by the residual and the next step: where contact is stiff, a small residual alone says little.

use crate::linalg::gmres;
use crate::response::harmonic_balance::{ContactShares, Status};

use super::attempts_on_receptances::Attempt::{Accelerated, Damped, Newton};
use super::attempts_on_receptances::Start::{Best, Known, Linear};
use super::attempts_on_receptances::{
    BESIDE, Circumstances, DAMPING, Effort, NEAR, NEWTON_STEPS, NewtonPlan, Plan, attempts,
};
use super::contact_equation::Preconditioned::{FirstOfFundamental, HighCoupled, Whole};
use super::contact_equation::{Buffers, ContactEquation, StepPreconditioner};
use super::fields::{Field, flatten, unflatten};
use super::pair_preconditioner::PairPreconditioner;
use super::preconditioner::Preconditioner;
use super::wave_preconditioner::WavePreconditioner;

/// Steps by the whole derivative at most, and the share of one below which it is not tried.
const DAMPED_STEPS: usize = 100;
const LEAST_FACTOR: f64 = 1.0 / 256.0;

/// What decides that an attempt is over.
struct Judge {
    tolerance: f64,
    /// The residual that the attempt began with; none before its first step.
    first: Option<f64>,
    /// The smallest residual of so many steps, and one more.
    least: Vec<f64>,
}

impl Judge {
    /// Growth of the residual over the first one, or over the motions, at which an attempt has diverged.
    const DIVERGED: f64 = 1e3;
    /// Steps that every attempt has, over how many later ones the smallest residual has to fall, and to what share of it.
    const PATIENCE: usize = 40;
    const WINDOW: usize = 25;
    const FALLS: f64 = 0.9;

    fn of(tolerance: f64) -> Self {
        Self {
            tolerance,
            first: None,
            least: Vec::new(),
        }
    }

    /// Whether the residual, which is that of the next step, hardly falls any more: what follows takes as many steps again for little.
    fn stalls(&mut self, residual: f64) -> bool {
        let least = self.least.last().map_or(residual, |l| l.min(residual));
        self.least.push(least);
        let steps = self.least.len() - 1;
        steps >= Self::PATIENCE && least > Self::FALLS * self.least[steps - Self::WINDOW]
    }

    /// How an attempt is lost by its residual; none while it is not.
    fn lost(&mut self, residual: f64) -> Option<Status> {
        let first = *self.first.get_or_insert(residual);
        if !residual.is_finite() {
            Some(Status::NonFinite)
        } else if residual > Self::DIVERGED * first.max(1.0) {
            Some(Status::Diverged)
        } else {
            None
        }
    }

    /// Whether the residual and the step that it leads to are within the tolerance. Forces of a pair without a periodic state prove nothing.
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
    /// Steps of the iteration; in Newton's method products with the derivative.
    pub(super) iterations: u64,
    /// Tangents taken.
    pub(super) tangents: u64,
    /// Attempts after the first.
    pub(super) retries: u64,
    /// Norm of the residual over that of the motions, of which harmonic k counts by `1/k`.
    pub(super) residual: f64,
    /// Norm of the step that was left over that of the motions, in the same way.
    pub(super) step: f64,
    pub(super) shares: ContactShares,
}

impl ContactEquation<'_> {
    /// Solves from the best of `starts`, or from the linear response without any, until the residual is within `tolerance`.
    pub(super) fn solve(&mut self, starts: &[Vec<f64>], tolerance: f64, effort: Effort) -> Outcome {
        let linear = self.linear_start();
        let known = self.best_of(starts);
        let attempts = attempts(Circumstances {
            harmonics: self.harmonics.len(),
            unknowns: self.contact.motion().len(),
            takes_whole: effort.takes_whole,
            couples_high: WavePreconditioner::fits(self.contact),
            has_known: known.is_some(),
        });
        let attempts = attempts.take(effort.most_attempts);
        let mut best = (f64::INFINITY, linear.clone());
        let mut total = Outcome::none();
        for (rung, (start, attempt)) in attempts.enumerate() {
            let start = match start {
                Known => known.as_ref().unwrap_or(&linear),
                Linear => &linear,
                Best => &best.1,
            };
            self.buffers.motions.clone_from(start);
            let outcome = match attempt {
                Accelerated(plan) => self.accelerate(plan, tolerance),
                Newton(plan) => self.newton(plan, tolerance),
                Damped => self.damped_newton(tolerance),
            };
            total = total.followed_by(outcome, rung);
            if total.status == Status::Ok || total.iterations >= effort.most_steps {
                break;
            }
            if outcome.residual < best.0 {
                best = (outcome.residual, self.buffers.motions.clone());
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
        let mut preconditioner = StepPreconditioner::Harmonics(Vec::new());
        let mut outcome = Outcome::none();
        // What couples harmonics is taken from the contact itself. The mean tangents beside it stay those of the attempt before.
        let couples = matches!(plan.takes_in, HighCoupled | Whole);
        self.contact.couple(couples);
        let mut judge = Judge::of(tolerance);
        for iteration in 0..plan.iterations {
            let renew = plan.renewals.contains(&iteration);
            (outcome.residual, outcome.shares) = if couples {
                self.residual(renew)
            } else {
                self.residual_with_tangent(renew)
            };
            if let Some(status) = judge.lost(outcome.residual) {
                outcome.status = status;
                break;
            }
            if plan.gives_up && judge.stalls(outcome.residual) {
                break;
            }
            if renew {
                preconditioner = self.preconditioner(plan.takes_in);
                outcome.tangents += 1;
                self.buffers.acceleration.begin(DAMPING * tolerance);
            }
            self.precondition_by(&mut preconditioner);
            outcome.step = self.step_over_motion();
            if let Some(status) = judge.settled(outcome.residual, outcome.step, &outcome.shares) {
                outcome.status = status;
                break;
            }
            outcome.iterations += 1;
            self.buffers.move_on(plan.depth);
        }
        self.contact.couple(false);
        outcome
    }

    /// Newton's method with steps by GMRES under preconditioners, shortened while more would be left; all harmonics of the tangent are
    /// coupled.
    fn newton(&mut self, plan: &NewtonPlan, tolerance: f64) -> Outcome {
        self.contact.couple(true);
        let mut outcome = Outcome::none();
        let mut judge = Judge::of(tolerance);
        for _ in 0..NEWTON_STEPS {
            (outcome.residual, outcome.shares) = self.residual(true);
            outcome.tangents += 1;
            let pairs = plan.pairs;
            let mut by = NewtonPreconditioner {
                harmonics: self.preconditioners(FirstOfFundamental),
                pairs: pairs.then(|| PairPreconditioner::new(self.contact, self.harmonics)),
            };
            let right = self.preconditioned_residual(&mut by);
            unflatten(&right, &mut self.buffers.residual);
            outcome.step = self.step_over_motion();
            let settled = judge.settled(outcome.residual, outcome.step, &outcome.shares);
            let settled = settled.filter(|status| *status == Status::Ok);
            if let Some(status) = settled.or_else(|| judge.lost(outcome.residual)) {
                outcome.status = status;
                // The forces of the motions, where the preconditioner of pairs has left products with the derivative.
                self.residual(false);
                break;
            }
            let solved = gmres(&right, plan.step_error, plan.products, |direction| {
                let mut turned = self.derivative(direction);
                self.precondition_flat(&mut by, &mut turned);
                turned
            });
            outcome.iterations += solved.products as u64;
            let is_poor = solved.residual > plan.most_step_error;
            if outcome.iterations > plan.products_in_all
                || is_poor && outcome.residual > NEAR * tolerance
            {
                break;
            }
            let before = if pairs {
                norm(&right)
            } else {
                outcome.residual
            };
            if !self.moves_by(&solved.x, plan, &mut by, before) {
                outcome.status = Status::Stagnated;
                break;
            }
        }
        self.contact.couple(false);
        outcome
    }

    /// Newton's method by the whole derivative, factorised at every step. A step is shortened until the next one with the same factors
    /// would be shorter: the natural monotonicity test (Deuflhard 2004, section 3.3), which does not depend on how stiff a pair is.
    fn damped_newton(&mut self, tolerance: f64) -> Outcome {
        self.contact.couple(true);
        let mut outcome = Outcome::none();
        let mut judge = Judge::of(tolerance);
        for _ in 0..DAMPED_STEPS {
            (outcome.residual, outcome.shares) = self.residual(true);
            let mut by = self.preconditioner(Whole);
            outcome.tangents += 1;
            outcome.iterations += 1;
            self.precondition_by(&mut by);
            outcome.step = self.step_over_motion();
            let settled = judge.settled(outcome.residual, outcome.step, &outcome.shares);
            if let Some(status) = settled.or_else(|| judge.lost(outcome.residual)) {
                outcome.status = status;
                break;
            }
            if !self.shortens_next(&mut by) {
                outcome.status = Status::Stagnated;
                break;
            }
        }
        self.contact.couple(false);
        outcome
    }

    /// Moves by the largest of the step in the place of the residual, its half and so on after which the next step `by` the same
    /// derivative is shorter; false, and nothing moved, if there is none.
    fn shortens_next(&mut self, by: &mut StepPreconditioner) -> bool {
        let (mut from, mut step) = (Vec::new(), Vec::new());
        flatten(&self.buffers.motions, 1.0, &mut from);
        flatten(&self.buffers.residual, -1.0, &mut step);
        let before = self.step_size();
        let mut factor = 1.0;
        while factor >= LEAST_FACTOR {
            let moved = from.iter().zip(&step).map(|(u, s)| u + factor * s);
            let moved: Vec<f64> = moved.collect();
            unflatten(&moved, &mut self.buffers.motions);
            self.residual(false);
            self.precondition_by(by);
            if self.step_size() <= (1.0 - 0.25 * factor) * before {
                return true;
            }
            factor *= 0.5;
        }
        unflatten(&from, &mut self.buffers.motions);
        false
    }

    /// Preconditions motions in place: every harmonic by itself, then every pair by itself what that leaves.
    fn precondition_flat(&mut self, by: &mut NewtonPreconditioner, flat: &mut Vec<f64>) {
        let mut left = by.pairs.is_some().then(|| flat.clone());
        unflatten(flat, &mut self.buffers.residual);
        self.precondition(&mut by.harmonics);
        flatten(&self.buffers.residual, 1.0, flat);
        if let (Some(pairs), Some(left)) = (&mut by.pairs, &mut left) {
            let taken = self.derivative(flat);
            left.iter_mut().zip(taken).for_each(|(l, t)| *l -= t);
            self.precondition_pairs(pairs, left);
            flat.iter_mut().zip(left).for_each(|(x, l)| *x += *l);
        }
    }

    /// The step that the residual last evaluated asks for, by the preconditioners alone.
    fn preconditioned_residual(&mut self, by: &mut NewtonPreconditioner) -> Vec<f64> {
        let mut right = Vec::new();
        flatten(&self.buffers.residual, -1.0, &mut right);
        self.precondition_flat(by, &mut right);
        right
    }

    /// Moves by the largest of the step, its half and so on after which less than `before` is left; false, and nothing moved, if there
    /// is none.
    fn moves_by(
        &mut self,
        step: &[f64],
        plan: &NewtonPlan,
        by: &mut NewtonPreconditioner,
        before: f64,
    ) -> bool {
        let mut from = Vec::new();
        flatten(&self.buffers.motions, 1.0, &mut from);
        let mut factor = 1.0;
        while factor >= plan.least_factor {
            let moved = from.iter().zip(step).map(|(u, s)| u + factor * s);
            let moved: Vec<f64> = moved.collect();
            unflatten(&moved, &mut self.buffers.motions);
            let (residual, _) = self.residual(false);
            let left = if plan.pairs {
                norm(&self.preconditioned_residual(by))
            } else {
                residual
            };
            if left < (1.0 - plan.decrease * factor) * before {
                return true;
            }
            factor *= 0.5;
        }
        unflatten(&from, &mut self.buffers.motions);
        false
    }
}

/// Preconditioners of a Newton step.
struct NewtonPreconditioner {
    harmonics: Vec<Preconditioner>,
    /// Of every pair by itself, where the plan has it.
    pairs: Option<PairPreconditioner>,
}

fn norm(vector: &[f64]) -> f64 {
    crate::linalg::dot(vector, vector).sqrt()
}

impl Buffers {
    /// The next motions by the preconditioned residual and the steps before.
    fn move_on(&mut self, depth: usize) {
        let [x, step, next] = &mut self.flat;
        flatten(&self.motions, 1.0, x);
        flatten(&self.residual, -1.0, step);
        next.resize(x.len(), 0.0);
        self.acceleration.next(x, step, depth, next);
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

    /// This outcome with the work of an earlier one.
    pub(super) fn after(self, before: Option<Self>) -> Self {
        let Some(before) = before else { return self };
        Self {
            iterations: before.iterations + self.iterations,
            tangents: before.tangents + self.tangents,
            retries: before.retries + self.retries,
            ..self
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

#[cfg(test)]
mod tests {
    use super::{ContactShares, Judge, Status};

    #[test]
    fn the_judge_ends_what_grows_and_what_stalls() {
        let mut judge = Judge::of(1e-6);
        assert_eq!(judge.lost(5.0), None);
        assert_eq!(judge.lost(4.9e3), None);
        assert_eq!(judge.lost(5.1e3), Some(Status::Diverged));
        assert_eq!(judge.lost(f64::NAN), Some(Status::NonFinite));
        // A residual below 1 may grow to as much as one of 1.
        assert_eq!(Judge::of(1e-6).lost(1e-3), None);
        let mut flat = Judge::of(1e-6);
        let first = (0..100).position(|_| flat.stalls(0.5));
        assert_eq!(first, Some(Judge::PATIENCE));
        let mut falling = Judge::of(1e-6);
        assert!(!(0..100).any(|step| falling.stalls(0.99_f64.powi(step))));
    }

    #[test]
    fn a_solution_has_a_small_residual_a_small_step_and_closed_pairs() {
        let judge = Judge::of(1e-6);
        let closed = ContactShares::default();
        let unclosed = ContactShares {
            unclosed: 0.1,
            ..closed
        };
        assert_eq!(judge.settled(1e-6, 1e-7, &closed), Some(Status::Ok));
        assert_eq!(judge.settled(1e-6, 1e-5, &closed), None);
        assert_eq!(judge.settled(1e-5, 0.0, &closed), None);
        assert_eq!(judge.settled(1e-7, 0.0, &unclosed), Some(Status::Stagnated));
    }
}
