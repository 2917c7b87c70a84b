//! One frequency of one row: the solution, found by a fixed ladder of attempts, and its amplitudes.

use super::attempts_on_basis::Attempt;
use super::branch::ResponseTrace;
use super::excited::Excited;
use super::folded_peak::over_folds;
use super::homotopy::{lower_normal_load, stiffen_contact};
use super::initial_guess::{KnownPoints, between};
use super::observed_amplitude::ObservedBlock;
use super::options::ContactCondition;
use super::point::{Point, Work, point_at};
use super::point_settings::PointSettings;
use super::row_equation::{RowEquation, real_parts};
use crate::linalg::{Complex64, LuWorkspace};
use crate::response::friction::Ring;
use crate::response::harmonic_balance::{
    ContactShares, HarmonicSystem, NewtonWorkspace, PairContact, Status,
};

/// Solver of the points of one row; keeps the converged points as starts for others.
pub struct PointSolver<'a> {
    excited: &'a Excited,
    condition: ContactCondition,
    settings: &'a PointSettings,
    /// Factors of a linear limit.
    linear: Option<LuWorkspace<Complex64>>,
    /// None for a linear limit.
    nonlinear: Option<RowEquation<'a>>,
    known: KnownPoints,
    failures: Vec<(f64, Status)>,
}

impl<'a> PointSolver<'a> {
    /// A solver for `condition`, with no point solved yet.
    #[must_use]
    pub fn new(
        excited: &'a Excited,
        condition: ContactCondition,
        settings: &'a PointSettings,
    ) -> Self {
        Self {
            excited,
            condition,
            settings,
            linear: None,
            nonlinear: RowEquation::new(excited, condition, settings),
            known: KnownPoints::default(),
            failures: Vec::new(),
        }
    }

    /// Converged points, in the order in which they were solved.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.known.solved
    }

    /// Frequencies that could not be solved, Hz, with the status of the last attempt.
    #[must_use]
    pub fn failures(&self) -> &[(f64, Status)] {
        &self.failures
    }

    /// Work done so far.
    #[must_use]
    pub fn work(&self) -> Work {
        let row = self.nonlinear.as_ref();
        row.map_or(Work::default(), |row| row.work)
    }

    /// Mean friction force on the ring at a point of this solver, N per sector, see
    /// [`HarmonicSystem::mean_friction_n`]; none for a linear limit.
    pub fn mean_friction_n(&mut self, point: &Point) -> Option<[f64; 2]> {
        let (system, workspace) = self.nonlinear_at(point)?;
        Some(system.mean_friction_n(&point.solution, workspace.system_mut()))
    }

    /// Equivalent linear spring of every contact row at a point of this solver, N/m, see
    /// [`HarmonicSystem::equivalent_springs`]; none for a linear limit.
    pub fn equivalent_springs(&mut self, point: &Point) -> Option<Vec<Complex64>> {
        let (system, workspace) = self.nonlinear_at(point)?;
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
        Some(self.nonlinear.as_mut()?.at(point))
    }

    /// From now on a point ends where the next step would change no amplitude by more than `precision` of the largest, unless its contacts
    /// open. Its residual may be far above the tolerance. Points with a creeping ring are solved to the tolerance all the same.
    pub(super) fn set_precision(&mut self, precision: f64) {
        if let Some(row) = &mut self.nonlinear {
            row.precision = Some(precision);
        }
    }

    /// The point at `frequency_hz` again, to the tolerance of the residual.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    pub fn finish(&mut self, frequency_hz: f64) -> Result<&Point, Status> {
        if let Some(row) = &mut self.nonlinear {
            row.precision = None;
        }
        let same = |point: &Point| point.frequency_hz.total_cmp(&frequency_hz).is_eq();
        let tolerance = self.settings.bounds.residual_tolerance;
        let done = |point: &Point| same(point) && point.residual <= tolerance;
        if let Some(at) = self.known.solved.iter().position(done) {
            return Ok(&self.known.solved[at]);
        }
        let finished = self.solve_nonlinear(frequency_hz)?;
        self.known.solved.retain(|point| !same(point));
        self.known.solved.push(finished);
        Ok(&self.known.solved[self.known.solved.len() - 1])
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
                self.known.solved.push(point);
                Ok(&self.known.solved[self.known.solved.len() - 1])
            }
            Err(status) => {
                self.failures.push((frequency_hz, status));
                Err(status)
            }
        }
    }

    /// Amplitude of every blade, m, at a frequency, Hz, that may have been solved before; none where it cannot be.
    pub(super) fn amplitudes_at(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
        if let Some(point) = point_at(&self.known.solved, frequency_hz) {
            return Some(point.amplitudes_m.clone());
        }
        let point = self.solve(frequency_hz).ok()?;
        Some(point.amplitudes_m.clone())
    }

    fn solve_linear(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let structure = &self.excited.linear.structure;
        let factors = self
            .linear
            .get_or_insert_with(|| LuWorkspace::new(structure.size()));
        let response = self
            .excited
            .linear_response(self.condition, frequency_hz, factors)
            .ok_or(Status::SingularJacobian)?;
        let solution = real_parts(&response);
        let blocks = ObservedBlock::fundamental(structure);
        Ok(Point {
            frequency_hz,
            amplitudes_m: self.settings.amplitude.of(&blocks, &solution),
            solution,
            residual: 0.0,
            shares: ContactShares::default(),
            ring_drift_m: [0.0; 2],
        })
    }

    fn solve_nonlinear(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let Some(row) = &mut self.nonlinear else {
            return Err(Status::SingularJacobian);
        };
        row.work.nonlinear_solves += 1;
        let mut last = Status::IterationLimit;
        for (rung, attempt) in Attempt::ALL.into_iter().enumerate() {
            match attempt_at(row, &self.known, attempt, frequency_hz) {
                Ok(point) => {
                    row.work.retries += u64::from(rung > 0);
                    return Ok(point);
                }
                Err(status) => last = status,
            }
        }
        row.work.retries += 1;
        Err(last)
    }

    /// Follows the curve from `start_hz` to `stop_hz`; `grid_hz` are frequencies between them that
    /// are solved for exactly, at each passage. Linear limits have no curve to follow: their trace
    /// is `singular_jacobian`.
    pub fn trace(&mut self, start_hz: f64, stop_hz: f64, grid_hz: &[f64]) -> ResponseTrace {
        let mut trace = match self.solve(start_hz) {
            Ok(point) => ResponseTrace::beginning_at(point.clone(), grid_hz),
            Err(status) => return ResponseTrace::without_points(status),
        };
        if start_hz.total_cmp(&stop_hz).is_ne() {
            match &mut self.nonlinear {
                Some(row) => row.trace(&mut trace, stop_hz, grid_hz),
                None => trace.status = Status::SingularJacobian,
            }
        }
        trace
    }

    /// A point of this row higher than `best`, the highest one solved, on a curve that folds, see
    /// [`super::folded_peak`].
    ///
    /// # Errors
    /// `branch_jump` where the curve from `best` does not lead to known points.
    pub(super) fn over_folds(
        &mut self,
        best: &Point,
        tolerance: f64,
        open: bool,
    ) -> Result<Option<Point>, Status> {
        match &mut self.nonlinear {
            Some(row) => over_folds(row, &self.known.solved, best, tolerance, open),
            None => Ok(None),
        }
    }
}

/// Tries to solve `row` at one frequency, Hz, in one way.
fn attempt_at(
    row: &mut RowEquation<'_>,
    known: &KnownPoints,
    attempt: Attempt,
    frequency_hz: f64,
) -> Result<Point, Status> {
    let start = match attempt {
        Attempt::Neighbours => {
            let (mut starts, stuck_too) = known.expected(frequency_hz);
            if stuck_too {
                starts.push(row.stuck_start(frequency_hz)?);
            }
            row.of_least_residual(starts, frequency_hz)?
        }
        Attempt::Line => {
            let mut starts = between(&known.solved, frequency_hz);
            starts.push(row.stuck_start(frequency_hz)?);
            starts.swap_remove(0)
        }
        Attempt::Stuck => row.stuck_start(frequency_hz)?,
        // At fixed drift the curve is not that of a ring that creeps.
        Attempt::Continuation if row.settings.ring == Ring::Creeping => {
            return Err(Status::StepTooSmall);
        }
        Attempt::Continuation => {
            let nearest = known.nearest(frequency_hz).ok_or(Status::StepTooSmall)?;
            return row.continue_to(nearest, frequency_hz);
        }
        Attempt::StiffnessHomotopy => return stiffen_contact(row, frequency_hz),
        Attempt::LoadHomotopy => return lower_normal_load(row, frequency_hz),
    };
    row.newton(frequency_hz, start, None)
}
