//! The harmonic balance equation of one row at any frequency, solved by Newton's method from a start that is given.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::excited::Excited;
use super::observed_amplitude::ObservedBlock;
use super::options::ContactCondition;
use super::point::{Point, Work};
use super::point_settings::PointSettings;
use crate::linalg::{Complex64, LuWorkspace};
use crate::response::friction::{PairParameters, Ring};
use crate::response::harmonic_balance::{
    DriftingRing, HarmonicSystem, NewtonBounds, NewtonOutcome, NewtonWorkspace, Status, let_creep,
    solve,
};

/// The equation of one row, with the buffers of its solver.
pub(super) struct RowEquation<'a> {
    pub(super) excited: &'a Excited,
    pub(super) condition: ContactCondition,
    pub(super) settings: &'a PointSettings,
    pub(super) system: HarmonicSystem,
    workspace: NewtonWorkspace,
    /// Factors of the stuck limit.
    stuck: LuWorkspace<Complex64>,
    /// Relative precision of the amplitudes at which a point may end before its residual is met.
    pub(super) precision: Option<f64>,
    pub(super) work: Work,
}

impl<'a> RowEquation<'a> {
    /// The equation of `condition`; none for a linear limit.
    pub(super) fn new(
        excited: &'a Excited,
        condition: ContactCondition,
        settings: &'a PointSettings,
    ) -> Option<Self> {
        let ContactCondition::Full { normal_load_n } = condition else {
            return None;
        };
        let (law, sector) = settings.contact?;
        let interface = settings.interface(law, sector, normal_load_n);
        let system = HarmonicSystem::new(
            excited.blocks.clone(),
            excited.force.clone(),
            interface,
            Arc::clone(&settings.transform),
        );
        Some(Self {
            excited,
            condition,
            settings,
            workspace: NewtonWorkspace::new(&system),
            system,
            stuck: LuWorkspace::new(excited.linear.structure.size()),
            precision: None,
            work: Work::default(),
        })
    }

    /// The equation that `point` solves, with its buffers.
    pub(super) fn at(&mut self, point: &Point) -> (&HarmonicSystem, &mut NewtonWorkspace) {
        self.system.set_ring_drift(point.ring_drift_m);
        (&self.system, &mut self.workspace)
    }

    /// The response with every pair stuck, as a start.
    pub(super) fn stuck_start(&mut self, frequency_hz: f64) -> Result<Vec<f64>, Status> {
        let stuck = self
            .excited
            .linear_response(self.condition, frequency_hz, &mut self.stuck)
            .ok_or(Status::SingularJacobian)?;
        // The fundamental and nothing else.
        let mut start = vec![0.0; self.system.unknowns()];
        let at = self.system.block_start(self.system.fundamental());
        start[at..at + 2 * stuck.len()].copy_from_slice(&real_parts(&stuck));
        Ok(start)
    }

    /// The one of `starts` with the smallest residual.
    pub(super) fn of_least_residual(
        &mut self,
        starts: Vec<Vec<f64>>,
        frequency_hz: f64,
    ) -> Result<Vec<f64>, Status> {
        let omega = TAU * frequency_hz;
        let best = self
            .workspace
            .of_least_residual(&self.system, omega, starts);
        best.ok_or(Status::NonFinite)
    }

    /// Newton's method from `start`; on another system than that of the row where one is given.
    pub(super) fn newton(
        &mut self,
        frequency_hz: f64,
        start: Vec<f64>,
        other: Option<&HarmonicSystem>,
    ) -> Result<Point, Status> {
        let (system, workspace) = (&mut self.system, &mut self.workspace);
        let mut x = start;
        let omega = TAU * frequency_hz;
        let bounds = self.settings.bounds;
        let (outcome, ring_drift_m) = if let Some(other) = other {
            // On the way the ring is locked.
            let outcome = solve(other, omega, &mut x, bounds, None, workspace);
            (outcome, [0.0; 2])
        } else {
            let blocks = ObservedBlock::all(&self.excited.blocks);
            let amplitude = &self.settings.amplitude;
            let precision = self.precision;
            let steady = |x: &[f64], step: &[f64]| {
                precision.is_some_and(|share| {
                    // Cheap to ask, and nearly always the answer.
                    let small = norm(step) <= WHOLE_STEP * share * norm(x);
                    small && amplitude.is_steady(&blocks, x, step, share)
                })
            };
            let outcome = match self.settings.ring {
                Ring::Locked => solve(system, omega, &mut x, bounds, Some(&steady), workspace),
                Ring::Creeping => {
                    system.set_ring_drift([0.0; 2]);
                    let mut ring = CreepingRing {
                        system,
                        omega,
                        x: &mut x,
                        bounds,
                        workspace,
                        outcome: None,
                    };
                    let status = let_creep(&mut ring);
                    let outcome = ring.outcome.ok_or(status)?;
                    NewtonOutcome { status, ..outcome }
                }
            };
            (outcome, system.ring_drift_m())
        };
        self.work.newton_iterations += outcome.iterations;
        self.work.factorisations += outcome.factorisations;
        if outcome.status != Status::Ok {
            return Err(outcome.status);
        }
        Ok(Point {
            frequency_hz,
            amplitudes_m: self.amplitudes_of(&x),
            solution: x,
            residual: outcome.residual,
            shares: outcome.shares,
            ring_drift_m,
        })
    }

    /// Amplitude of every blade, m, of a nonlinear solution.
    pub(super) fn amplitudes_of(&self, solution: &[f64]) -> Vec<f64> {
        let blocks = ObservedBlock::all(&self.excited.blocks);
        self.settings.amplitude.of(&blocks, solution)
    }
}

/// The equation of a row at one frequency with a ring that creeps.
struct CreepingRing<'a> {
    system: &'a mut HarmonicSystem,
    omega: f64,
    x: &'a mut Vec<f64>,
    bounds: NewtonBounds,
    workspace: &'a mut NewtonWorkspace,
    /// How the last solution ended, with the work of all.
    outcome: Option<NewtonOutcome>,
}

impl DriftingRing for CreepingRing<'_> {
    fn pairs(&self) -> &[PairParameters] {
        self.system.pairs()
    }

    fn free_motions(&self) -> [bool; 2] {
        self.system.free_ring_motions()
    }

    fn drift_m(&self) -> [f64; 2] {
        self.system.ring_drift_m()
    }

    fn set_drift(&mut self, drift_m: [f64; 2]) {
        self.system.set_ring_drift(drift_m);
    }

    fn mean_friction_n(&mut self) -> [f64; 2] {
        self.system
            .mean_friction_n(self.x, self.workspace.system_mut())
    }

    fn solve(&mut self) -> Status {
        let bounds = self.bounds;
        let mut found = solve(
            self.system,
            self.omega,
            self.x,
            bounds,
            None,
            self.workspace,
        );
        if let Some(before) = self.outcome {
            found.iterations += before.iterations;
            found.factorisations += before.factorisations;
        }
        self.outcome = Some(found);
        found.status
    }
}

/// A step that changes the amplitudes by a share is no longer than this many times the share of the solution.
const WHOLE_STEP: f64 = 10.0;

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Real parts, then imaginary parts.
pub(super) fn real_parts(x: &[Complex64]) -> Vec<f64> {
    x.iter()
        .map(|x| x.re)
        .chain(x.iter().map(|x| x.im))
        .collect()
}
