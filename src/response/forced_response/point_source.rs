//! What a search asks of a solver of points, and which resonances of the stuck limit it has to look at: a mode that hardly slips keeps its
//! height and is as narrow as without friction, while friction holds the others far below their linear heights.

use super::point::{Point, Work, point_at};
use super::point_solver::PointSolver;
use super::search::{Curve, Reading, Sample};
use crate::response::harmonic_balance::Status;
use crate::response::receptance::Resonance;

/// Share of pairs that slip beside a resonance that may be one with stuck contact.
const STICKS: f64 = 0.5;
/// Height of a resonance among others, over that of its mode alone.
const JOINED: f64 = 2.0;
/// Distance of a sample that has seen a resonance, in half-bandwidths.
const SEEN: f64 = 0.5;

/// A row at any frequency.
pub(super) trait PointSource {
    /// Amplitude of every blade, m, at a frequency, Hz, that may have been solved before; none where it cannot be.
    fn amplitudes_at(&mut self, frequency_hz: f64) -> Option<Vec<f64>>;

    /// Converged points, in the order in which they were solved.
    fn points(&self) -> &[Point];

    /// Frequencies that could not be solved, Hz, with the status of the last attempt.
    fn failures(&self) -> &[(f64, Status)];

    /// The point at a frequency, Hz, to the tolerance of the residual.
    ///
    /// # Errors
    /// The status of the last attempt, if none converged.
    fn finished(&mut self, frequency_hz: f64) -> Result<Point, Status>;

    /// From now on a point ends where the next step would change no amplitude by more than `share` of the largest.
    fn set_precision(&mut self, share: f64);

    /// Mean friction force on the ring at a point, N per sector; none for a linear limit.
    fn mean_friction_n(&mut self, point: &Point) -> Option<[f64; 2]>;

    /// Work done so far.
    fn work(&self) -> Work;
}

impl PointSource for PointSolver<'_> {
    fn amplitudes_at(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
        Self::amplitudes_at(self, frequency_hz)
    }

    fn points(&self) -> &[Point] {
        Self::points(self)
    }

    fn failures(&self) -> &[(f64, Status)] {
        Self::failures(self)
    }

    fn finished(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        self.finish(frequency_hz).cloned()
    }

    fn set_precision(&mut self, share: f64) {
        Self::set_precision(self, share);
    }

    fn mean_friction_n(&mut self, point: &Point) -> Option<[f64; 2]> {
        Self::mean_friction_n(self, point)
    }

    fn work(&self) -> Work {
        Self::work(self)
    }
}

/// The points of a solver, and the resonances of the stuck limit, ascending in frequency, that may stand above them.
pub(super) struct Watched<'a, S> {
    pub(super) solver: &'a mut S,
    pub(super) stuck: &'a [Resonance],
}

impl<S: PointSource> Curve for Watched<'_, S> {
    fn read(&mut self, frequency_hz: f64) -> Option<Reading> {
        self.solver.amplitudes_at(frequency_hz).map(Reading::from)
    }

    fn unseen(&self, samples: &[Sample], best: usize) -> Option<f64> {
        let sticks =
            |frequency_hz| point_at(self.solver.points(), frequency_hz).is_some_and(sticks);
        unseen(self.stuck, samples, best, sticks)
    }

    fn is_steep(&self) -> bool {
        opens(self.solver.points())
    }
}

/// Whether a contact opens at one of the points.
pub(super) fn opens(points: &[Point]) -> bool {
    points.iter().any(|point| point.shares.separated > 0.0)
}

/// Whether few pairs slip at a point.
pub(super) fn sticks(point: &Point) -> bool {
    point.shares.slipping < STICKS
}

/// The frequency, Hz, of a resonance that may be higher than the best, that no sample is near enough to have seen, and that lies outside of
/// the samples or where the contact of one beside it sticks: the band of a search is that of the high resonances alone.
pub(super) fn unseen(
    stuck: &[Resonance],
    samples: &[Sample],
    best: usize,
    sticks: impl Fn(f64) -> bool,
) -> Option<f64> {
    let is_unseen = |peak: &&Resonance| {
        let below = |sample: &Sample| sample.frequency_hz < peak.frequency_hz;
        let right = samples.partition_point(below);
        let beside = || {
            let left = right.checked_sub(1).and_then(|left| samples.get(left));
            left.into_iter().chain(samples.get(right))
        };
        let seen = |sample: &Sample| {
            let distance = (sample.frequency_hz - peak.frequency_hz).abs();
            distance <= SEEN * peak.half_bandwidth_hz
        };
        // Outside of the samples the nearest one is too far away to tell.
        let may_stick =
            || beside().count() < 2 || beside().any(|sample| sticks(sample.frequency_hz));
        JOINED * peak.amplitude_m > samples[best].largest && !beside().any(seen) && may_stick()
    };
    stuck.iter().find(is_unseen).map(|peak| peak.frequency_hz)
}
