//! Initial guesses of a row: what the points solved so far, and points with fewer harmonics, lead one to expect at a frequency.

use super::excited::Excited;
use super::point::{Point, Slope};
use super::starts::{NEAR, between, nearest};
use crate::response::harmonic_balance::HarmonicBlock;

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
        for own in &from.blocks {
            if own.harmonic == block.harmonic {
                found = Some(at..at + size(own));
            }
            at += size(own);
        }
        match found {
            Some(place) => all.extend_from_slice(&solution[place]),
            None => all.resize(all.len() + size(block), 0.0),
        }
    }
    all
}
