//! A response curve followed upwards and downwards: rows, folds, and whether the two agree.

use serde::Serialize;

use crate::population::table::{Direction, TracePoint};
use crate::response::forced_response::{BranchPlace, BranchPoint, ResponseTrace};
use crate::response::harmonic_balance::Status;

/// Largest difference between the two directions that counts as agreement, over the largest
/// amplitude of the curve.
const AGREEMENT: f64 = 1e-5;

/// A point at which the frequency turns.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TracedFold {
    /// Direction of the trace that passed it.
    pub direction: Direction,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Largest amplitude over the blades, m.
    pub amplitude_m: f64,
}

/// Both traces of a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TracedCurve {
    /// Rows of the table: the frequencies asked for and the folds, in the order of the traces.
    #[serde(skip)]
    pub points: Vec<TracePoint>,
    /// How the traces ended, upwards and downwards; `ok`: complete.
    pub status: [Status; 2],
    /// Folds, in the order of the traces.
    pub folds: Vec<TracedFold>,
    /// Intervals of frequency, Hz, with several solutions, seen by either trace.
    pub multivalued_hz: Vec<(f64, f64)>,
    /// Whether both traces passed each frequency with the same solutions.
    pub directions_agree: bool,
    /// Largest difference of the amplitude of a blade between the two, over the largest amplitude;
    /// none where they differ in the number of solutions.
    pub largest_difference: Option<f64>,
    /// Row of the largest amplitude, the steps between the frequencies asked for included.
    pub largest: Option<TracePoint>,
}

impl TracedCurve {
    /// Puts the traces beside each other; a pattern that cannot be applied has none.
    #[must_use]
    pub fn of(traces: &Result<[ResponseTrace; 2], Status>, frequencies_hz: &[f64]) -> Self {
        let (up, down) = match traces {
            Ok([up, down]) => (up, down),
            Err(status) => {
                let points = Direction::BOTH.into_iter().flat_map(|direction| {
                    let frequencies = frequencies_hz.iter();
                    frequencies.map(move |&hz| unsolved(hz, direction, *status))
                });
                return Self {
                    points: points.collect(),
                    status: [*status; 2],
                    folds: Vec::new(),
                    multivalued_hz: Vec::new(),
                    directions_agree: false,
                    largest_difference: None,
                    largest: None,
                };
            }
        };
        let both = || Direction::BOTH.into_iter().zip([up, down]);
        let largest = both()
            .filter_map(|(direction, trace)| {
                let (point, blade) = trace.largest()?;
                Some(row(point, direction, blade))
            })
            .max_by(|a, b| {
                a.amplitude_m
                    .unwrap_or(0.0)
                    .total_cmp(&b.amplitude_m.unwrap_or(0.0))
            });
        let height = largest.and_then(|row| row.amplitude_m).unwrap_or(0.0);
        let largest_difference = difference(up, down, frequencies_hz).map(|d| d / height);
        Self {
            points: both()
                .flat_map(|(direction, trace)| rows(trace, direction, frequencies_hz))
                .collect(),
            status: [up.status, down.status],
            folds: both()
                .flat_map(|(direction, trace)| {
                    trace.folds().map(move |fold| TracedFold {
                        direction,
                        frequency_hz: fold.point.frequency_hz,
                        amplitude_m: fold.point.largest_amplitude_m(),
                    })
                })
                .collect(),
            multivalued_hz: up
                .multivalued_hz()
                .into_iter()
                .chain(
                    // Where the upward trace was cut short, what the downward one saw.
                    (up.status != Status::Ok)
                        .then(|| down.multivalued_hz())
                        .into_iter()
                        .flatten(),
                )
                .collect(),
            directions_agree: largest_difference.is_some_and(|d| d <= AGREEMENT),
            largest_difference,
            largest,
        }
    }
}

/// Largest difference of any blade at any passage, m; the second trace passes them in reverse.
fn difference(up: &ResponseTrace, down: &ResponseTrace, frequencies_hz: &[f64]) -> Option<f64> {
    let mut largest = 0.0_f64;
    for &hz in frequencies_hz {
        let (up, down) = (up.at(hz), down.at(hz));
        if up.len() != down.len() || up.is_empty() {
            return None;
        }
        for (a, b) in up.iter().zip(down.iter().rev()) {
            for (a, b) in a.point.amplitudes_m.iter().zip(&b.point.amplitudes_m) {
                largest = largest.max((a - b).abs());
            }
        }
    }
    Some(largest)
}

/// Rows of one trace, then a row without value for every frequency that it did not pass.
fn rows(trace: &ResponseTrace, direction: Direction, frequencies_hz: &[f64]) -> Vec<TracePoint> {
    let wanted = trace
        .points
        .iter()
        .filter(|point| point.place != BranchPlace::Step);
    let passed = wanted.flat_map(|point| {
        let blades = 0..point.point.amplitudes_m.len();
        blades.map(move |blade| row(point, direction, blade))
    });
    let missing = frequencies_hz
        .iter()
        .filter(|&&hz| trace.at(hz).is_empty())
        .map(|&hz| unsolved(hz, direction, trace.status));
    passed.chain(missing).collect()
}

fn row(point: &BranchPoint, direction: Direction, blade: usize) -> TracePoint {
    TracePoint {
        frequency_hz: point.point.frequency_hz,
        blade: Some(blade as u32),
        amplitude_m: Some(point.point.amplitudes_m[blade]),
        status: Status::Ok,
        direction,
        branch: Some(point.branch),
        fold: point.place == BranchPlace::Fold,
    }
}

fn unsolved(frequency_hz: f64, direction: Direction, status: Status) -> TracePoint {
    TracePoint {
        frequency_hz,
        blade: None,
        amplitude_m: None,
        // A complete trace passes every frequency between its ends.
        status: if status == Status::Ok {
            Status::SweepIncomplete
        } else {
            status
        },
        direction,
        branch: None,
        fold: false,
    }
}
