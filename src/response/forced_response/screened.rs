//! The points of a search, screened by a solution with fewer harmonics.
//!
//! Most points of a search only show that nothing is higher there, by a wide margin. For that harmonic 1 alone will do, at a
//! fraction of the cost; where it comes near the highest point so far all harmonics are solved, beside it.

use super::excited::Excited;
use super::initial_guess::NEAR;
use super::point::point_at;
use super::point::{Point, Work};
use super::point_solver::PointSolver;
use super::point_source::{sticks, unseen};
use super::search::{Curve, Reading, Sample};
use crate::response::receptance::Resonance;

/// Share of its height that a point may gain by the harmonics left out. Harmonic 3 raised the highest blade of a lumped wheel
/// by 6 %, and lowered that of another by a fifth, which is why the highest place of few harmonics is solved with all at
/// once.
const GAINED: f64 = 0.3;

/// Solver of a search; `'search` is the lifetime of what only the search needs.
pub(super) struct Screened<'a, 'search> {
    solver: PointSolver<'a>,
    /// With fewer harmonics; none where all points are solved with all.
    few: Option<(&'search Excited, PointSolver<'search>)>,
    /// Highest amplitude with all harmonics so far, m.
    highest_m: f64,
    /// Resonances of the stuck limit.
    stuck: &'search [Resonance],
}

impl<'a, 'search> Screened<'a, 'search> {
    /// Points of `solver`, screened by those of a structure in `few` harmonics where both have slopes; `stuck` are the
    /// resonances of the stuck limit.
    pub(super) fn new(
        solver: PointSolver<'a>,
        few: Option<(&'search Excited, PointSolver<'search>)>,
        stuck: &'search [Resonance],
    ) -> Self {
        let pays = |(_, few): &(_, PointSolver<'_>)| few.is_sloped() && solver.is_sloped();
        Self {
            few: few.filter(pays),
            solver,
            highest_m: 0.0,
            stuck,
        }
    }

    /// Solves the highest of these places first, so that the others are compared with it.
    pub(super) fn begin(&mut self, frequencies_hz: &[f64]) {
        let Some((_, few)) = &mut self.few else {
            return;
        };
        let mut highest: Option<(f64, f64)> = None;
        for &frequency_hz in frequencies_hz {
            let Ok(point) = few.solve(frequency_hz) else {
                continue;
            };
            let height = point.largest_amplitude_m();
            if highest.is_none_or(|(known, _)| height > known) {
                highest = Some((height, frequency_hz));
            }
        }
        if let Some((_, frequency_hz)) = highest {
            self.point(frequency_hz);
        }
    }

    fn point(&mut self, frequency_hz: f64) -> Option<Reading> {
        if let Some(point) = point_at(self.solver.points(), frequency_hz) {
            return Some(point.reading());
        }
        if let Some(low) = self.screened(frequency_hz) {
            return Some(low);
        }
        let point = self.solver.solve(frequency_hz).ok()?;
        self.highest_m = self.highest_m.max(point.largest_amplitude_m());
        Some(point.reading())
    }

    /// The reading with few harmonics where it is too low for more to matter.
    fn screened(&mut self, frequency_hz: f64) -> Option<Reading> {
        let (excited, few) = self.few.as_mut()?;
        let known = point_at(few.points(), frequency_hz).cloned();
        let point = if let Some(point) = known {
            point
        } else {
            // Beside a known point all harmonics cost no more.
            let near =
                |point: &Point| (point.frequency_hz - frequency_hz).abs() <= NEAR * frequency_hz;
            if self.solver.nearest(frequency_hz).is_some_and(near) {
                return None;
            }
            few.solve(frequency_hz).ok()?.clone()
        };
        if point.largest_amplitude_m() * (1.0 + GAINED) < self.highest_m {
            return Some(point.reading());
        }
        self.solver.start_beside(excited, point);
        None
    }

    /// Whether few pairs slip at a point that is solved.
    fn sticks(&self, frequency_hz: f64) -> bool {
        let few = self.few.as_ref();
        let point = point_at(self.solver.points(), frequency_hz)
            .or_else(|| point_at(few?.1.points(), frequency_hz));
        point.is_some_and(sticks)
    }

    /// The solver of all harmonics, and the work of the solver of few.
    pub(super) fn into_parts(self) -> (PointSolver<'a>, Work) {
        let work = self.few.map_or(Work::default(), |(_, few)| few.work());
        (self.solver, work)
    }
}

impl Curve for &mut Screened<'_, '_> {
    fn read(&mut self, frequency_hz: f64) -> Option<Reading> {
        self.point(frequency_hz)
    }

    fn unseen(&self, samples: &[Sample], best: usize) -> Option<f64> {
        unseen(self.stuck, samples, best, |hz| self.sticks(hz))
    }
}
