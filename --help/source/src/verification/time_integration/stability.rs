//! Floquet multipliers of the periodic motion next to a state: whether the wheel stays on it.
//!
//! Let `Phi` take the state at phase zero to that one period later. A periodic motion is a fixed
//! point; a small deviation from it is multiplied by `M = dPhi/dz` every period, so that it grows
//! if an eigenvalue of M (a Floquet multiplier) is larger than 1. Newton's method closes the period,
//!
//! ```text
//! z <- z - (M - I)^+ (Phi(z) - z)
//! ```
//!
//! M by differences of the marched period, one march per component of the state
//!
//! ```text
//! z = (q, q' / omega, friction of every pair along t1, t2)
//! ```
//!
//! (where a pair is and how it is loaded follows from q). The pseudo-inverse leaves out the directions
//! in which every state is periodic: the offset of a pair that sticks, the position of a free ring.
//! Their multipliers are 1. The map is that of the discrete march; it is differentiable but where
//! a pair starts or ends to slip or to separate exactly at the end of a step.

use rayon::prelude::*;

use super::contact_rows::ContactRows;
use super::periods::{Period, blade_norms};
use super::state::{MarchedWheel, WheelState};
use super::stepper::TimeStepper;
use crate::linalg::{Complex64, Matrix, eigenvalues, hermitian_eigen};
use crate::response::friction::PairMemory;
use crate::response::harmonic_balance::{ContactShares, Status};

/// Components of the state at most: a march each, several times.
const MOST_COMPONENTS: usize = 700;
/// Steps of Newton's method at most.
const STEPS: usize = 20;
/// Change of the state over a period, relative to its scale, at which the period counts as closed.
const CLOSED: f64 = 1e-5;
/// Disturbance of the differences, relative to the scale of the component.
const DISTURBANCE: f64 = 1e-6;
/// Singular values of `M - I` below this, relative to the largest, are directions in which any
/// state is periodic.
const NEUTRAL: f64 = 1e-6;
/// A multiplier above 1 by more than this is one of a growing deviation: those that are 1 (pairs
/// that stick, a ring that creeps) come out of the differences within 1e-5.
const GROWTH: f64 = 1e-3;

/// A periodic motion of the wheel and its stability.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicMotion {
    /// `ok`: the period is closed. `stagnated`: Newton's method did not close it. Otherwise why a
    /// march broke off; `work_budget` where the state has too many components.
    pub status: Status,
    /// Newton steps taken.
    pub newton_steps: usize,
    /// Largest change of the state over the period, relative to its scale.
    pub change: f64,
    /// Floquet multipliers, the largest first; of the last state looked at, also if not closed.
    pub multipliers: Vec<Complex64>,
    /// Amplitude of harmonic 1 of every blade, m.
    pub fundamental_m: Vec<f64>,
    /// Shares of pairs slipping and open at any step of the period.
    pub shares: ContactShares,
    /// The state at phase zero.
    pub state: WheelState,
}

impl PeriodicMotion {
    /// Largest modulus of a multiplier.
    #[must_use]
    pub fn largest_multiplier(&self) -> Option<f64> {
        self.multipliers.first().map(|multiplier| multiplier.norm())
    }

    /// Whether deviations from the periodic motion die out (or stay, as those of pairs that stick do);
    /// none where the period is not closed.
    #[must_use]
    pub fn is_stable(&self) -> Option<bool> {
        let largest = self
            .largest_multiplier()
            .filter(|_| self.status == Status::Ok)?;
        Some(largest <= 1.0 + GROWTH)
    }
}

/// Looks for the periodic motion next to `start`, with `steps_per_period`, and for its multipliers.
#[must_use]
pub fn periodic_motion(
    wheel: &MarchedWheel<'_>,
    start: &WheelState,
    steps_per_period: usize,
) -> PeriodicMotion {
    let mut found = PeriodicMotion {
        status: Status::WorkBudget,
        newton_steps: 0,
        change: f64::INFINITY,
        multipliers: Vec::new(),
        fundamental_m: Vec::new(),
        shares: ContactShares::default(),
        state: start.clone(),
    };
    let map = PeriodMap::new(wheel, start, steps_per_period);
    let mut z = map.components(start);
    if z.len() > MOST_COMPONENTS {
        return found;
    }
    found.status = map.close(&mut z, &mut found);
    found.state = map.state(&z);
    found
}

/// The map of one period in scaled components.
struct PeriodMap<'a> {
    wheel: &'a MarchedWheel<'a>,
    contact: ContactRows,
    steps_per_period: usize,
    balance_n: Vec<f64>,
    scale: Vec<f64>,
}

/// One marched period: the components after it, and what was seen on the way.
struct Marched {
    after: Vec<f64>,
    period: Period,
}

impl<'a> PeriodMap<'a> {
    fn new(wheel: &'a MarchedWheel<'a>, start: &WheelState, steps_per_period: usize) -> Self {
        let contact = ContactRows::new(wheel.interface, wheel.structure.contact().real.rows());
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        let position = largest(&start.position).max(largest(&start.velocity) / wheel.omega);
        let mut scale = vec![position; 2 * start.position.len()];
        scale.extend(contact.parameters().flat_map(|pair| {
            let limit = pair.friction_coefficient * pair.normal_load_n;
            [limit.max(f64::MIN_POSITIVE); 2]
        }));
        Self {
            wheel,
            contact,
            steps_per_period,
            balance_n: start.balance_n.clone(),
            scale,
        }
    }

    fn components(&self, state: &WheelState) -> Vec<f64> {
        let velocity = state.velocity.iter().map(|v| v / self.wheel.omega);
        let friction = state.pairs.iter().flat_map(|pair| pair.friction_n);
        let all = state.position.iter().copied().chain(velocity);
        all.chain(friction)
            .zip(&self.scale)
            .map(|(component, scale)| component / scale)
            .collect()
    }

    fn state(&self, z: &[f64]) -> WheelState {
        let physical: Vec<f64> = z.iter().zip(&self.scale).map(|(z, s)| z * s).collect();
        let size = self.wheel.structure.size();
        let position = physical[..size].to_vec();
        let velocity = physical[size..2 * size].iter();
        let displacement = self.wheel.structure.contact().real.times_vector(&position);
        let pairs = self
            .contact
            .parameters()
            .zip(physical[2 * size..].chunks(2));
        let pairs = pairs.enumerate().map(|(index, (pair, friction))| {
            let displacement_m = self.contact.gather(index, &displacement);
            let closing = if self.wheel.interface.law.has_variable_load() {
                displacement_m[0]
            } else {
                0.0
            };
            PairMemory {
                displacement_m,
                signed_load_n: pair.normal_load_n + pair.normal_stiffness_n_per_m * closing,
                friction_n: [friction[0], friction[1]],
                slipping: false,
            }
        });
        WheelState {
            pairs: pairs.collect(),
            velocity: velocity.map(|v| v * self.wheel.omega).collect(),
            position,
            balance_n: self.balance_n.clone(),
        }
    }

    fn stepper(&self, z: &[f64]) -> Option<TimeStepper<'a>> {
        TimeStepper::new(self.wheel, &self.state(z), self.steps_per_period)
    }

    fn march(&self, stepper: &mut TimeStepper<'_>, z: &[f64]) -> Result<Marched, Status> {
        stepper.restart(&self.state(z));
        let period = Period::march(stepper, &self.wheel.structure.observed().real)?;
        Ok(Marched {
            after: self.components(&stepper.state()),
            period,
        })
    }

    /// `dPhi/dz` at `z`, where `Phi(z) = after`.
    fn jacobian(&self, z: &[f64], after: &[f64]) -> Result<Matrix<f64>, Status> {
        let columns: Vec<Vec<f64>> = (0..z.len())
            .into_par_iter()
            .map_init(
                || self.stepper(z),
                |stepper, component| {
                    let stepper = stepper.as_mut().ok_or(Status::SingularJacobian)?;
                    let mut disturbed = z.to_vec();
                    disturbed[component] += DISTURBANCE;
                    let marched = self.march(stepper, &disturbed)?;
                    let change = marched.after.iter().zip(after);
                    Ok(change.map(|(a, b)| (a - b) / DISTURBANCE).collect())
                },
            )
            .collect::<Result<_, Status>>()?;
        Ok(Matrix::from_fn(z.len(), z.len(), |i, j| columns[j][i]))
    }

    /// Newton's method on `Phi(z) = z`; of several lengths of a step that with the smallest change over a
    /// period is taken, also if it is larger than before: the map has kinks.
    fn close(&self, z: &mut Vec<f64>, found: &mut PeriodicMotion) -> Status {
        let Some(mut stepper) = self.stepper(z) else {
            return Status::SingularJacobian;
        };
        let change = |z: &[f64], marched: &Marched| -> Vec<f64> {
            marched.after.iter().zip(z).map(|(a, b)| a - b).collect()
        };
        let mut marched = match self.march(&mut stepper, z) {
            Ok(marched) => marched,
            Err(status) => return status,
        };
        loop {
            let residual = change(z, &marched);
            found.change = residual.iter().fold(0.0, |a, x| f64::max(a, x.abs()));
            found.fundamental_m = blade_norms(&marched.period.fundamental());
            let (slipping, separated) = marched.period.shares();
            found.shares = ContactShares {
                slipping,
                separated,
                ..ContactShares::default()
            };
            let jacobian = match self.jacobian(z, &marched.after) {
                Ok(jacobian) => jacobian,
                Err(status) => return status,
            };
            found.multipliers = eigenvalues(&jacobian);
            if found.change <= CLOSED {
                return Status::Ok;
            }
            let step = minimum_norm_step(jacobian, &residual);
            let Some(step) = step.filter(|_| found.newton_steps < STEPS) else {
                return Status::Stagnated;
            };
            found.newton_steps += 1;
            let trials = [1.0, 0.5, 0.25, 0.125].into_iter().filter_map(|factor| {
                let trial: Vec<f64> = z.iter().zip(&step).map(|(z, s)| z + factor * s).collect();
                let marched = self.march(&mut stepper, &trial).ok()?;
                Some((norm(&change(&trial, &marched)), trial, marched))
            });
            let best = trials.min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, trial, next)) = best else {
                return Status::Stagnated;
            };
            (*z, marched) = (trial, next);
        }
    }
}

/// `-(M - I)^+ r`, without the directions in which every state is periodic.
fn minimum_norm_step(mut jacobian: Matrix<f64>, residual: &[f64]) -> Option<Vec<f64>> {
    for i in 0..residual.len() {
        jacobian[(i, i)] -= 1.0;
    }
    let (squares, vectors) = hermitian_eigen(&jacobian.adjoint_times(&jacobian)).ok()?;
    let largest = squares.iter().copied().fold(0.0, f64::max);
    let loads = vectors.adjoint_times_vector(&jacobian.adjoint_times_vector(residual));
    let shares: Vec<f64> = loads
        .iter()
        .zip(&squares)
        .map(|(load, &square)| {
            if square > NEUTRAL * NEUTRAL * largest {
                -load / square
            } else {
                0.0
            }
        })
        .collect();
    Some(vectors.times_vector(&shares))
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
