//! Initial guesses of a row: what the points solved so far, and points with fewer harmonics, lead one to expect at a frequency.

use super::excited::Excited;
use super::point::{Point, Slope};
use crate::response::harmonic_balance::HarmonicBlock;
use crate::response::receptance::WheelSolver;

/// Share of the frequency within which a point at which most pairs slip tells more than the stuck solution.
pub(super) const NEAR: f64 = 0.002;

/// The points that tell where to start.
#[derive(Default)]
pub(super) struct KnownPoints {
    /// Converged points, in the order in which they were solved.
    pub(super) solved: Vec<Point>,
    /// Points with fewer harmonics, in the unknowns of the solved ones; none unless these refine them.
    pub(super) coarse: Vec<Point>,
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

    /// The curve with fewer harmonics, moved to the nearest solved point, and the polynomials through solved points on
    /// either side; none without such a curve.
    pub(super) fn expected_from_coarse(&self, frequency_hz: f64) -> Option<Vec<Vec<f64>>> {
        let coarse = |frequency_hz: f64| between(&self.coarse, frequency_hz).into_iter().next();
        let mut start = coarse(frequency_hz)?;
        let mut starts = Vec::new();
        if let Some(near) = self.nearest(frequency_hz) {
            let there = coarse(near.frequency_hz)?;
            for ((x, fine), coarse) in start.iter_mut().zip(&near.solution).zip(&there) {
                *x += fine - coarse;
            }
            starts = between(&self.solved, frequency_hz);
        }
        starts.push(start);
        Some(starts)
    }
}

/// A point of `from` in the unknowns of `to`, which has its harmonics among others.
pub(super) fn beside(from: &Excited, to: &Excited, point: Point) -> Point {
    Point {
        solution: embedded(from, to, &point.solution),
        slope: point.slope.map(|slope| Slope {
            solution: embedded(from, to, &slope.solution),
            ..slope
        }),
        ..point
    }
}

/// A solution of `from` in the unknowns of `to`.
fn embedded(from: &Excited, to: &Excited, solution: &[f64]) -> Vec<f64> {
    let size = |block: &HarmonicBlock| block.size() * if block.harmonic == 0 { 1 } else { 2 };
    let mut all = Vec::new();
    for block in &to.blocks {
        let mut at = 0;
        let mut found = None;
        for known_block in &from.blocks {
            if known_block.harmonic == block.harmonic {
                found = Some(at..at + size(known_block));
            }
            at += size(known_block);
        }
        match found {
            Some(place) => all.extend_from_slice(&solution[place]),
            None => all.resize(all.len() + size(block), 0.0),
        }
    }
    all
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
