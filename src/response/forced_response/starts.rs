//! Where Newton's method starts at a frequency of a row: from what is known beside it.

use std::f64::consts::TAU;

use super::point::Point;
use super::point_solver::PointSolver;
use crate::response::harmonic_balance::Status;

/// Share of the frequency within which a point at which most pairs slip tells more than the stuck solution.
pub(super) const NEAR: f64 = 0.002;

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

fn nearest(points: &[Point], frequency_hz: f64) -> Option<&Point> {
    points.iter().min_by(|a, b| {
        let distance = |point: &Point| (point.frequency_hz - frequency_hz).abs();
        distance(a).total_cmp(&distance(b))
    })
}

/// The solution of the nearest point, and the polynomials through the two and three nearest with points on
/// either side.
pub(super) fn between(points: &[Point], frequency_hz: f64) -> Vec<Vec<f64>> {
    let distance = |point: &Point| (point.frequency_hz - frequency_hz).abs();
    let mut near: Vec<&Point> = points.iter().collect();
    near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(&first) = near.first() else {
        return Vec::new();
    };
    let below = first.frequency_hz <= frequency_hz;
    let other = near[1..]
        .iter()
        .find(|point| (point.frequency_hz <= frequency_hz) != below);
    let Some(&second) = other else {
        let ahead = first.slope.as_ref().map(|slope| {
            let step = frequency_hz - first.frequency_hz;
            let tangent = first.solution.iter().zip(&slope.solution);
            tangent.map(|(x, slope)| x + step * slope).collect()
        });
        return ahead.into_iter().chain([first.solution.clone()]).collect();
    };
    if let Some(start) = hermite(first, second, frequency_hz) {
        return vec![start];
    }
    let mut starts = vec![interpolated(&[first, second], frequency_hz)];
    let third = near[1..].iter().find(|point| {
        let differs = |other: &Point| point.frequency_hz.total_cmp(&other.frequency_hz).is_ne();
        differs(first) && differs(second)
    });
    if let Some(&third) = third {
        starts.push(interpolated(&[first, second, third], frequency_hz));
    }
    starts
}

/// The cubic through two solutions with their slopes at `frequency_hz`; none where a slope is not known.
fn hermite(first: &Point, second: &Point, frequency_hz: f64) -> Option<Vec<f64>> {
    let (first_slope, second_slope) = (first.slope.as_ref()?, second.slope.as_ref()?);
    let width = second.frequency_hz - first.frequency_hz;
    let t = (frequency_hz - first.frequency_hz) / width;
    let values = [(1.0 + 2.0 * t) * (1.0 - t).powi(2), t * t * (3.0 - 2.0 * t)];
    let slopes = [width * t * (1.0 - t).powi(2), width * t * t * (t - 1.0)];
    let ends = first.solution.iter().zip(&second.solution);
    let rates = first_slope.solution.iter().zip(&second_slope.solution);
    let sum = ends.zip(rates).map(|((x0, x1), (s0, s1))| {
        values[0] * x0 + values[1] * x1 + slopes[0] * s0 + slopes[1] * s1
    });
    Some(sum.collect())
}

/// The polynomial through the solutions of `points`, of different frequencies, at `frequency_hz`.
fn interpolated(points: &[&Point], frequency_hz: f64) -> Vec<f64> {
    let mut sum = vec![0.0; points[0].solution.len()];
    for (at, point) in points.iter().enumerate() {
        let others = points.iter().enumerate().filter(|(other, _)| *other != at);
        let share: f64 = others
            .map(|(_, other)| {
                (frequency_hz - other.frequency_hz) / (point.frequency_hz - other.frequency_hz)
            })
            .product();
        for (sum, x) in sum.iter_mut().zip(&point.solution) {
            *sum += share * x;
        }
    }
    sum
}
