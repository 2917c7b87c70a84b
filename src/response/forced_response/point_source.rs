//! What a search asks of a solver of points, and which resonances of the stuck limit it has to look at: a mode that hardly slips keeps its
//! height and is as narrow as without friction, while friction holds the others far below their linear heights.

use super::point::{Point, Work, point_at};
use super::point_solver::PointSolver;
use super::search::{Curve, Sample};
use crate::response::harmonic_balance::Status;
use crate::response::receptance::Resonance;

/// Share of pairs that slip beside a resonance that may be one with stuck contact.
const STICKS: f64 = 0.5;
/// Height of a resonance among others, over that of its mode alone.
const JOINED: f64 = 2.0;
/// Distance of a sample that has seen a resonance, in half-bandwidths.
const SEEN: f64 = 0.5;
/// Height of such a sample over that of the best, from which the resonance may be the higher one: at that distance it reads a tenth lower.
const RIVAL: f64 = 0.89;

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
    fn read(&mut self, frequency_hz: f64) -> Option<Vec<f64>> {
        self.solver.amplitudes_at(frequency_hz)
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

/// The frequency, Hz, at which a resonance may be higher than the best: one that no sample is near enough to have seen, and that lies outside
/// of the samples or where the contact of one beside it sticks: the band of a search is that of the high resonances alone. Where a sample
/// has seen it nearly as high as the best, one on its other side tells whether it is higher.
pub(super) fn unseen(
    stuck: &[Resonance],
    samples: &[Sample],
    best: usize,
    sticks: impl Fn(f64) -> bool,
) -> Option<f64> {
    let best = &samples[best];
    let unseen_at = |peak: &Resonance| {
        let at = peak.frequency_hz;
        let right = samples.partition_point(|sample| sample.frequency_hz < at);
        let left = right.checked_sub(1).and_then(|left| samples.get(left));
        let beside = [left, samples.get(right)];
        let both = || beside.into_iter().flatten();
        // Outside of the samples the nearest one is too far away to tell.
        let may_stick = || both().count() < 2 || both().any(|sample| sticks(sample.frequency_hz));
        if JOINED * peak.amplitude_m <= best.largest || !may_stick() {
            return None;
        }
        let within = |sample: &Sample, half_bandwidths: f64| {
            (sample.frequency_hz - at).abs() <= half_bandwidths * peak.half_bandwidth_hz
        };
        let Some(near) = both().find(|sample| within(sample, SEEN)) else {
            return Some(at);
        };
        let is_rival = near.largest > RIVAL * best.largest
            && near.frequency_hz.total_cmp(&best.frequency_hz).is_ne();
        let [alone_below, alone_above] =
            beside.map(|sample| sample.is_none_or(|sample| !within(sample, 2.0 * SEEN)));
        let beside_it = SEEN * peak.half_bandwidth_hz;
        match is_rival {
            true if alone_below => Some(at - beside_it),
            true if alone_above => Some(at + beside_it),
            _ => None,
        }
    };
    stuck.iter().find_map(unseen_at)
}
