//! Whether a wheel stays on its periodic motion: the largest multiplier of the period's map.
//!
//! Directions in which every state is periodic have the multiplier 1 and are taken out exactly: the slider of a tangent that
//! sticks throughout keeps its place whatever moves, so that disturbances which leave it there are a space of their own; and a
//! ring that nothing holds but friction is periodic wherever it stands, its sliders with it, so that disturbances are looked at
//! up to that one.

use super::arnoldi::{Arnoldi, RitzValue};
use super::contact_path::{ContactMotion, ContactPath};
use super::period_map::PeriodMap;
use crate::linalg::{Complex64, dot};
use crate::response::harmonic_balance::ContactInterface;
use crate::response::receptance::FreeWheel;

/// How multipliers are sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StabilityOptions {
    /// Steps per period. Default 512.
    pub steps_per_period: usize,
    /// A multiplier above 1 by more than this is one of a growing disturbance. Default 1e-3.
    pub growth: f64,
    /// Periods marched at most. Default 300.
    pub maximum_periods: usize,
}

impl Default for StabilityOptions {
    fn default() -> Self {
        Self {
            steps_per_period: 512,
            growth: 1e-3,
            maximum_periods: 300,
        }
    }
}

/// What is known of the multipliers of a periodic motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Multipliers {
    /// The largest one that is not of a neutral direction.
    pub largest: Complex64,
    /// How far its vector is from being one of the map.
    pub residual: f64,
    /// Periods marched.
    pub periods: usize,
    /// Whether disturbances die out; none where that is not settled.
    pub stable: Option<bool>,
}

/// Periods that a first disturbance is marched before multipliers are looked at: what dies out soon is gone then.
const FIRST_PERIODS: usize = 10;
/// Periods between two looks.
const BETWEEN_LOOKS: usize = 10;
/// Looks over which the largest multiplier has to stay.
const LOOKS: usize = 3;
/// Residual of a multiplier of a growing disturbance over its growth, at most.
const CLEAR: f64 = 0.1;

/// The multipliers of the motion `motion` of the contact of a wheel; none where a period cannot be marched.
#[must_use]
pub fn multipliers(
    wheel: &FreeWheel,
    interface: &ContactInterface,
    motion: &ContactMotion,
    omega: f64,
    options: &StabilityOptions,
) -> Option<Multipliers> {
    let steps = options.steps_per_period;
    let contact = ContactPath::new(interface, motion, wheel.sectors, steps);
    let map = PeriodMap::new(wheel, contact, omega)?;
    let neutral = map.neutral(omega);
    let apply = |state: &[f64]| {
        let mut after = map.apply(state)?;
        for direction in &neutral {
            let share = dot(direction, &after);
            let along = after.iter_mut().zip(direction);
            along.for_each(|(x, n)| *x -= share * n);
        }
        Some(after)
    };
    let mut first = map.disturbance();
    for _ in 0..FIRST_PERIODS {
        first = apply(&first)?;
        let norm = dot(&first, &first).sqrt();
        if norm <= f64::MIN_POSITIVE || !norm.is_finite() {
            return None;
        }
        for x in &mut first {
            *x /= norm;
        }
    }
    let mut arnoldi = Arnoldi::new(first);
    let mut seen: Vec<f64> = Vec::new();
    let mut found = None;
    for periods in 1.. {
        arnoldi.extend(apply)?;
        let last = arnoldi.is_closed() || periods + FIRST_PERIODS >= options.maximum_periods;
        if periods % BETWEEN_LOOKS != 0 && !last {
            continue;
        }
        let RitzValue { value, residual } = *arnoldi.largest(1)?.first()?;
        let size = value.norm();
        let near = CLEAR * options.growth.max((size - 1.0).abs());
        let mut earlier = seen.iter().rev().take(LOOKS);
        let stays =
            seen.len() >= LOOKS && earlier.all(|earlier_size| (earlier_size - size).abs() <= near);
        seen.push(size);
        let grows = size > 1.0 + options.growth && residual <= CLEAR * (size - 1.0);
        let decays = size + residual <= 1.0 + options.growth && (stays || arnoldi.is_closed());
        let stable = match (grows, decays) {
            (true, _) => Some(false),
            (_, true) => Some(true),
            _ => None,
        };
        found = Some(Multipliers {
            largest: value,
            residual,
            periods: periods + FIRST_PERIODS,
            stable,
        });
        if stable.is_some() || last {
            break;
        }
    }
    found
}
