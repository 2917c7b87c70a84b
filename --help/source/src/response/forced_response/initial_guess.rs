//! Where the solution of a point begins: the initial guess with the smallest residual, or the solution of an easier problem, under a higher
//! normal load or with softer contact.

use std::f64::consts::TAU;

use super::point::Point;
use super::point_solver::PointSolver;
use super::starts::{NEAR, between, nearest};
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::{HarmonicSystem, Status, linear_response};

/// Softest contact of the homotopy in stiffness: this power of [`STIFFNESS_RATIO`] below the wanted one.
const STIFFNESS_STAGES: f64 = 6.0;
const STIFFNESS_RATIO: f64 = 4.0;
/// Smallest step of its exponent.
const SMALLEST_STIFFNESS_STEP: f64 = 1.0 / 8.0;

impl PointSolver<'_> {
    /// The start with the smallest residual: what the converged points beside the frequency lead one to expect,
    /// or the stuck solution, which is the answer itself where nothing slips.
    pub(super) fn expected(&mut self, frequency_hz: f64) -> Result<Vec<f64>, Status> {
        let nearest = self.nearest(frequency_hz).map(|point| {
            let distance = (point.frequency_hz - frequency_hz).abs();
            (distance <= NEAR * frequency_hz, point.shares)
        });
        let mut starts = between(&self.points, frequency_hz);
        match nearest {
            // Contact that opens folds the curve: the straight line stays on its branch most often.
            Some((_, shares)) if shares.separated > 0.0 => starts.truncate(1),
            Some((true, shares)) if shares.slipping > 0.5 => {}
            _ => starts.push(self.stuck_start(frequency_hz)?),
        }
        self.of_least_residual(starts, frequency_hz)
    }

    /// The start with the smallest residual among the curve with fewer harmonics, moved to the nearest converged point,
    /// and the polynomials through converged points on either side.
    pub(super) fn expected_from_coarse(&mut self, frequency_hz: f64) -> Result<Vec<f64>, Status> {
        let coarse = |frequency_hz: f64| between(&self.coarse, frequency_hz).into_iter().next();
        let mut start = coarse(frequency_hz).ok_or(Status::SingularJacobian)?;
        let mut starts = Vec::new();
        if let Some(near) = nearest(&self.points, frequency_hz) {
            let there = coarse(near.frequency_hz).ok_or(Status::SingularJacobian)?;
            for ((x, fine), coarse) in start.iter_mut().zip(&near.solution).zip(&there) {
                *x += fine - coarse;
            }
            starts = between(&self.points, frequency_hz);
        }
        starts.push(start);
        self.of_least_residual(starts, frequency_hz)
    }

    fn of_least_residual(
        &mut self,
        starts: Vec<Vec<f64>>,
        frequency_hz: f64,
    ) -> Result<Vec<f64>, Status> {
        let Some((system, workspace)) = &mut self.nonlinear else {
            return Err(Status::SingularJacobian);
        };
        let best = workspace.of_least_residual(system, TAU * frequency_hz, starts);
        best.ok_or(Status::NonFinite)
    }

    pub(super) fn nearest(&self, frequency_hz: f64) -> Option<&Point> {
        nearest(&self.points, frequency_hz)
    }

    /// Homotopy in normal load: from a load at which every pair sticks down to that of the
    /// scenario, the step (in the logarithm of the load) halved on failure.
    pub(super) fn lower_normal_load(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        const FIRST_FACTOR: f64 = 64.0;
        const SMALLEST_STEP: f64 = 1.0 / 64.0;
        let mut current = self.stuck_start(frequency_hz)?;
        let (mut exponent, mut step) = (1.0, 0.25);
        loop {
            let next = f64::max(exponent - step, 0.0);
            let factor = FIRST_FACTOR.powf(next);
            let other = (next > 0.0).then(|| self.under_load(factor)).flatten();
            match self.newton(frequency_hz, current.clone(), other.as_ref()) {
                Ok(point) if next <= 0.0 => return Ok(point),
                Ok(point) => {
                    current = point.solution;
                    exponent = next;
                }
                Err(_) if step > SMALLEST_STEP => step *= 0.5,
                Err(_) => return Err(Status::StepTooSmall),
            }
        }
    }

    /// Homotopy in tangential contact stiffness, from soft contact, which slips little, to that of
    /// the study. Over `1 / kt` the solution tends to that of rigid contact along a line, so each
    /// stage starts from the extrapolation of the two before it in `1 / kt`. Newton's method
    /// alone fails in stiff contact: what sticks or slips changes within `mu N0 / kt`.
    pub(super) fn stiffen_contact(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let (mut exponent, mut step) = (STIFFNESS_STAGES, 1.0);
        let first = self.softened(exponent).ok_or(Status::SingularJacobian)?;
        let start = self.stuck_start_of(&first, frequency_hz)?;
        let compliance = |exponent: f64| STIFFNESS_RATIO.powf(exponent);
        let mut current = self.newton(frequency_hz, start, Some(&first))?.solution;
        let mut previous: Option<(f64, Vec<f64>)> = None;
        loop {
            let next = f64::max(exponent - step, 0.0);
            let start = match &previous {
                None => current.clone(),
                Some((before, solution)) => {
                    let share = (compliance(next) - compliance(exponent))
                        / (compliance(exponent) - compliance(*before));
                    let pairs = current.iter().zip(solution);
                    pairs.map(|(now, old)| now + share * (now - old)).collect()
                }
            };
            let other = (next > 0.0).then(|| self.softened(next)).flatten();
            match self.newton(frequency_hz, start, other.as_ref()) {
                Ok(point) if next <= 0.0 => return Ok(point),
                Ok(point) => {
                    previous = Some((exponent, std::mem::replace(&mut current, point.solution)));
                    exponent = next;
                    step = f64::min(2.0 * step, 1.0);
                }
                Err(_) if step > SMALLEST_STIFFNESS_STEP => step *= 0.5,
                Err(_) => return Err(Status::StepTooSmall),
            }
        }
    }

    /// The system of the row under its normal load times `factor`.
    fn under_load(&self, factor: f64) -> Option<HarmonicSystem> {
        let (system, _) = self.nonlinear.as_ref()?;
        let pairs = system.pairs().iter().map(|pair| PairParameters {
            normal_load_n: factor * pair.normal_load_n,
            ..*pair
        });
        Some(locked(system.with_pairs(pairs.collect())))
    }

    /// The system of the row with a tangential stiffness [`STIFFNESS_RATIO`] to the power `exponent` smaller.
    fn softened(&self, exponent: f64) -> Option<HarmonicSystem> {
        let (system, _) = self.nonlinear.as_ref()?;
        let softer = system.with_tangential_stiffness(STIFFNESS_RATIO.powf(-exponent));
        Some(locked(softer))
    }

    /// Linear response on the stuck springs of another system.
    fn stuck_start_of(
        &mut self,
        system: &HarmonicSystem,
        frequency_hz: f64,
    ) -> Result<Vec<f64>, Status> {
        let block = &system.blocks()[system.fundamental()];
        let stuck = linear_response(
            &block.structure,
            Some(&block.stuck),
            TAU * frequency_hz,
            system.force(),
            &mut self.linear,
        );
        self.start_from(&stuck.ok_or(Status::SingularJacobian)?)
    }
}

/// The system with the ring at rest, as it is on the way of a homotopy.
fn locked(mut system: HarmonicSystem) -> HarmonicSystem {
    system.set_ring_drift([0.0; 2]);
    system
}
