//! The solution of a point by way of easier problems: under a higher normal load, or with softer contact.

use std::f64::consts::TAU;

use super::point::Point;
use super::row_equation::RowEquation;
use super::softer_contact::from_softer_contact;
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::{HarmonicSystem, Status};

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

/// By way of softer contact, which slips little.
pub(super) fn stiffen_contact(
    row: &mut RowEquation<'_>,
    frequency_hz: f64,
) -> Result<Point, Status> {
    let mut last = Err(Status::StepTooSmall);
    let found = from_softer_contact(|share, starts| {
        let other = (share < 1.0).then(|| softened(&row.system, share));
        let start = match (starts, &other) {
            ([start], _) => start.clone(),
            (_, Some(other)) => other.stuck_response(TAU * frequency_hz)?,
            (_, None) => return None,
        };
        last = row.newton(frequency_hz, start, other.as_ref());
        Some(last.as_ref().ok()?.solution.clone())
    });
    found.ok_or(Status::StepTooSmall)?;
    last
}

/// The system under its normal load times `factor`.
fn under_load(system: &HarmonicSystem, factor: f64) -> HarmonicSystem {
    let pairs = system.pairs().iter().map(|pair| PairParameters {
        normal_load_n: factor * pair.normal_load_n,
        ..*pair
    });
    locked(system.with_pairs(pairs.collect()))
}

/// The system with a share of its tangential stiffness.
fn softened(system: &HarmonicSystem, share: f64) -> HarmonicSystem {
    locked(system.with_tangential_stiffness(share))
}

/// The system with the ring at rest, as it is on the way of a homotopy.
fn locked(mut system: HarmonicSystem) -> HarmonicSystem {
    system.set_ring_drift([0.0; 2]);
    system
}
