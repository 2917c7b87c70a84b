//! One frequency of one row: the solution, found by a fixed ladder of attempts, and its amplitudes.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::attempts_on_basis::Attempt;
use super::excited::Excited;
use super::observed_amplitude::ObservedBlock;
use super::options::ContactCondition;
use super::point::{Point, Slope, Work};
use super::point_settings::PointSettings;
use super::starts::between;
use crate::linalg::{Complex64, LuWorkspace};
use crate::response::friction::Ring;
use crate::response::harmonic_balance::{
    ContactInterface, ContactShares, HarmonicBlock, HarmonicSystem, NewtonWorkspace, PairContact,
    Status, linear_response, response_slope, solve, solve_creeping,
};

/// Solver of the points of one row; keeps the converged points as starts for others.
pub struct PointSolver<'a> {
    pub(super) excited: &'a Excited,
    pub(super) condition: ContactCondition,
    pub(super) settings: &'a PointSettings,
    pub(super) linear: LuWorkspace<Complex64>,
    pub(super) nonlinear: Option<(HarmonicSystem, NewtonWorkspace)>,
    pub(super) points: Vec<Point>,
    /// Points with fewer harmonics, in the unknowns of this solver; none unless it refines them.
    pub(super) coarse: Vec<Point>,
    failures: Vec<(f64, Status)>,
    /// Relative precision of the amplitudes at which a point may end before its residual is met.
    pub(super) precision: Option<f64>,
    /// Whether the slopes of points are asked for.
    sloped: bool,
    pub(super) work: Work,
}

impl<'a> PointSolver<'a> {
    /// A solver for `condition`, with no point solved yet.
    #[must_use]
    pub fn new(
        excited: &'a Excited,
        condition: ContactCondition,
        settings: &'a PointSettings,
    ) -> Self {
        let nonlinear = match (condition, settings.contact) {
            (ContactCondition::Full { normal_load_n }, Some((law, sector))) => {
                let interface = ContactInterface {
                    law,
                    geometry: settings.geometry.clone(),
                    pairs: sector.pairs_under(normal_load_n, &settings.geometry, &settings.factors),
                };
                let system = HarmonicSystem::new(
                    excited.blocks.clone(),
                    excited.force.clone(),
                    interface,
                    Arc::clone(&settings.transform),
                );
                let workspace = NewtonWorkspace::new(&system);
                Some((system, workspace))
            }
            _ => None,
        };
        Self {
            excited,
            condition,
            settings,
            linear: LuWorkspace::new(excited.linear.structure.size()),
            nonlinear,
            points: Vec::new(),
            coarse: Vec::new(),
            failures: Vec::new(),
            precision: None,
            sloped: false,
            work: Work::default(),
        }
    }

    /// Converged points, in the order in which they were solved.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Frequencies that could not be solved, Hz, with the status of the last attempt.
    #[must_use]
    pub fn failures(&self) -> &[(f64, Status)] {
        &self.failures
    }

    /// Work done so far.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work
    }

    /// Mean friction force on the ring at a point of this solver, N per sector, see
    /// [`HarmonicSystem::mean_friction_n`]; none for a linear limit.
    pub fn mean_friction_n(&mut self, point: &Point) -> Option<[f64; 2]> {
        let (system, workspace) = self.nonlinear.as_mut()?;
        system.set_ring_drift(point.ring_drift_m);
        Some(system.mean_friction_n(&point.solution, workspace.system_mut()))
    }

    /// Equivalent linear spring of every contact row at a point of this solver, N/m, see
    /// [`HarmonicSystem::equivalent_springs`]; none for a linear limit.
    pub fn equivalent_springs(&mut self, point: &Point) -> Option<Vec<Complex64>> {
        let (system, workspace) = self.nonlinear.as_mut()?;
        system.set_ring_drift(point.ring_drift_m);
        Some(system.equivalent_springs(&point.solution, workspace.system_mut()))
    }

    /// State of every contact pair at a point of this solver, see [`HarmonicSystem::contact_states`];
    /// none for a linear limit.
    pub fn contact_states(&mut self, point: &Point) -> Option<Vec<PairContact>> {
        let (system, workspace) = self.nonlinear_at(point)?;
        Some(system.contact_states(&point.solution, workspace.system_mut()))
    }

    /// The nonlinear equation that `point` solves, with its buffers; none for a linear limit.
    pub(super) fn nonlinear_at(
        &mut self,
        point: &Point,
    ) -> Option<(&HarmonicSystem, &mut NewtonWorkspace)> {
        let (system, workspace) = self.nonlinear.as_mut()?;
        system.set_ring_drift(point.ring_drift_m);
        Some((&*system, workspace))
    }

    /// This solver for a search: from now on a point ends where the next step would change no amplitude by more than
    /// `precision` of the largest, unless its contacts open. Its residual may be far above the tolerance. Points with
    /// a creeping ring are solved to the tolerance all the same.
    #[must_use]
    pub fn with_precision(self, precision: f64) -> Self {
        Self {
            precision: Some(precision),
            ..self
        }
    }

    /// This solver with the slope of every point, where Newton's method has it at hand: for wheels with few contact
    /// rows and a locked ring.
    #[must_use]
    pub(super) fn with_slopes(mut self) -> Self {
        let condenses = |(system, _): &(HarmonicSystem, _)| system.condenses();
        self.sloped =
            self.nonlinear.as_ref().is_some_and(condenses) && self.settings.ring == Ring::Locked;
        self
    }

    /// Whether points have slopes.
    pub(super) fn is_sloped(&self) -> bool {
        self.sloped
    }

    /// This solver for points that begin at the solutions of `coarse`, a solver with fewer harmonics.
    #[must_use]
    pub(super) fn refining(self, coarse: &PointSolver<'_>) -> Self {
        let coarse_excited = coarse.excited;
        let coarse = coarse.points.iter();
        let coarse = coarse.map(|point| self.beside(coarse_excited, point.clone()));
        Self {
            coarse: coarse.collect(),
            ..self
        }
    }

    /// From now on `point`, solved with the fewer harmonics of `excited`, tells where to start.
    pub(super) fn start_beside(&mut self, excited: &Excited, point: Point) {
        let point = self.beside(excited, point);
        self.coarse.push(point);
    }

    /// A point of `excited` in the unknowns of this solver.
    fn beside(&self, excited: &Excited, point: Point) -> Point {
        Point {
            solution: self.embedded(excited, &point.solution),
            slope: point.slope.map(|slope| Slope {
                solution: self.embedded(excited, &slope.solution),
                ..slope
            }),
            ..point
        }
    }

    /// A solution of `excited`, whose harmonics are among those of this solver, in the unknowns of this one.
    fn embedded(&self, excited: &Excited, solution: &[f64]) -> Vec<f64> {
        let size = |block: &HarmonicBlock| block.size() * if block.harmonic == 0 { 1 } else { 2 };
        let mut all = Vec::new();
        for block in &self.excited.blocks {
            let mut from = 0;
            let mut found = None;
            for own in &excited.blocks {
                if own.harmonic == block.harmonic {
                    found = Some(from..from + size(own));
                }
                from += size(own);
            }
            match found {
                Some(place) => all.extend_from_slice(&solution[place]),
                None => all.resize(all.len() + size(block), 0.0),
            }
        }
        all
    }

    /// The point at `frequency_hz` again, to the tolerance of the residual.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    pub fn finish(&mut self, frequency_hz: f64) -> Result<&Point, Status> {
        self.precision = None;
        self.sloped = false;
        let same = |point: &Point| point.frequency_hz.total_cmp(&frequency_hz).is_eq();
        let tolerance = self.settings.bounds.residual_tolerance;
        let done = |point: &Point| same(point) && point.residual <= tolerance;
        if let Some(at) = self.points.iter().position(done) {
            return Ok(&self.points[at]);
        }
        let finished = self.solve_nonlinear(frequency_hz)?;
        self.points.retain(|point| !same(point));
        self.points.push(finished);
        Ok(&self.points[self.points.len() - 1])
    }

    /// Solves at one frequency, Hz.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    pub fn solve(&mut self, frequency_hz: f64) -> Result<&Point, Status> {
        let solved = if self.nonlinear.is_some() {
            self.solve_nonlinear(frequency_hz)
        } else {
            self.solve_linear(frequency_hz)
        };
        match solved {
            Ok(point) => {
                self.points.push(point);
                Ok(&self.points[self.points.len() - 1])
            }
            Err(status) => {
                self.failures.push((frequency_hz, status));
                Err(status)
            }
        }
    }

    /// Amplitude of every blade, m, at a frequency, Hz, that may have been solved before; none where it cannot be.
    pub(super) fn amplitudes_at(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
        let known = |point: &&Point| point.frequency_hz.total_cmp(&frequency_hz).is_eq();
        if let Some(point) = self.points.iter().find(known) {
            return Some(point.amplitudes_m.clone());
        }
        let point = self.solve(frequency_hz).ok()?;
        Some(point.amplitudes_m.clone())
    }

    fn solve_linear(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let response = self.linear_at(frequency_hz)?;
        let solution = real_parts(&response);
        let blocks = ObservedBlock::fundamental(&self.excited.linear.structure);
        Ok(Point {
            frequency_hz,
            amplitudes_m: self.settings.amplitude.of(&blocks, &solution),
            solution,
            residual: 0.0,
            shares: ContactShares::default(),
            ring_drift_m: [0.0; 2],
            slope: None,
        })
    }

    /// Linear response with the springs of the condition, stuck ones for the full law.
    fn linear_at(&mut self, frequency_hz: f64) -> Result<Vec<Complex64>, Status> {
        linear_response(
            &self.excited.linear.structure,
            self.excited.linear.contact(self.condition),
            TAU * frequency_hz,
            &self.excited.force,
            &mut self.linear,
        )
        .ok_or(Status::SingularJacobian)
    }

    pub(super) fn stuck_start(&mut self, frequency_hz: f64) -> Result<Vec<f64>, Status> {
        if let Some((system, workspace)) = &mut self.nonlinear
            && let Some(stuck) = workspace.stuck_response(system, TAU * frequency_hz)
        {
            return Ok(stuck);
        }
        let stuck = self.linear_at(frequency_hz)?;
        self.start_from(&stuck)
    }

    /// Unknowns with the given fundamental and nothing else.
    pub(super) fn start_from(&self, fundamental: &[Complex64]) -> Result<Vec<f64>, Status> {
        let Some((system, _)) = &self.nonlinear else {
            return Err(Status::SingularJacobian);
        };
        let mut start = vec![0.0; system.unknowns()];
        let at = system.block_start(system.fundamental());
        start[at..at + 2 * fundamental.len()].copy_from_slice(&real_parts(fundamental));
        Ok(start)
    }

    fn solve_nonlinear(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        self.work.nonlinear_solves += 1;
        let mut last = Status::IterationLimit;
        let condenses = self.nonlinear.as_ref().is_some_and(|(s, _)| s.condenses());
        let ladder = Attempt::ladder(condenses, !self.coarse.is_empty());
        for (rung, attempt) in ladder.enumerate() {
            if let Some((_, workspace)) = &mut self.nonlinear {
                workspace.set_steps(attempt.steps());
            }
            match self.attempt(attempt, frequency_hz) {
                Ok(point) => {
                    self.work.retries += u64::from(rung > 0);
                    return Ok(point);
                }
                Err(status) => last = status,
            }
        }
        self.work.retries += 1;
        Err(last)
    }

    fn attempt(&mut self, attempt: Attempt, frequency_hz: f64) -> Result<Point, Status> {
        match attempt {
            Attempt::Renewed if self.coarse.is_empty() => {
                let start = self.expected(frequency_hz)?;
                self.newton(frequency_hz, start, None)
            }
            Attempt::Renewed | Attempt::ByHarmonic | Attempt::Once => {
                let start = self.expected_from_coarse(frequency_hz)?;
                self.newton(frequency_hz, start, None)
            }
            Attempt::Neighbours => {
                let start = self.expected(frequency_hz)?;
                self.newton(frequency_hz, start, None)
            }
            Attempt::Line => {
                let mut starts = between(&self.points, frequency_hz);
                starts.push(self.stuck_start(frequency_hz)?);
                self.newton(frequency_hz, starts.swap_remove(0), None)
            }
            Attempt::Stuck => {
                let start = self.stuck_start(frequency_hz)?;
                self.newton(frequency_hz, start, None)
            }
            // At fixed drift the curve is not that of a ring that creeps.
            Attempt::Continuation if self.settings.ring == Ring::Creeping => {
                Err(Status::StepTooSmall)
            }
            Attempt::Continuation => self.continue_to(frequency_hz),
            Attempt::StiffnessHomotopy => self.stiffen_contact(frequency_hz),
            Attempt::LoadHomotopy => self.lower_normal_load(frequency_hz),
        }
    }

    /// Newton's method from `start`; on another system than that of the row where one is given.
    pub(super) fn newton(
        &mut self,
        frequency_hz: f64,
        start: Vec<f64>,
        other: Option<&HarmonicSystem>,
    ) -> Result<Point, Status> {
        let Some((system, workspace)) = &mut self.nonlinear else {
            return Err(Status::SingularJacobian);
        };
        let mut x = start;
        let omega = TAU * frequency_hz;
        let bounds = self.settings.bounds;
        let bounds = workspace.steps().bounds(bounds);
        let (outcome, ring_drift_m) = if let Some(other) = other {
            // On the way the ring is locked.
            let outcome = solve(other, omega, &mut x, bounds, None, workspace);
            (outcome, [0.0; 2])
        } else {
            let blocks = ObservedBlock::all(&self.excited.blocks);
            let amplitude = &self.settings.amplitude;
            let precision = self.precision;
            let steady = |x: &[f64], step: &[f64]| {
                precision.is_some_and(|share| {
                    // Cheap to ask, and nearly always the answer.
                    let small = norm(step) <= WHOLE_STEP * share * norm(x);
                    small && amplitude.is_steady(&blocks, x, step, share)
                })
            };
            let outcome = match self.settings.ring {
                Ring::Locked => solve(system, omega, &mut x, bounds, Some(&steady), workspace),
                Ring::Creeping => solve_creeping(system, omega, &mut x, bounds, workspace),
            };
            (outcome, system.ring_drift_m())
        };
        self.work.newton_iterations += outcome.iterations;
        self.work.factorisations += outcome.factorisations;
        if outcome.status != Status::Ok {
            return Err(outcome.status);
        }
        let slope = match &mut self.nonlinear {
            Some((system, workspace)) if self.sloped && other.is_none() => {
                self.work.factorisations += 1;
                response_slope(system, omega, &x, workspace)
            }
            _ => None,
        };
        let (amplitudes_m, slope) = match slope {
            Some(per_rad_per_s) => {
                let solution: Vec<f64> = per_rad_per_s.iter().map(|rate| TAU * rate).collect();
                let (amplitudes_m, amplitudes_m_per_hz) = self.amplitudes_with_rates(&x, &solution);
                let slope = Slope {
                    solution,
                    amplitudes_m_per_hz,
                };
                (amplitudes_m, Some(slope))
            }
            None => (self.amplitudes_of(&x), None),
        };
        Ok(Point {
            frequency_hz,
            amplitudes_m,
            solution: x,
            residual: outcome.residual,
            shares: outcome.shares,
            ring_drift_m,
            slope,
        })
    }

    /// Amplitude of every blade, m, of a nonlinear solution.
    pub(super) fn amplitudes_of(&self, solution: &[f64]) -> Vec<f64> {
        let blocks = ObservedBlock::all(&self.excited.blocks);
        self.settings.amplitude.of(&blocks, solution)
    }

    /// [`Self::amplitudes_of`], and what they change by where the solution changes by `slope`.
    fn amplitudes_with_rates(&self, solution: &[f64], slope: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let blocks = ObservedBlock::all(&self.excited.blocks);
        self.settings.amplitude.with_rates(&blocks, solution, slope)
    }
}

/// A step that changes the amplitudes by a share is no longer than this many times the share of the solution.
const WHOLE_STEP: f64 = 10.0;

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn real_parts(x: &[Complex64]) -> Vec<f64> {
    x.iter()
        .map(|x| x.re)
        .chain(x.iter().map(|x| x.im))
        .collect()
}
