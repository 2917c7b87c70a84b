//! Pseudo-arc-length continuation of the harmonic balance equation in frequency, through folds.
//!
//! The unknowns `u = (x / X, omega / W)` are solution and frequency, each in a size that makes a
//! step of one as large as one of the other: X is the norm of the solution, W the frequency given
//! by the caller, as a rule a half-bandwidth. With `DR = (X dR/dx, W dR/domega)`,
//!
//! ```text
//! tangent      DR t = 0,  |t| = 1
//! predictor    u + s t
//! corrector    u <- u - DR^+ R(u)       the shortest step onto the linearised curve
//! ```
//!
//! The corrector is that of Deuflhard, Fiedler & Kunkel (1987, SIAM J. Numer. Anal. 24(4)). `DR` is
//! bordered by a row c near its kernel, which keeps the matrix regular at folds, where `dR/dx` is
//! not. Contact makes the curve piecewise smooth: at a kink the tangent jumps, and it may turn by more
//! than a right angle. The corrector needs no plane that the curve would have to cross, and the
//! way on is told by the sign of `det (DR; t^T)`, which is the same on all pieces of one curve
//! (Allgower & Georg 1990, Numerical Continuation Methods, section 2.1 and chapter 15).

use super::curve::{AtFrequency, Curve, distance, dot};
use crate::response::harmonic_balance::Status;
use crate::response::harmonic_balance::equation::HarmonicSystem;
use crate::response::harmonic_balance::pairs::ContactShares;
use crate::response::harmonic_balance::solver::{
    Equation, NewtonBounds, NewtonBuffers, NewtonOutcome, iterate, norm_of,
};

/// Wanted distance from predicted to corrected point over the step.
const WANTED_DEVIATION: f64 = 0.1;
/// Largest such distance, and smallest cosine between the tangents at both ends of a step.
const LARGEST_DEVIATION: f64 = 0.4;
const SMALLEST_COSINE: f64 = 0.7;
/// Steps up to this may turn by any angle: a kink, not a coarse step.
const KINK_STEP: f64 = 2e-3;
/// Largest distance from predicted to corrected point over the step at a kink; beyond it the point
/// is one of another branch.
const KINK_DEVIATION: f64 = 2.0;
/// The size X is renewed once the solution has changed by this factor.
const RESCALING: f64 = 2.0;
/// Halvings of a stretch of the curve to solve at a frequency inside of it, and largest distance of
/// the solution from the chord over the length of the chord.
const LANDING_HALVINGS: usize = 12;
const LANDING_DEVIATION: f64 = 0.35;
/// A fold is found at this slope of frequency over arc length, or once it lies within this length;
/// largest number of corrections, two per halving of the largest step to that length.
const FOLD_SLOPE: f64 = 1e-4;
const FOLD_WIDTH: f64 = 1e-6;
const FOLD_CORRECTIONS: usize = 40;

/// Bounds of a continuation. Steps are relative: 1 is a change of the solution by its own norm, or
/// of the frequency by [`Self::frequency_scale`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContinuationBounds {
    /// Bounds of the corrector.
    pub newton: NewtonBounds,
    /// Frequency change that weighs as much as a change of the whole solution, rad/s.
    pub frequency_scale: f64,
    /// First step.
    pub first_step: f64,
    /// Steps below this end the continuation.
    pub smallest_step: f64,
    /// Largest step.
    pub largest_step: f64,
    /// Largest number of correctors started.
    pub correctors: u64,
}

impl ContinuationBounds {
    /// Default bounds for a curve whose frequency scale, rad/s, is given.
    #[must_use]
    pub fn new(newton: NewtonBounds, frequency_scale: f64) -> Self {
        Self {
            newton: NewtonBounds {
                iterations: 30,
                halvings: 3,
                ..newton
            },
            frequency_scale,
            first_step: 0.05,
            smallest_step: 1e-6,
            largest_step: 1.0,
            correctors: 4000,
        }
    }
}

/// A converged point of the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct PathPoint {
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Unknowns of the system.
    pub solution: Vec<f64>,
    /// Length of the tangent step that led to it, relative.
    pub along: f64,
    /// Residual relative to the excitation.
    pub residual: f64,
    /// Shares of slipping and separated pairs.
    pub shares: ContactShares,
}

/// A point at which the frequency turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Fold {
    /// The point.
    pub point: PathPoint,
    /// Whether the frequency is largest there, else smallest.
    pub largest: bool,
}

/// Work done by a continuation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ContinuationWork {
    /// Correctors started.
    pub correctors: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Jacobians assembled and factored.
    pub factorisations: u64,
}

/// A point with its tangent, in scaled unknowns.
#[derive(Debug, Clone)]
struct Place {
    u: Vec<f64>,
    tangent: Vec<f64>,
    residual: f64,
    shares: ContactShares,
}

impl Place {
    fn slope(&self) -> f64 {
        self.tangent[self.tangent.len() - 1]
    }
}

/// A walk along the curve.
pub struct Continuation<'a> {
    bounds: ContinuationBounds,
    curve: Curve<'a>,
    buffers: NewtonBuffers,
    here: Place,
    previous: Place,
    /// Length of the last step.
    taken: f64,
    step: f64,
    work: ContinuationWork,
}

impl<'a> Continuation<'a> {
    /// Starts at a solution `x` of the equation at `omega`, towards larger or smaller frequencies.
    ///
    /// # Errors
    /// `non_finite` or `singular_jacobian` where there is no tangent at the start.
    pub fn new(
        system: &'a HarmonicSystem,
        omega: f64,
        x: &[f64],
        rising: bool,
        bounds: ContinuationBounds,
    ) -> Result<Self, Status> {
        let state_scale = norm_of(x);
        if !(state_scale > 0.0 && state_scale.is_finite()) {
            return Err(Status::NonFinite);
        }
        let n = system.unknowns();
        let curve = Curve::new(system, state_scale, bounds.frequency_scale);
        let mut u: Vec<f64> = x.iter().map(|x| x / state_scale).collect();
        u.push(omega / bounds.frequency_scale);
        let start = Place {
            tangent: curve.border.clone(),
            u,
            residual: 0.0,
            shares: ContactShares::default(),
        };
        let mut walk = Self {
            here: start.clone(),
            previous: start,
            taken: 0.0,
            bounds,
            buffers: NewtonBuffers::new(n + 1),
            step: bounds.first_step,
            work: ContinuationWork::default(),
            curve,
        };
        let mut residual = vec![0.0; n + 1];
        let u = walk.here.u.clone();
        (walk.here.residual, walk.here.shares) = walk.curve.residual(&u, &mut residual);
        let (mut tangent, sign) = walk.tangent_at(&u)?;
        let wanted = if rising { 1.0 } else { -1.0 };
        let turn = wanted * tangent[n].signum();
        for t in &mut tangent {
            *t *= turn;
        }
        walk.curve.orientation = sign * turn;
        walk.here.tangent = tangent;
        Ok(walk)
    }

    /// The point reached last.
    #[must_use]
    pub fn point(&self) -> PathPoint {
        self.path_point(&self.here, self.taken)
    }

    /// The point before the last step.
    #[must_use]
    pub fn previous(&self) -> PathPoint {
        self.path_point(&self.previous, 0.0)
    }

    /// Work done so far.
    #[must_use]
    pub fn work(&self) -> ContinuationWork {
        self.work
    }

    /// One step along the curve; the fold that lies in it, if there is one.
    ///
    /// # Errors
    /// `step_too_small` where no corrector converges, `branch_jump` where it does so to another
    /// branch alone, `work_budget` when the correctors are used up.
    pub fn advance(&mut self) -> Result<Option<Fold>, Status> {
        self.rescale();
        let before = self.here.clone();
        let mut failure = Status::StepTooSmall;
        let (after, taken) = loop {
            if self.step < self.bounds.smallest_step {
                return Err(failure);
            }
            let step = self.step;
            match self.corrected(&before, step) {
                Ok((after, deviation)) => {
                    let cosine = dot(&before.tangent, &after.tangent);
                    let smooth = deviation <= LARGEST_DEVIATION && cosine >= SMALLEST_COSINE;
                    if smooth || (step <= KINK_STEP && deviation <= KINK_DEVIATION) {
                        let growth = (WANTED_DEVIATION / deviation.max(1e-9)).clamp(0.5, 2.0);
                        self.step = (growth * step).min(self.bounds.largest_step);
                        break (after, step);
                    }
                    failure = Status::BranchJump;
                    self.step *= 0.5;
                }
                Err(Status::WorkBudget) => return Err(Status::WorkBudget),
                Err(_) => {
                    failure = Status::StepTooSmall;
                    self.curve.factored = false;
                    self.step *= 0.25;
                }
            }
        };
        self.here = after;
        self.previous = before.clone();
        self.taken = taken;
        let turned = before.slope() * self.here.slope() < 0.0;
        Ok(turned.then(|| self.fold_between(&before, taken)))
    }

    /// The solution at `omega`, which lies between `from` and `to`: two of the place before the last
    /// step, the fold in it and the place behind it. Where Newton's method from the chord does not
    /// stay by the curve, the stretch is halved.
    ///
    /// # Errors
    /// The status of Newton's method from the last chord, `branch_jump` where it does not stay by that
    /// chord; the status of a corrector that fails; `work_budget` when the correctors are used up.
    pub fn land(
        &mut self,
        from: &PathPoint,
        to: &PathPoint,
        omega: f64,
    ) -> Result<PathPoint, Status> {
        let (mut from, mut to) = (from.clone(), to.clone());
        let mut failure = Status::StepTooSmall;
        for _ in 0..LANDING_HALVINGS {
            match self.land_on_chord(&from, &to, omega) {
                Ok(point) => return Ok(point),
                Err(status) => failure = status,
            }
            let start = self.previous.clone();
            let along = 0.5 * (from.along + to.along);
            let (place, _) = self.corrected(&start, along)?;
            let middle = self.path_point(&place, along);
            if (middle.omega < omega) == (from.omega < omega) {
                from = middle;
            } else {
                to = middle;
            }
        }
        Err(failure)
    }

    fn land_on_chord(
        &mut self,
        from: &PathPoint,
        to: &PathPoint,
        omega: f64,
    ) -> Result<PathPoint, Status> {
        let share = (omega - from.omega) / (to.omega - from.omega);
        let (state, frequency) = (self.curve.state_scale, self.curve.frequency_scale);
        let mut u: Vec<f64> = from
            .solution
            .iter()
            .zip(&to.solution)
            .map(|(a, b)| (a + share * (b - a)) / state)
            .collect();
        u.push(omega / frequency);
        let chord = u.clone();
        let mut fixed = AtFrequency::new(&mut self.curve);
        let outcome = iterate(&mut fixed, &mut u, self.bounds.newton, &mut self.buffers);
        self.curve.factored = false;
        self.count(outcome);
        if outcome.status != Status::Ok {
            return Err(outcome.status);
        }
        let pairs = from.solution.iter().zip(&to.solution);
        let length = pairs
            .map(|(a, b)| ((a - b) / state).powi(2))
            .chain([((from.omega - to.omega) / frequency).powi(2)])
            .sum::<f64>()
            .sqrt();
        if distance(&u, &chord) > LANDING_DEVIATION * length {
            return Err(Status::BranchJump);
        }
        let place = Place {
            tangent: Vec::new(),
            residual: outcome.residual,
            shares: outcome.shares,
            u,
        };
        Ok(PathPoint {
            omega,
            ..self.path_point(&place, from.along + share * (to.along - from.along))
        })
    }

    /// The curve at the distance `step` from a place, and how far from the prediction, over `step`.
    fn corrected(&mut self, from: &Place, step: f64) -> Result<(Place, f64), Status> {
        if self.work.correctors >= self.bounds.correctors {
            return Err(Status::WorkBudget);
        }
        self.work.correctors += 1;
        let predicted: Vec<f64> = from
            .u
            .iter()
            .zip(&from.tangent)
            .map(|(u, t)| u + step * t)
            .collect();
        if predicted[predicted.len() - 1] <= 0.0 {
            return Err(Status::StepTooSmall);
        }
        self.curve.border.copy_from_slice(&from.tangent);
        let mut u = predicted.clone();
        let newton = self.bounds.newton;
        let outcome = iterate(&mut self.curve, &mut u, newton, &mut self.buffers);
        self.count(outcome);
        if outcome.status != Status::Ok {
            return Err(outcome.status);
        }
        let deviation = distance(&u, &predicted) / step;
        let tangent = self.oriented_tangent(&u, &from.tangent)?;
        let place = Place {
            u,
            tangent,
            residual: outcome.residual,
            shares: outcome.shares,
        };
        Ok((place, deviation))
    }

    fn count(&mut self, outcome: NewtonOutcome) {
        self.work.iterations += outcome.iterations;
        self.work.factorisations += outcome.factorisations;
    }

    /// Unit tangent at `u` and the sign of `det (DR; t^T)`.
    fn tangent_at(&mut self, u: &[f64]) -> Result<(Vec<f64>, f64), Status> {
        let mut residual = vec![0.0; u.len()];
        self.work.factorisations += 1;
        if !self.curve.linearise(u, &mut residual) {
            return Err(Status::SingularJacobian);
        }
        let length = norm_of(&self.curve.kernel);
        let tangent = self.curve.kernel.iter().map(|t| t / length).collect();
        Ok((tangent, self.curve.factors.determinant_sign()))
    }

    /// The tangent at `u` that leads on, coming along `before`.
    fn oriented_tangent(&mut self, u: &[f64], before: &[f64]) -> Result<Vec<f64>, Status> {
        let (mut tangent, sign) = self.tangent_at(u)?;
        let mut turn = sign * self.curve.orientation;
        // Where the curve goes straight on while the sign changes, another branch crosses it.
        if turn * dot(&tangent, before) < -SMALLEST_COSINE {
            turn = -turn;
            self.curve.orientation = -self.curve.orientation;
        }
        for t in &mut tangent {
            *t *= turn;
        }
        Ok(tangent)
    }

    /// Where the frequency turns between `before` and the point a step of length `taken` behind
    /// it: the slope is brought to zero by the Illinois form of false position, and by halving where
    /// that is slow, since a sharp fold makes the slope jump. At a kink it has no zero: the bracket
    /// shrinks round the place.
    fn fold_between(&mut self, before: &Place, taken: f64) -> Fold {
        let largest = before.slope() > 0.0;
        let outer = |a: &Place, b: &Place| (a.u[a.u.len() - 1] > b.u[b.u.len() - 1]) == largest;
        let (mut best, mut along) = if outer(before, &self.here) {
            (before.clone(), 0.0)
        } else {
            (self.here.clone(), taken)
        };
        let (mut low, mut high) = ((0.0, before.slope()), (taken, self.here.slope()));
        let mut halve = false;
        for _ in 0..FOLD_CORRECTIONS {
            let width = high.0 - low.0;
            if width <= FOLD_WIDTH {
                break;
            }
            let at = if halve {
                0.5 * (low.0 + high.0)
            } else {
                (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1)
            };
            let Ok((place, _)) = self.corrected(before, at) else {
                break;
            };
            let slope = place.slope();
            if outer(&place, &best) {
                (best, along) = (place, at);
            }
            if slope.abs() <= FOLD_SLOPE {
                break;
            }
            if slope * low.1 > 0.0 {
                low = (at, slope);
                high.1 *= 0.5;
            } else {
                high = (at, slope);
                low.1 *= 0.5;
            }
            halve = !halve && high.0 - low.0 > 0.5 * width;
        }
        Fold {
            point: self.path_point(&best, along),
            largest,
        }
    }

    /// Renews the size X where the solution has grown or shrunk away from it.
    fn rescale(&mut self) {
        let n = self.curve.x.len();
        let size = norm_of(&self.here.u[..n]);
        if size < RESCALING && size > 1.0 / RESCALING {
            return;
        }
        self.curve.state_scale *= size;
        self.curve.factored = false;
        for values in [&mut self.here.u, &mut self.here.tangent] {
            values[..n].iter_mut().for_each(|value| *value /= size);
        }
        let length = norm_of(&self.here.tangent);
        self.here.tangent.iter_mut().for_each(|t| *t /= length);
    }

    fn path_point(&self, place: &Place, along: f64) -> PathPoint {
        let n = self.curve.x.len();
        PathPoint {
            omega: place.u[n] * self.curve.frequency_scale,
            solution: place.u[..n]
                .iter()
                .map(|u| u * self.curve.state_scale)
                .collect(),
            along,
            residual: place.residual,
            shares: place.shares,
        }
    }
}
