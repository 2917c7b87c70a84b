//! Where Newton's method starts at a frequency of a row: the initial guess with the smallest residual.

use std::f64::consts::TAU;

use super::point::Point;
use super::point_solver::PointSolver;
use super::starts::{NEAR, between, nearest};
use crate::response::harmonic_balance::Status;

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
}
