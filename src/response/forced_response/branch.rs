//! The response curve between two frequencies followed as one curve, through its folds.
//!
//! Where the curve folds, several solutions belong to one frequency. Counted along the curve from
//! its start, those of odd number, between one fold and the next, are the ones that no sweep
//! reaches: a sweep in the direction of the trace follows branch 0 to its fold, then jumps.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use super::point::Point;
use super::row_equation::RowEquation;
use crate::response::harmonic_balance::{Continuation, ContinuationBounds, PathPoint, Status};

/// Frequency scale where no linear resonance tells it, over the frequency.
const FREQUENCY_SCALE: f64 = 1e-3;
/// Bounds of the frequency scale over the frequency.
const FREQUENCY_SCALES: (f64, f64) = (1e-6, 2e-2);
/// Largest number of correctors of a continuation to one frequency.
const CORRECTORS_TO_ONE_FREQUENCY: u64 = 60;
/// Correctors of a trace: at least, and per frequency scale between its ends.
const CORRECTORS: u64 = 4000;
const CORRECTORS_PER_SCALE: f64 = 8.0;
/// Largest number of correctors of any trace.
const MOST_CORRECTORS: f64 = 1e5;

/// A point of the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct BranchPoint {
    /// The converged point.
    pub point: Point,
    /// Number of folds between the start of the trace and the point.
    pub branch: u32,
    /// What the point is.
    pub place: BranchPlace,
}

/// What a point of the curve is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BranchPlace {
    /// A step of the continuation.
    Step,
    /// A frequency asked for.
    Grid,
    /// A fold; it belongs to the branch that ends there.
    Fold,
}

/// The curve from one frequency towards another.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseTrace {
    /// Points in their order along the curve.
    pub points: Vec<BranchPoint>,
    /// `ok` if the curve reached the far end: it is complete. Else why not.
    pub status: Status,
}

impl ResponseTrace {
    /// A trace without points that ended with `status`.
    pub(super) fn without_points(status: Status) -> Self {
        Self {
            points: Vec::new(),
            status,
        }
    }

    /// A trace of nothing but its first point, which may be one of `grid_hz`.
    pub(super) fn beginning_at(first: Point, grid_hz: &[f64]) -> Self {
        let place = if grid_hz.contains(&first.frequency_hz) {
            BranchPlace::Grid
        } else {
            BranchPlace::Step
        };
        let first = BranchPoint {
            place,
            point: first,
            branch: 0,
        };
        Self {
            points: vec![first],
            status: Status::Ok,
        }
    }

    /// The folds, in their order along the curve.
    pub fn folds(&self) -> impl Iterator<Item = &BranchPoint> {
        self.points
            .iter()
            .filter(|point| point.place == BranchPlace::Fold)
    }

    /// Intervals of frequency, Hz, with several solutions: between one fold and the next.
    #[must_use]
    pub fn multivalued_hz(&self) -> Vec<(f64, f64)> {
        let folds: Vec<f64> = self.folds().map(|fold| fold.point.frequency_hz).collect();
        let mut intervals: Vec<(f64, f64)> = folds
            .windows(2)
            .map(|pair| (pair[0].min(pair[1]), pair[0].max(pair[1])))
            .collect();
        intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut joined: Vec<(f64, f64)> = Vec::new();
        for (low, high) in intervals {
            match joined.last_mut() {
                Some(last) if low <= last.1 => last.1 = last.1.max(high),
                _ => joined.push((low, high)),
            }
        }
        joined
    }

    /// The points at a frequency asked for, Hz: one per passage of the curve.
    #[must_use]
    pub fn at(&self, frequency_hz: f64) -> Vec<&BranchPoint> {
        self.points
            .iter()
            .filter(|point| {
                point.place == BranchPlace::Grid
                    && point.point.frequency_hz.total_cmp(&frequency_hz).is_eq()
            })
            .collect()
    }

    /// The point of the largest amplitude and its blade.
    #[must_use]
    pub fn largest(&self) -> Option<(&BranchPoint, usize)> {
        self.points
            .iter()
            .flat_map(|point| (0..point.point.amplitudes_m.len()).map(move |blade| (point, blade)))
            .max_by(|a, b| a.0.point.amplitudes_m[a.1].total_cmp(&b.0.point.amplitudes_m[b.1]))
    }
}

impl RowEquation<'_> {
    /// Follows the curve from the point that `trace` begins with to `stop_hz`; `grid_hz` are frequencies between them
    /// that are solved for exactly, at each passage.
    pub(super) fn trace(&mut self, trace: &mut ResponseTrace, stop_hz: f64, grid_hz: &[f64]) {
        let first = trace.points[0].point.clone();
        let start_hz = first.frequency_hz;
        let bounds = self.continuation_bounds(start_hz);
        let scales = TAU * (stop_hz - start_hz).abs() / bounds.frequency_scale;
        let bounds = ContinuationBounds {
            correctors: CORRECTORS + (CORRECTORS_PER_SCALE * scales).min(MOST_CORRECTORS) as u64,
            ..bounds
        };
        let points = &mut trace.points;
        trace.status = self.follow(&first, (stop_hz, start_hz), bounds, grid_hz, |point| {
            points.push(point);
            ControlFlow::Continue(())
        });
    }

    /// Continuation from the converged point `from` to `frequency_hz`.
    pub(super) fn continue_to(&mut self, from: &Point, frequency_hz: f64) -> Result<Point, Status> {
        let bounds = ContinuationBounds {
            correctors: CORRECTORS_TO_ONE_FREQUENCY,
            ..self.continuation_bounds(from.frequency_hz)
        };
        let mut found = None;
        let ends = (frequency_hz, 2.0 * from.frequency_hz - frequency_hz);
        let grid = [frequency_hz];
        let status = self.follow(from, ends, bounds, &grid, |point| {
            if point.place == BranchPlace::Grid {
                found = Some(point.point);
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        match (found, status) {
            (Some(point), _) => Ok(point),
            (None, Status::Ok) => Err(Status::BranchJump),
            (None, status) => Err(status),
        }
    }

    /// Walks from `from` until beyond the first of `ends_hz`, or until told to stop; hands over steps,
    /// folds and passages of the grid. Beyond the second one, behind the start, it is `branch_jump`:
    /// the wanted end belongs to another curve.
    pub(super) fn follow(
        &mut self,
        from: &Point,
        ends_hz: (f64, f64),
        bounds: ContinuationBounds,
        grid_hz: &[f64],
        mut visit: impl FnMut(BranchPoint) -> ControlFlow<()>,
    ) -> Status {
        let system = &self.system;
        let (stop_hz, back_hz) = ends_hz;
        let rising = stop_hz > from.frequency_hz;
        let omega = TAU * from.frequency_hz;
        let mut walk = match Continuation::new(system, omega, &from.solution, rising, bounds) {
            Ok(walk) => walk,
            Err(status) => return status,
        };
        let mut branch = 0;
        let mut stopped = false;
        let mut hand_over = |point: &PathPoint, frequency_hz, branch, place| {
            let flow = visit(BranchPoint {
                point: self.point_of(frequency_hz, point),
                branch,
                place,
            });
            flow.is_break()
        };
        let status = loop {
            let fold = match walk.advance() {
                Ok(fold) => fold,
                Err(status) => break status,
            };
            // From the last point to the fold, if there is one, and on to the new point.
            let mut stretches = Vec::with_capacity(2);
            let mut begin = walk.previous();
            if let Some(fold) = fold {
                stretches.push((begin, fold.point.clone(), true));
                begin = fold.point;
            }
            stretches.push((begin, walk.point(), false));
            let mut failed = None;
            for (begin, end, is_fold) in stretches {
                for frequency_hz in passed(&begin, &end, grid_hz) {
                    match walk.land(&begin, &end, TAU * frequency_hz) {
                        Ok(point) => {
                            stopped |= hand_over(&point, frequency_hz, branch, BranchPlace::Grid);
                        }
                        Err(status) => failed = Some(status),
                    }
                }
                let place = if is_fold {
                    BranchPlace::Fold
                } else {
                    BranchPlace::Step
                };
                let end_hz = end.omega / TAU;
                if (end_hz < stop_hz) == rising {
                    stopped |= hand_over(&end, end_hz, branch, place);
                }
                branch += u32::from(is_fold);
            }
            if let Some(status) = failed {
                break status;
            }
            let at_hz = walk.point().omega / TAU;
            if stopped || (at_hz >= stop_hz) == rising {
                break Status::Ok;
            }
            if (at_hz < back_hz) == rising {
                break Status::BranchJump;
            }
        };
        let work = walk.work();
        self.work.newton_iterations += work.iterations;
        self.work.factorisations += work.factorisations;
        self.work.folds += u64::from(branch);
        status
    }

    fn point_of(&self, frequency_hz: f64, point: &PathPoint) -> Point {
        Point {
            frequency_hz,
            amplitudes_m: self.amplitudes_of(&point.solution),
            solution: point.solution.clone(),
            residual: point.residual,
            shares: point.shares,
            ring_drift_m: [0.0; 2],
        }
    }

    /// Bounds in which the half-bandwidth of the nearest linear resonance is the frequency scale.
    pub(super) fn continuation_bounds(&self, frequency_hz: f64) -> ContinuationBounds {
        let nearest = self
            .excited
            .linear_peaks(self.condition)
            .into_iter()
            .flatten()
            .filter(|peak| peak.amplitude_m > 0.0)
            .min_by(|a, b| {
                let off = |hz: f64| (hz - frequency_hz).abs();
                off(a.frequency_hz).total_cmp(&off(b.frequency_hz))
            });
        let scale_hz = nearest
            .map_or(FREQUENCY_SCALE * frequency_hz, |peak| {
                peak.half_bandwidth_hz
            })
            .clamp(
                FREQUENCY_SCALES.0 * frequency_hz,
                FREQUENCY_SCALES.1 * frequency_hz,
            );
        ContinuationBounds::new(self.settings.bounds, TAU * scale_hz)
    }
}

/// The frequencies of the grid, Hz, behind `begin` up to `end`, in the order in which they are passed.
fn passed(begin: &PathPoint, end: &PathPoint, grid_hz: &[f64]) -> Vec<f64> {
    let (from, to) = (begin.omega, end.omega);
    let mut inside: Vec<f64> = grid_hz
        .iter()
        .copied()
        .filter(|hz| {
            let omega = TAU * hz;
            (omega > from && omega <= to) || (omega < from && omega >= to)
        })
        .collect();
    inside.sort_by(|a, b| {
        if to > from {
            a.total_cmp(b)
        } else {
            b.total_cmp(a)
        }
    });
    inside
}
