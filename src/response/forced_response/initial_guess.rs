//! Initial guesses of a row: what the points solved so far lead one to expect at a frequency.

use super::point::Point;
use crate::response::receptance::WheelSolver;

/// Share of the frequency within which a point at which most pairs slip tells more than the stuck solution.
const NEAR: f64 = 0.002;

/// The points that tell where to start.
#[derive(Default)]
pub(super) struct KnownPoints {
    /// Converged points, in the order in which they were solved.
    pub(super) solved: Vec<Point>,
}

impl KnownPoints {
    /// The solved point nearest to a frequency, Hz.
    pub(super) fn nearest(&self, frequency_hz: f64) -> Option<&Point> {
        nearest(&self.solved, frequency_hz)
    }

    /// What the points beside the frequency, Hz, lead one to expect, and whether the stuck solution, which is the
    /// answer itself where nothing slips, may be as good.
    pub(super) fn expected(&self, frequency_hz: f64) -> (Vec<Vec<f64>>, bool) {
        let nearest = self.nearest(frequency_hz).map(|point| {
            let distance = (point.frequency_hz - frequency_hz).abs();
            (distance <= NEAR * frequency_hz, point.shares)
        });
        let mut starts = between(&self.solved, frequency_hz);
        match nearest {
            // Contact that opens folds the curve: the straight line stays on its branch most often.
            Some((_, shares)) if shares.separated > 0.0 => {
                starts.truncate(1);
                (starts, false)
            }
            Some((true, shares)) if shares.slipping > 0.5 => (starts, false),
            _ => (starts, true),
        }
    }
}

/// The point nearest to a frequency, Hz.
pub(super) fn nearest(points: &[Point], frequency_hz: f64) -> Option<&Point> {
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
        return vec![first.solution.clone()];
    };
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

/// Motions between the solutions of `solver` next to a frequency, Hz, on either side; the nearest solution where there is none on one
/// side.
pub(super) fn between_neighbours(
    points: &[Point],
    solver: &WheelSolver<'_>,
    frequency_hz: f64,
) -> Option<Vec<f64>> {
    let next = |is_below: bool| {
        let side = points.iter();
        let side = side.filter(move |point| (point.frequency_hz <= frequency_hz) == is_below);
        side.min_by(|a, b| {
            let distance = |point: &Point| (point.frequency_hz - frequency_hz).abs();
            distance(a).total_cmp(&distance(b))
        })
    };
    let (Some(low), Some(high)) = (next(true), next(false)) else {
        return nearest(points, frequency_hz).map(|point| point.solution.clone());
    };
    let share = (frequency_hz - low.frequency_hz) / (high.frequency_hz - low.frequency_hz);
    Some(solver.between_turning(&low.solution, &high.solution, share))
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
