//! What a row on the receptances of the tuned wheel leaves out: errors, and its top on another engine.

use super::a_posteriori::ErrorEstimate;
use super::error_settings::ErrorSettings;
use super::observed_amplitude::ObservedHarmonic;
use super::point::Point;
use super::point_settings::PointSettings;
use super::receptance_points::{EngineRow, observed};
use crate::linalg::Complex64;
use crate::response::harmonic_balance::ContactShares;
use crate::response::receptance::{WheelSolver, embedded};

/// Tolerance of the solutions that tell the errors of another one, over that of the peak, and its bounds.
const ERROR_SHARE: f64 = 0.1;
const ERROR_TOLERANCES: (f64, f64) = (1e-6, 3e-4);

/// What the amplitude of `point` would change by with finer sampling, and with the harmonics that its errors look at beyond its set; on
/// the engine of `row`, which may have more blade shapes than that of the point. None where one of these solutions is not found.
#[must_use]
pub fn receptance_errors(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    point: &Point,
    peak_tolerance: f64,
) -> Option<ErrorEstimate> {
    let tolerance = ERROR_SHARE * peak_tolerance;
    let tolerance = tolerance.clamp(ERROR_TOLERANCES.0, ERROR_TOLERANCES.1);
    let ErrorSettings {
        set,
        amplitude,
        law,
    } = settings.errors();
    let nonlinear = row.condition.normal_load_n().is_some();
    let sticks = law.is_none() && point.shares == ContactShares::default();
    if !nonlinear || sticks {
        return Some(ErrorEstimate::default());
    }
    let [alone, enlarged, tangents] = set.transforms();
    let settled = |mut solver: WheelSolver<'_>, start: &[f64], from: &[u32]| {
        let start = embedded(start, from, solver.harmonics());
        solver.set_ring_drift(point.ring_drift_m);
        let (motions, unsettled) = solver.settle(point.frequency_hz, &start, tolerance)?;
        let observed = observed(&mut solver, amplitude);
        let observed = in_harmonics(&observed, set.harmonics(), row.engine.sectors());
        Some((motions, observed, unsettled))
    };
    let harmonics = settings.harmonics();
    let solver = row.solver(settings, &settings.transform, None);
    let (_, before, _) = settled(solver, &point.solution, harmonics)?;
    let solver = row.solver(settings, alone, *law);
    let (motions, alone, own_unsettled) = settled(solver, &point.solution, harmonics)?;
    let solver = row
        .solver(settings, enlarged, *law)
        .with_coarse_contact(row.contact(settings, tangents, *law));
    let (_, after, unsettled) = settled(solver, &motions, harmonics)?;
    let largest = |amplitudes: Vec<f64>| amplitudes.into_iter().fold(0.0, f64::max);
    let height = largest(amplitude.of_observed(&before));
    let change = |after: &[ObservedHarmonic]| {
        largest(amplitude.changed_observed(&before, after)) / height - 1.0
    };
    let sampling = change(&alone);
    Some(ErrorEstimate {
        sampling,
        harmonics: change(&after) - sampling,
        unsettled: own_unsettled + unsettled,
    })
}

/// Largest amplitude, m, of a row near `point`, a solution of the same wheel on this or on another engine: the top of a parabola
/// through it and two points `step_hz` on either side. None where one of them is not found.
#[must_use]
pub fn receptance_top_m(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    point: &Point,
    step_hz: f64,
    tolerance: f64,
) -> Option<f64> {
    let start = [point.solution.clone()];
    let mut solver = row.solver(settings, &settings.transform, None);
    let mut amplitude_m = |frequency_hz: f64| {
        solver.set_ring_drift(point.ring_drift_m);
        let (solved, _) = solver.solve(frequency_hz, &start, tolerance);
        solved.ok()?;
        let observed = observed(&mut solver, &settings.amplitude);
        let amplitudes_m = settings.amplitude.of_observed(&observed).into_iter();
        Some(amplitudes_m.fold(0.0, f64::max))
    };
    let [low, middle, high] =
        [-step_hz, 0.0, step_hz].map(|way| amplitude_m(point.frequency_hz + way));
    Some(vertex([low?, middle?, high?]).1)
}

/// The top of a parabola through heights at -1, 0 and 1: its place and height; the highest of them where it has none between.
fn vertex([low, middle, high]: [f64; 3]) -> (f64, f64) {
    let (slope, curvature) = (0.5 * (high - low), high - 2.0 * middle + low);
    if curvature < 0.0 && slope.abs() < -curvature {
        let place = -slope / curvature;
        return (place, middle + 0.5 * slope * place);
    }
    [(-1.0, low), (0.0, middle), (1.0, high)]
        .into_iter()
        .fold(
            (0.0, middle),
            |best, sample| if sample.1 > best.1 { sample } else { best },
        )
}

/// Steps by which a top is climbed at most.
const MOST_STEPS: usize = 8;

/// A top of a row beside a solution that was found with less.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TopBeside {
    /// Amplitude, m.
    pub amplitude_m: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// What the amplitude may be off by, relative, because a solution had not settled.
    pub unsettled: f64,
}

/// The top of a row near `point`, a solution of the same wheel in harmonics `from`, which are among those of `settings`; climbed by steps of
/// `step_hz`. None where a solution does not settle, or the top is further away than some steps.
#[must_use]
pub fn receptance_top_beside(
    row: &EngineRow<'_>,
    settings: &PointSettings,
    (point, from): (&Point, &[u32]),
    step_hz: f64,
    tolerance: f64,
) -> Option<TopBeside> {
    let mut solver = row.solver(settings, &settings.transform, None);
    let mut motions = embedded(&point.solution, from, settings.harmonics());
    solver.set_ring_drift(point.ring_drift_m);
    let mut unsettled = 0.0_f64;
    let mut height_m = |frequency_hz: f64| -> Option<f64> {
        let (settled, left) = solver.settle(frequency_hz, &motions, tolerance)?;
        motions = settled;
        unsettled = unsettled.max(left);
        let observed = observed(&mut solver, &settings.amplitude);
        let amplitudes_m = settings.amplitude.of_observed(&observed).into_iter();
        Some(amplitudes_m.fold(0.0, f64::max))
    };
    let mut place = point.frequency_hz;
    let middle = height_m(place)?;
    let low = height_m(place - step_hz)?;
    let mut heights = [low, middle, height_m(place + step_hz)?];
    for _ in 0..MOST_STEPS {
        let [low, middle, high] = heights;
        if low > middle && low >= high {
            place -= step_hz;
            heights = [height_m(place - step_hz)?, low, middle];
        } else if high > middle {
            place += step_hz;
            heights = [middle, high, height_m(place + step_hz)?];
        } else {
            let (steps, amplitude_m) = vertex(heights);
            return Some(TopBeside {
                amplitude_m,
                frequency_hz: place + steps * step_hz,
                unsettled,
            });
        }
    }
    None
}

/// What is observed in the harmonics of a larger set.
fn in_harmonics(
    observed: &[ObservedHarmonic],
    set: &[u32],
    blades: usize,
) -> Vec<ObservedHarmonic> {
    set.iter()
        .map(|&harmonic| ObservedHarmonic {
            harmonic,
            displacement: observed
                .iter()
                .find(|known| known.harmonic == harmonic)
                .map_or_else(
                    || vec![Complex64::default(); 3 * blades],
                    |known| known.displacement.clone(),
                ),
        })
        .collect()
}
