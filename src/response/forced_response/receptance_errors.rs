//! What a row on the receptances of the tuned wheel leaves out: its harmonics and samples.

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
    let ErrorSettings { set, amplitude } = settings.errors();
    let nonlinear = row.condition.normal_load_n().is_some();
    let sticks = point.shares == ContactShares::default();
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
    let solver = row.solver(settings, &settings.transform);
    let (_, before, _) = settled(solver, &point.solution, harmonics)?;
    let solver = row.solver(settings, alone);
    let (motions, alone, own_unsettled) = settled(solver, &point.solution, harmonics)?;
    let solver = row
        .solver(settings, enlarged)
        .with_coarse_contact(row.contact(settings, tangents));
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
