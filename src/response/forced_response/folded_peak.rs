//! The top of a response curve that folds, which a search with one solution per frequency walks past.
//!
//! Where a contact opens the curve softens, leans over and folds: between its folds several solutions
//! belong to one frequency, the search gets one of them, and its samples jump from one branch to
//! another. Two samples are known to lie on one curve once continuation from one has landed on the
//! other. Stretches that could hide a jump are walked so, and what is passed higher up is the peak.

use std::ops::ControlFlow;

use super::branch::BranchPlace;
use super::point::Point;
use super::row_equation::RowEquation;
use super::search::Envelope;
use super::search::Sample;
use crate::response::friction::Ring;
use crate::response::harmonic_balance::{ContinuationBounds, Status};

/// Correctors of one walk.
const CORRECTORS: u64 = 400;
/// First step of a walk down from the peak, see [`ContinuationBounds`].
const FIRST_STEP: f64 = 0.25;
/// What is this low relative to the highest point, at half the power, is off the peak: a walk ends there, and a
/// fall from there is none of the peak's.
const FAR_DOWN: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Beyond the ends of a band that may be widened, a walk goes on for this share of the frequency.
const BEYOND_BAND: f64 = 0.5;
/// Largest distance of two solutions that are one, over their norm.
const SAME: f64 = 1e-3;
/// Steps are made this much smaller round after round to read the top.
const FINER: f64 = 8.0;

/// Steepness of a fall that no single branch shows, over that of the narrowest linear resonance:
/// friction only adds damping.
const CLIFF: f64 = 8.0;
/// Share of the higher of two neighbours at which a fall begins to count.
const FALLEN: f64 = 0.98;

/// Whether two neighbouring samples, the higher one of at least half the power of the best, are
/// further apart in height than on any one branch.
pub(super) fn falls_off(samples: &[Sample], best: usize, envelope: Envelope) -> bool {
    samples.windows(2).any(|pair| {
        let (lower, higher) = if pair[0].largest < pair[1].largest {
            (&pair[0], &pair[1])
        } else {
            (&pair[1], &pair[0])
        };
        let distance = (pair[1].frequency_hz - pair[0].frequency_hz).abs();
        let widths = CLIFF * distance / envelope.linear_half_bandwidth_hz;
        higher.largest >= FAR_DOWN * samples[best].largest
            && lower.largest < FALLEN * higher.largest / (1.0 + widths * widths).sqrt()
    })
}

/// A point higher than `best`, the highest one solved, on the curve of `row` from `best` to `known` points of
/// less than half its power on either side; none where nothing is higher between them. Beyond
/// the known points the curve is followed if the band is `open`.
///
/// Only contacts that open fold a curve of these laws: without separation at `best` nothing is
/// done. Nor is there a curve to follow where the ring creeps.
///
/// # Errors
/// `branch_jump` where the curve from `best` does not lead to known points.
pub(super) fn over_folds(
    row: &mut RowEquation<'_>,
    known: &[Point],
    best: &Point,
    tolerance: f64,
    open: bool,
) -> Result<Option<Point>, Status> {
    let creeps = row.settings.ring == Ring::Creeping
        && best.ring_drift_m.iter().any(|drift| drift.abs() > 0.0);
    if best.shares.separated <= 0.0 || creeps {
        return Ok(None);
    }
    let mut highest: Option<Point> = None;
    for rising in [false, true] {
        let above = highest.as_ref().unwrap_or(best).largest_amplitude_m();
        let (before, point) = down_from(row, known, best, rising, open)?;
        if point.largest_amplitude_m() <= (1.0 + 0.5 * tolerance) * above {
            continue;
        }
        let folds = row.work.folds;
        highest = Some(summit(row, before, point, tolerance));
        // The same folds again.
        row.work.folds = folds;
    }
    Ok(highest)
}

/// Follows the curve from `best` until it lands on a known point far down, or on the last one;
/// the highest point passed, with the one before it.
fn down_from(
    row: &mut RowEquation<'_>,
    known: &[Point],
    best: &Point,
    rising: bool,
    open: bool,
) -> Result<(Point, Point), Status> {
    let frequencies = || known.iter().map(|point| point.frequency_hz);
    let low = frequencies().fold(best.frequency_hz, f64::min);
    let high = frequencies().fold(best.frequency_hz, f64::max);
    let (last_hz, back_hz, beyond) = if rising {
        (high, low, 1.0 + BEYOND_BAND)
    } else {
        (low, high, 1.0 - BEYOND_BAND)
    };
    let stop_hz = if open { beyond * last_hz } else { last_hz };
    // Not where the walk begins: it would land at once.
    let grid: Vec<f64> = frequencies()
        .filter(|hz| hz.total_cmp(&best.frequency_hz).is_ne())
        .collect();
    let bounds = ContinuationBounds {
        first_step: FIRST_STEP,
        correctors: CORRECTORS,
        ..row.continuation_bounds(best.frequency_hz)
    };
    let (mut previous, mut before, mut highest) = (best.clone(), best.clone(), best.clone());
    let mut on_known = false;
    let status = row.follow(best, (stop_hz, back_hz), bounds, &grid, |passed| {
        let point = passed.point;
        let amplitude = point.largest_amplitude_m();
        let mut arrived = false;
        if passed.place == BranchPlace::Grid {
            on_known = known.iter().any(|known| same(known, &point));
            let last = point.frequency_hz.total_cmp(&last_hz).is_eq();
            let far_down = amplitude <= FAR_DOWN * highest.largest_amplitude_m();
            arrived = on_known && (far_down || last);
        }
        if amplitude > highest.largest_amplitude_m() {
            before = std::mem::replace(&mut previous, point.clone());
            highest = point;
        } else {
            previous = point;
        }
        if arrived {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    if status == Status::Ok && on_known {
        Ok((before, highest))
    } else {
        Err(Status::BranchJump)
    }
}

/// The top of the curve, to a tolerance, that rises from `before` to `highest`, one step on.
fn summit(row: &mut RowEquation<'_>, before: Point, highest: Point, tolerance: f64) -> Point {
    let (mut before, mut highest) = (before, highest);
    // Half a step of relative length s beside a top, 1 - s^2 / 8 of it is read.
    let finest = 2.0 * tolerance.sqrt();
    let bounds = ContinuationBounds {
        correctors: CORRECTORS,
        ..row.continuation_bounds(highest.frequency_hz)
    };
    let mut step = bounds.largest_step;
    while step > finest {
        step = (step / FINER).max(finest);
        let bounds = ContinuationBounds {
            first_step: step,
            largest_step: step,
            ..bounds
        };
        let rising = highest.frequency_hz > before.frequency_hz;
        let ends_hz = if rising {
            (f64::INFINITY, 0.0)
        } else {
            (0.0, f64::INFINITY)
        };
        let from = before.clone();
        let mut previous = before.clone();
        // As far as the curve can be followed; a walk that ends early has seen no less.
        row.follow(&from, ends_hz, bounds, &[], |passed| {
            let point = passed.point;
            let falls = point.largest_amplitude_m() < previous.largest_amplitude_m();
            if point.largest_amplitude_m() > highest.largest_amplitude_m() {
                before = previous.clone();
                highest = point.clone();
            }
            previous = point;
            if falls {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
    }
    highest
}

/// Whether a passage of the frequency of a known point is that point.
fn same(known: &Point, point: &Point) -> bool {
    if known.frequency_hz.total_cmp(&point.frequency_hz).is_ne() {
        return false;
    }
    let pairs = || known.solution.iter().zip(&point.solution);
    let size: f64 = known.solution.iter().map(|x| x * x).sum();
    let apart: f64 = pairs().map(|(a, b)| (a - b).powi(2)).sum();
    apart <= SAME * SAME * size
}
