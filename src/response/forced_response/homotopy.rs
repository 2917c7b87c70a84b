//! Solutions reached from an easier problem: a higher normal load, or softer contact.

use std::f64::consts::TAU;

use super::point_solver::{Point, PointSolver};
use crate::response::friction::PairParameters;
use crate::response::harmonic_balance::{
    Along, ContactShares, Continuation, ContinuationBounds, HarmonicSystem, Status, linear_response,
};

/// Softest contact of the homotopy in stiffness: this power of [`STIFFNESS_RATIO`] below the wanted one.
const STIFFNESS_STAGES: f64 = 6.0;
const STIFFNESS_RATIO: f64 = 4.0;
/// Smallest step of its exponent.
const SMALLEST_STIFFNESS_STEP: f64 = 1.0 / 8.0;

/// Factor on the normal load, again and again, until every pair sticks, and how often at most.
const TOWARDS_STUCK: f64 = 4.0;
const LOAD_RAISES: i32 = 40;
/// Change of the logarithm of the normal load that weighs as much as a change of the whole solution,
/// and correctors on the way.
const LOAD_SCALE: f64 = 1.0;
const LOAD_CORRECTORS: u64 = 400;

impl PointSolver<'_> {
    /// Homotopy in normal load: from a load at which every pair sticks down to that of the
    /// scenario, the step (in the logarithm of the load) halved on failure.
    pub(super) fn lower_normal_load(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        const FIRST_FACTOR: f64 = 64.0;
        const SMALLEST_STEP: f64 = 1.0 / 64.0;
        let mut current = self.stuck_start(frequency_hz)?;
        let (mut exponent, mut step) = (1.0, 0.25);
        loop {
            let next = f64::max(exponent - step, 0.0);
            let factor = FIRST_FACTOR.powf(next);
            let other = (next > 0.0).then(|| self.under_load(factor)).flatten();
            match self.newton(frequency_hz, current.clone(), other.as_ref()) {
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
    pub(super) fn stiffen_contact(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let (mut exponent, mut step) = (STIFFNESS_STAGES, 1.0);
        let first = self.softened(exponent).ok_or(Status::SingularJacobian)?;
        let start = self.stuck_start_of(&first, frequency_hz)?;
        let compliance = |exponent: f64| STIFFNESS_RATIO.powf(exponent);
        let mut current = self.newton(frequency_hz, start, Some(&first))?.solution;
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
            let other = (next > 0.0).then(|| self.softened(next)).flatten();
            match self.newton(frequency_hz, start, other.as_ref()) {
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

    /// Continuation in normal load, from one at which every pair sticks and the linear stuck solution
    /// is exact down to that of the scenario: it passes folds, at which a homotopy ends.
    pub(super) fn follow_normal_load(&mut self, frequency_hz: f64) -> Result<Point, Status> {
        let omega = TAU * frequency_hz;
        let start = self.stuck_start(frequency_hz)?;
        let raised = self.sticking_factor(omega, &start);
        let factor = raised.ok_or(Status::StepTooSmall)?;
        let (system, _) = self.nonlinear.as_ref().ok_or(Status::SingularJacobian)?;
        let system = locked(system.clone());
        let bounds = ContinuationBounds {
            correctors: LOAD_CORRECTORS,
            ..ContinuationBounds::new(self.settings.bounds, LOAD_SCALE)
        };
        let along = Along::NormalLoad { omega };
        let mut walk = Continuation::new(&system, along, factor.ln(), &start, false, bounds)?;
        let arrived = loop {
            if let Err(status) = walk.step_on() {
                break Err(status);
            }
            let (before, here) = (walk.previous(), walk.point());
            if here.parameter <= 0.0 {
                break walk.land(&before, &here, 0.0);
            }
            // Back beyond where every pair sticks: no way leads to the load of the scenario.
            if here.parameter > factor.ln() {
                break Err(Status::BranchJump);
            }
        };
        let work = walk.work();
        self.work.newton_iterations += work.iterations;
        self.work.factorisations += work.factorisations;
        self.newton(frequency_hz, arrived?.solution, None)
    }

    /// Smallest factor tried on the normal load under which every pair sticks at the stuck solution;
    /// none where no load is raised.
    fn sticking_factor(&mut self, omega: f64, stuck: &[f64]) -> Option<f64> {
        let mut residual = vec![0.0; stuck.len()];
        (0..LOAD_RAISES)
            .map(|raise| TOWARDS_STUCK.powi(raise))
            .find(|&factor| {
                let Some(system) = self.under_load(factor) else {
                    return false;
                };
                let Some((_, workspace)) = &mut self.nonlinear else {
                    return false;
                };
                let buffers = workspace.system_mut();
                let (_, shares) = system.residual(omega, stuck, &mut residual, false, buffers);
                shares == ContactShares::default()
            })
    }

    /// The system of the row under its normal load times `factor`.
    fn under_load(&self, factor: f64) -> Option<HarmonicSystem> {
        let (system, _) = self.nonlinear.as_ref()?;
        let pairs = system.pairs().iter().map(|pair| PairParameters {
            normal_load_n: factor * pair.normal_load_n,
            ..*pair
        });
        Some(locked(system.with_pairs(pairs.collect())))
    }

    /// The system of the row with a tangential stiffness [`STIFFNESS_RATIO`] to the power `exponent` smaller.
    fn softened(&self, exponent: f64) -> Option<HarmonicSystem> {
        let (system, _) = self.nonlinear.as_ref()?;
        let softer = system.with_tangential_stiffness(STIFFNESS_RATIO.powf(-exponent));
        Some(locked(softer))
    }

    /// Linear response on the stuck springs of another system.
    fn stuck_start_of(
        &mut self,
        system: &HarmonicSystem,
        frequency_hz: f64,
    ) -> Result<Vec<f64>, Status> {
        let block = &system.blocks()[system.fundamental()];
        let stuck = linear_response(
            &block.structure,
            Some(&block.stuck),
            TAU * frequency_hz,
            system.force(),
            &mut self.linear,
        );
        self.start_from(&stuck.ok_or(Status::SingularJacobian)?)
    }
}

/// The system with the ring at rest, as it is on the way of a homotopy.
fn locked(mut system: HarmonicSystem) -> HarmonicSystem {
    system.set_ring_drift([0.0; 2]);
    system
}
