//! The motions at the contact of a mistuned wheel at one frequency: a preconditioned, accelerated iteration.
//!
//! A step is `-P r` with the inverse P of `I + A G'` for the mean tangent G' of the contact; Anderson's acceleration makes up for
//! what the mean leaves out. What is approximate stands in P alone. Where the first attempts by these steps end without
//! a solution, Newton's method goes on from the best of them; the last ones are Newton's method too, and with few harmonics every pair is
//! preconditioned by itself besides.

use crate::linalg::gmres;
use crate::response::harmonic_balance::{ContactShares, Status};

use super::contact_equation::PreconditionedShapes::{self, FirstOfFundamental, Resonant};
use super::contact_equation::{Buffers, ContactEquation};
use super::fields::{Field, flatten, norm_squared, unflatten};
use super::pair_preconditioner::PairPreconditioner;
use super::preconditioner::Preconditioner;

use Attempt::{Accelerated, Newton};
use Start::{Best, Known, Linear};

/// Damping of the shares of earlier steps, over the tolerance that is asked for.
const DAMPING: f64 = 0.5;

/// Newton steps of an attempt at most.
const NEWTON_STEPS: usize = 40;
/// Most harmonics that are few: with more a step takes so long that attempts are ended early, and that no pair is preconditioned by itself.
const FEW_HARMONICS: usize = 6;

/// When preconditioners are renewed, what they take in, and how many steps are taken at most.
#[derive(Clone, Copy)]
struct Plan {
    renewals: &'static [usize],
    iterations: usize,
    shapes: PreconditionedShapes,
    /// Earlier steps that are combined.
    depth: usize,
    /// Whether an attempt that stalls is over before that: Newton's method goes on from there.
    gives_up: bool,
}

const fn plan(renewals: &'static [usize], iterations: usize, shapes: PreconditionedShapes) -> Plan {
    Plan {
        renewals,
        iterations,
        shapes,
        depth: 80,
        gives_up: false,
    }
}

/// With many harmonics the steps that follow a new beginning cost more than a long history: all steps are combined.
const fn combining_all(plan: Plan) -> Plan {
    Plan { depth: 160, ..plan }
}

const fn brief(plan: Plan) -> Attempt {
    Accelerated(Plan {
        gives_up: true,
        ..combining_all(plan)
    })
}

/// How Newton steps are preconditioned, how closely they are solved, and how they are shortened.
struct NewtonPlan {
    /// Whether every pair is preconditioned by itself besides. What is left is then measured after the preconditioners: without them
    /// the stiffest pairs alone would count.
    pairs: bool,
    /// Residual of a step, relative to its right-hand side.
    step_error: f64,
    /// Products with the derivative of a step, and of an attempt, at most.
    products: usize,
    products_in_all: u64,
    /// Share of a step below which it is not tried.
    least_factor: f64,
    /// Share of what a step promises that it has to take off.
    decrease: f64,
}

const BY_HARMONICS: NewtonPlan = NewtonPlan {
    pairs: false,
    step_error: 1e-3,
    products: 120,
    products_in_all: u64::MAX,
    least_factor: 1.0 / 128.0,
    decrease: 0.0,
};
/// With many harmonics: where these are not enough, more hardly ever are.
const BY_MANY_HARMONICS: NewtonPlan = NewtonPlan {
    products_in_all: 1_500,
    ..BY_HARMONICS
};
/// From where the iteration has come to: few steps are left, which need not be solved closely.
const FROM_THERE: NewtonPlan = NewtonPlan {
    pairs: false,
    step_error: 0.1,
    products: 120,
    products_in_all: 700,
    least_factor: 1.0 / 128.0,
    decrease: 0.0,
};
/// The same with many, where its steps take off less each.
const FROM_THERE_WITH_MANY: NewtonPlan = NewtonPlan {
    products_in_all: 1_500,
    ..FROM_THERE
};
const BY_PAIRS: NewtonPlan = NewtonPlan {
    pairs: true,
    step_error: 1e-2,
    products: 250,
    products_in_all: 3_500,
    least_factor: 1.0 / 256.0,
    decrease: 0.1,
};

/// Where an attempt begins.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// Motions that are known beside the frequency or with other harmonics.
    Known,
    /// The linear response.
    Linear,
    /// The motions with the smallest residual of all attempts before.
    Best,
}

/// One way to a solution.
enum Attempt {
    #[allow(dead_code)]
    Accelerated(Plan),
    Newton(NewtonPlan),
}

/// What is tried, in this order, until an attempt ends with a solution. The tangent of a known start is near; that of the linear
/// response says little, and is renewed. Where the iteration creeps, Newton's method ends what it began. Harmonics above 1 near
/// resonances that deviations split take the resonant shapes. Where pairs open, their harmonics depend on each other, and pairs are
/// preconditioned by themselves.
const WITH_FEW_HARMONICS: [(Start, Attempt); 13] = [
    (Known, Accelerated(plan(&[0], 100, FirstOfFundamental))),
    (Linear, Accelerated(plan(&[0, 3], 80, FirstOfFundamental))),
    (Linear, Accelerated(RENEWED)),
    (Known, Accelerated(RENEWED)),
    (Best, Newton(FROM_THERE)),
    (Known, Accelerated(plan(&[0, 3], 80, Resonant))),
    (Known, Accelerated(RENEWED_RESONANT)),
    (Linear, Accelerated(plan(&[0, 3], 80, Resonant))),
    (Linear, Accelerated(RENEWED_RESONANT)),
    (Known, Newton(BY_HARMONICS)),
    (Linear, Newton(BY_HARMONICS)),
    (Known, Newton(BY_PAIRS)),
    (Linear, Newton(BY_PAIRS)),
];
/// The same with many: where an attempt stalls it is over, since Newton's method from there takes less than other starts do.
const WITH_MANY_HARMONICS: [(Start, Attempt); 12] = [
    (Known, brief(plan(&[0], 160, FirstOfFundamental))),
    (Best, Newton(FROM_THERE_WITH_MANY)),
    (Known, Newton(BY_MANY_HARMONICS)),
    (Linear, brief(plan(&[0, 3], 120, FirstOfFundamental))),
    (Best, Newton(FROM_THERE_WITH_MANY)),
    (Linear, Accelerated(combining_all(RENEWED))),
    (Known, Accelerated(combining_all(RENEWED))),
    (Known, Accelerated(plan(&[0, 3], 80, Resonant))),
    (Known, Accelerated(combining_all(RENEWED_RESONANT))),
    (Linear, Accelerated(plan(&[0, 3], 80, Resonant))),
    (Linear, Accelerated(combining_all(RENEWED_RESONANT))),
    (Linear, Newton(BY_MANY_HARMONICS)),
];
const RENEWED: Plan = plan(&[0, 10, 25], 160, FirstOfFundamental);
const RENEWED_RESONANT: Plan = plan(&[0, 10, 25], 160, Resonant);

/// For the errors of a solution, from that solution: what is left counts, so every step does.
const BESIDE: Plan = combining_all(plan(&[0], 120, FirstOfFundamental));

/// What decides that an attempt is over.
struct Judge {
    tolerance: f64,
    /// The residual that the attempt began with.
    first: f64,
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
            first: f64::INFINITY,
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

fn dbg_ladder() -> &'static [(Start, Attempt)] {
    static L: std::sync::OnceLock<Vec<(Start, Attempt)>> = std::sync::OnceLock::new();
    L.get_or_init(|| {
        let Ok(text) = std::env::var("BLK_LADDER") else { return Vec::new() };
        text.split(' ').map(|t| {
            let mut c = t.chars();
            let start = match c.next().unwrap() { 'K' => Known, 'L' => Linear, _ => Best };
            let kind = c.next().unwrap();
            let rest: Vec<f64> = c.as_str().split(',').filter(|x| !x.is_empty()).map(|x| x.parse().unwrap()).collect();
            let attempt = match kind {
                'b' if start == Known => brief(plan(&[0], 160, FirstOfFundamental)),
                'b' => brief(plan(&[0, 3], 120, FirstOfFundamental)),
                'r' => Accelerated(combining_all(RENEWED)),
                'R' => Accelerated(combining_all(RENEWED_RESONANT)),
                _ => Newton(NewtonPlan { pairs: kind == 'p', step_error: rest[0], products: rest[1] as usize, products_in_all: rest[2] as u64, least_factor: 1.0/256.0, decrease: rest[3] }),
            };
            (start, attempt)
        }).collect()
    })
}

impl ContactEquation<'_> {
    /// Solves from the best of `starts`, or from the linear response without any, until the residual is within `tolerance`.
    pub(super) fn solve(&mut self, starts: &[Vec<f64>], tolerance: f64) -> Outcome {
        let linear = self.linear_start();
        let known = self.best_of(starts);
        let attempts = if self.harmonics.len() <= FEW_HARMONICS {
            WITH_FEW_HARMONICS.as_slice()
        } else {
            WITH_MANY_HARMONICS.as_slice()
        };
        let dbg = dbg_ladder();
        let attempts = if self.harmonics.len() > FEW_HARMONICS && !dbg.is_empty() { dbg } else { attempts };
        let attempts = attempts.iter();
        let attempts = attempts.filter(|(start, _)| known.is_some() || *start != Known);
        // Without a known start the linear response begins.
        let attempts = attempts.skip_while(|(start, _)| known.is_none() && *start == Best);
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
            };
            if rung > 0 || outcome.status != Status::Ok { eprintln!("DBG   rung {} {} st={:?} res={:.2e} step={:.2e} it={} tan={} sep={:.3}", rung, match attempt { Accelerated(p) => format!("acc{:?}x{} d{}", p.renewals, p.iterations, p.depth), Newton(_) => "newton".into() }, outcome.status, outcome.residual, outcome.step, outcome.iterations, outcome.tangents, outcome.shares.separated); }
            total = total.followed_by(outcome, rung);
            if total.status == Status::Ok {
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
        let mut preconditioners: Vec<Preconditioner> = Vec::new();
        let mut outcome = Outcome::none();
        let mut judge = Judge::of(tolerance);
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
            if plan.gives_up && judge.stalls(outcome.residual) {
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
            self.buffers.move_on(plan.depth);
        }
        outcome
    }

    /// Newton's method with steps by GMRES under preconditioners, shortened while more would be left; all harmonics of the tangent are
    /// coupled.
    fn newton(&mut self, plan: &NewtonPlan, tolerance: f64) -> Outcome {
        self.contact.couple(true);
        let mut outcome = Outcome::none();
        let judge = Judge::of(tolerance);
        for _ in 0..NEWTON_STEPS {
            (outcome.residual, outcome.shares) = self.residual(true);
            let settled = judge.settled(outcome.residual, 0.0, &outcome.shares);
            let settled = settled.filter(|status| *status == Status::Ok);
            if let Some(status) = settled.or(judge.lost(outcome.residual)) {
                outcome.status = status;
                break;
            }
            outcome.tangents += 1;
            eprintln!("DBG     newton res={:.2e} products={}", outcome.residual, outcome.iterations);
            let pairs = plan.pairs;
            let mut by = NewtonPreconditioner {
                harmonics: self.preconditioners(FirstOfFundamental),
                pairs: pairs.then(|| PairPreconditioner::new(self.contact, self.harmonics)),
            };
            let right = self.preconditioned_residual(&mut by);
            let (step, products) = gmres(&right, plan.step_error, plan.products, |direction| {
                let mut turned = self.derivative(direction);
                self.precondition_flat(&mut by, &mut turned);
                turned
            });
            outcome.iterations += products as u64;
            if outcome.iterations > plan.products_in_all {
                break;
            }
            let before = if pairs {
                norm(&right)
            } else {
                outcome.residual
            };
            if !self.moves_by(&step, plan, &mut by, before) {
                outcome.status = Status::Stagnated;
                break;
            }
        }
        self.contact.couple(false);
        outcome
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

    /// Moves by the largest of the step, its half and so on after which less than `before` is left; false if there is none.
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
    /// Norm of the preconditioned residual over that of the motions.
    fn step_over_motion(&self) -> f64 {
        let step: f64 = self.residual.iter().map(norm_squared).sum();
        let motion: f64 = self.motions.iter().map(norm_squared).sum();
        (step / motion).sqrt()
    }

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
