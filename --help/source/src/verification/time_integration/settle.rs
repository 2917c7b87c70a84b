//! Marching period after period until the motion repeats itself, or the budget is used up.

use std::collections::VecDeque;

use super::contact_rows::ContactRows;
use super::options::TimeOptions;
use super::periods::{Period, blade_norms};
use super::state::{MarchedWheel, WheelState};
use super::stepper::TimeStepper;
use crate::linalg::Complex64;
use crate::response::harmonic_balance::{ContactShares, Status};

/// How a march ended, and the last period of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// `ok`: periodic. `work_budget`: not periodic within the budget. Otherwise why it broke off;
    /// `singular_jacobian` where it could not begin.
    pub status: Status,
    /// Periods marched.
    pub periods: usize,
    /// Steps per period.
    pub steps_per_period: usize,
    /// Change over the last period of blade displacements, relative to the largest.
    pub blade_change: f64,
    /// Change over the last period of contact forces, relative to the largest.
    pub force_change: f64,
    /// Change of the blades' fundamental amplitudes over the last `drift_periods`, relative to the
    /// largest; infinite before as many periods have passed.
    pub drift: f64,
    /// Largest shift of a tangential contact row over the last period, m: the ring creeping.
    pub creep_m: f64,
    /// Amplitude of harmonic 1 of every blade over the last period, m.
    pub fundamental_m: Vec<f64>,
    /// Amplitude of harmonic 1 of every blade, averaged with its phase over the last
    /// `drift_periods`, m: what a motion that does not repeat itself has at the frequency of the
    /// excitation.
    pub mean_fundamental_m: Vec<f64>,
    /// Largest displacement of every blade about its mean over the period, m.
    pub time_maximum_m: Vec<f64>,
    /// Shares of pairs slipping and open at any step of the last period.
    pub shares: ContactShares,
    /// Iterations on the contact forces, all steps.
    pub contact_iterations: u64,
    /// The state at the end of the last period.
    pub state: WheelState,
}

/// Marches `wheel` from `start` until it is periodic.
///
/// Periodic: blade displacements and contact forces repeat, and the blades' fundamental amplitudes
/// stay over many periods. The position of the ring is not looked at; it may creep.
#[must_use]
pub fn settle(wheel: &MarchedWheel<'_>, start: &WheelState, options: &TimeOptions) -> Settled {
    let mut settled = Settled {
        status: Status::SingularJacobian,
        periods: 0,
        steps_per_period: options.steps_per_period,
        blade_change: f64::INFINITY,
        force_change: f64::INFINITY,
        drift: f64::INFINITY,
        creep_m: f64::INFINITY,
        fundamental_m: Vec::new(),
        mean_fundamental_m: Vec::new(),
        time_maximum_m: Vec::new(),
        shares: ContactShares::default(),
        contact_iterations: 0,
        state: start.clone(),
    };
    let Some(mut stepper) = TimeStepper::new(wheel, start, options.steps_per_period) else {
        return settled;
    };
    let observed = &wheel.structure.observed().real;
    let contact = ContactRows::new(wheel.interface, wheel.structure.contact().real.rows());
    let mut before: Option<Period> = None;
    let mut amplitudes: VecDeque<Vec<Complex64>> = VecDeque::new();
    settled.status = Status::WorkBudget;
    while settled.periods < options.maximum_periods {
        let period = match Period::march(&mut stepper, observed) {
            Ok(period) => period,
            Err(status) => {
                settled.status = status;
                break;
            }
        };
        settled.periods += 1;
        amplitudes.push_back(period.fundamental());
        if amplitudes.len() > options.drift_periods + 1 {
            amplitudes.pop_front();
        }
        if let Some(before) = &before {
            settled.blade_change = period.blade_change(before);
            settled.force_change = period.force_change(before);
            settled.creep_m = period.creep_m(before, contact.tangential_rows());
        }
        settled.drift = drift(&amplitudes, options.drift_periods);
        before = Some(period);
        if settled.periods >= options.minimum_periods && settled.is_periodic(options) {
            settled.status = Status::Ok;
            break;
        }
    }
    if let Some(period) = &before {
        settled.fundamental_m = blade_norms(&period.fundamental());
        settled.mean_fundamental_m = blade_norms(&mean(&amplitudes));
        settled.time_maximum_m = period.time_maxima();
        let (slipping, separated) = period.shares();
        settled.shares = ContactShares {
            slipping,
            separated,
            ..ContactShares::default()
        };
    }
    settled.contact_iterations = stepper.iterations();
    settled.state = stepper.state();
    settled
}

impl Settled {
    fn is_periodic(&self, options: &TimeOptions) -> bool {
        self.blade_change <= options.periodicity_tolerance
            && self.force_change <= options.periodicity_tolerance
            && self.drift <= options.drift_tolerance
    }
}

/// Change of the complex amplitudes over the window, relative to the largest.
fn drift(amplitudes: &VecDeque<Vec<Complex64>>, periods: usize) -> f64 {
    let (Some(first), Some(last)) = (amplitudes.front(), amplitudes.back()) else {
        return f64::INFINITY;
    };
    if amplitudes.len() <= periods {
        return f64::INFINITY;
    }
    let largest = last.iter().map(|x| x.norm()).fold(0.0, f64::max);
    let change = first
        .iter()
        .zip(last)
        .map(|(a, b)| (a - b).norm())
        .fold(0.0, f64::max);
    if largest > 0.0 {
        change / largest
    } else {
        change
    }
}

/// Mean over the window.
fn mean(amplitudes: &VecDeque<Vec<Complex64>>) -> Vec<Complex64> {
    let components = amplitudes.front().map_or(0, Vec::len);
    let mut mean = vec![Complex64::default(); components];
    for period in amplitudes {
        for (mean, x) in mean.iter_mut().zip(period) {
            *mean += x / amplitudes.len() as f64;
        }
    }
    mean
}
