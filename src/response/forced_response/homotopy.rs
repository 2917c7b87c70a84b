//! The solution of a point by way of easier problems: under a higher normal load, or with softer contact.

use std::f64::consts::TAU;

use super::point::Point;
use super::row_equation::RowEquation;
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::{HarmonicSystem, Status};

/// Softest contact of the homotopy in stiffness: this power of [`STIFFNESS_RATIO`] below the wanted one.
const STIFFNESS_STAGES: f64 = 6.0;
const STIFFNESS_RATIO: f64 = 4.0;
/// Smallest step of its exponent.
const SMALLEST_STIFFNESS_STEP: f64 = 1.0 / 8.0;

/// Homotopy in normal load: from a load at which every pair sticks down to that of the
/// scenario, the step (in the logarithm of the load) halved on failure.
pub(super) fn lower_normal_load(
    row: &mut RowEquation<'_>,
    frequency_hz: f64,
) -> Result<Point, Status> {
    const FIRST_FACTOR: f64 = 64.0;
    const SMALLEST_STEP: f64 = 1.0 / 64.0;
    let mut current = row.stuck_start(frequency_hz)?;
    let (mut exponent, mut step) = (1.0, 0.25);
    loop {
        let next = f64::max(exponent - step, 0.0);
        let factor = FIRST_FACTOR.powf(next);
        let other = (next > 0.0).then(|| under_load(&row.system, factor));
        match row.newton(frequency_hz, current.clone(), other.as_ref()) {
            Ok(point) if next <= 0.0 => return Ok(point),
            Ok(point) => {
                current = point.solution;
                exponent = next;
            }
            Err(_) if step > SMALLEST_STEP => step *= 0.5,
            Err(_) => return Err(Status::StepTooSmall),
        }
    }
}

/// Homotopy in tangential contact stiffness, from soft contact, which slips little, to that of
/// the study. Over `1 / kt` the solution tends to that of rigid contact along a line, so each
/// stage starts from the extrapolation of the two before it in `1 / kt`. Newton's method
/// alone fails in stiff contact: what sticks or slips changes within `mu N0 / kt`.
pub(super) fn stiffen_contact(
    row: &mut RowEquation<'_>,
    frequency_hz: f64,
) -> Result<Point, Status> {
    let (mut exponent, mut step) = (STIFFNESS_STAGES, 1.0);
    let first = softened(&row.system, exponent);
    let start = first.stuck_response(TAU * frequency_hz);
    let start = start.ok_or(Status::SingularJacobian)?;
    let compliance = |exponent: f64| STIFFNESS_RATIO.powf(exponent);
    let mut current = row.newton(frequency_hz, start, Some(&first))?.solution;
    let mut previous: Option<(f64, Vec<f64>)> = None;
    loop {
        let next = f64::max(exponent - step, 0.0);
        let start = match &previous {
            None => current.clone(),
            Some((before, solution)) => {
                let share = (compliance(next) - compliance(exponent))
                    / (compliance(exponent) - compliance(*before));
                let pairs = current.iter().zip(solution);
                pairs.map(|(now, old)| now + share * (now - old)).collect()
            }
        };
        let other = (next > 0.0).then(|| softened(&row.system, next));
        match row.newton(frequency_hz, start, other.as_ref()) {
            Ok(point) if next <= 0.0 => return Ok(point),
            Ok(point) => {
                previous = Some((exponent, std::mem::replace(&mut current, point.solution)));
                exponent = next;
                step = f64::min(2.0 * step, 1.0);
            }
            Err(_) if step > SMALLEST_STIFFNESS_STEP => step *= 0.5,
            Err(_) => return Err(Status::StepTooSmall),
        }
    }
}

/// The system under its normal load times `factor`.
fn under_load(system: &HarmonicSystem, factor: f64) -> HarmonicSystem {
    let pairs = system.pairs().iter().map(|pair| PairParameters {
        normal_load_n: factor * pair.normal_load_n,
        ..*pair
    });
    locked(system.with_pairs(pairs.collect()))
}

/// The system with a tangential stiffness [`STIFFNESS_RATIO`] to the power `exponent` smaller.
fn softened(system: &HarmonicSystem, exponent: f64) -> HarmonicSystem {
    locked(system.with_tangential_stiffness(STIFFNESS_RATIO.powf(-exponent)))
}

/// The system with the ring at rest, as it is on the way of a homotopy.
fn locked(mut system: HarmonicSystem) -> HarmonicSystem {
    system.set_ring_drift([0.0; 2]);
    system
}
