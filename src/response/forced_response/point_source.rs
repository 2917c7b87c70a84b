//! What a search asks of a solver of points.

use super::point::{Point, Work};
use super::point_solver::PointSolver;
use crate::response::harmonic_balance::Status;

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
        self.precision = Some(share);
    }

    fn mean_friction_n(&mut self, point: &Point) -> Option<[f64; 2]> {
        Self::mean_friction_n(self, point)
    }

    fn work(&self) -> Work {
        Self::work(self)
    }
}
